"""Planetary stages and internal gears from REXS: what a file has planet by planet is written once, and is the same gearbox."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.rexs.document import Component, Document, Value
from rotorgear.rexs.read import read_document
from tests.paths import ROOT
from tests.unit.rexs.documents import changed, write_json
from tests.unit.rexs.written import MM, Written

PLANETARY = ROOT / "tests" / "rexs_files" / "planetary_1.4.rexs"
SUN, PLANET, RING, N = 21, 28, 79, 4


def document() -> Document:
    return read_document(PLANETARY)


def imported(document: Document, tmp_path: Path) -> rg.RexsImport:
    return rg.import_rexs(write_json(document, tmp_path / "gearbox.rexsj"))


def model_of(document: Document, tmp_path: Path) -> rg.Model:
    return rg.loads(imported(document, tmp_path).toml)


def named(document: Document, name: str) -> Component:
    (found,) = (part for part in document.components.values() if part.name == name)
    return found


def without_relation(document: Document, kind: str) -> Document:
    return replace(document, relations=tuple(one for one in document.relations if one.type != kind))


def test_a_planetary_stage_has_the_ratio_of_willis_in_fractions_and_torques_that_balance() -> None:
    result = rg.import_rexs(PLANETARY)
    model = rg.loads(result.toml)
    assert (result.shafts, result.gears, result.meshes, result.bearings) == (5, 3, 2, 6)
    speeds = model.layout.train.ratios
    carrier = Fraction(SUN, SUN + RING)
    assert speeds["carrier_shaft"] == carrier
    assert speeds["ring_shaft"] == 0
    # Seen from the carrier all teeth pass at one speed.
    assert {speeds[f"planet_shaft_1#{k}"] for k in range(1, N + 1)} == {carrier - Fraction(SUN, PLANET) * (1 - carrier)}
    # Slowly, so that no centrifugal load of the planets moves them off their circle.
    static = rg.static(model.with_("operation.speed", "0.01 rpm"))
    torques = {load.name: load.torque_n_m for load in rg.check(model).torques}
    assert torques["loads.output"] == pytest.approx(-210.0 / float(carrier), rel=1e-12)
    assert static.support_force["ring_held"][5] == pytest.approx(210.0 / float(carrier) - 210.0, rel=1e-9)


def test_every_planet_stands_where_the_file_has_it() -> None:
    model = rg.loads(rg.import_rexs(PLANETARY).toml)
    for k in range(1, N + 1):
        shaft = named(document(), f"Planet shaft {k}")
        raw = shaft.attributes["support_vector"].raw
        assert isinstance(raw, list)
        _, x, y = (1e-3 * float(entry) for entry in raw)
        position = model.shafts[f"planet_shaft_1#{k}"].position
        assert position is not None
        assert position[:2] == pytest.approx((x, y), abs=1e-12)
        gear = model.gears[f"planet_1#{k}"]
        assert gear.at == pytest.approx(0.123)


def test_pins_and_plates_are_bodies_of_the_carrier() -> None:
    model = rg.loads(rg.import_rexs(PLANETARY).toml)
    pins = model.disks["stage_pins"]
    m = N * 7850.0 * math.pi / 4.0 * 0.032**2 * 0.098
    r = 0.0641
    assert pins.mass == pytest.approx(m, rel=1e-5)
    assert pins.polar_inertia == pytest.approx(m * r**2, rel=1e-5)
    # Pins of length l at the corners of a square, about x: sum of (r sin)^2 + l^2/12.
    assert pins.diametral_inertia == pytest.approx(m * (0.5 * r**2 + 0.098**2 / 12.0), rel=1e-5)
    assert (model.disks["front_plate"].shaft, model.disks["back_plate"].shaft) == ("carrier_shaft", "back_plate_ring")
    assert model.disks["back_plate"].width == pytest.approx(0.011)
    # The back plate's shaft hangs on the pins alone, so that they become a coupling.
    (coupling,) = model.couplings.values()
    assert (coupling.from_shaft, coupling.to_shaft) == ("carrier_shaft", "back_plate_ring")
    assert coupling.turns_both


def test_a_stage_whose_axis_lies_in_space_has_the_same_frequencies(tmp_path: Path) -> None:
    # All of the gearbox turned against the gear unit, and a shaft of its own along the gear unit's u beside it.
    rng = np.random.default_rng(5)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn = turn * np.sign(np.linalg.det(turn))
    base = document()
    parts = {}
    for number, part in base.components.items():
        attributes = dict(part.attributes)
        for key in ("support_vector", "u_axis_vector", "w_axis_vector"):
            value = attributes.get(key)
            if value is not None and part.type != "gear_unit":
                assert isinstance(value.raw, list)
                attributes[key] = Value((turn @ np.array(value.raw, dtype=float)).tolist(), MM)
        parts[number] = replace(part, attributes=attributes)
    turned = replace(base, components=parts)
    beside = Written()
    beside.components, beside.relations = dict(turned.components), list(turned.relations)
    other = beside.shaft("other", 400.0, 0.0)
    beside.bearing("other left", other, "2", 10.0)
    beside.bearing("other right", other, "2", 90.0)
    model = model_of(replace(turned, components=beside.components, relations=tuple(beside.relations)), tmp_path)
    assert model.shafts["carrier_shaft"].frame.is_turned
    old = rg.modal(rg.loads(rg.import_rexs(PLANETARY).toml), modes=12, elements=1).frequency_hz
    new = rg.modal(model, modes=24, elements=1).frequency_hz
    assert np.max(np.abs(new[:, None] - old[None, 1:]).min(axis=0) / old[1:]) < 1e-6
    static = rg.static(model)
    assert np.sort(static.mesh_force) == pytest.approx(
        np.sort(rg.static(rg.loads(rg.import_rexs(PLANETARY).toml)).mesh_force), rel=1e-6
    )


def test_where_the_gear_unit_itself_stands_changes_nothing(tmp_path: Path) -> None:
    moved = changed(
        document(),
        "1",
        support_vector=Value([130.0, -70.0, 45.0], MM),
        u_axis_vector=Value([0.0, 0.0, 1.0], MM),
        w_axis_vector=Value([1.0, 0.0, 0.0], MM),
    )
    assert model_of(moved, tmp_path) == model_of(document(), tmp_path)


def test_a_ring_on_a_shaft_inside_of_its_teeth_has_a_rim_of_three_modules(tmp_path: Path) -> None:
    ring = model_of(stage_of((18, 21, 60), 3), tmp_path).gears["ring_gear"]
    assert ring.mass == 0.0  # the section of the shaft is around the teeth
    small = stage_of((18, 21, 60), 3)
    (section,) = (
        part for part in small.of_type("shaft_section") if part.attributes["outer_diameter_begin"].raw == 150.0
    )
    result = imported(changed(small, section.id, outer_diameter_begin=Value(50.0, MM)), tmp_path)
    found = rg.loads(result.toml).gears["ring_gear"].body.outer_diameter
    # Roots lie 1.25 modules of 2 mm outside of 120 mm.
    assert found == pytest.approx(0.120 + 2 * 1.25 * 0.002 + 2 * 3 * 0.002, rel=1e-12)
    assert any(item.address == "gears.ring_gear.body.outer_diameter" for item in result.assumptions)


def test_a_ring_with_the_signs_of_iso_21771_is_the_same_gear(tmp_path: Path) -> None:
    whole = document()
    ring = named(whole, "Ring")
    other = changed(
        whole,
        ring.id,
        number_of_teeth=Value(-RING),
        tip_diameter=Value(-float(str(ring.attributes["tip_diameter"].raw)), MM),
    )
    for stage in whole.of_type("cylindrical_stage"):
        if stage.name.startswith("Planet-ring"):
            other = changed(other, stage.id, center_distance=Value(-64.1, MM))
    external = replace(other.components[ring.id], type="cylindrical_gear")
    other = replace(other, components={**other.components, ring.id: external})
    assert model_of(other, tmp_path) == model_of(whole, tmp_path)


def test_the_shift_of_a_ring_is_read_with_either_sign_or_follows_from_the_axes(tmp_path: Path) -> None:
    whole = document()
    given = model_of(whole, tmp_path)
    flanks = [whole.components[n] for n in ("22", "23")]
    assert {float(str(flank.attributes["addendum_modification_coefficient"].raw)) for flank in flanks} == {0.112838}
    outwards = missing = whole
    for flank in flanks:
        outwards = changed(outwards, flank.id, addendum_modification_coefficient=Value(-0.112838))
        missing = changed(missing, flank.id, addendum_modification_coefficient=None)
    result = imported(outwards, tmp_path)
    assert rg.loads(result.toml).gears["ring"] == given.gears["ring"]
    assert any("fits the axes" in note and "gears.ring.profile_shift" in note for note in result.warnings)
    assert model_of(missing, tmp_path).gears["ring"].profile_shift == pytest.approx(0.112838, abs=2e-6)


def test_an_opposite_helix_of_the_ring_is_that_of_its_planet_and_said(tmp_path: Path) -> None:
    result = imported(
        changed(document(), named(document(), "Ring").id, helix_angle_reference_diameter=Value(12.0, "deg")), tmp_path
    )
    assert rg.loads(result.toml).gears["ring"].hand == "left"
    assert any(item.address == "gears.ring.hand" for item in result.assumptions)


def test_a_planet_bearing_without_a_stiffness_is_estimated_around_its_pin(tmp_path: Path) -> None:
    other = document()
    for k in range(1, N + 1):
        for end in ("back", "front"):
            part = named(other, f"Planet bearing {k} {end}")
            kind = Value("radial_needle_roller_bearing")
            other = changed(other, part.id, radial_stiffness=Value(1e20, "N / m"), bearing_type=kind)
    result = imported(other, tmp_path)
    said = result.toml.partition("id 30)")[2].partition("stiffness =")[0]
    # The pin is 32 mm thick; its planet's shaft 52 mm.
    assert "from 32 x" in said


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            lambda d: without_relation(d, "planet_carrier_shaft"),
            "planetary_stage 'Stage' (id 4): a planet carrier is needed",
        ),
        (
            lambda d: replace(d, relations=tuple(one for one in d.relations if one.refs[-1:] != (("shaft", "50"),))),
            "shaft 'Planet shaft 3' (id 50): it runs on a pin of planetary_stage 'Stage' (id 4): a relation planet_shaft is",
        ),
        (
            lambda d: replace(d, components={n: c for n, c in d.components.items() if c.type != "planetary_stage"}),
            "planet_carrier 'Carrier' (id 5): it must be part of a planetary stage",
        ),
        (lambda d: without_relation(d, "planet_shaft"), "planetary_stage 'Stage' (id 4): planets are needed"),
        (
            lambda d: changed(d, named(d, "Planet 3").id, number_of_teeth=Value(27)),
            "planetary_stage 'Stage' (id 4): its planets must be alike; number_of_teeth of the gear at z = 123.000 mm: 28 of "
            "shaft 'Planet shaft 1' (id 24), 27 of shaft 'Planet shaft 3' (id 50)",
        ),
        (
            lambda d: changed(d, named(d, "Planet shaft 2").id, support_vector=Value([101, -18.74, 61.5], MM)),
            "planetary_stage 'Stage' (id 4): its pins must stand on one circle; they stand at 64.1 and 64.2918 mm",
        ),
        (
            lambda d: replace(d, components={n: c for n, c in d.components.items() if c.name != "Planet-ring 4"}),
            "its planets must mesh alike, or be of several kinds with as many of each; they mesh 3 with Ring and Sun, 1 with Sun",
        ),
        (lambda d: changed(d, "25", length=None), "shaft_section (id 25): length and outer_diameter_begin are needed"),
        (lambda d: changed(d, "27", length=None), "shaft_section (id 27): length and outer_diameter_begin are needed"),
        (
            lambda d: changed(d, named(d, "Ring held").id, is_engaged=Value("false")),
            "shafts.ring_shaft",
        ),
        (
            lambda d: replace(d, components={**d.components, "18": replace(d.components["18"], type="ring_gear")}),
            "cylindrical_stage 'Sun-planet 1'",
        ),
    ],
)
def test_what_can_not_be_a_planetary_stage_is_told_with_its_address(change, words: str, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(rg.ModelError) as caught:
        imported(change(document()), tmp_path)
    assert words in str(caught.value)


def test_other_ways_to_write_the_same_stage_give_the_same_model(tmp_path: Path) -> None:
    """Pins that only their carrier names, a brake with a truth value for each gear, and power in place of torque."""
    whole = document()
    given = model_of(whole, tmp_path)
    assert model_of(without_relation(whole, "planet_pin"), tmp_path) == given
    brake = changed(whole, named(whole, "Ring held").id, is_engaged=Value(["true", "false"]))
    assert model_of(changed(brake, "1", gear_shift_index=Value(1)), tmp_path) == given
    with pytest.raises(rg.ModelError, match=r"shafts\."):
        model_of(changed(brake, "1", gear_shift_index=Value(2)), tmp_path)
    power = 210.0 * 1800.0 * math.pi / 30.0
    load = changed(whole, named(whole, "Input").id, torque_around_u_axis=None, power=Value(1e-3 * power, "kW"))
    result = imported(load, tmp_path)
    assert rg.loads(result.toml).loads["input"].torque == pytest.approx(210.0, rel=1e-9)
    assert any("power of" in item.reason for item in result.assumptions)


def test_a_strut_between_the_shafts_of_a_carrier_joins_them(tmp_path: Path) -> None:
    g = Written()
    whole = document()
    g.components, g.relations = dict(whole.components), list(whole.relations)
    strut = g.add("shaft", "Strut", support_vector=Value([84.0, 0.0, 0.0], MM))
    section = g.add(
        "shaft_section",
        "",
        length=Value(83.0, MM),
        outer_diameter_begin=Value(150.0, MM),
        inner_diameter_begin=Value(120.0, MM),
    )
    g.join("assembly", assembly=strut, part=section)
    for name, end, z in (("Carrier shaft", "front", 167.0), ("Back plate ring", "back", 84.0)):
        joint = g.add("coupling", f"Strut {end}", support_vector=Value([z, 0.0, 0.0], MM))
        g.join("side", assembly=joint, inner_part=named(whole, name).id, outer_part=strut)
    model = model_of(replace(whole, components=g.components, relations=tuple(g.relations)), tmp_path)
    assert sorted(model.couplings) == ["strut_back", "strut_front"]
    assert model.layout.train.ratios["strut"] == Fraction(SUN, SUN + RING)


def test_pins_at_unequal_angles_are_written_as_angles(tmp_path: Path) -> None:
    # (21 + 79) teeth: pins may stand at multiples of 3.6 deg.
    gearbox = stage_of((18, 21, 60), 3, angles=[0.0, 120.0, 240.0])
    assert "planets = 3" in imported(gearbox, tmp_path).toml
    uneven = model_of(
        stage_of((18, 21, 60), 3, angles=[10.0, 10.0 + 360.0 * 24 / 78, 10.0 + 360.0 * 53 / 78]), tmp_path
    )
    (carrier,) = uneven.carriers.values()
    assert np.degrees(carrier.angles) == pytest.approx([0.0, 360.0 * 24 / 78, 360.0 * 53 / 78], abs=1e-9)
    assert uneven.shafts["planet_0#2"].offset == pytest.approx(math.radians(10.0))


def stage_of(
    teeth: tuple[int, int, int],
    count: int,
    *,
    angles: list[float] | None = None,
    brake: bool = True,
    speed: float | None = None,
) -> Document:
    """A spur stage by its teeth: sun in at 1000 rpm, the ring held by a brake or at a speed in rpm of its own."""
    sun, planet, ring = teeth
    g = Written()
    defines = {"defines_speed": Value("true")}
    stage = g.add("planetary_stage", "stage")
    shafts = {
        "sun": g.shaft("sun", rotational_speed=Value(1000.0, "1 / min"), **defines),
        "ring": g.shaft(
            "ring",
            d=2.0 * ring + 30.0,
            **({} if speed is None else {"rotational_speed": Value(speed, "1 / min"), **defines}),
        ),
        "carrier": g.shaft("carrier"),
    }
    g.join("planet_carrier_shaft", planetary_stage=stage, shaft=shafts["carrier"])
    for name, shaft in shafts.items():
        for u in (5.0, 95.0):
            g.bearing(f"{name} {u:g}", shaft, g.casing, u)
    if brake:
        g.held(shafts["ring"])
    sun_gear, ring_gear = g.gear("sun gear", shafts["sun"], sun), g.gear("ring gear", shafts["ring"], ring, ring=True)
    radius = float(sun + planet)
    planets = [
        g.planets(stage, "planet", 1, radius, math.radians(angle))[0]
        for angle in (angles or [360.0 * k / count for k in range(count)])
    ]
    for k, (shaft, _) in enumerate(planets):
        gear = g.gear(f"planet gear {k}", shaft, planet)
        g.mesh(f"sun planet {k}", sun_gear, gear)
        g.mesh(f"planet ring {k}", gear, ring_gear)
    return g.document()


@pytest.mark.parametrize("rpm", [0.0, -150.0, 77.0])
def test_a_second_speed_that_the_file_defines_makes_a_differential(rpm: float, tmp_path: Path) -> None:
    model = model_of(stage_of((18, 21, 60), 3, brake=False, speed=rpm), tmp_path)
    found = {row.name: row.speed_rpm for row in rg.check(model).shafts}
    assert found["ring"] == pytest.approx(rpm, rel=1e-9)
    assert found["carrier"] == pytest.approx((18 * 1000.0 + 60 * rpm) / 78, rel=1e-9)


def test_two_kinds_of_planets_share_the_pins_and_mesh_with_their_neighbours(tmp_path: Path) -> None:
    """A Ravigneaux set, first gear: small sun 28 in, short 20, long 31, ring 98, and the carrier held."""
    small, large, short, long, ring = 28, 36, 20, 31, 98
    g = Written()
    stage = g.add("planetary_stage", "ravigneaux")
    shafts = {
        name: g.shaft(name, d=10.0 if name != "ring" else 240.0) for name in ("small", "large", "ring", "carrier")
    }
    first = g.components[shafts["small"]]
    g.components[first.id] = replace(
        first, attributes={**first.attributes, "rotational_speed": Value(1000.0, "1 / min")}
    )
    g.join("planet_carrier_shaft", planetary_stage=stage, shaft=shafts["carrier"])
    g.held(shafts["carrier"])
    for name, shaft in shafts.items():
        g.bearing(f"{name} left", shaft, g.casing, 5.0)
        g.bearing(f"{name} right", shaft, g.casing, 95.0)
    gears = {
        "small": g.gear("small sun", shafts["small"], small, u=30.0),
        "large": g.gear("large sun", shafts["large"], large, u=70.0),
        "ring": g.gear("ring gear", shafts["ring"], ring, u=70.0, ring=True),
    }
    near, far, between = float(small + short), float(large + long), float(short + long)
    turn = math.acos((near**2 + far**2 - between**2) / (2.0 * near * far))
    shorts = g.planets(stage, "short", 2, near, 0.2)
    # The long planets are listed from another one on: whose mate is written first is found by the meshes.
    longs = g.planets(stage, "long", 2, far, 0.2 + turn + math.pi)
    for k in range(2):
        one = g.gear(f"short {k}", shorts[k][0], short, u=30.0)
        wide, thin = g.gear(f"long {k} a", longs[k][0], long, u=30.0), g.gear(f"long {k} b", longs[k][0], long, u=70.0)
        g.mesh(f"small short {k}", gears["small"], one)
        g.mesh(f"large long {k}", gears["large"], thin)
        g.mesh(f"long ring {k}", thin, gears["ring"])
        longs[k] = (longs[k][0], wide)
        shorts[k] = (shorts[k][0], one)
    for k in range(2):
        # Long planet k is half a turn ahead of short planet k: it meshes with the other one.
        g.mesh(f"short long {k}", shorts[1 - k][1], longs[k][1])
    model = model_of(g.document(), tmp_path)
    speeds = model.layout.train.ratios
    assert speeds["ring"] == Fraction(2, 7)
    assert speeds["large"] == Fraction(-7, 9)
    assert len(model.meshes) == 8


def test_two_stages_in_series_one_of_them_with_stepped_planets_have_the_product_of_their_ratios(tmp_path: Path) -> None:
    g = Written()
    speed = {"rotational_speed": Value(1000.0, "1 / min")}
    sun, middle, out = g.shaft("sun", **speed), g.shaft("middle"), g.shaft("out")
    for shaft in (sun, middle, out):
        for u in (5.0, 95.0):
            g.bearing(f"{g.components[shaft].name} {u:g}", shaft, g.casing, u)
    # Stepped: 24 with 53, and 19 in a ring of 96; then 18, 21 and 60 teeth. Both rings are held.
    for name, first, second, count, teeth in (
        ("stepped", sun, middle, 2, (24, 53, 19, 96)),
        ("plain", middle, out, 3, (18, 21, 21, 60)),
    ):
        stage = g.add("planetary_stage", name)
        g.join("planet_carrier_shaft", planetary_stage=stage, shaft=second)
        ring = g.shaft(f"{name} ring", d=2.0 * teeth[3] + 30.0)
        g.held(ring)
        at = {"stepped": (25.0, 45.0), "plain": (70.0, 70.0)}[name]
        gears = (
            g.gear(f"{name} sun", first, teeth[0], u=at[0]),
            g.gear(f"{name} ring", ring, teeth[3], u=at[1], ring=True),
        )
        for k, (planet, _) in enumerate(g.planets(stage, name, count, float(teeth[0] + teeth[1]), 0.4)):
            one = g.gear(f"{name} {k} a", planet, teeth[1], u=at[0])
            other = one if teeth[1] == teeth[2] else g.gear(f"{name} {k} b", planet, teeth[2], u=at[1])
            g.mesh(f"{name} {k} in", gears[0], one)
            g.mesh(f"{name} {k} out", other, gears[1])
    model = model_of(g.document(), tmp_path)
    assert sorted(model.carriers) == ["plain", "stepped"]
    assert model.layout.train.ratios["middle"] == Fraction(19, 231)
    assert model.layout.train.ratios["out"] == Fraction(19, 231) * Fraction(18, 78)


def seated(d: Document, **attributes: Value) -> Document:
    """A stage whose ring stands in the casing: as a part of it, or with attributes, by a coupling that has them."""
    ring = named(d, "ring gear")
    (shaft,) = (part.id for part in d.components.values() if (part.type, part.name) == ("shaft", "ring"))
    g = Written(d.version)
    g.components, g.relations = dict(d.components), list(d.relations)
    g.casing = next(part.id for part in d.of_type("gear_casing"))
    gone = {shaft, *(n for r in d.relations if ("assembly", shaft) in r.refs for n in r.at("part") if n != ring.id)}
    gone |= {r.refs[0][1] for r in d.relations if ("inner_part", shaft) in r.refs}
    g.relations = [r for r in g.relations if not gone & {n for _, n in r.refs}]
    g.components = {n: part for n, part in g.components.items() if n not in gone}
    # Axes of a ring may run the other way; its support vector is the middle of its face.
    place = {"support_vector": Value([50.0, 0.0, 0.0], MM), "u_axis_vector": Value([-1.0, 0.0, 0.0], MM)}
    kept = {key: value for key, value in ring.attributes.items() if key != "u_coordinate_on_shaft"}
    g.components[ring.id] = replace(ring, attributes={**kept, **place})
    if attributes:
        number = "900"
        g.components[number] = Component(number, "coupling", "bolts", attributes)
        g.join("side", assembly=number, inner_part=ring.id, outer_part=g.casing)
    else:
        g.join("assembly", assembly=g.casing, part=ring.id)
    return g.document()


def test_a_ring_that_is_part_of_the_casing_stands_fixed_and_takes_its_torque(tmp_path: Path) -> None:
    teeth, count = (17, 22, 61), 3
    result = imported(seated(stage_of(teeth, count)), tmp_path)
    model = rg.loads(result.toml)
    ring = model.gears["ring_gear"]
    assert (ring.shaft, ring.at, ring.teeth, ring.internal) == ("ring_gear", pytest.approx(0.05), 61, True)
    assert ring.body.outer_diameter == pytest.approx(2e-3 * (61 + 2 * 1.25 + 2 * 3), rel=1e-12)
    assert model.supports["ring_gear"].fixed == ("x", "y", "z", "tilt_x", "tilt_y", "torsion")
    assert model.layout.train.ratios["carrier"] == Fraction(17, 17 + 61)
    assert any(item.address == "supports.ring_gear.fixed" for item in result.assumptions)
    # Willis: the ring takes z_r/z_s of the torque that goes in, against the sense of the carrier's.
    loaded = model.with_("operation.output_shaft", "carrier").with_("operation.torque", "130 N m")
    loaded = loaded.with_("operation.speed", "0.01 rpm")
    assert abs(rg.static(loaded).support_force["ring_gear"][5]) == pytest.approx(130.0 * 61 / 17, rel=1e-9)


def test_a_coupling_between_a_ring_and_the_casing_holds_it_by_its_stiffnesses(tmp_path: Path) -> None:
    bolts = {
        "radial_stiffness": Value(7e8, "N / m"),
        "torsional_stiffness": Value(3.3e7, "N m / rad"),
    }
    model = model_of(seated(stage_of((17, 22, 61), 3), **bolts), tmp_path)
    (bolted,) = model.supports.values()
    assert "bolts" in model.supports
    assert bolted.stiffness.radial == 7e8
    assert bolted.stiffness.torsion == 3.3e7
    assert bolted.fixed == ("z", "tilt_x", "tilt_y")
    # Nothing holds the ring of a coupling that is open: its speed and that of the carrier are not determined.
    with pytest.raises(rg.ModelError, match=r"shafts\."):
        model_of(seated(stage_of((17, 22, 61), 3), **bolts, is_engaged=Value("false")), tmp_path)
