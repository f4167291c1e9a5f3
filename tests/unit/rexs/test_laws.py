"""Laws of an import: places that lead back, sizes written in other ways, bodies and stubs by their closed forms."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.rexs.document import Document, Value
from rotorgear.rexs.read import read_document
from tests.paths import ROOT
from tests.unit.rexs.documents import changed, write_json
from tests.unit.rexs.written import MM, Written

TEETH = (23, 47)
MODULE = 2e-3
NORMAL = math.radians(20.0)


def imported(document: Document, tmp_path: Path) -> rg.RexsImport:
    return rg.import_rexs(write_json(document, tmp_path / "gearbox.rexsj"))


def model_of(document: Document, tmp_path: Path) -> rg.Model:
    return rg.loads(imported(document, tmp_path).toml)


def involute(angle: float) -> float:
    return math.tan(angle) - angle


def shift_sum(distance: float, helix: float = 0.0, module: float = MODULE) -> float:
    """x_1 + x_2 of the pair at a centre distance in m: the root of its equation for the working angle."""
    transverse = math.atan(math.tan(NORMAL) / math.cos(helix))
    reference = 0.5 * sum(TEETH) * module / math.cos(helix)
    working = brentq(lambda a: distance * math.cos(a) - reference * math.cos(transverse), 0.1, 0.8)
    return sum(TEETH) * (involute(working) - involute(transverse)) / (2.0 * math.tan(NORMAL))


class Pair(Written):
    """Two shafts with a gear each, at rotating_angle 37 deg of their stage from w; numbers in mm."""

    def __init__(self, distance: float = 70.0, degrees: float = 37.0, u: tuple[float, float] = (50.0, 50.0)) -> None:
        super().__init__()
        phi = math.radians(degrees)
        self.places = ((12.0, -7.0), (12.0 + distance * math.sin(phi), -7.0 + distance * math.cos(phi)))
        self.shafts = [self.shaft(f"shaft {k}", *place) for k, place in enumerate(self.places)]
        self.gears = [
            self.gear(f"gear {k}", shaft, z, u=at)
            for k, (shaft, z, at) in enumerate(zip(self.shafts, TEETH, u, strict=True))
        ]
        self.mesh("stage", *self.gears)
        self.stage = str(len(self.components))
        self.set(
            self.stage, center_distance=Value(distance, MM), rotating_angle_around_neg_u_axis=Value(degrees, "deg")
        )

    def set(self, number: str, **attributes: Value | None) -> None:
        """Set attributes of a component, or take them away."""
        self.components = dict(changed(self.document(), number, **attributes).components)


@pytest.mark.parametrize("first", [0, 1])
def test_a_stage_leads_from_either_of_its_shafts_to_the_other(first: int, tmp_path: Path) -> None:
    pair = Pair(u=(62.0, 45.0))
    pair.set(pair.shafts[1 - first], support_vector=None)
    shafts = list(model_of(pair.document(), tmp_path).shafts.values())
    for shaft, place in zip(shafts, pair.places, strict=True):
        assert 1e3 * np.array(shaft.position) == pytest.approx(np.array(place), abs=1e-9)
    # Faces stand beside each other: the gears are 17 mm apart along their shafts.
    assert shafts[first].start == pytest.approx(0.0, abs=1e-12)
    assert shafts[1 - first].start == pytest.approx((17e-3, -17e-3)[first], rel=1e-12)


def test_a_stage_without_an_angle_puts_its_second_shaft_along_x(tmp_path: Path) -> None:
    pair = Pair()
    pair.set(pair.shafts[1], support_vector=None)
    pair.set(pair.stage, rotating_angle_around_neg_u_axis=None)
    _, other = model_of(pair.document(), tmp_path).shafts.values()
    assert other.position == pytest.approx((82e-3, -7e-3), abs=1e-12)


def test_profile_shifts_as_lengths_and_what_is_left_for_the_axes(tmp_path: Path) -> None:
    """x m_n in mm of one gear; the other has what the closed form of ISO 21771 leaves."""
    pair = Pair(71.1)
    pair.set(pair.gears[0], addendum_modification=Value(0.62, MM))
    first, second = model_of(pair.document(), tmp_path).gears.values()
    assert first.profile_shift == pytest.approx(0.31, rel=1e-12)
    assert second.profile_shift == pytest.approx(shift_sum(71.1e-3) - 0.31, abs=2e-6)


def test_gears_without_any_shift_share_what_their_axes_need(tmp_path: Path) -> None:
    shifts = [gear.profile_shift for gear in model_of(Pair(71.1).document(), tmp_path).gears.values()]
    assert shifts == pytest.approx([0.5 * shift_sum(71.1e-3)] * 2, abs=2e-6)


@pytest.mark.parametrize(("off", "written"), [(0.03, False), (-0.03, False), (0.2, True), (-0.2, True)])
def test_shifts_that_miss_the_axes_are_mended_in_the_second_gear(off: float, written: bool, tmp_path: Path) -> None:
    pair = Pair(71.1)
    needed = shift_sum(71.1e-3)
    pair.set(pair.gears[0], profile_shift_coefficient=Value(0.17))
    pair.set(pair.gears[1], profile_shift_coefficient=Value(needed - 0.17 + off))
    result = imported(pair.document(), tmp_path)
    first, second = rg.loads(result.toml).gears.values()
    assert first.profile_shift == pytest.approx(0.17, rel=1e-12)
    assert second.profile_shift == pytest.approx(needed - 0.17 + (0.0 if written else off), abs=2e-6)
    assert any("do not fit their axes" in note for note in result.warnings) == written


@pytest.mark.parametrize("off", [0.45, -0.45])
def test_shifts_far_from_their_axes_are_refused(off: float, tmp_path: Path) -> None:
    pair = Pair(71.1)
    for gear, shift in zip(pair.gears, (0.17, shift_sum(71.1e-3) - 0.17 + off), strict=True):
        pair.set(gear, profile_shift_coefficient=Value(shift))
    with pytest.raises(rg.ModelError, match=r"its axes need 0\.5"):
        imported(pair.document(), tmp_path)


def test_a_transverse_module_is_the_normal_one_over_the_cosine_of_the_helix_angle(tmp_path: Path) -> None:
    helix = math.radians(17.0)
    pair = Pair(0.5e3 * sum(TEETH) * MODULE / math.cos(helix))
    for gear, sign in zip(pair.gears, (1.0, -1.0), strict=True):
        transverse = Value(1e3 * MODULE / math.cos(helix), MM)
        pair.set(gear, normal_module=None, transverse_module=transverse, helix_angle=Value(sign * 17.0, "deg"))
    first, second = model_of(pair.document(), tmp_path).gears.values()
    assert (first.normal_module, second.normal_module) == pytest.approx((MODULE, MODULE), rel=1e-12)
    assert (first.hand, second.hand) == ("right", "left")
    assert first.profile_shift == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("differ", "noted"), [(0.0, False), (0.02, True)])
def test_of_flanks_that_differ_the_first_counts_and_that_is_said(differ: float, noted: bool, tmp_path: Path) -> None:
    pair = Pair(71.1)
    for k, shift in enumerate((0.31, 0.31 + differ)):
        flank = pair.add("cylindrical_gear_flank", f"flank {k}", profile_shift_coefficient=Value(shift))
        pair.join("flank", gear=pair.gears[0], **{("left", "right")[k]: flank})
    result = imported(pair.document(), tmp_path)
    first, _ = rg.loads(result.toml).gears.values()
    assert first.profile_shift == pytest.approx(0.31, rel=1e-12)
    assert any("flank of" in item.reason and "differ" in item.reason for item in result.assumptions) == noted


@pytest.mark.parametrize(("place", "said"), [(52.0, False), (57.0, False), (55.0, True)])
def test_the_support_vector_of_a_gear_is_the_middle_of_its_face(place: float, said: bool, tmp_path: Path) -> None:
    """A face 10 mm wide, u = 52 mm of its begin or of its middle."""
    pair = Pair()
    pair.set(pair.gears[0], support_vector=Value([place, *pair.places[0]], MM), u_coordinate_on_shaft=Value(52.0, MM))
    result = imported(pair.document(), tmp_path)
    gear = next(iter(rg.loads(result.toml).gears.values()))
    assert gear.at == pytest.approx(1e-3 * place, rel=1e-9)
    assert any(item.address.endswith(".at") for item in result.assumptions) == said


def test_sections_of_a_shaft_may_be_cones_with_bores_in_any_order_and_gaps_go_on_as_before(tmp_path: Path) -> None:
    pair = Pair()
    number = pair.shaft("coned", 300.0)
    cone = pair.add(
        "shaft_section",
        "cone",
        u_coordinate_on_shaft=Value(130.0, MM),
        length=Value(40.0, MM),
        outer_diameter_begin=Value(50.0, MM),
        outer_diameter_end=Value(34.0, MM),
        inner_diameter_begin=Value(12.0, MM),
        inner_diameter_end=Value(20.0, MM),
    )
    pair.join("assembly", assembly=number, part=cone)
    for u in (10.0, 90.0):
        pair.bearing(f"coned {u:g}", number, pair.casing, u)
    forward = model_of(pair.document(), tmp_path)
    sections = next(shaft.sections for name, shaft in forward.shafts.items() if name == "coned")
    # 100 mm of 30 mm, a gap of 30 mm that goes on with them, and the cone.
    assert [1e3 * part.length for part in sections] == pytest.approx([100.0, 30.0, 40.0])
    assert [1e3 * part.outer_diameter for part in sections] == pytest.approx([30.0, 30.0, 50.0])
    assert 1e3 * sections[2].outer_diameter_end == pytest.approx(34.0)
    assert (1e3 * sections[2].bore, 1e3 * sections[2].bore_end) == pytest.approx((12.0, 20.0))
    # The same with u against z: from left to right the cone comes first, with its ends exchanged.
    pair.set(number, u_axis_vector=Value([-1.0, 0.0, 0.0], MM), support_vector=Value([170.0, 300.0, 0.0], MM))
    turned = next(
        shaft.sections for name, shaft in model_of(pair.document(), tmp_path).shafts.items() if name == "coned"
    )
    assert [1e3 * part.length for part in turned] == pytest.approx([40.0, 30.0, 100.0])
    assert (1e3 * turned[0].outer_diameter, 1e3 * turned[0].outer_diameter_end) == pytest.approx((34.0, 50.0))
    assert (1e3 * turned[0].bore, 1e3 * turned[0].bore_end) == pytest.approx((20.0, 12.0))


def test_a_coupling_without_numbers_is_a_steel_stub_as_long_as_thick(tmp_path: Path) -> None:
    """E A/l, 12 E I/l^3, E I/l and G I_p/l with l = d of the thinner shaft."""
    pair = Pair()
    other = pair.shaft("other", *pair.places[0], d=44.0)
    pair.set(other, support_vector=Value([100.0, *pair.places[0]], MM))
    joint = pair.add(
        "coupling",
        "joint",
        u_coordinate_on_shaft_inner_side=Value(100.0, MM),
        u_coordinate_on_shaft_outer_side=Value(0.0, MM),
        axial_stiffness=Value(3e7, "N / m"),
    )
    pair.join("side", assembly=joint, inner_part=pair.shafts[0], outer_part=other)
    (coupling,) = model_of(pair.document(), tmp_path).couplings.values()
    assert (coupling.from_at, coupling.to_at) == pytest.approx((0.1, 0.1))
    d = 30e-3
    area, second = math.pi * d**2 / 4.0, math.pi * d**4 / 64.0
    E, G = 206e9, 79e9
    K = np.array(coupling.stiffness.as_rows())
    assert np.diag(K)[[0, 2, 3, 5]] == pytest.approx(
        [12.0 * E * second / d**3, 3e7, E * second / d, G * 2.0 * second / d], rel=2e-4
    )
    assert E * area / d == pytest.approx(206e9 * math.pi * d / 4.0)


def test_the_power_of_a_load_means_its_torque_at_the_speed_of_its_own_shaft(tmp_path: Path) -> None:
    pair = Pair()
    for shaft in pair.shafts:
        for u in (10.0, 90.0):
            pair.bearing(f"{shaft} {u:g}", shaft, pair.casing, u)
    pair.set(pair.shafts[0], rotational_speed=Value(1400.0, "1 / min"))
    for shaft, u, attributes in (
        (pair.shafts[0], 0.0, {"transmits_torque": Value("true")}),
        (pair.shafts[1], 100.0, {"transmits_torque": Value("true"), "power": Value(-9.0, "kW")}),
    ):
        load = pair.add("external_load", f"load of {shaft}", u_coordinate_on_shaft=Value(u, MM), **attributes)
        pair.join("assembly", assembly=shaft, part=load)
    said = rg.check(model_of(pair.document(), tmp_path))
    speed = 1400.0 * math.pi / 30.0 * TEETH[0] / TEETH[1]
    by_shaft = {row.shaft: row.torque_n_m for row in said.torques}
    assert abs(by_shaft["shaft_1"]) == pytest.approx(9000.0 / speed, rel=1e-9)
    assert abs(by_shaft["shaft_0"]) == pytest.approx(9000.0 / speed * TEETH[0] / TEETH[1], rel=1e-9)
    assert [row.shaft for row in said.torques if (row.power_w or 0.0) > 0.0] == ["shaft_0"]


PLANETARY = ROOT / "tests" / "rexs_files" / "planetary_1.4.rexs"


def test_a_body_of_coned_pins_has_the_mass_of_its_sections(tmp_path: Path) -> None:
    """Four pins of 98 mm, each a cone from 32 to 24 mm with a bore that grows from 6 to 14 mm."""
    whole = read_document(PLANETARY)
    pins = [one.refs[1][1] for one in whole.relations if one.type == "planet_pin"]
    sections = [
        one.refs[1][1]
        for one in whole.relations
        if one.type == "assembly"
        and one.refs[0][1] in pins
        and whole.components[one.refs[1][1]].type == "shaft_section"
    ]
    assert len(sections) == 4
    for number in sections:
        whole = changed(
            whole,
            number,
            outer_diameter_end=Value(24.0, MM),
            inner_diameter_begin=Value(6.0, MM),
            inner_diameter_end=Value(14.0, MM),
        )
    length, r = 0.098, 0.0641

    def area(s: float) -> float:
        return math.pi / 4.0 * ((0.032 - 0.008 * s) ** 2 - (0.006 + 0.008 * s) ** 2)

    m = 4 * 7850.0 * length * quad(area, 0.0, 1.0)[0]
    body = model_of(whole, tmp_path).disks["stage_pins"]
    assert (body.mass, body.polar_inertia, body.diametral_inertia) == pytest.approx(
        (m, m * r**2, m * (0.5 * r**2 + length**2 / 12.0)), rel=1e-5
    )


@pytest.mark.parametrize("turned", [False, True])
def test_forces_and_moments_of_a_load_turn_with_its_shaft(turned: bool, tmp_path: Path) -> None:
    """u and v run against z and x: components along it and along x change their signs, along y they stay."""
    pair = Pair()
    if turned:
        place = Value([100.0, *pair.places[0]], MM)
        pair.set(pair.shafts[0], u_axis_vector=Value([-1.0, 0.0, 0.0], MM), support_vector=place)
        pair.set(pair.gears[0], u_coordinate_on_shaft=Value(50.0, MM))
    load = pair.add(
        "external_load",
        "push",
        u_coordinate_on_shaft=Value(30.0, MM),
        force_u_direction=Value(90.0, "N"),
        force_v_direction=Value(-170.0, "N"),
        force_w_direction=Value(300.0, "N"),
        torque_around_v_axis=Value(2.5, "N m"),
        torque_around_w_axis=Value(-4.0, "N m"),
    )
    pair.join("assembly", assembly=pair.shafts[0], part=load)
    (found,) = (one for name, one in model_of(pair.document(), tmp_path).loads.items() if name.startswith("push"))
    assert found.at == pytest.approx(70e-3 if turned else 30e-3)
    sign = -1.0 if turned else 1.0
    assert found.force == pytest.approx((sign * -170.0, 300.0, sign * 90.0))
    assert found.moment == pytest.approx((sign * 2.5, -4.0, 0.0))


def test_components_that_are_not_read_are_counted_by_their_kind(tmp_path: Path) -> None:
    pair = Pair()
    for k in range(3):
        pair.add("lubricant_nozzle", f"nozzle {k}")
    pair.add("heat_exchanger", "cooler")
    left = imported(pair.document(), tmp_path).left_out
    assert "3 x lubricant_nozzle" in left
    assert "heat_exchanger" in left
