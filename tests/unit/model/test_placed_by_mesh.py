"""Shafts that their meshes place: centre distances by their formulas, chains, axes in space, round trips, and refusals."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.app.study import Study
from rotorgear.errors import ModelError
from tests.paths import ROOT

# Three shafts one after the other, and a ring about a pinion of the last; all numbers differ.
CHAIN = """\
[shafts.one]
position = ["12 mm", "-7 mm"]

[shafts.three]
position = { mesh = "second", angle = "-110 deg" } # below the second

[shafts.two]
position = { mesh = "first", angle = "35 deg" }

[shafts.ring]
position = { mesh = "inside", angle = "200 deg" }

[gears.p1]
shaft = "one"
at = "0 mm"
kind = "helical"
teeth = 19
normal_module = "3 mm"
helix_angle = "17 deg"
hand = "left"
width = "30 mm"
profile_shift = 0.31

[gears.w1]
shaft = "two"
at = "0 mm"
kind = "helical"
teeth = 52
normal_module = "3 mm"
helix_angle = "17 deg"
hand = "right"
width = "28 mm"
profile_shift = -0.12

[gears.p2]
shaft = "two"
at = "0 mm"
kind = "herringbone"
teeth = 21
normal_module = "2.5 mm"
helix_angle = "28 deg"
hand = "left"
width = "20 mm"
gap = "12 mm"
nodes = 1

[gears.w2]
shaft = "three"
at = "0 mm"
kind = "herringbone"
teeth = 47
normal_module = "2.5 mm"
helix_angle = "28 deg"
hand = "right"
width = "20 mm"
gap = "12 mm"
nodes = 1

[gears.p3]
shaft = "three"
at = "0 mm"
kind = "spur"
teeth = 23
normal_module = "2 mm"
width = "15 mm"

[gears.ring]
shaft = "ring"
at = "0 mm"
kind = "spur"
teeth = 78
normal_module = "2 mm"
width = "15 mm"
internal = true
body = { outer_diameter = "190 mm" }

[meshes.first]
pinion = "p1"
gear = "w1"
stiffness = "4e8 N/m"

[meshes.second]
pinion = "p2"
gear = "w2"
stiffness = "5e8 N/m"

[meshes.inside]
pinion = "p3"
gear = "ring"
stiffness = "3e8 N/m"
"""


def _involute(angle: float) -> float:
    return math.tan(angle) - angle


def _distance(module: float, helix: float, teeth: tuple[int, int], shifts: float = 0.0) -> float:
    """a_w by bisection of inv a_w = inv a_t + 2 tan a_n (x1 + x2)/(z1 + z2), from the drawing's numbers in mm and deg."""
    normal, beta = math.radians(20.0), math.radians(helix)
    transverse = math.atan(math.tan(normal) / math.cos(beta))
    wanted = _involute(transverse) + 2.0 * math.tan(normal) * shifts / sum(teeth)
    low, high = 0.01, 1.2
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _involute(middle) < wanted else (low, middle)
    return 1e-3 * abs(0.5 * module * sum(teeth) / math.cos(beta) * math.cos(transverse) / math.cos(low))


def _axis(model: rg.Model, shaft: str) -> np.ndarray:
    return np.array(model.shafts[shaft].frame.origin)


def test_chains_stand_at_the_centre_distances_of_their_teeth() -> None:
    model = rg.loads(CHAIN)
    steps = [
        ("one", "two", _distance(3.0, 17.0, (19, 52), 0.31 - 0.12), 35.0),
        ("two", "three", _distance(2.5, 28.0, (21, 47)), -110.0),
        ("three", "ring", 0.001 * (78 - 23), 200.0),
    ]
    for before, after, distance, angle in steps:
        turned = math.radians(angle)
        wanted = distance * np.array([math.cos(turned), math.sin(turned), 0.0])
        np.testing.assert_allclose(_axis(model, after) - _axis(model, before), wanted, atol=1e-14)
    # No teeth part or jam there, and the mesh finds the direction that was given.
    for mesh in ("first", "second", "inside"):
        assert abs(model.layout.mesh(mesh).backlash.least) < 1e-15
    assert math.degrees(model.layout.mesh("second").psi) == pytest.approx(-110.0)


