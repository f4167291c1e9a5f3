"""The state about the mean of its loaded teeth over their mesh cycles, which all linear analyses take.

A mesh alone at the force of the torque flow has another stiffness than one that shares its load with others: helices, branches
and loops are solved together (`cycle.py`), and each contact then has its mean tangent in that state.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.solve import Equilibrated, equilibrate
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.state import MeshForce, State
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.system.system import flow_system

# A helix that carries less than this share of the force of the torque flow is as good as open, as between two shafts that are
# held: its tangent would be that of a few newtons, which the rounding of the map decides.
_CARRIES = 1e-3


def state_speed(model: Model, speeds: Sequence[float | None], direction: int) -> float:
    """Speed in rad/s of the static state that analyses at some speeds of one sense are about.

    It is the operating speed where that has the same sense, else the first one; None stands for standstill, where it is the
    operating speed in the sense +1 or -1 of the state.
    """
    asked = [speed for speed in speeds if speed is not None]
    operating = (model.operation.speed if model.operation else None) or 0.0
    if not asked:
        return direction * abs(operating)
    return operating if operating * min(asked, key=abs) > 0.0 else asked[0]


def about_cycle(model: Model, speeds: Sequence[float | None], state: State) -> State:
    """Return the state about the mean of the loaded teeth over their mesh cycles, with a note where there is no such mean.

    Without loaded teeth (`stiffness = "tooth_fe"`), or where nothing loads them, it is the one given.

    Args:
        model: a checked model.
        speeds: as for `state_speed`.
        state: about the loads along the faces.
    """
    teeth = [name for name, mesh in model.meshes.items() if mesh.stiffness == "tooth_fe"]
    if not teeth or not state.applied:
        return state
    speed = state_speed(model, speeds, state.direction)
    flow = state.of_kind("static")
    try:
        equilibrium, joint = over_cycle(equilibrate(flow_system(model).with_state(flow), speed), speed)
    except AnalysisError as error:
        reason = (
            f"there is no solution ({str(error).rstrip('.')}); the tangent at the force of the torque flow is taken"
        )
        lost = (
            Note(f"meshes.{name}", "the mean state of its loaded teeth over the mesh cycle", reason) for name in teeth
        )
        return replace(state, notes=(*state.notes, *lost))
    if joint is None:
        return state
    carried = [abs(force.normal_force) for force in flow.forces]
    cycle = {name: found for name in teeth if (found := _cycle_of(equilibrium, name, carried))}
    return replace(state, cycle=cycle).of_kind("dynamic")


def _cycle_of(equilibrium: Equilibrated, mesh: str, flow: Sequence[float]) -> tuple[MeshForce, ...]:
    """State of each helix of a mesh, given all forces (N) of the torque flow; none where one carries nothing or has no state."""
    found = []
    for state, closed, carried in zip(equilibrium.lines.states, equilibrium.closed, flow, strict=True):
        if state.contact.mesh != mesh:
            continue
        if not closed or state.start is None or state.normal_force <= _CARRIES * carried:
            return ()
        found.append(state)
    return tuple(found)
