"""K_v, corner impact and friction laws against hand calculation, kinematics and limits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.geometry.pair import pair_geometry
from rotorgear.gears.loaded.friction import (
    benedict_kelley_friction,
    mean_mesh_friction,
    saturating_friction,
    xu_kahraman_friction,
)
from rotorgear.gears.loaded.impact import corner_contact, corner_gap, corner_impact_force, impulse_force
from rotorgear.gears.stiffness.dynamic_factor import (
    DynamicMesh,
    iso_dynamic_factor,
    reduced_mass,
    simple_dynamic_factor,
)
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair

deg = math.radians
MESH = DynamicMesh(
    pinion_teeth=20,
    ratio=3.0,
    pinion_speed=300.0,
    pitch_line_velocity=15.0,
    total_contact_ratio=1.6,
    line_load=4e5,
    single_stiffness=14e9,
    mesh_stiffness=20e9,
    reduced_mass=8.0,
    base_pitch_deviation=10e-6,
    profile_deviation=8e-6,
)


def test_method_b_below_resonance_is_the_sum_written_out_by_hand() -> None:
    n = 300.0 / (math.sqrt(20e9 / 8.0) / 20)
    b_p = 14e9 * 9.25e-6 / 4e5
    b_f = 14e9 * 7.4e-6 / 4e5
    found = iso_dynamic_factor(MESH)
    assert found.resonance_ratio == pytest.approx(n, rel=1e-14)
    assert found.value == pytest.approx(1 + n * (0.32 * b_p + 0.34 * b_f + 0.23), rel=1e-14)
    assert found.speed_range == "subcritical"


def test_running_in_takes_at_most_3_micrometres() -> None:
    rough = replace(MESH, base_pitch_deviation=100e-6, profile_deviation=8e-6)
    change = iso_dynamic_factor(rough).value - iso_dynamic_factor(MESH).value
    assert change == pytest.approx(MESH.resonance_ratio * 0.32 * 14e9 * (97e-6 - 9.25e-6) / 4e5, rel=1e-12)


@pytest.mark.parametrize("eps", [1.3, 1.9, 2.1, 3.0])
def test_between_resonance_and_supercritical_method_b_has_no_jump(eps: float) -> None:
    def value(ratio: float) -> float:
        speed = ratio * MESH.resonance_speed
        return iso_dynamic_factor(replace(MESH, pinion_speed=speed, total_contact_ratio=eps)).value

    for joint in (1.15, 1.5):
        assert value(joint * (1 + 1e-9)) == pytest.approx(value(joint * (1 - 1e-9)), abs=1e-7)


def test_a_tip_relief_that_equals_the_give_of_the_teeth_takes_its_term_away() -> None:
    tuned = replace(MESH, tip_relief=4e5 / 14e9)
    lost = iso_dynamic_factor(MESH).value - iso_dynamic_factor(tuned).value
    assert lost == pytest.approx(0.23 * MESH.resonance_ratio, rel=1e-12)


def test_the_simple_form_gives_the_factors_that_a_study_of_two_herringbone_pairs_quotes() -> None:
    """1.22 and 1.19 at 2000 rpm and 2000 Nm, grade 6, K_A = 1.1, b = 50 mm, all of F_t on one helix."""
    for z1, z2, helix, printed in ((34, 80, 20.86, 1.22), (30, 72, 33.27, 1.19)):
        diameter = z1 * 5e-3 / math.cos(deg(helix))
        velocity = 0.5 * diameter * 2000 * math.pi / 30
        found = simple_dynamic_factor(velocity, z1, z2 / z1, 1.1 * 2 * 2000 / diameter / 0.05, 1.2, 6)
        assert round(found.value, 2) == printed


def test_two_equal_disks_have_half_the_mass_of_one_at_the_base_circle() -> None:
    assert reduced_mass(0.02, 0.02, 0.1, 0.1, 0.05) == pytest.approx(0.02 / 0.1**2 / 2 / 0.05, rel=1e-14)


def test_no_load_and_a_contact_ratio_of_1_are_refused() -> None:
    with pytest.raises(AnalysisError, match="needs a load"):
        iso_dynamic_factor(replace(MESH, line_load=0.0))
    with pytest.raises(AnalysisError, match="total contact ratio above 1"):
        iso_dynamic_factor(replace(MESH, total_contact_ratio=1.0))
    with pytest.raises(AnalysisError, match="grades 3 to 12, not 2"):
        simple_dynamic_factor(10.0, 20, 3.0, 1e5, 1.0, 2)


def spur() -> ToothPair:
    g1 = GearGeometry(34, 5e-3, deg(20), 0.0)
    g2 = GearGeometry(80, 5e-3, deg(20), 0.0)
    return ToothPair(g1, g2, pair_geometry(g1, g2, 0.054), 0.054)


def test_the_tip_corner_lies_on_the_flank_that_rolled_back_by_the_gap() -> None:
    """Both gears turned by hand to a position before A: how far the driver's flank must turn to reach the corner."""
    teeth = spur()
    advance = 2e-3
    g1 = teeth.first
    g2 = teeth.second
    distance = teeth.pair.centre_distance
    angle = teeth.pair.working_transverse_pressure_angle
    start = teeth.pair.start_of_contact
    pitch = g1.base_radius / math.cos(angle)
    a = np.array([pitch + start * math.sin(angle), start * math.cos(angle)])
    back = advance / g2.base_radius  # the driven gear turns clockwise; earlier it was turned the other way
    rotate = np.array([[math.cos(back), -math.sin(back)], [math.sin(back), math.cos(back)]])
    corner = rotate @ (a - [distance, 0.0]) + [distance, 0.0]
    outline = tooth_outline(g1)
    roll = np.linspace(0.0, 0.06, 400001)
    radius, half = outline.involute(roll)
    at_a = float(outline.involute(math.sqrt(float(a @ a) - g1.base_radius**2))[1])
    turned = math.atan2(a[1], a[0]) - at_a - advance / g1.base_radius  # middle of the driver's tooth
    flank = float(np.interp(np.linalg.norm(corner), radius, half)) + turned
    gap = g1.base_radius * (math.atan2(corner[1], corner[0]) - flank)
    assert corner_gap(teeth, advance) == pytest.approx(gap, abs=1e-12)


