"""What an equilibrium makes of the state of the torque flow: loads along faces, loaded teeth over their cycles, films.

A mesh alone at the force of the torque flow has another stiffness than one that shares its load with others: helices, branches
and loops are solved together (`cycle.py`), and each contact then has its mean tangent in that state, which all linear analyses
take. Motions in time start from films that keep the temperature and the inlet of their mean state.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rotorgear.analysis.static.along_faces import equilibrate_along_faces
from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.state import State
from rotorgear.model.layout.torque_flow import torque_flow
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.system.local_parts import without_linear_part
from rotorgear.system.system import flow_system

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw
# A helix that carries less than this share of the force of the torque flow is as good as open, as between two shafts that are
# held: its tangent would be that of a few newtons, which the rounding of the map decides.
_CARRIES = 1e-3


def state_speed(model: Model, speeds: Sequence[float | None], direction: int) -> float:
    """Speed in rad/s of the static state that analyses at some speeds of one sense are about.

    It is the operating speed where that has the same sense, else the first one; None is standstill, where it is the
    operating speed in the sense +1 or -1 of the state.
    """
    asked = [speed for speed in speeds if speed is not None]
    operating = model.operating_speed or 0.0
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
        what = "the mean state of its loaded teeth over the mesh cycle"
        why = f"there is no solution ({str(error).rstrip('.')}); the tangent at the force of the torque flow is taken"
        return replace(state, notes=(*state.notes, *(Note(f"meshes.{name}", what, why) for name in teeth)))
    if joint is None:
        return state
    lines = equilibrium.lines
    open_meshes = {
        now.contact.mesh
        for now, closed, alone in zip(lines.states, equilibrium.closed, flow.forces, strict=True)
        if not closed or now.start is None or now.normal_force <= _CARRIES * abs(alone.normal_force)
    }
    cycle = {
        name: tuple(now for now in lines.states if now.contact.mesh == name)
        for name in teeth
        if name in lines.names and name not in open_meshes
    }
    return replace(state, cycle=cycle).of_kind("dynamic")


def along_faces(model: Model, speeds: Sequence[float | None], state: State) -> State:
    """Return the state about the loads along the faces in the static equilibrium, with a note on each such mesh.

    Where no mesh feels a tilt, or nothing loads them, it is the one given.

    Args:
        model: a checked model.
        speeds: of the reference shaft in rad/s, of one sense, as for `state_speed`.
        state: that of the torque flow, with the films and springs in place of bearings that the equilibrium is to have.

    Raises:
        What `equilibrate_along_faces` raises.
    """
    tilted = [name for name, mesh in model.meshes.items() if mesh.tilt]
    if not tilted or not state.applied:
        return state
    speed = state_speed(model, speeds, state.direction)
    films = tuple(state.films.items())
    key = ("along faces", speed, state.direction, films, tuple(state.mapped_at.items()))
    if key in model.states and not state.tangents:
        return model.states[key]
    settled = equilibrate_along_faces(flow_system(model).with_state(state.of_kind("static")), speed)
    found = replace(
        torque_flow(model.layout, state.direction, settled.system.state.faces),
        tangents=state.tangents,
        films=state.films,
        mapped_at=state.mapped_at,
        notes=state.notes,
    )
    if not state.tangents:
        model.states[key] = found
    return found


def state_in_time(model: Model, speed: float, direction: int | None = None) -> State:
    """The state that motions in time start from: films as they are in equilibrium, teeth along their faces with these films.

    Args:
        model: a checked model. speed: of the reference shaft in rad/s.
        direction: its sense of rotation; None: that of the operating speed.

    Raises:
        AnalysisError: there is no equilibrium at that speed.
    """
    return along_faces(model, [speed], replace(model.torque_flow(direction), films=settled_films(model, speed)))


def settled_films(model: Model, speed: float) -> dict[str, tuple[float | None, float | None]]:
    """The films of a model as they are in the equilibrium at a speed, by address: at one temperature and with one inlet.

    Motions in time are too fast to warm a film; and where oil flows in is a place of the bearing, which does not turn with the
    journal: linear analyses take it to stay as well.

    Args:
        model: a checked model. speed: of the reference shaft in rad/s.

    Raises:
        AnalysisError: there is no equilibrium at that speed.
    """
    system = flow_system(model, direction=-1 if speed < 0.0 else 1, kind="static")
    if not speed or not any(any(_settles(part.law)) for part in without_linear_part(system)):
        return {}
    equilibrium, _ = over_cycle(equilibrate(system, speed), speed)
    films: dict[str, tuple[float | None, float | None]] = {}
    for state in equilibrium.laws:
        heats, follows = _settles(state.part.law)
        law: Any = state.part.law.settled(state.d)
        if heats or follows:
            films[state.part.part] = law.temperature if heats else None, law.inlet if follows else None
    return films


def _settles(law: ForceLaw) -> tuple[bool, bool]:
    """Whether a law is a film whose viscosity follows from its heat balance, and one whose inlet is where its gap is widest."""
    return getattr(law, "heats", False), getattr(law, "follows", False)