def test_a_shaft_moves_with_its_teeth() -> None:
    model = rg.loads(CHAIN).with_({"gears.w1.teeth": 55, "shafts.two.position.angle": "40 deg"})
    apart = _axis(model, "two") - _axis(model, "one")
    assert np.hypot(*apart[:2]) == pytest.approx(_distance(3.0, 17.0, (19, 55), 0.19), rel=1e-12)
    assert math.degrees(math.atan2(apart[1], apart[0])) == pytest.approx(40.0)


def test_analyses_find_the_same_as_with_the_numbers_of_the_axes() -> None:
    """Two lumped gears on soft bearings: frequencies of both files are the same."""
    text = """
    [shafts.a]
    position = ["0 mm", "0 mm"]
    [shafts.b]
    position = {place}
    [gears.a]
    shaft = "a"
    at = "0 mm"
    kind = "spur"
    base_radius = "30 mm"
    transverse_pressure_angle = "21 deg"
    mass = 2.0
    polar_inertia = 1e-3
    diametral_inertia = 8e-4
    [gears.b]
    shaft = "b"
    at = "0 mm"
    kind = "spur"
    base_radius = "71 mm"
    transverse_pressure_angle = "21 deg"
    mass = 7.0
    polar_inertia = 2e-2
    diametral_inertia = 1e-2
    [meshes.ab]
    pinion = "a"
    gear = "b"
    stiffness = 2e8
    [bearings.a]
    shaft = "a"
    at = "start"
    stiffness = {{ x = 3e7, y = 5e7, axial = 1e7, tilt = 1e5 }}
    [bearings.b]
    shaft = "b"
    at = "start"
    stiffness = {{ x = 6e7, y = 4e7, axial = 2e7, tilt = 3e5 }}
    """
    distance, angle = 0.101 / math.cos(math.radians(21.0)), math.radians(63.0)
    numbers = [distance * math.cos(angle), distance * math.sin(angle)]
    by_mesh, by_numbers = (
        rg.modal(rg.loads(text.format(place=place)), modes=6).frequency_hz
        for place in ('{ mesh = "ab", angle = "63 deg" }', numbers)
    )
    np.testing.assert_allclose(by_mesh, by_numbers, rtol=1e-9)


def test_beside_an_axis_in_space_the_angle_counts_from_its_own_x() -> None:
    axis, x_axis = "axis = [0.6, 0.0, 0.8]", "x_axis = [0, 1, 0]"
    text = CHAIN.replace('position = ["12 mm", "-7 mm"]', f'position = ["1 mm", "2 mm", "3 mm"]\n{axis}\n{x_axis}')
    for shaft in ("two", "three", "ring"):
        text = text.replace(f"[shafts.{shaft}]", f"[shafts.{shaft}]\n{axis}")
    model = rg.loads(text)
    apart = _axis(model, "two") - _axis(model, "one")
    y = np.cross([0.6, 0.0, 0.8], [0.0, 1.0, 0.0])
    angle = math.radians(35.0)
    wanted = math.cos(angle) * np.array([0.0, 1.0, 0.0]) + math.sin(angle) * y
    np.testing.assert_allclose(apart, _distance(3.0, 17.0, (19, 52), 0.19) * wanted, atol=1e-14)


def test_a_model_is_written_as_it_was_read(tmp_path: Path) -> None:
    model = rg.loads(CHAIN)
    file = model.to_toml(tmp_path / "same.toml")
    assert file.read_text() == CHAIN
    turned = model.with_("shafts.three.position.angle", "-90 deg").to_toml(tmp_path / "turned.toml")
    assert turned.read_text() == CHAIN.replace("-110 deg", "-90 deg")
    from_parts = rg.Model(**{name: getattr(model.written, name) for name in type(model).model_fields})
    assert rg.load(from_parts.to_toml(tmp_path / "parts.toml")) == model
    assert model.shafts["two"].position == pytest.approx(_axis(model, "two")[:2])
    assert isinstance(model.written.shafts["two"].position, rg.PositionByMesh)


