"""Checks of general nonlinear elements: the law is known, and its parameters are what it declares."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import AnalysisError, Problem
from rotorgear.model.checks.names import unknown
from rotorgear.model.parts.nonlinear_element import NonlinearElement, element_law, law_parameters
from rotorgear.model.parts.problems import shown
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import nearest


def nonlinear_elements(model: Tables) -> Iterator[Problem]:
    """Every element names a law, gives its parameters, and acts on as many displacements as the law has."""
    for name, element in model.nonlinear_elements.items():
        yield from _element(f"nonlinear_elements.{name}", element)


def _element(address: str, element: NonlinearElement) -> Iterator[Problem]:
    # Laws are compiled: they are loaded for models that name one only.
    from rotorgear.forces.registry import law_of, names

    if element.law not in names():
        yield unknown(f"{address}.law", element.law, list(names()), "a force law")
        return
    law = law_of(element.law)
    declared = law.declared()
    known = list(declared)
    wrong = [name for name in element.parameters if name not in declared]
    for name in wrong:
        guess = nearest(name, known)
        hint = f"did you mean '{guess}'?" if guess else "valid here: " + ", ".join(known)
        yield Problem(f"{address}.parameters.{name}", "", f"unknown parameter of {element.law}", hint)
    _, refused = law_parameters(law, element.parameters)
    for name, expected in refused.items():
        yield Problem(f"{address}.parameters.{name}", shown(element.parameters[name]), expected, declared[name].meaning)
    missing = [
        name
        for name in law.required()
        if name not in element.parameters and name != law.shaft_ratio and nearest(name, wrong) == ""
    ]
    for name in missing:
        yield Problem(f"{address}.parameters.{name}", "", "missing", f"required: {declared[name].meaning}")
    if wrong or refused or missing:
        return
    try:
        made = element_law(element, 1.0)
    except AnalysisError as error:
        yield Problem(f"{address}.parameters", str(error), "parameters that go together")
        return
    if made.components != len(element.directions):
        count = f"{made.components} direction{'s'[: made.components != 1]}"
        yield Problem(f"{address}.directions", shown(list(element.directions)), f"{count}, as {element.law} has")
    if element.to_at is not None and element.to_shaft is None:
        yield Problem(f"{address}.to_at", "without to_shaft", "the name of the second shaft beside it")
