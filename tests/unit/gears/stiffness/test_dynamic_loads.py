"""K_v against hand calculation and limits."""

from __future__ import annotations

import math
from typing import Any

import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.stiffness.dynamic_factor import iso_dynamic_factor, reduced_mass, simple_dynamic_factor

deg = math.radians
MESH: dict[str, Any] = {
    "pinion_teeth": 20,
    "ratio": 3.0,
    "pinion_speed": 300.0,
    "pitch_line_velocity": 15.0,
    "total_contact_ratio": 1.6,
    "line_load": 4e5,
    "single_stiffness": 14e9,
    "mesh_stiffness": 20e9,
    "reduced_mass": 8.0,
    "base_pitch_deviation": 10e-6,
    "profile_deviation": 8e-6,
}


# The pinion's resonance speed in rad/s, and the speed over it.
RESONANCE = math.sqrt(20e9 / 8.0) / 20
N = 300.0 / RESONANCE


def test_method_b_below_resonance_is_the_sum_written_out_by_hand() -> None:
    b_p = 14e9 * 9.25e-6 / 4e5
    b_f = 14e9 * 7.4e-6 / 4e5
    found = iso_dynamic_factor(**MESH)
    assert found.resonance_ratio == pytest.approx(N, rel=1e-14)
    assert found.value == pytest.approx(1 + N * (0.32 * b_p + 0.34 * b_f + 0.23), rel=1e-14)


def test_running_in_takes_at_most_3_micrometres() -> None:
    rough = MESH | {"base_pitch_deviation": 100e-6, "profile_deviation": 8e-6}
    change = iso_dynamic_factor(**rough).value - iso_dynamic_factor(**MESH).value
    assert change == pytest.approx(N * 0.32 * 14e9 * (97e-6 - 9.25e-6) / 4e5, rel=1e-12)


@pytest.mark.parametrize("eps", [1.3, 1.9, 2.1, 3.0])
def test_between_resonance_and_supercritical_method_b_has_no_jump(eps: float) -> None:
    def value(ratio: float) -> float:
        speed = ratio * RESONANCE
        return iso_dynamic_factor(**MESH | {"pinion_speed": speed, "total_contact_ratio": eps}).value

    for joint in (1.15, 1.5):
        assert value(joint * (1 + 1e-9)) == pytest.approx(value(joint * (1 - 1e-9)), abs=1e-7)


def test_a_tip_relief_that_equals_the_give_of_the_teeth_takes_its_term_away() -> None:
    tuned = MESH | {"tip_relief": 4e5 / 14e9}
    lost = iso_dynamic_factor(**MESH).value - iso_dynamic_factor(**tuned).value
    assert lost == pytest.approx(0.23 * N, rel=1e-12)


def test_the_simple_form_gives_the_factors_that_a_study_of_two_herringbone_pairs_quotes() -> None:
    """1.22 and 1.19 at 2000 rpm and 2000 Nm, grade 6, K_A = 1.1, b = 50 mm, all of F_t on one helix."""
    for z1, z2, helix, printed in ((34, 80, 20.86, 1.22), (30, 72, 33.27, 1.19)):
        diameter = z1 * 5e-3 / math.cos(deg(helix))
        velocity = 0.5 * diameter * 2000 * math.pi / 30
        found = simple_dynamic_factor(velocity, z1, z2 / z1, 1.1 * 2 * 2000 / diameter / 0.05, 1.2, 6)
        assert round(found.value, 2) == printed


@pytest.mark.parametrize(
    ("grade", "spur", "helical"), [(3, 2.1, 1.9), (6, 14.9, 13.3), (9, 52.8, 47.0), (12, 146.3, 130.3)]
)
def test_the_simple_form_has_the_constants_of_its_table_and_is_straight_between_spur_and_helical(
    grade: int, spur: float, helical: float
) -> None:
    """K_v = 1 + (K1 / (F_t K_A / b) + K2) v z1/100 sqrt(u^2 / (1 + u^2)), DIN 3990-1, table 3."""
    speed = 8.0 * 25 / 100.0 * 2.0 / math.sqrt(5.0)

    def found(overlap: float, line_load: float = 3e5) -> float:
        return simple_dynamic_factor(8.0, 25, 2.0, line_load, overlap, grade).value

    assert found(0.0) == pytest.approx(1.0 + (spur / 300.0 + 0.0193) * speed, rel=1e-12)
    assert found(1.0) == found(1.7) == pytest.approx(1.0 + (helical / 300.0 + 0.0087) * speed, rel=1e-12)
    assert found(0.25) == pytest.approx(0.75 * found(0.0) + 0.25 * found(1.0), rel=1e-12)
    # Light loads count as 100 N/mm.
    assert found(0.0, 2e4) == found(0.0, 1e5) > found(0.0)


def test_two_equal_disks_have_half_the_mass_of_one_at_the_base_circle() -> None:
    assert reduced_mass((0.02, 0.02), (0.1, 0.1), 0.05) == pytest.approx(0.02 / 0.1**2 / 2 / 0.05, rel=1e-14)


def test_no_load_and_a_contact_ratio_of_1_are_refused() -> None:
    with pytest.raises(AnalysisError, match="needs a load"):
        iso_dynamic_factor(**MESH | {"line_load": 0.0})
    with pytest.raises(AnalysisError, match="total contact ratio above 1"):
        iso_dynamic_factor(**MESH | {"total_contact_ratio": 1.0})
    with pytest.raises(AnalysisError, match="grades 3 to 12, not 2"):
        simple_dynamic_factor(10.0, 20, 3.0, 1e5, 1.0, 2)
