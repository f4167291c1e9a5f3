"""General nonlinear elements in a model file: what is checked, and how it is told."""

from __future__ import annotations

import re
from typing import Any

import pytest

import rotorgear as rg
from rotorgear.errors import ModelError
from rotorgear.model.parts.supports import element_law


def model(**element: Any) -> rg.Model:
    return rg.Model(
        shafts={"rotor": {"position": [0.0, 0.0], "sections": [{"length": "300 mm", "outer_diameter": "50 mm"}]}},
        nonlinear_elements={
            "stop": {"law": "plain_spring", "shaft": "rotor", "at": "end", "directions": ["y"], **element}
        },
    )


def problem(**element: Any) -> str:
    with pytest.raises(ModelError) as caught:
        model(**element)
    (found,) = caught.value.problems
    return str(found)


def test_parameters_are_quantities_with_the_units_that_the_law_declares() -> None:
    given = {"stiffness": "20 N/um", "cubic": "1e3 N/mm^3", "damping": "0.3 N s/mm", "gap": "10 um"}
    law = element_law(model(parameters=given).nonlinear_elements["stop"], 1.0)
    assert law.parameters() == pytest.approx([2e7, 1e12, 300.0, 1e-5])


def test_the_ratio_of_its_shaft_is_filled_in_where_a_law_asks_for_it() -> None:
    film = {"viscosity": 0.02, "radius": "25 mm", "length": "25 mm", "clearance": "50 um"}
    own = model(law="journal_bearing", directions=["x", "y"], parameters=film).nonlinear_elements["stop"]
    assert element_law(own, -2.5).order == -2.5


@pytest.mark.parametrize(
    ("element", "expected"),
    [
        ({"law": "plane_spring"}, "nonlinear_elements.stop.law: got 'plane_spring', .*did you mean 'plain_spring'"),
        ({"parameters": {}}, r"nonlinear_elements.stop.parameters.stiffness: missing \(required: k\)"),
        ({"parameters": {"stifness": "2e7 N/m"}}, "parameters.stifness: unknown parameter.*did you mean 'stiffness'"),
        ({"parameters": {"stiffness": "2e7 N"}}, "elements.stop.parameters.stiffness: got '2e7 N', .*a stiffness such as"),
        ({"parameters": {"stiffness": 2e7, "gap": "-1 um"}}, "parameters.gap: got '-1 um', .*at least 0"),
        ({"parameters": {"stiffness": 2e7, "cubic": "3 N/m"}}, "parameters.cubic: .*a cubic stiffness such as '1e13 N/m"),
        ({"parameters": {"stiffness": 2e7}, "directions": ["x", "y"]}, "stop.directions: .*1 direction"),
        ({"parameters": {"stiffness": 2e7}, "shaft": "rotr"}, "stop.shaft: .*did you mean 'rotor'"),
        ({"parameters": {"stiffness": 2e7}, "at": "400 mm"}, "nonlinear_elements.stop.at: .*a place on shaft"),
        ({"parameters": {"stiffness": 2e7}, "to_shaft": "rotr"}, "stop.to_shaft: .*did you mean 'rotor'"),
        ({"parameters": {"stiffness": 2e7}, "to_at": "end"}, "stop.to_at: .*second shaft"),
        ({"parameters": {"stiffness": 2e7}, "damping": {"y": 3.0}}, "stop.damping: .*stiffness beside it"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_with_its_address_and_remedy(element: dict[str, Any], expected: str) -> None:
    assert re.search(expected, problem(**element)), problem(**element)


def test_a_model_without_laws_compiles_nothing() -> None:
    import subprocess
    import sys

    code = (
        "import sys, rotorgear as rg; m = rg.Model(shafts={'a': {'sections': [{'length': 1.0, 'outer_diameter': 0.1}]}});"
        "rg.modal(m, modes=3); assert 'numba' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
