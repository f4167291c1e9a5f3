"""Rigid bodies at the nodes: given ones as they are, blanks from their sizes, herringbones in two halves."""

from __future__ import annotations

import math
from typing import Any

import pytest

from rotorgear.errors import ModelError
from rotorgear.gears.geometry.blank import RigidBody, hollow_cylinder
from rotorgear.model.model import Model

Data = dict[str, Any]
STEEL = 7850.0


def bodies(model: Model, part: str) -> list[tuple[float, RigidBody]]:
    return [(place.z, body) for address, place, body in model.layout.bodies if address == part]


def test_a_gear_without_a_body_is_solid_down_to_its_shaft(pair: Data) -> None:
    model = Model(**pair)
    geometry = model.gears["pinion"].geometry
    assert geometry is not None
    ((z, body),) = bodies(model, "gears.pinion")
    assert z == pytest.approx(0.1)
    assert body == hollow_cylinder(geometry.reference_diameter, 0.04, 0.03, STEEL)


def test_the_default_bore_is_the_thickest_shaft_under_the_gear(pair: Data) -> None:
    pair["shafts"]["input"]["sections"] = [
        {"length": "100 mm", "outer_diameter": "30 mm"},
        {"length": "100 mm", "outer_diameter": "40 mm", "outer_diameter_end": "20 mm"},
    ]
    model = Model(**pair)
    reference = 24 * 0.002 / math.cos(math.radians(20))
    ((_, body),) = bodies(model, "gears.pinion")
    assert body.mass == pytest.approx(STEEL * math.pi / 4 * (reference**2 - 0.04**2) * 0.03, rel=1e-12)


def test_a_cone_counts_with_its_diameter_at_the_gear(pair: Data) -> None:
    pair["shafts"]["input"]["sections"][0] |= {"outer_diameter": "40 mm", "outer_diameter_end": "20 mm"}
    assert Model(**pair).shafts["input"].diameter_at(0.1) == pytest.approx(0.03, rel=1e-12)


def test_given_inertias_are_taken_as_they_are(everything: Data) -> None:
    model = Model(**everything)
    assert bodies(model, "gears.idler") == [(0.0, RigidBody(2.0, 0.01, 0.006))]
    assert bodies(model, "disks.rotor") == [(pytest.approx(-0.2), RigidBody(20.0, 0.1, 0.06))]


def test_a_disk_by_its_sizes_is_a_cylinder_of_its_own_material(everything: Data) -> None:
    ((z, body),) = bodies(Model(**everything), "disks.blower")
    assert z == pytest.approx(0.2)
    assert body == hollow_cylinder(0.3, 0.0, 0.04, 2700.0)
    del everything["disks"]["blower"]["bore"]
    ((_, ring),) = bodies(Model(**everything), "disks.blower")
    assert ring == hollow_cylinder(0.3, 0.05, 0.04, 2700.0)


def test_a_point_mass_has_no_moments(everything: Data) -> None:
    assert bodies(Model(**everything), "point_masses.nut") == [(0.0, RigidBody(0.2, 0.0, 0.0))]


def test_the_halves_of_a_herringbone_tied_rigidly_are_the_whole(split: Data) -> None:
    model = Model(**split)
    whole = model.layout.gear("wheel_a").body
    (left, one), (right, two) = bodies(model, "gears.wheel_a")
    assert (left, right) == pytest.approx((-0.045, 0.045))
    assert one == two
    assert one.mass + two.mass == pytest.approx(whole.mass, rel=1e-14)
    assert one.polar_inertia + two.polar_inertia == pytest.approx(whole.polar_inertia, rel=1e-14)
    tilt = sum(body.diametral_inertia + body.mass * z**2 for z, body in ((left, one), (right, two)))
    assert tilt == pytest.approx(whole.diametral_inertia, rel=1e-14)


def test_a_herringbone_blank_is_two_single_helices_side_by_side(split: Data) -> None:
    double = Model(**split).layout.gear("pinion").body
    split["gears"]["pinion"] |= {"kind": "helical", "gap": "0 mm"}
    del split["meshes"]["first_a"], split["meshes"]["first_b"], split["operation"]
    single = Model(**split).layout.gear("pinion").body
    assert double.mass == pytest.approx(2 * single.mass)
    assert double.diametral_inertia == pytest.approx(2 * (single.diametral_inertia + single.mass * 0.045**2))


def test_a_herringbone_in_one_node_keeps_its_whole_body_there(split: Data) -> None:
    two = Model(**split).layout.gear("wheel_a").body
    split["gears"]["wheel_a"]["nodes"] = 1
    model = Model(**split)
    assert bodies(model, "gears.wheel_a") == [(0.0, two)]


def test_a_rim_and_a_web_weigh_less_than_a_solid_wheel(split: Data) -> None:
    light = Model(**split).layout.gear("wheel_a").body
    del split["gears"]["wheel_a"]["body"]
    solid = Model(**split).layout.gear("wheel_a").body
    assert light.mass < 0.8 * solid.mass
    # The rim is far out: the inertia falls by less than the mass.
    assert light.polar_inertia / solid.polar_inertia > light.mass / solid.mass


@pytest.mark.parametrize(
    ("motions", "needed"),
    [
        (["torsion"], ["polar_inertia"]),
        (["axial"], ["mass"]),
        (["bending"], ["mass", "polar_inertia", "diametral_inertia"]),
    ],
)
def test_only_the_inertias_of_the_motions_are_asked_for(
    everything: Data, motions: list[str], needed: list[str]
) -> None:
    everything["motions"] = motions
    rotor = everything["disks"]["rotor"]
    for key in ("mass", "polar_inertia", "diametral_inertia"):
        if key not in needed:
            del rotor[key]
    Model(**everything)
    if len(needed) > 1:
        del rotor[needed[-1]]
        with pytest.raises(ModelError, match=rf"disks\.rotor\.{needed[-1]}: missing"):
            Model(**everything)