def test_the_page_shows_the_mesh_and_drags_the_angle(tmp_path: Path) -> None:
    file = tmp_path / "chain.toml"
    file.write_text(CHAIN)
    study = Study(file)
    fields = {field.address: field for field in study.fields("shafts.two")}
    assert fields["shafts.two.position.mesh"].text == "first"
    assert fields["shafts.two.position.angle"].is_number
    assert study.change("shafts.two.position.angle", "36 deg")
    assert study.change("shafts.two.position", '["80 mm", "60 mm"]') is False
    assert study.problems[0].address == "meshes.first"


BEVEL = """
[shafts.one]
position = [0, 0, 0]
[shafts.two]
position = { mesh = "pair", angle = 0 }
axis = [1, 0, 0]
[gears.a]
shaft = "one"
at = 0
kind = "bevel"
teeth = 20
mean_normal_module = "3 mm"
width = "15 mm"
mass = 1
polar_inertia = 1
diametral_inertia = 1
[gears.b]
shaft = "two"
at = 0
kind = "bevel"
teeth = 30
mean_normal_module = "3 mm"
width = "15 mm"
mass = 1
polar_inertia = 1
diametral_inertia = 1
[meshes.pair]
pinion = "a"
gear = "b"
stiffness = 1e8
"""


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({'"second", angle': '"secnd", angle'}, "three.position.mesh: got 'secnd'.*did you mean 'second'"),
        ({'"second", angle': '"first", angle'}, "three.position: got mesh 'first'.*of this shaft: second, inside"),
        ({'angle = "35 deg"': 'angle = "35 mm"'}, "two.position.angle: got '35 mm', expected an angle"),
        ({'angle = "35 deg"': 'angel = "35 deg"'}, "two.position.angel: unknown key .did you mean 'angle'"),
        ({', angle = "35 deg"': ""}, "two.position.angle: missing"),
        (
            {'["12 mm", "-7 mm"]': '{ mesh = "first", angle = 0 }'},
            "one.position: got a place beside 'two', beside 'one'",
        ),
        ({'position = ["12 mm", "-7 mm"]': ""}, "two.position: got a place beside shaft 'one', which has none"),
        ({'mesh = "first"': 'mesh = "second"'}, "three.position: got a place beside 'two', beside 'three'"),
        ({'"3 mm"': '"4 mm"'}, "meshes.first: got a normal module of 4 mm"),
        ({"[shafts.ring]": "[shafts.ring]\naxis = [0, 1, 1]"}, "meshes.inside: got shafts whose axes are 45 deg apart"),
        ({"shift = 0.31": "shift = -0.9", "shift = -0.12": "shift = -1.0"}, "meshes.first: The profile shifts"),
        ({'"12 mm", "-7 mm"': '"12 mm"'}, "one.position: got .*mesh = 'stage_2'"),
        ({'{ mesh = "first", angle = "35 deg" }': '"35 mm"'}, "two.position: got '35 mm'.*mesh = 'stage_2'"),
    ],
)
def test_what_can_not_be_placed_is_told_where_it_stands(changes: dict[str, str], said: str) -> None:
    text = CHAIN
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new, 1)
    with pytest.raises(ModelError, match=said) as caught:
        rg.loads(text)
    assert len(caught.value.problems) == 1  # what only follows is not told


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (BEVEL, "shafts.two.position: got mesh 'pair' of bevel gears"),
        (
            """
            [shafts.a]
            position = [0, 0]
            [shafts.b]
            position = { mesh = "ab", angle = 0 }
            [gears]
            a = { shaft = "a", at = 0, kind = "spur", base_radius = 0.1, mass = 1, polar_inertia = 1, diametral_inertia = 1 }
            b = { shaft = "b", at = 0, kind = "spur", base_radius = 0.1, mass = 1, polar_inertia = 1, diametral_inertia = 1 }
            [meshes.ab]
            pinion = "a"
            gear = "b"
            stiffness = 1e8
            """,
            "shafts.b.position: got mesh 'ab', whose gears say no distance.*transverse_pressure_angle",
        ),
    ],
)
def test_meshes_without_a_distance_place_nothing(text: str, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        rg.loads(text)


def test_a_planet_places_nothing() -> None:
    text = (ROOT / "models/planetary.toml").read_text()
    text = text.replace("[shafts.ring]", '[shafts.ring]\nposition = { mesh = "planet_ring", angle = 0 }')
    with pytest.raises(ModelError, match=r"shafts.ring.position: got mesh 'planet_ring' with a planet"):
        rg.loads(text)
