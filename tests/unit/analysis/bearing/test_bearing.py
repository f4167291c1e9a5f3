"""The sheet of a bearing: loads and pressures inside against closed forms, flow and friction against tables, and its refusals."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.bearing.bearing import rigid_threshold
from rotorgear.errors import AnalysisError
from rotorgear.forces.journal_film import JournalFilm
from rotorgear.forces.rolling import contact_ellipses, line_pressure, point_pressure
from tests.models import disk_in_bearing
from tests.paths import ROOT
from tests.unit.analysis.static.test_bearing_states import BALLS, ROLLERS, rotor

PULL = '["1 kN", "0 N", "0 N"]'
FILM = 'journal = {{ diameter = "60 mm", length = "30 mm", clearance = "60 um", viscosity = "20 mPa s", around = {}, along = 4 }}'

# A spindle on two tapered bearings, both of which take a push towards +z.
SET_AGAINST = """
operation = { input_shaft = "spindle", speed = "900 rpm" }
[shafts.spindle]
sections = [{ length = "140 mm", outer_diameter = "50 mm" }]
[bearings]
left = { shaft = "spindle", at = "start", rolling = { designation = "32010", preload_displacement = "7 um" } }
right = { shaft = "spindle", at = "end", rolling = { designation = "32010", preload_displacement = "7 um" } }
[loads.pull]
shaft = "spindle"
at = "40 mm"
force = ["600 N", "0 N", "0 N"]
"""


def journal_rotor(around: int = 60) -> rg.Model:
    """A rigid disk on one film, pulled across."""
    return disk_in_bearing(FILM.format(around), '["300 N", "400 N", "0 N"]')


def test_a_ball_on_a_plane_and_a_roller_on_a_plane_have_hertz_pressure() -> None:
    R, Q, L, E, nu = 5e-3, 100.0, 10e-3, 210e9, 0.3
    reduced = 0.5 * E / (1.0 - nu**2)
    flat = point_pressure(np.array([Q]), contact_ellipses(2.0 * R, 1e6, 1e6, 1e6, 0.0), 2.0 * reduced)[0][0]
    assert flat == pytest.approx((6.0 * Q * reduced**2 / (np.pi**3 * R**2)) ** (1.0 / 3.0), rel=1e-6)
    line = line_pressure(np.array([Q]), L, 2.0 * R, 0.0)[1][0]
    assert line == pytest.approx(np.sqrt(Q * reduced / (np.pi * L * R)), rel=1e-12)


@pytest.mark.parametrize("rolling", [BALLS, ROLLERS])
def test_the_loads_of_the_rolling_elements_add_up_to_that_of_the_bearing(rolling: str) -> None:
    sheet = rg.bearing(rotor(rolling, PULL), stability=False)
    loads = np.array([row.load for row in sheet.rolling_elements])
    angles = np.array([row.angle for row in sheet.rolling_elements])
    assert loads @ np.cos(angles) == pytest.approx(1000.0, rel=1e-9)
    assert loads @ np.sin(angles) == pytest.approx(0.0, abs=1e-6)
    assert sheet.largest_element_load == loads.max()
    assert all((row.inner_pressure > row.outer_pressure > 0.0) is (row.load > 0.0) for row in sheet.rolling_elements)
    assert sheet.consistency < 1e-9


@pytest.mark.parametrize(("rolling", "limit"), [(BALLS, 4.2e9), (ROLLERS, 4.0e9)])
def test_the_static_safety_brings_the_most_pressed_element_to_its_limit(rolling: str, limit: float) -> None:
    # Without clearance loads of elements grow as the load of the bearing.
    model = rotor(rolling, PULL)
    safety = rg.bearing(model, stability=False).static_safety
    assert safety is not None
    more = rg.bearing(model.with_("loads.pull.force", [f"{safety} kN", "0 N", "0 N"]), stability=False)
    pressed = max(row.inner_pressure for row in more.rolling_elements)
    assert pressed == pytest.approx(limit, rel=1e-6)
    assert more.static_safety == pytest.approx(1.0, rel=1e-6)


def test_the_load_of_a_sheet_is_that_of_statics_where_teeth_feel_the_tilt() -> None:
    model = rg.load(ROOT / "models" / "helical_pair.toml")
    ball = {"shaft": "input", "at": "-47 mm", "rolling": {"designation": "6310"}}
    model = model.with_("bearings.input_left", ball).with_("meshes.stage.tilt", True)
    sheet = rg.bearing(model, "input_left", stability=False)
    force = rg.static(model).bearing_force["input_left"]
    assert sheet.bearing_load[:3] == pytest.approx(-force[:3], rel=1e-6)
    alone = rg.static(model.with_("meshes.stage.tilt", False)).bearing_force["input_left"]
    assert np.abs(alone - force).max() > 1e-3 * np.abs(force).max()


def test_bearings_that_take_one_push_only_are_named_with_the_angle_that_turns_one_round() -> None:
    model = rg.loads(SET_AGAINST)
    with pytest.raises(AnalysisError, match=r"nothing takes its push towards -z; .*contact_angle = '-[\d.]+ deg'$"):
        rg.static(model)
    assert any("nothing takes its push towards -z" in text for text in rg.check(model).warnings)
    angle = model.bearings["right"].rolling.contact_angle
    for held in (
        model.with_("bearings.right.rolling.contact_angle", -angle),
        model.with_("supports.thrust", {"shaft": "spindle", "at": "start", "stiffness": {"axial": "1e7 N/m"}}),
        model.with_("bearings.middle", {"shaft": "spindle", "at": "70 mm", "rolling": {"designation": "6010"}}),
        model.with_("operation.gravity", ["0 m/s^2", "0 m/s^2", "9.81 m/s^2"]),
    ):
        assert not any("push towards" in text for text in rg.check(held).warnings)
    upside_down = model.with_("operation.gravity", ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"])
    assert any("push towards -z" in text for text in rg.check(upside_down).warnings)


@pytest.mark.parametrize(
    ("ratio", "eccentricity", "friction", "flow"),
    [(1.0, 0.2, 12.8, 3.59 * 0.280), (1.0, 0.6, 3.22, 4.33 * 0.680), (1.0, 0.8, 1.70, 4.62 * 0.842)],
)
def test_friction_and_side_flow_are_those_of_raimondi_and_boyd(ratio, eccentricity, friction, flow) -> None:
    R, c, speed = 0.05, 1e-4, 100.0
    law = JournalFilm(0.05, R, 2.0 * R * ratio, c, follows=True)
    d = np.array([eccentricity * c, 0.0])
    film = law.inside(d, speed=speed)
    load = float(np.hypot(*law.settled(d).evaluate(d, speed=speed).force))
    assert film.power_loss / (speed * load * c) == pytest.approx(friction, rel=0.015)
    assert film.side_flow / (R * c * speed / (2.0 * np.pi) * law.length) == pytest.approx(flow, rel=0.015)


def test_a_film_carries_the_load_of_the_gearbox_at_the_attitude_of_its_state() -> None:
    sheet = rg.bearing(journal_rotor(), speeds=["3000 rpm"], stability=False)
    film = sheet.film
    assert np.hypot(*sheet.bearing_load) == pytest.approx(500.0, rel=1e-9)
    assert 30.0 < np.degrees(film.attitude) < 90.0
    assert film.minimum_gap == pytest.approx((1.0 - film.eccentricity) * 60e-6, rel=2e-3)
    pressure = film.pressure.sum(axis=1)
    across = pressure @ np.column_stack([np.cos(film.angle), np.sin(film.angle)])
    assert across / np.linalg.norm(across) == pytest.approx([0.6, 0.8], rel=1e-6)
    assert 0.0 < sheet.error_estimate < 0.1
    np.testing.assert_allclose(sheet.over_speed[0].stiffness, sheet.bearing_stiffness, rtol=1e-6)


@pytest.mark.parametrize(
    ("at", "keys"),
    [
        ("pad_at", {"pads": 5, "preload": 0.3, "pivot": 0.6}),
        ("lobe_at", {"lobes": 2, "preload": 0.5, "offset": 0.8}),
    ],
)
def test_a_bearing_built_for_the_other_sense_of_rotation_is_the_mirror_image(at: str, keys: dict[str, float]) -> None:
    there = journal_rotor().with_("loads.pull.force", [0.0, -500.0, 0.0])
    sheets = []
    film = {"diameter": 0.06, "length": 0.03, "clearance": 60e-6, "viscosity": 0.02, "around": 60, "along": 4, **keys}
    for speed, angle in (("3000 rpm", "100 deg"), ("-3000 rpm", "80 deg")):
        model = there.with_({"bearings.front.journal": {**film, at: angle}, "operation.speed": speed})
        sheets.append(rg.bearing(model, speeds=[], stability=False))
    here, mirrored = sheets
    flip = np.array([-1.0, 1.0])
    np.testing.assert_allclose(mirrored.bearing_displacement, flip * here.bearing_displacement, rtol=1e-6)
    np.testing.assert_allclose(mirrored.bearing_stiffness, np.outer(flip, flip) * here.bearing_stiffness, rtol=1e-5)


def test_the_threshold_of_a_rigid_rotor_makes_its_characteristic_polynomial_imaginary() -> None:
    K = np.array([[8.0, 40.0], [-52.0, 4.0]]) * 1e6
    C = np.array([[90.0, -9.0], [-9.0, 110.0]]) * 1e3
    mass, ratio = rigid_threshold(K, C, 900.0)
    s = 1j * ratio * 900.0
    M = mass * s**2 * np.eye(2) + C * s + K
    assert abs(np.linalg.det(M)) < 1e-9 * abs(K[0, 1] * K[1, 0])
    assert rigid_threshold(np.diag([8e6, 4e6]), C, 900.0) == (None, None)


def test_what_has_no_sheet_is_refused_with_a_remedy() -> None:
    jeffcott = rg.load(ROOT / "models" / "jeffcott.toml")
    with pytest.raises(AnalysisError, match="a stiffness given by hand has no sheet"):
        rg.bearing(jeffcott, next(iter(jeffcott.bearings)))
    with pytest.raises(AnalysisError, match="did you mean 'front'"):
        rg.bearing(journal_rotor(), "frnt")
    with pytest.raises(AnalysisError, match="give a speed"):
        rg.bearing(journal_rotor(), speed=0.0)


def test_both_kinds_have_a_convergence_study() -> None:
    films = rg.accuracy(journal_rotor(96), "bearing", bearing="front")
    assert films.rungs[-1].error < 0.02
    assert all(rung.error <= 1.5 * rung.estimate for rung in films.rungs)
    balls = rg.accuracy(rotor(BALLS, PULL, "3000 rpm"), "bearing")
    assert balls.rungs[-1].order == pytest.approx(1.5, abs=0.1)
    assert all(rung.error <= 1.5 * rung.estimate for rung in balls.rungs)


@pytest.mark.parametrize(
    "kind",
    [
        'rolling = { kind = "tapered", elements = 14, element_diameter = "10 mm", pitch_diameter = "60 mm", length = "14 mm", '
        'contact_angle = "15 deg", slices = 7 }',
        'rolling = { kind = "four-point", elements = 13, element_diameter = "12 mm", pitch_diameter = "65 mm", '
        'contact_angle = "35 deg" }',
        'thrust = { inner_diameter = "80 mm", outer_diameter = "140 mm", clearance = "60 um", viscosity = "0.03 Pa s", pads = 4, '
        "pivot = 0.6, around = 24, across = 8 }",
        pytest.param(
            FILM.format(120).replace("along = 4", "along = 6, pads = 5, preload = 0.3"), marks=pytest.mark.long
        ),
        FILM.format(96).replace('viscosity = "20 mPa s"', 'oil = "VG 46", inlet_temperature = "45 degC"'),
    ],
    ids=["tapered", "four-point", "thrust", "tilting pads", "heat balance"],
)
def test_the_newer_kinds_have_a_convergence_study(kind: str) -> None:
    model = rg.loads(f"""
