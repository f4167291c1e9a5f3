"""The films that motions in time start from: they keep the temperature and the inlet of their mean state."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from rotorgear.analysis.static.along_faces import along_faces
from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.forces.registry import law_of
from rotorgear.model.layout.state import FilmState, State
from rotorgear.model.model import Model
from rotorgear.model.parts.supports import NonlinearElement
from rotorgear.system.system import flow_system


def state_in_time(model: Model, speed: float, direction: int | None = None) -> State:
    """The state that motions in time start from: films as they are in equilibrium, teeth along their faces with these films.

    Args:
        model: a checked model. speed: of the reference shaft in rad/s.
        direction: its sense of rotation; None: that of the operating speed.

    Raises:
        AnalysisError: there is no equilibrium at that speed.
    """
    return along_faces(model, [speed], replace(model.torque_flow(direction), films=settled_films(model, speed)))


def settled_films(model: Model, speed: float) -> dict[str, FilmState]:
    """The films of a model as they are in the equilibrium at a speed, by address: at one temperature and with one inlet.

    Motions in time are too fast to warm a film; and where oil flows in is a place of the bearing, which does not turn with the
    journal: linear analyses take it to stay as well.

    Args:
        model: a checked model. speed: of the reference shaft in rad/s.

    Raises:
        AnalysisError: there is no equilibrium at that speed.
    """
    films = {
        f"bearings.{name}": (bearing.film.heats, bearing.film.follows)
        for name, bearing in model.bearings.items()
        if bearing.film is not None and bearing.film.settles
    } | {
        f"nonlinear_elements.{name}": (_heats(element), _follows(element))
        for name, element in model.nonlinear_elements.items()
        if _heats(element) or _follows(element)
    }
    if not films or not speed:
        return {}
    system = flow_system(model, direction=-1 if speed < 0.0 else 1, kind="static")
    equilibrium, _ = over_cycle(equilibrate(system, speed), speed)
    laws: dict[str, Any] = {state.part.part: state.part.law.settled(state.d) for state in equilibrium.laws}
    return {
        address: FilmState(laws[address].temperature if heats else None, laws[address].inlet if follows else None)
        for address, (heats, follows) in films.items()
    }


def _heats(element: NonlinearElement) -> bool:
    """Whether an element is a film whose viscosity follows from its heat balance."""
    if "grade" not in law_of(element.law).declared():
        return False
    return bool(element.parameters.get("grade")) and element.parameters.get("heat_share", 1.0) != 0.0


def _follows(element: NonlinearElement) -> bool:
    """Whether an element is a film whose inlet is where its gap is widest."""
    return bool(element.parameters.get("follows")) and "inlet" in law_of(element.law).declared()
