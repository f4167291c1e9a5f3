"""Lists that Python asks for, and sheets of force laws that act along one direction."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.paths import ROOT

TEXT = """
[operation]
input_shaft = "r"
speed = "3000 rpm"
[shafts.r]
sections = [{ length = "300 mm", outer_diameter = "30 mm" }]
[bearings.a]
shaft = "r"
at = "start"
stiffness = { radial = "1e7 N/m", axial = "1e7 N/m", torsion = "1e3 N m/rad" }
[bearings.b]
shaft = "r"
at = "end"
stiffness = { radial = "1e7 N/m" }
[loads.l]
shaft = "r"
at = "150 mm"
force = ["100 N", "50 N", "20 N"]
[nonlinear_elements.stop]
shaft = "r"
at = "150 mm"
law = "plain_spring"
directions = ["DIRECTION"]
parameters = { stiffness = "1e6 N/m", cubic = "1e15 N/m^3", damping = "50 N s/m" }
"""


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda m: rg.campbell(m, mesh_orders=1), r"mesh_orders: got 1, expected a list, such as \[1\]"),
        (lambda m: rg.campbell(m, shaft_orders=2.0), "shaft_orders: got 2.0, expected a list"),
        (lambda m: rg.critical(m, mesh_orders=1), "mesh_orders: got 1, expected a list"),
        (
            lambda m: rg.frf(m, inputs="gears.pinion:x", outputs=["gears.wheel:x"], fmax=100.0),
            r"inputs: got 'gears.pinion:x', expected a list, such as \['gears.pinion:x'\]",
        ),
        (lambda m: rg.state_space(m, inputs=["gears.pinion:x"], outputs="gears.wheel:x", fmax=100.0), "outputs: got"),
    ],
)
def test_one_entry_in_place_of_a_list_is_refused_with_a_sentence(call: Callable[[rg.Model], Any], said: str) -> None:
    with pytest.raises(rg.AnalysisError, match=said):
        call(rg.load(ROOT / "models" / "helical_pair.toml"))


def test_one_frequency_is_a_frequency_still() -> None:
    model = rg.load(ROOT / "models" / "helical_pair.toml")
    found = rg.frf(model, 500.0, inputs=["gears.pinion:x"], outputs=["gears.wheel:x"], elements=1)  # type: ignore[arg-type]
    assert found.frequency_hz.tolist() == [500.0]


@pytest.mark.parametrize("direction", ["x", "y", "z"])
def test_a_law_along_one_direction_has_a_sheet(direction: str) -> None:
    model = rg.loads(TEXT.replace("DIRECTION", direction))
    sheet = rg.bearing(model, "nonlinear_elements.stop")
    moved = float(sheet.bearing_displacement[0])
    assert sheet.bearing_load[0] == pytest.approx(1e6 * moved + 1e15 * moved**3, rel=1e-9)
    assert sheet.bearing_stiffness == pytest.approx(np.array([[1e6 + 3e15 * moved**2]]), rel=1e-9)
    assert all(row.critical_mass is None for row in sheet.over_speed)
    printed = str(sheet)
    assert f"K {direction}{direction}" in printed
    assert f"{direction}, N" in printed
