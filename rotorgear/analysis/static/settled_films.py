"""The model that motions in time start from: its oil films keep the temperature and the inlet of their mean state."""

from __future__ import annotations

from typing import Any

from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.forces.registry import law_of
from rotorgear.model.model import Model
from rotorgear.model.parts.nonlinear_element import NonlinearElement
from rotorgear.system.system import System


def with_settled_films(model: Model, speed: float) -> Model:
    """The model with its films as they are in the equilibrium at a speed, at one temperature and with one inlet.

    Motions in time are too fast to warm a film; and where oil flows in is a place of the bearing, which does not turn with the
    journal: linear analyses take it to stay as well. A model without such films comes back as it is.

    Args:
        model: a checked model. speed: of the reference shaft in rad/s.

    Raises:
        AnalysisError: there is no equilibrium at that speed.
    """
    films = [name for name, bearing in model.bearings.items() if bearing.film is not None and bearing.film.settles]
    elements = [name for name, element in model.nonlinear_elements.items() if _heats(element) or _follows(element)]
    if not (films or elements) or not speed:
        return model
    load = model.mean_load(-1 if speed < 0.0 else 1).of_kind("static")
    equilibrium, _ = over_cycle(equilibrate(System(model, load=load), speed), speed)
    found: dict[str, Any] = {state.part.part: state.part.law.settled(state.d) for state in equilibrium.laws}
    bearings = dict(model.bearings)
    for name in films:
        bearing = bearings[name]
        key = "journal" if bearing.journal is not None else "thrust"
        film: Any = bearing.film
        law = found[f"bearings.{name}"]
        kept = {"inlet_temperature": law.temperature, "heat_share": 0.0} if film.heats else {}
        if film.follows:
            kept["inlet"] = law.inlet
        bearings[name] = bearing.model_copy(update={key: film.model_copy(update=kept)})
    others = dict(model.nonlinear_elements)
    for name in elements:
        law = found[f"nonlinear_elements.{name}"]
        own = {**others[name].parameters}
        if _heats(others[name]):
            own |= {"viscosity": law.viscosity, "heat_share": 0.0}
        if _follows(others[name]):
            own |= {"follows": False, "inlet": law.inlet}
        others[name] = others[name].model_copy(update={"parameters": own})
    return model.model_copy(update={"bearings": bearings, "nonlinear_elements": others})


def _heats(element: NonlinearElement) -> bool:
    """Whether an element is a film whose viscosity follows from its heat balance."""
    if "grade" not in law_of(element.law).declared():
        return False
    return bool(element.parameters.get("grade")) and element.parameters.get("heat_share", 1.0) != 0.0


def _follows(element: NonlinearElement) -> bool:
    """Whether an element is a film whose inlet is where its gap is widest."""
    return bool(element.parameters.get("follows")) and "inlet" in law_of(element.law).declared()
