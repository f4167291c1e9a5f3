"""The lower end of a range of speeds: standstill, or where oil films begin to carry."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.static.lowest_speed import lowest_speed

MODELS = Path(__file__).parents[4] / "models"
FILM = "{ diameter = '60 mm', length = '30 mm', clearance = '60 um', viscosity = '0.02 Pa s', around = 24, along = 2 }"
TURBINE = f"""
[operation]
input_shaft = "rotor"
speed = "9000 rpm"
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[shafts.rotor]
sections = [{{ length = "600 mm", outer_diameter = "50 mm" }}]
[disks.wheel]
shaft = "rotor"
at = "300 mm"
outer_diameter = "280 mm"
width = "60 mm"
[bearings.left]
shaft = "rotor"
at = "start"
journal = {FILM}
[bearings.right]
shaft = "rotor"
at = "end"
journal = {FILM}
[supports.thrust]
shaft = "rotor"
at = "start"
fixed = ["z"]
"""


@pytest.fixture(scope="module")
def turbine():
    return rg.loads(TURBINE)


def test_films_begin_where_they_carry_and_that_is_said(turbine):
    low, sentence = lowest_speed(turbine, None, 700.0)
    assert 0.0 < low < 700.0
    assert "bearings.left and 1 more" in sentence
    assert "--from" in sentence
    heavy = turbine.with_("operation.gravity", [0.0, -981.0, 0.0])
    assert lowest_speed(heavy, None, 700.0)[0] > low


def test_rotors_without_films_begin_at_standstill():
    model = rg.load(MODELS / "jeffcott.toml")
    assert lowest_speed(model, None, 500.0) == (0.0, "")
    assert rg.critical(model, stop="6000 rpm").low_speed == 0.0


def test_a_lower_end_leaves_the_critical_speeds_above_it(turbine):
    whole = rg.critical(turbine)
    found = whole.critical_speed_rpm
    above = rg.critical(turbine, start="3 krpm").critical_speed_rpm
    assert found.size
    assert any("carries only while its shaft turns" in note for note in whole.left_out)
    # The tangents of the films are taken at other speeds in a shorter range, and are straight between them.
    assert above == pytest.approx(found[found > 3000.0], rel=1e-3)


def test_an_empty_range_is_refused(turbine):
    for start in ("7 krpm", "-1 krpm"):
        with pytest.raises(rg.RotorgearError, match="range of speeds is empty"):
            rg.critical(turbine, start=start, stop="6 krpm")


@pytest.mark.long
def test_rules_and_diagrams_take_a_rotor_on_films(turbine):
    rules = rg.standards(turbine)
    assert rules.curve_speeds.min() >= lowest_speed(turbine, None, 1.5 * turbine.operation.speed)[0] * (1.0 - 1e-12)
    assert {check.rule for check in rules.checks} >= {"stability", "vibration limit"}
    diagram = rg.campbell(turbine, points=3, modes=4)
    assert np.min(np.abs(diagram.speeds)) > 0.0


def test_a_table_of_many_rows_loses_no_damped_critical_speed():
    model = rg.loads(TURBINE)
    matrices = {"stiffness": {"x": 20e6, "y": 30e6, "xy": 5e6, "yx": -5e6}, "damping": {"x": 4e4, "y": 6e4}}
    rows = [{"speed": float(speed), **matrices} for speed in np.linspace(0.0, 1500.0, 30)]
    found = []
    for held in (matrices, {"table": rows}):
        one = model.with_({"bearings.left": {"shaft": "rotor", "at": "start", **held}})
        one = one.with_({"bearings.right": {"shaft": "rotor", "at": "end", **held}})
        found.append(rg.critical(one, stop="12 krpm"))
    assert found[0].speeds
    assert max(item.damping_ratio for item in found[0].speeds) > 0.03
    assert found[1].critical_speed_rpm == pytest.approx(found[0].critical_speed_rpm, rel=1e-9)


def test_critical_speeds_of_shafts_and_meshes_below_the_range_are_left_out():
    model = rg.load(MODELS / "helical_pair.toml")
    lines = {"stop": "6000 rpm", "mesh_orders": (1, 2), "shaft_orders": (1.0, 2.0), "fmax": 1500.0}
    whole = rg.critical(model, **lines).critical_speed_rpm
    found = rg.critical(model, start="900 rpm", **lines).critical_speed_rpm
    assert whole.min() < 900.0
    assert found == pytest.approx(whole[whole >= 900.0], rel=1e-12)
