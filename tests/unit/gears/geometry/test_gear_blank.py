"""Gear blanks against frozen inertias, cutting and drilling identities, and shapes that can't be."""

from __future__ import annotations

import math

import pytest

from rotorgear.gears.geometry.blank import RigidBody, gear_blank, hollow_cylinder, mass_centre, stack
from rotorgear.gears.geometry.geometry import GearGeometry

STEEL = 7850.0
WEBBED = {"root_diameter": 0.34, "rim_thickness": 0.015, "web_thickness": 0.02, "hub_diameter": 0.12}


def numbers(body: RigidBody) -> tuple[float, float, float]:
    return body.mass, body.polar_inertia, body.diametral_inertia


@pytest.mark.parametrize(
    ("teeth", "module", "bore", "width", "expected"),
    [
        (29, 2.75e-3, 0.075, 0.065, (1.14417297, 0.002017331885, 0.001411510176)),
        (26, 4.25e-3, 0.0844, 0.085, (4.798775283, 0.01403863314, 0.009908579187)),
    ],
)
def test_the_split_torque_pinions_have_their_frozen_mass_and_inertias(
    teeth: int, module: float, bore: float, width: float, expected: tuple[float, float, float]
) -> None:
    diameter = GearGeometry(teeth, module, math.radians(25), math.radians(30)).reference_diameter
    assert numbers(gear_blank(diameter, bore, width, STEEL)) == pytest.approx(expected, rel=1e-9)


def test_a_solid_cylinder_is_the_hollow_one_without_bore() -> None:
    mass = STEEL * math.pi * 0.05**2 * 0.03
    expected = (mass, mass * 0.05**2 / 2, mass * (3 * 0.05**2 + 0.03**2) / 12)
    assert numbers(hollow_cylinder(0.1, 0.0, 0.03, STEEL)) == pytest.approx(expected, rel=1e-14)


def test_a_thin_disk_has_twice_the_polar_inertia_and_a_thin_ring_all_its_mass_at_its_radius() -> None:
    disk = hollow_cylinder(0.2, 0.0, 1e-7, STEEL)
    assert disk.polar_inertia == pytest.approx(2 * disk.diametral_inertia, rel=1e-11)
    ring = hollow_cylinder(0.2, 0.2 - 1e-9, 0.01, STEEL)
    assert ring.polar_inertia == pytest.approx(ring.mass * 0.1**2, rel=1e-8, abs=0)


def test_slices_of_a_cylinder_stack_up_to_the_cylinder() -> None:
    widths = [0.01, 0.025, 0.005, 0.04]
    starts = [sum(widths[:i]) for i in range(len(widths))]
    offsets = [0.3 + start + width / 2 for start, width in zip(starts, widths, strict=True)]
    slices = [hollow_cylinder(0.1, 0.04, width, STEEL) for width in widths]
    assert numbers(stack(slices, offsets)) == pytest.approx(numbers(hollow_cylinder(0.1, 0.04, 0.08, STEEL)), rel=1e-13)
    assert mass_centre(slices, offsets) == pytest.approx(0.34, rel=1e-14)


def test_two_halves_of_a_herringbone_gear_add_their_parallel_axis_share() -> None:
    half = gear_blank(0.1, 0.04, 0.06, STEEL)
    both = stack([half, half], [-0.05, 0.05])
    assert both.mass == 2 * half.mass
    assert both.polar_inertia == 2 * half.polar_inertia
    assert both.diametral_inertia == pytest.approx(2 * (half.diametral_inertia + half.mass * 0.05**2), rel=1e-14)


def test_a_webbed_blank_is_the_solid_one_less_its_two_pockets() -> None:
    width = 0.065
    web = WEBBED["web_thickness"]
    inner = WEBBED["root_diameter"] - 2 * WEBBED["rim_thickness"]
    depth = (width - web) / 2
    pocket = hollow_cylinder(inner, WEBBED["hub_diameter"], depth, STEEL)
    both = stack([pocket, pocket], [-(web + depth) / 2, (web + depth) / 2])
    solid = gear_blank(0.36, 0.08, width, STEEL)
    expected = [whole - cut for whole, cut in zip(numbers(solid), numbers(both), strict=True)]
    assert numbers(gear_blank(0.36, 0.08, width, STEEL, **WEBBED)) == pytest.approx(expected, rel=1e-13)