def test_without_separation_the_corner_touches_at_a_without_a_blow() -> None:
    contact = corner_contact(spur(), 0.0)
    assert contact.advance == 0.0
    assert contact.base_radius == pytest.approx(spur().second.base_radius, rel=1e-12)
    assert contact.approach == pytest.approx(0.0, abs=1e-12)


def test_the_approach_velocity_is_how_fast_the_gap_closes() -> None:
    teeth = spur()
    contact = corner_contact(teeth, 20e-6)
    step = 1e-7
    closing = (corner_gap(teeth, contact.advance + step) - corner_gap(teeth, contact.advance - step)) / (2 * step)
    assert contact.approach == pytest.approx(
        closing, rel=1e-2
    )  # the gap is an arc of base circle 1, v_s along the normal


def test_the_impact_force_is_the_energy_of_the_reduced_mass_in_the_springs() -> None:
    teeth = spur()
    contact = corner_contact(spur(), 20e-6)
    given = {"driver_speed": 200.0, "driver_inertia": 0.05, "driven_inertia": 1.3, "hit_compliance": 1e-9}
    force = corner_impact_force(teeth, 20e-6, **given, carrying_compliance=0.0)
    mass = 1 / (teeth.first.base_radius**2 / 0.05 + contact.base_radius**2 / 1.3)
    velocity = 200.0 * teeth.first.base_radius * contact.approach
    assert 0.5 * force**2 * 1e-9 == pytest.approx(0.5 * mass * velocity**2, rel=1e-12)
    assert corner_impact_force(teeth, 20e-6, **given, carrying_compliance=1e-9) < force
    assert impulse_force(mass, velocity, 1e-4) == pytest.approx(mass * velocity / 1e-4, rel=1e-14)


def test_a_separation_of_millimetres_and_a_lacking_mass_are_refused() -> None:
    with pytest.raises(AnalysisError, match="more than a base pitch too early"):
        corner_contact(spur(), 0.02)
    with pytest.raises(AnalysisError, match="driven inertia of a corner impact must be positive"):
        corner_impact_force(
            spur(),
            1e-5,
            driver_speed=1.0,
            driver_inertia=1.0,
            driven_inertia=0.0,
            hit_compliance=1e-9,
            carrying_compliance=0.0,
        )


def test_friction_grows_and_falls_as_the_regressions_say() -> None:
    base = {"line_load": 5e5, "viscosity": 0.02, "sliding_velocity": 2.0, "rolling_velocity": 10.0}
    mu = benedict_kelley_friction(**base)
    assert mu == pytest.approx(0.0127 * math.log10(29.66 * 5e5 / (20.0 * 2.0 * 100.0)), rel=1e-12)
    assert benedict_kelley_friction(**{**base, "line_load": 1e6}) - mu == pytest.approx(
        0.0127 * math.log10(2), rel=1e-9
    )
    assert benedict_kelley_friction(**{**base, "rolling_velocity": 1e4}) == 0.0
    mean = mean_mesh_friction(5e5, 10.0, 0.01, 0.02)
    assert mean_mesh_friction(32 * 5e5, 10.0, 0.01, 0.02) == pytest.approx(2 * mean, rel=1e-12)
    assert mean == pytest.approx(0.045 * (500 / 100) ** 0.2 * 20**-0.05, rel=1e-12)


def test_ehl_friction_vanishes_in_pure_rolling_and_has_the_usual_size() -> None:
    at = {
        "hertz_pressure": 1e9,
        "viscosity": 0.02,
        "entraining_velocity": 8.0,
        "curvature_radius": 0.01,
        "roughness": 0.3e-6,
    }
    assert xu_kahraman_friction(0.0, **at) == 0.0
    assert 0.01 < xu_kahraman_friction(0.3, **at) < 0.08
    assert xu_kahraman_friction(-0.3, **at) == xu_kahraman_friction(0.3, **at)
    f = (
        -8.916465
        - 0.354068 * 0.3 * math.log10(20)
        + 2.812084 * math.exp(-0.3 * math.log10(20))
        + 0.620305 * math.exp(0.3)
    )
    expected = math.exp(f) * 0.3**1.036077 * 8**-0.100601 * 20**0.752755 * 0.01**-0.390958
    assert xu_kahraman_friction(0.3, **at) == pytest.approx(expected, rel=1e-12)


def test_saturating_friction_is_odd_and_bounded() -> None:
    assert saturating_friction(0.0, 0.06, 20.0) == 0.0
    assert saturating_friction(-0.5, 0.06, 20.0) == -saturating_friction(0.5, 0.06, 20.0)
    assert saturating_friction(1e3, 0.06, 20.0) == pytest.approx(0.06, rel=1e-12)
