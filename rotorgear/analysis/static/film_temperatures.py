"""The model that motions in time start from: its oil films keep the temperatures of their mean state."""

from __future__ import annotations

from typing import Any

from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.forces.registry import law_of
from rotorgear.model.model import Model
from rotorgear.model.parts.nonlinear_element import NonlinearElement
from rotorgear.system.system import System


def at_film_temperatures(model: Model, speed: float) -> Model:
    """The model with its films at the temperatures of their heat balance in the equilibrium at a speed, which they keep.

    Motions in time are too fast to warm a film. A model without films in heat balance comes back as it is.

    Args:
        model: a checked model. speed: of the reference shaft in rad/s.

    Raises:
        AnalysisError: there is no equilibrium at that speed.
    """
    films = [name for name, bearing in model.bearings.items() if bearing.film is not None and bearing.film.heats]
    elements = [name for name, element in model.nonlinear_elements.items() if _heats(element)]
    if not (films or elements):
        return model
    load = model.mean_load(-1 if speed < 0.0 else 1).of_kind("static")
    equilibrium, _ = over_cycle(equilibrate(System(model, load=load), speed), speed)
    found = {state.part.part: state.part.law for state in equilibrium.laws}
    bearings = dict(model.bearings)
    for name in films:
        bearing = bearings[name]
        key = "journal" if bearing.journal is not None else "thrust"
        kept = {"inlet_temperature": found[f"bearings.{name}"].temperature, "heat_share": 0.0}  # type: ignore[attr-defined]
        bearings[name] = bearing.model_copy(update={key: bearing.film.model_copy(update=kept)})  # type: ignore[union-attr]
    others = dict(model.nonlinear_elements)
    for name in elements:
        viscosity: Any = found[f"nonlinear_elements.{name}"].viscosity  # type: ignore[attr-defined]
        kept = {**others[name].parameters, "viscosity": viscosity, "heat_share": 0.0}
        others[name] = others[name].model_copy(update={"parameters": kept})
    return model.model_copy(update={"bearings": bearings, "nonlinear_elements": others})


def _heats(element: NonlinearElement) -> bool:
    """Whether an element is a film whose viscosity follows from its heat balance."""
    if "grade" not in law_of(element.law).declared():
        return False
    return bool(element.parameters.get("grade")) and element.parameters.get("heat_share", 1.0) != 0.0
