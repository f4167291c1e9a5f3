"""The map of a helix whose flanks tilt, as a law."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw
    from rotorgear.gears.maps.face_map import FaceMap


def face_law(face_map: FaceMap, stiffness: float, gap: float, **more: Any) -> ForceLaw:
    """(F, M) of approach and tilt; its angle is 2 pi times the place u on the map where `more` gives no other order.

    Args:
        face_map: of the helix.
        stiffness: of its mean state along the flank normal (N/m).
        gap: index error (m).
        more: further parameters of the law.
    """
    from rotorgear.forces.loaded_face import LoadedFace

    given: dict[str, Any] = {"order": 1.0, **more}
    return LoadedFace(
        load=face_map.load,
        tilt=face_map.tilt,
        approach=face_map.approach,
        moment=face_map.moment,
        stiffness=stiffness,
        periods=face_map.periods,
        error_mean=gap,
        **given,
    )
