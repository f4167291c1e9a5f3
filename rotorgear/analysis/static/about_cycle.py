"""The model about the mean state of its loaded teeth over their mesh cycles, which all linear analyses take.

A mesh alone at the force of the torque flow has another stiffness than one that shares its load with others: helices, branches
and loops are solved together (`cycle.py`), and each contact then has its mean tangent in that state.
"""

from __future__ import annotations

from collections.abc import Sequence

from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.solve import Equilibrated, equilibrate
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.model.parts.helix_state import HelixState
from rotorgear.system.system import System

# A helix that carries less than this share of the force of the torque flow is as good as open, as between two shafts that are
# held: its tangent would be that of a few newtons, which the rounding of the map decides.
_CARRIES = 1e-3


def state_speed(model: Model, speeds: Sequence[float | None]) -> float:
    """Speed in rad/s of the static state that analyses at some speeds of one sense are about.

    It is the operating speed where that has the same sense, else the first one; None stands for standstill.
    """
    asked = [speed for speed in speeds if speed is not None]
    operating = (model.operation.speed if model.operation else None) or 0.0
    return operating if not asked or operating * min(asked, key=abs) > 0.0 else asked[0]


def about_cycle(model: Model, speeds: Sequence[float | None]) -> tuple[Model, tuple[str, ...]]:
    """Return the model about the mean state of its loaded teeth, and a sentence where there is no such state.

    A model without loaded teeth (`stiffness = "tooth_fe"`), or that nothing loads, comes back as it is.

    Args:
        model: a checked model, its meshes about the loads along their faces.
        speeds: as for `state_speed`.
    """
    teeth = [name for name, mesh in model.meshes.items() if mesh.stiffness == "tooth_fe" and not mesh.helix_states]
    if not teeth:
        return model, ()
    speed = state_speed(model, speeds)
    load = model.mean_load(-1 if speed < 0.0 else 1).of_kind("static")
    if not load.applied:
        return model, ()
    try:
        equilibrium, joint = over_cycle(equilibrate(System(model, load=load), speed), speed)
    except AnalysisError as error:
        where = ", ".join(f"meshes.{name}" for name in teeth)
        reason = str(error).rstrip(".")
        return model, (
            f"{where}: the mean state of the loaded teeth over the mesh cycle, for which there is no solution ({reason}); the "
            "tangent at the force of the torque flow is taken",
        )
    if joint is None:
        return model, ()
    meshes = dict(model.meshes)
    for name in teeth:
        if states := _states_of(equilibrium, name, [abs(force.normal_force) for force in load.forces]):
            meshes[name] = meshes[name].about_cycle(states)
    return model.model_copy(update={"meshes": meshes}), ()


def _states_of(equilibrium: Equilibrated, mesh: str, flow: Sequence[float]) -> tuple[HelixState, ...]:
    """State of each helix of a mesh, given all forces (N) of the torque flow; none where one carries nothing or has no state."""
    found = []
    for state, closed, carried in zip(equilibrium.lines.states, equilibrium.closed, flow, strict=True):
        if state.contact.mesh != mesh:
            continue
        if not closed or state.start is None or state.normal_force <= _CARRIES * carried:
            return ()
        found.append(
            HelixState(
                force=state.normal_force,
                torque_sense=state.torque_sense,
                pinion_drives=state.pinion_drives,
                stiffness=state.contact.stiffness,
                start=state.start,
                face=state.face,
            )
        )
    return tuple(found)
