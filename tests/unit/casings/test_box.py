"""Casings in numbers: a box with its bores, inner walls, ribs and feet against volumes, plates, beams and tubes by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.casings.assembly import Elastic
from rotorgear.casings.box import BoxSeat, BoxShape
from rotorgear.casings.fe_body import FiniteElementBody, finite_element_body
from rotorgear.casings.mesh_error import eigenvalue_errors
from rotorgear.casings.patches import Cylinder
from rotorgear.casings.reduction import free_modes, reduce
from rotorgear.casings.settings import CasingSettings
from tests.paths import ROOT

E, NU, RHO = 206e9, 0.3, 7850.0
CUBE = BoxShape(
    low=(0.0, 0.0, 0.0),
    high=(0.2, 0.2, 0.2),
    wall=0.004,
    walls=(),
    boss=0.006,
    seats=(),
    shafts=(),
    ribs=((), (), ()),
    rib=(0.0, 0.0),
    feet=(),
    feet_side="-y",
    element=0.05,
)


def body_of(shape: BoxShape, held: tuple[str, ...] = ()) -> FiniteElementBody:
    """The finite-element body of a box of steel."""
    seats = tuple(
        (seat.name, Cylinder(seat.at, (0.0, 0.0, 1.0), -0.5 * seat.width, 0.5 * seat.width, seat.radius))
        for seat in shape.seats
    )
    return finite_element_body(CasingSettings("box", (), 1.0, Elastic(E, NU, RHO), held=held, seats=seats, box=shape))


def seat(name: str, x: float, y: float, z: float, radius: float, width: float) -> BoxSeat:
    return BoxSeat(name, (x, y, z), radius, width)


def test_mass_and_sets_are_those_of_the_drawing() -> None:
    """An inner wall, ribs, feet; a block along to a bearing inside, bores of two sizes on one axis, a wall that stays closed."""
    shape = replace(
        CUBE,
        high=(0.3, 0.2, 0.25),
        walls=(0.1,),
        seats=(
            seat("left", 0.08, 0.1, 0.005, 0.02, 0.018),
            seat("inner", 0.08, 0.1, 0.1, 0.025, 0.01),
            seat("far", 0.2, 0.09, 0.22, 0.03, 0.02),
        ),
        shafts=((0.08, 0.1, -0.05, 0.12), (0.2, 0.09, 0.09, 0.23)),
        ribs=((0.15,), (), (0.05,)),
        rib=(0.006, 0.012),
        feet=(0.03, 0.015, 0.04),
    )
    body = body_of(shape)
    a, b, c, t, h = 0.308, 0.208, 0.258, 0.004, 0.012
    plates = a * b * c - 0.3 * 0.2 * 0.25 + 0.3 * 0.2 * t
    # Around each bore a square block as long as the seat, where that is not in the wall; the bores go through both.
    square = (2 * 0.031) ** 2
    one, two, three = (math.pi * r**2 for r in (0.02, 0.025, 0.03))
    left = square * 0.014 - one * 0.018
    inner = square * 0.006 - two * 0.01
    far = (2 * 0.036) ** 2 * 0.04 - three * 0.044 - two * t  # the second shaft runs through the inner wall, too
    far += two * t - three * t
    rib_x = 0.006 * ((b + 2 * h) * (c + 2 * h) - b * c)
    rib_z = 0.006 * ((a + 2 * h) * (b + 2 * h) - a * b)
    both = 2 * h * 0.006**2  # where they cross, above and below
    feet = 4 * 0.03 * 0.015 * 0.04
    volume = plates + left + inner + far + rib_x + rib_z - both + feet
    assert body.mass_properties[0] == pytest.approx(RHO * volume, rel=1e-9)
    areas = {name: body_area(body, name) for name in ("feet", "-y", "+x")}
    assert areas["feet"] == pytest.approx(4 * 0.03 * 0.04)
    assert areas["-y"] == pytest.approx(a * c - 4 * 0.03 * 0.04 - 0.006 * (a + c) + 0.006**2)
    assert areas["+x"] == pytest.approx(b * c - 0.006 * b)
    for patch, one_seat in zip(body.seats, shape.seats, strict=True):
        assert patch.point == pytest.approx(one_seat.at)
        assert patch.area == pytest.approx(2 * math.pi * one_seat.radius * one_seat.width, rel=0.01)


def body_area(body: FiniteElementBody, name: str) -> float:
    """Area of a set of plane faces in m^2."""
    corners = np.vstack(body.mesh.sets[name].faces)
    p = body.mesh.points[corners]
    return float(0.5 * np.linalg.norm(np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]), axis=1).sum())


@pytest.mark.parametrize("angle", [0.0, 30.0, 45.0, 52.0, 135.0, -48.0])
def test_two_bores_may_be_as_near_as_their_walls_allow_in_any_direction(angle: float) -> None:
    x, y = (0.1 + 0.09 * f(math.radians(angle)) for f in (math.cos, math.sin))
    low, high = (-0.05, -0.05, 0.0), (0.27, 0.27, 0.03)
    seats = (seat("one", 0.1, 0.1, -0.002, 0.036, 0.004), seat("two", x, y, -0.002, 0.03, 0.004))
    body = body_of(replace(CUBE, low=low, high=high, seats=seats, element=0.08))
    hollow = 0.328**2 * 0.038 - 0.32**2 * 0.03
    assert body.mass_properties[0] == pytest.approx(RHO * (hollow - math.pi * (0.036**2 + 0.03**2) * 0.004), rel=1e-9)
    assert body.mesh.jacobian_low > 0.1


def test_breathing_of_a_cube_is_that_of_clamped_plates_and_converges_as_its_error_says() -> None:
    """All walls outwards at once: by symmetry no edge turns. 35.99 is of Leissa, Vibration of plates, for clamped squares.

    Its span ends between the inner side and the middle of the walls that hold it.
    """
    t = 0.008
    plate = 35.99 * math.sqrt(E * t**2 / 12.0 / (1.0 - NU**2) / RHO) / (2.0 * math.pi)
    found, stated = [], []
    for element in (0.05, 0.034):
        body = body_of(replace(CUBE, wall=t, element=element))
        modes = free_modes(body, 6)
        outwards = (body.mesh.points - 0.1) / np.abs(body.mesh.points - 0.1).max(axis=1)[:, None]
        volume = np.abs(np.einsum("pi,pim->m", outwards, modes.shapes.reshape(-1, 3, 6)))
        k = int(np.argmax(volume))
        assert volume[k] > 100.0 * np.delete(volume, k).max()
        found.append(modes.frequency[k])
        stated.append(0.5 * eigenvalue_errors(body, modes.eigenvalues, modes.shapes)[k] / modes.eigenvalues[k])
        assert modes.frequency[:2] == pytest.approx(
            modes.frequency[0], rel=1e-6
        )  # a cube has pairs and threes of modes
        assert modes.frequency[2:5] == pytest.approx(modes.frequency[2], rel=1e-6)
    best = found[1] * (1.0 - stated[1])
    assert plate / (0.2 + t) ** 2 < best < plate / 0.2**2
    assert 0.3 * (found[0] / best - 1.0) < stated[0] < 3.0 * (found[0] / best - 1.0)
    assert stated[1] < 0.6 * stated[0]


def test_a_seat_at_the_end_of_a_long_box_is_as_soft_as_a_beam_and_a_tube() -> None:
    """Held at one end: across L^3/3EI + L/(k G A), k of a square tube by Cowper; in torsion Bredt's tube and Lamé's disk."""
    a, t, length = 0.1, 0.004, 1.0
    shape = replace(
        CUBE,
        low=(0.0, 0.0, 0.0),
        high=(a - t, a - t, length),
        seats=(seat("end", 0.5 * (a - t), 0.5 * (a - t), length + 0.002, 0.015, 0.003),),
        element=0.12,
    )
    body = body_of(shape, held=("-z",))
    stiffness = reduce(body, 1.0)[0].stiffness[:6, :6]
    flexibility = np.linalg.inv(stiffness)
    area_moment = ((a + t) ** 4 - (a - t) ** 4) / 12.0
    A = (a + t) ** 2 - (a - t) ** 2
    G = E / 2.0 / (1.0 + NU)
    kappa = 20.0 * (1.0 + NU) / (48.0 + 39.0 * NU)
    span = length + 0.006
    across = span**3 / (3.0 * E * area_moment) + span / (kappa * G * A)
    assert flexibility[0, 0] == pytest.approx(flexibility[1, 1], rel=1e-6)
    assert flexibility[0, 0] == pytest.approx(across, rel=0.01)
    annulus = (1.0 / 0.015**2 - 1.0 / (0.5 * a) ** 2) / (4.0 * math.pi * G * t)  # of the end wall, turned in its plane
    assert flexibility[5, 5] == pytest.approx(span * 4.0 * a / (4.0 * G * a**4 * t) + annulus, rel=0.03)
    assert body.mass_properties[0] == pytest.approx(RHO * (A * length + 2 * (a + t) ** 2 * t - math.pi * 0.015**2 * t))


TEXT = """
title = "A shaft in a box"
operation = { input_shaft = "rotor", speed = "3000 rpm", gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"] }

[shafts.rotor]
position = ["0 mm", "10 mm"]
start = "-20 mm"
sections = [{ length = "240 mm", outer_diameter = "25 mm" }]

[bearings]
left = { shaft = "rotor", at = "-4 mm", casing = "box", stiffness = { radial = 1e8, axial = 1e7 } }

[bearings.right]
shaft = "rotor"
at = "204 mm"
casing = "box"
rolling = { designation = "6205" }
stiffness = { radial = 1e8, axial = 1e7 }

[casings.box]
material = "aluminium"
held = ["feet"]

[casings.box.box]
corners = [["-60 mm", "-50 mm", "0 mm"], ["60 mm", "60 mm", "200 mm"]]
wall = "8 mm"
element = "60 mm"
bores = { left = { diameter = "52 mm", width = "8 mm" } }
feet = { size = ["30 mm", "12 mm", "30 mm"] }
"""


def test_a_gearbox_in_a_box_stands_on_its_feet_and_vibrates_softer_than_on_the_ground(tmp_path: Path) -> None:
    model = rg.loads(TEXT)
    model.to_toml(tmp_path / "model.toml")
    assert rg.load(tmp_path / "model.toml") == model
    static = rg.static(model)
    (force,) = static.casing_ground_force.values()
    body = model.layout.casing("box")
    shaft = 7850.0 * math.pi / 4.0 * 0.025**2 * 0.24
    assert force[:3] == pytest.approx([0.0, 9.81 * (body.body_mass + shaft), 0.0], abs=1e-6)
    ground = model.with_({"bearings.left.casing": None, "bearings.right.casing": None, "casings": {}})
    softer = rg.modal(model, modes=4, shapes=False).frequency_hz
    assert (softer[1:] < rg.modal(ground, modes=4, shapes=False).frequency_hz[1:]).all()


def test_the_shipped_casing_is_around_the_shipped_reducer() -> None:
    model = rg.load(ROOT / "models" / "two_stage_casing.toml")
    alone = {f"bearings.{name}.casing": None for name in model.bearings}
    assert model.with_({**alone, "casings": {}, "title": "x"}) == rg.load(ROOT / "models" / "two_stage.toml").with_(
        "title", "x"
    )


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('wall = "8 mm"', 'wall = "60 mm"', r"casings\.box\.box\.wall: .*less than half"),
        ('["60 mm", "60 mm", "200 mm"]', '["-60 mm", "60 mm", "200 mm"]', r"casings\.box\.box\.corners: .*differ"),
        ("bores = {", "walls = ['250 mm']\nbores = {", r"casings\.box\.box\.walls\[0\]: .*between the ends"),
        ("left = { diameter", "front = { diameter", r"bores\.front.*(?s:.)*bores\.left: missing"),
        ('held = ["feet"]', 'held = ["feet"]\nunit = "mm"', r"casings\.box\.unit: .*beside a box"),
        ('held = ["feet"]', 'held = ["feet"]\nmesh = "a.msh"', r"casings\.box\.mesh: .*beside a box"),
        ('size = ["30 mm"', 'size = ["80 mm"', r"feet\.size\[0\]: .*at most half"),
        (
            "bores = {",
            "ribs = { x = ['70 mm'], thickness = '5 mm', height = '9 mm' }\nbores = {",
            r"ribs\.x\[0\]: .*on the",
        ),
        ('start = "-20 mm"', 'start = "-20 mm"\naxis = [1, 0, 0]', r"bearings\.left\.casing: .*not along z"),
    ],
)
def test_numbers_that_make_no_box_are_refused_by_address(old: str, new: str, said: str) -> None:
    with pytest.raises(rg.ModelError, match=said):
        rg.loads(TEXT.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            '["0 mm", "10 mm"]',
            '["0 mm", "35 mm"]',
            r"casings\.box\.box\.bores\.\w+: the block of its seat reaches over y",
        ),
        ('at = "-4 mm"', 'at = "100 mm"', r"casings\.box\.box\.bores\.left: .*away from the nearest wall"),
        ('held = ["feet"]', 'held = ["fet"]', r"casings\.box\.held\[0\]: .*did you mean 'feet'"),
    ],
)
def test_a_seat_that_no_wall_holds_is_refused_by_address(old: str, new: str, said: str) -> None:
    with pytest.raises(rg.AnalysisError, match=said):
        rg.casing(rg.loads(TEXT.replace(old, new)), modes=1)


def test_blocks_that_cannot_stand_beside_each_other_are_refused() -> None:
    with pytest.raises(rg.AnalysisError, match=r"bores\.two: .*overlaps that of one.*boss thinner"):
        body_of(
            replace(CUBE, seats=(seat("one", 0.08, 0.1, 0.0, 0.03, 0.004), seat("two", 0.14, 0.1, 0.0, 0.025, 0.004)))
        )
    with pytest.raises(rg.AnalysisError, match=r"bores\.one: .*leaves too little wall"):
        body_of(
            replace(CUBE, seats=(seat("one", 0.08, 0.08, 0.0, 0.04, 0.004), seat("two", 0.12, 0.12, 0.0, 0.04, 0.004)))
        )
    wide = seat("wide", 0.1, 0.1, 0.004, 0.04, 0.006)
    with pytest.raises(rg.AnalysisError, match=r"bores\.slim: .*in the bore of another on its axis"):
        body_of(replace(CUBE, seats=(wide, seat("slim", 0.1, 0.1, 0.005, 0.03, 0.01))))


def test_walls_much_thinner_than_their_elements_are_told() -> None:
    model = rg.load(ROOT / "models" / "two_stage_casing.toml")
    wall = model.casings["housing"].box.wall
    for times, told in ((7.9, False), (8.1, True)):
        said = rg.check(model.with_("casings.housing.box.element", times * wall)).warnings
        assert any("box.element" in note and "larger than is stated" in note for note in said) == told
