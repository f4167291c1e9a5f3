"""Force laws as the columns of the lane kernels: what sweeps take, and what they refuse."""

from __future__ import annotations

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.solvers.small_system import Columns

# Places of MeshContact's parameters that don't shape its tables: k, c, backlash, gap, damping, ramp, impact.
_NO_SHAPE = (0, 1, 2, 3, 4, 5, 12)


def column_of(law: object, place: str, speed: float = 1.0) -> list[tuple[float, ...]]:
    """gap, mode, k, c, backlash, 1/ramp, prescribed force and whether it is a mesh, of each component.

    Raises:
        AnalysisError: the law is none that sweeps take.
    """
    from rotorgear.forces.mesh_contact import DAMPINGS, GAPS, MeshContact
    from rotorgear.forces.rotating_force import RotatingForce
    from rotorgear.forces.torque_curve import TorqueCurve
    from rotorgear.solvers.kernel_lane_parts import LINE, NEVER_PARTS, ONE_SIDED, PRESCRIBED

    if isinstance(law, MeshContact):
        gap = {"line": LINE, "one-sided": ONE_SIDED, "none": NEVER_PARTS}[GAPS[GAPS.index(law.gap)]]
        backlash = np.inf if law.gap == "one-sided" else law.backlash
        mode = DAMPINGS.index(law.contact_damping)
        mean = law.mean().stiffness
        return [(gap, mode, mean, law.damping, backlash, 1.0 / law.ramp, law.impact, 1.0)]
    if isinstance(law, RotatingForce):
        size = law.amplitude * abs(law.order * speed) ** law.power
        return [(PRESCRIBED, 0, 0.0, 0.0, 0.0, 1.0, size, 0.0)] * law.components
    if isinstance(law, TorqueCurve) and law.power == 0.0 and law.step == 1.0 and law.damping == 0.0:
        return [(PRESCRIBED, 0, 0.0, 0.0, 0.0, 1.0, law.torque, 0.0)]
    reason = {
        "TorqueCurve": "a torque that steps or depends on speed",
        "MeshFriction": "friction between the flanks",
        "BallBearing": "rolling elements in a bearing",
        "RollerBearing": "rolling elements in a bearing",
    }.get(type(law).__name__, type(law).__name__)
    raise AnalysisError(
        f"{place}: sweeps don't take {reason}; leave it out, or run single points by the transient analysis"
    )


def columns_of(rows: list[tuple[float, ...]]) -> Columns:
    """Columns from rows of `column_of`."""
    gap, mode, k, c, backlash, ramp, push, mesh = np.array(rows, dtype=float).reshape(-1, 8).T.copy()
    return Columns(gap.astype(np.int64), mode.astype(np.int64), k, c, backlash, ramp, push, mesh > 0.5)


def shape_of(law: object) -> bytes:
    """Bytes that two laws share where their tables are the same."""
    from rotorgear.forces.mesh_contact import MeshContact

    values = law.parameters().copy()  # type: ignore[attr-defined]
    if isinstance(law, MeshContact):
        values[list(_NO_SHAPE)] = 0.0
        return bytes(values.tobytes())
    return bytes(values[1:3].tobytes())
