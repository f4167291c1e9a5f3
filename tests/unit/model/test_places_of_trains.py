"""Where gears stand and face each other, and what shafts give between them, by triangles, ranges and integrals."""

from __future__ import annotations

import math

import pytest
from scipy.integrate import quad

import rotorgear as rg
from rotorgear.model.parts.shaft import Section
from tests.planetary import torsional_train
from tests.unit.model.test_torque_flow import flow_of, two_meshes_between_two_shafts

STEEL_G = 206e9 / 2.6


@pytest.mark.parametrize(("first", "second"), [(0.0, 0.45), (0.07, 0.39), (0.1, 0.22)])
def test_what_a_shaft_gives_between_two_places_is_the_integral_over_its_cones_and_pieces(
    first: float, second: float
) -> None:
    """1/(G J) of a hollow cone, a rigid piece and a pipe; both shafts of the loop twist alike."""
    sections = (
        Section(length=0.15, outer_diameter=0.04, outer_diameter_end=0.07, bore=0.01, bore_end=0.03),
        Section(length=0.1, outer_diameter=0.05, rigid=True),
        Section(length=0.2, outer_diameter=0.06, bore=0.02),
    )

    def give(z: float) -> float:
        if z < 0.15:
            outer, bore = 0.04 + 0.03 * z / 0.15, 0.01 + 0.02 * z / 0.15
        elif z < 0.25:
            return 0.0
        else:
            outer, bore = 0.06, 0.02
        return 1.0 / (STEEL_G * math.pi / 32.0 * (outer**4 - bore**4))

    model = two_meshes_between_two_shafts(sections[0], 1e8, 1.7e8)
    shafts = {name: shaft.model_copy(update={"sections": sections}) for name, shaft in model.shafts.items()}
    at = {"p1": first, "w1": first, "p2": second, "w2": second}
    gears = {name: gear.model_copy(update={"at": at[name]}) for name, gear in model.gears.items()}
    loads = {name: load.model_copy(update={"at": first}) for name, load in model.loads.items()}
    flow = flow_of(model.model_copy(update={"shafts": shafts, "gears": gears, "loads": loads}))
    twist = quad(give, first, second, points=[0.15, 0.25], limit=200)[0]
    short, long = 1e-8, 1.0 / 1.7e8 + twist * (0.05**2 + 0.1**2)
    share = long / (short + long)
    # Cones count by their mean flexibility: what is left of the quadrature is small.
    assert flow.forces[0].normal_force == pytest.approx(share * 100 / 0.05, rel=1e-6)
    assert flow.forces[1].normal_force == pytest.approx((1.0 - share) * 100 / 0.05, rel=1e-6)


PAIR = """
[operation]
input_shaft = "one"
[shafts.one]
position = ["0 mm", "0 mm"]
start = "-20 mm"
sections = [{{ length = "200 mm", outer_diameter = "30 mm" }}]
[shafts.two]
position = ["123 mm", "0 mm", "-4 mm"]
start = "10 mm"
sections = [{{ length = "200 mm", outer_diameter = "30 mm" }}]
[gears.pinion]
shaft = "one"
at = "{first} mm"
teeth = 25
width = "{wide} mm"
kind = "spur"
normal_module = "3 mm"
normal_pressure_angle = "20 deg"
[gears.wheel]
shaft = "two"
at = "{second} mm"
teeth = 57
width = "{narrow} mm"
kind = "spur"
normal_module = "3 mm"
normal_pressure_angle = "20 deg"
[meshes.pair]
pinion = "pinion"
gear = "wheel"
stiffness = "iso"
"""


@pytest.mark.parametrize(
    ("first", "wide", "second", "narrow", "face"),
    [
        (100.0, 30.0, 107.0, 18.0, (94.0, 112.0)),
        (100.0, 18.0, 93.0, 30.0, (91.0, 104.0)),
        (100.0, 30.0, 114.0, 16.0, (102.0, 115.0)),
    ],
)
def test_two_gears_face_each_other_where_both_widths_are(
    first: float, wide: float, second: float, narrow: float, face: tuple[float, float]
) -> None:
    model = rg.loads(PAIR.format(first=first, wide=wide, second=second, narrow=narrow))
    mesh = model.layout.mesh("pair")
    assert mesh.width == pytest.approx(1e-3 * min(wide, narrow))
    assert mesh.face(0) == pytest.approx((1e-3 * face[0], 1e-3 * face[1]))
    # z = 0 of the second shaft is 4 mm below that of the first.
    assert mesh.planes == (pytest.approx((1e-3 * first, 1e-3 * (second - 4.0))),)
    for gear, lower in zip(mesh.gears, (0.0, 4.0), strict=True):
        assert mesh.own_face(gear, 0) == pytest.approx((1e-3 * (face[0] + lower), 1e-3 * (face[1] + lower)))


def test_meshed_planets_stand_beside_each_other_by_the_triangle_of_their_pins() -> None:
    """A Ravigneaux set, module 3 mm: radii of (28 + 20) and (36 + 31) half modules, 51 between the planets."""
    model = torsional_train(
        "ss",
        "ss sl r c",
        "gss ss 28, gsl sl 36, gps ps 20, gpl pl 31, gr r -98",
        "gss gps, gps gpl, gsl gpl, gpl gr",
        "k c 2",
        "ps k, pl k",
        given="c 0",
        loads="r",
    )
    place = {name: shaft.position for name, shaft in model.shafts.items()}
    half = 1.5e-3
    for k in (1, 2):
        short, long = place[f"ps#{k}"], place[f"pl#{k}"]
        assert short is not None
        assert long is not None
        assert math.hypot(*short) == pytest.approx(half * 48, rel=1e-9)
        assert math.hypot(*long) == pytest.approx(half * 67, rel=1e-9)
        assert math.dist(short, long) == pytest.approx(half * 51, rel=1e-9)
        # The planet whose place follows stands ahead of the other one.
        offset = model.shafts[f"pl#{k}"].offset
        assert offset is not None
        assert offset == pytest.approx(math.acos((48**2 + 67**2 - 51**2) / (2 * 48 * 67)), rel=1e-9)


def test_lumped_planets_stand_where_their_base_circles_and_pressure_angle_put_them() -> None:
    """(r_b1 + r_b2)/cos alpha from the sun, (r_b3 - r_b2)/cos alpha from the ring."""
    inertia = "mass = 1.0\npolar_inertia = 1e-3\ndiametral_inertia = 1e-3\nkind = 'spur'\n"
    text = f"""
motions = ["torsion"]
[operation]
input_shaft = "s"
[shafts.s]
[shafts.c]
[shafts.r]
speed_ratio = 0
[shafts.p]
carrier = "k"
[carriers.k]
shaft = "c"
at = 0
planets = 3
[gears.sun]
shaft = "s"
at = 0
base_radius = "31 mm"
{inertia}
[gears.planet]
shaft = "p"
at = 0
base_radius = "42 mm"
{inertia}
[gears.ring]
shaft = "r"
at = 0
base_radius = "115 mm"
internal = true
{inertia}
[meshes.inner]
pinion = "sun"
gear = "planet"
stiffness = 1e8
pressure_angle = "22 deg"
[meshes.outer]
pinion = "planet"
gear = "ring"
stiffness = 1e8
pressure_angle = "22 deg"
"""
    model = rg.loads(text)
    assert model.shafts["p#2"].radius == pytest.approx(73e-3 / math.cos(math.radians(22.0)), rel=1e-12)