def test_a_web_as_wide_as_the_gear_makes_it_solid() -> None:
    full = gear_blank(0.36, 0.08, 0.065, STEEL, **(WEBBED | {"web_thickness": 0.065}))
    assert numbers(full) == pytest.approx(numbers(gear_blank(0.36, 0.08, 0.065, STEEL)), rel=1e-13)


def test_without_a_hub_the_web_reaches_the_bore() -> None:
    shape = {key: value for key, value in WEBBED.items() if key != "hub_diameter"}
    thin_hub = gear_blank(0.36, 0.08, 0.065, STEEL, **shape, hub_diameter=0.1, hub_width=shape["web_thickness"])
    assert numbers(gear_blank(0.36, 0.08, 0.065, STEEL, **shape)) == pytest.approx(numbers(thin_hub), rel=1e-13)


def test_a_longer_hub_adds_exactly_its_two_overhangs() -> None:
    plain, longer = (gear_blank(0.36, 0.08, 0.065, STEEL, **WEBBED, hub_width=w) for w in (0.065, 0.085))
    ring = hollow_cylinder(0.12, 0.08, 0.01, STEEL)
    overhangs = stack([ring, ring], [-0.0375, 0.0375])
    expected = [one + more for one, more in zip(numbers(plain), numbers(overhangs), strict=True)]
    assert numbers(longer) == pytest.approx(expected, rel=1e-13)


def test_a_web_off_the_middle_adds_its_own_steiner_term() -> None:
    centred, off = (gear_blank(0.36, 0.08, 0.065, STEEL, **WEBBED, web_position=e) for e in (0.0, -0.02))
    inner = WEBBED["root_diameter"] - 2 * WEBBED["rim_thickness"]
    web = hollow_cylinder(inner, WEBBED["hub_diameter"], WEBBED["web_thickness"], STEEL)
    assert numbers(off)[:2] == pytest.approx(numbers(centred)[:2], rel=1e-14)
    assert off.diametral_inertia - centred.diametral_inertia == pytest.approx(web.mass * 0.02**2, rel=1e-10)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"rim_thickness": None}, "needs a rim"),
        ({"root_diameter": None}, "needs its root diameter"),
        ({"web_thickness": None}, "web thickness as well"),
        ({"hub_diameter": None, "hub_width": 0.05}, "hub width needs a hub diameter"),
        ({"rim_thickness": 0.17}, "leaves no room inside"),
        ({"rim_thickness": 0.12}, "make the rim thinner"),
        ({"rim_thickness": -0.01}, "rim thickness must be positive"),
        ({"web_thickness": 0.07}, "wider than the face width"),
        ({"hub_diameter": 0.07}, "above the bore"),
        ({"hub_width": 0.01}, "narrower than its web"),
        ({"web_position": 0.03}, "beyond the face width"),
        ({"web_position": 0.015, "hub_width": 0.03}, "beyond the hub"),
        ({"rim_thickness": None, "web_thickness": None, "hub_diameter": None, "web_position": 0.01}, "needs a rim"),
        ({"root_diameter": 0.5}, "below the outer diameter"),
    ],
)
def test_parts_that_do_not_fit_each_other_are_refused(changes: dict[str, float | None], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        gear_blank(0.36, 0.08, 0.065, STEEL, **(WEBBED | changes))


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        ((0.1, 0.1, 0.02, STEEL), "below the outer diameter of 100 mm"),
        ((0.1, -0.01, 0.02, STEEL), "must be 0 or more"),
        ((0.1, 0.0, 0.0, STEEL), "width must be positive"),
        ((math.nan, 0.0, 0.02, STEEL), "outer diameter must be positive"),
        ((0.1, 0.0, 0.02, -1.0), "density must be positive"),
    ],
)
def test_cylinders_that_cannot_be_are_refused(shape: tuple[float, float, float, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        hollow_cylinder(*shape)


def test_a_stack_needs_one_offset_for_each_body() -> None:
    body = hollow_cylinder(0.1, 0.0, 0.02, STEEL)
    for bodies, offsets in [([body], [0.0, 1.0]), ([], [])]:
        with pytest.raises(ValueError, match="one offset for each body"):
            stack(bodies, offsets)