[operation]
input_shaft = "rotor"
speed = "3000 rpm"
[shafts.rotor]
[bearings.front]
shaft = "rotor"
at = "start"
{kind}
[supports.guide]
shaft = "rotor"
at = "start"
fixed = ["tilt_x", "tilt_y"{', "x", "y"' if kind.startswith("thrust") else ', "z"' if "journal" in kind else ""}]
[disks.d]
shaft = "rotor"
at = "start"
mass = 10
polar_inertia = 0.1
diametral_inertia = 0.1
[loads.pull]
shaft = "rotor"
at = "start"
force = {"[1500.0, 2000.0, 1000.0]" if kind.startswith("rolling") else "[300.0, 400.0, 2000.0]"}
""")
    study = rg.accuracy(model, "bearing")
    assert study.rungs[-1].error < 0.02
    # Means over fewer than eight positions do not know their own error.
    assert all(rung.error <= 1.5 * rung.estimate for rung in study.rungs[-4:])


def test_a_split_torque_gearbox_stands_in_its_films_at_its_own_loads_and_runs_stably() -> None:
    model = rg.load(ROOT / "models" / "split_torque_journals.toml")
    speed = model.operation.speed
    found = rg.static(model, elements=1)
    assert found.imbalance < 1e-9
    for row in found.laws:
        name = row.part.removeprefix("bearings.")
        assert found.bearing_force[name][:2] == pytest.approx(-row.force, rel=1e-6)
        bearing = model.bearings[name]
        law = bearing.law(float(model.layout.train.ratio(bearing.shaft)), 1.0)
        there = law.settled(row.displacement).evaluate(row.displacement, speed=speed)
        np.testing.assert_allclose(there.force, row.force, rtol=0.0, atol=1e-6 * np.abs(row.force).max())
        np.testing.assert_allclose(there.in_displacement, row.stiffness, rtol=1e-12)
    # What weighs and what the meshes push stands in the bearings: all forces on the gearbox from outside.
    weight = 9.81 * sum(shaft.shaft_mass_kg + shaft.body_mass_kg for shaft in rg.check(model).shafts)
    assert sum(force[1] for force in found.bearing_force.values()) == pytest.approx(weight, rel=1e-6)
    modes = rg.modal(model, speed=speed, modes=12, elements=2)
    assert modes.eigenvalues.real.max() < 0.0
    at_rest = {row.part: row.load for row in found.laws}
    assert {row.part: row.load for row in modes.laws} == pytest.approx(at_rest, rel=1e-6)
