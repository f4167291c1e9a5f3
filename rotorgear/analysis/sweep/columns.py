"""Force laws as the columns of the lane kernels: what runs in vectors, what by its own law, and what sweeps refuse."""

from __future__ import annotations

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.solvers.lanes.small_system import Columns

# Places of MeshContact's parameters that don't shape its tables: k, c, backlash, gap, damping, ramp, impact.
_NO_SHAPE = (0, 1, 2, 3, 4, 5, 12)


def column_of(law: object, place: str, speed: float = 1.0) -> list[tuple[float, ...]]:
    """gap, mode, k, c, backlash, 1/ramp, prescribed force and whether it is a mesh, of each component.

    Raises:
        AnalysisError: the law is none that sweeps take.
    """
    from rotorgear.forces.mesh_contact import DAMPINGS, MeshContact
    from rotorgear.forces.rotating_force import RotatingForce
    from rotorgear.forces.torque_curve import TorqueCurve
    from rotorgear.solvers.lanes.kernel_parts import LINE, NEVER_PARTS, ONE_SIDED, OWN_LAW, PRESCRIBED

    if isinstance(law, MeshContact):
        gap = {"dead zone": LINE, "unilateral": ONE_SIDED, "bilateral": NEVER_PARTS}[law.gap]
        backlash = np.inf if law.gap == "unilateral" else law.backlash
        mode = DAMPINGS.index(law.contact_damping)
        mean = law.mean().stiffness
        return [(gap, mode, mean, law.damping, backlash, 1.0 / law.ramp, law.impact, 1.0)]
    if isinstance(law, RotatingForce):
        size = law.amplitude * abs(law.order * speed) ** law.power
        return [(PRESCRIBED, 0, 0.0, 0.0, 0.0, 1.0, size, 0.0)] * law.components
    if isinstance(law, TorqueCurve) and law.step != 1.0:
        raise AnalysisError(
            f"{place}: sweeps don't take a torque that steps at a time, which no settled motion shows; leave step_to out, or run "
            "single points by the transient analysis"
        )
    if isinstance(law, TorqueCurve) and law.power == 0.0 and law.damping == 0.0:
        return [(PRESCRIBED, 0, 0.0, 0.0, 0.0, 1.0, law.torque, 0.0)]
    return [(OWN_LAW, 0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0)] * law.components  # type: ignore[attr-defined]


def columns_of(rows: list[tuple[float, ...]]) -> Columns:
    """Columns from rows of `column_of`."""
    gap, mode, k, c, backlash, ramp, push, mesh = np.array(rows, dtype=float).reshape(-1, 8).T.copy()
    return Columns(gap.astype(np.int64), mode.astype(np.int64), k, c, backlash, ramp, push, mesh > 0.5)


def shape_of(law: object) -> bytes:
    """Bytes that two laws share where their tables are the same."""
    from rotorgear.forces.mesh_contact import MeshContact
    from rotorgear.forces.rotating_force import RotatingForce
    from rotorgear.forces.torque_curve import TorqueCurve

    if isinstance(law, MeshContact):
        values = law.parameters().copy()
        values[list(_NO_SHAPE)] = 0.0
        return bytes(values.tobytes())
    if isinstance(law, RotatingForce):
        return np.array([law.order, law.phase]).tobytes()
    if isinstance(law, TorqueCurve):
        return np.array([law.ripple, law.order, law.phase]).tobytes()
    return b""


def order_of(law: object) -> float:
    """Periods of what varies in a law in a turn of the reference; 0 where nothing does.

    Rolling elements don't count: cages turn with slip-free kinematics that never repeat with teeth.
    """
    from rotorgear.forces.rotating_force import RotatingForce
    from rotorgear.forces.torque_curve import TorqueCurve

    still = (isinstance(law, TorqueCurve) and not law.ripple) or (isinstance(law, RotatingForce) and not law.amplitude)
    if still or is_rolling(law):
        return 0.0
    return abs(float(getattr(law, "order", 0.0)))


def is_rolling(law: object) -> bool:
    """Whether a law is a bearing whose rolling elements turn."""
    return type(law).__name__ in ("BallBearing", "RollerBearing") and bool(getattr(law, "order", 0.0))
