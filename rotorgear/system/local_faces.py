"""Maps of loaded teeth as the law of their contact."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import PchipInterpolator

if TYPE_CHECKING:
    from rotorgear.forces.loaded_teeth import LoadedTeeth
    from rotorgear.gears.maps.contact_map import ContactMap
    from rotorgear.gears.maps.face_map import FaceMap
    from rotorgear.model.layout.mesh_force import FaceState

# Loads of a law to each step of load of its maps.
_FINER = 8


def teeth_law(
    teeth: ContactMap | FaceMap, stiffness: float, gap: float, face: FaceState | None = None, **more: Any
) -> LoadedTeeth:
    """F(delta, u) of a map, or (F, M)(delta, tilt, u) of the maps along a face.

    Args:
        teeth: of the helix.
        stiffness: of its mean state along the flank normal (N/m).
        gap: what must close before the flanks touch (m).
        face: how the mean state carries along a face that has maps.
        more: further parameters of the law.
    """
    from rotorgear.forces.loaded_teeth import LoadedTeeth
    from rotorgear.gears.maps.contact_map import ContactMap

    maps = (teeth,) if isinstance(teeth, ContactMap) else teeth.maps
    # Where a contact under the largest loads is no line any more, its map ends earlier.
    solved = min((one.load for one in maps), key=len)
    at = np.arange(_FINER * (len(solved) - 1) + 1) / _FINER
    load = np.interp(at, np.arange(len(solved)), solved)
    # Between its loads the curve is the map's own, which knows its tangents.
    approach = np.stack([one.approaches(load) for one in maps])
    given: dict[str, Any] = {"periods": teeth.periods, "error_mean": gap, **more}
    if isinstance(teeth, ContactMap):
        return LoadedTeeth(load, approach[0], stiffness, **given)
    if face is not None:
        given |= {"place": face.place, "tilt_stiffness": face.tilt_stiffness}
    moment = np.stack([PchipInterpolator(one.load, one.moment, axis=1)(load) for one in maps])
    return LoadedTeeth(load, approach, stiffness, tilt=teeth.tilt, moment=moment, **given)


def face_law(face_map: FaceMap, stiffness: float, gap: float) -> LoadedTeeth:
    """(F, M) of approach and tilt without damping, at an angle that is 2 pi times the place u on the map.

    Args:
        face_map: of the helix.
        stiffness: of its mean state along the flank normal (N/m).
        gap: index error (m).
    """
    return teeth_law(face_map, stiffness, gap, order=1.0)
