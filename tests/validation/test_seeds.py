"""The five published systems: exact rows, the chosen sets, and the misprinted equations, each shown to fail."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.elements.gear_mesh import ContactGeometry, contact_vector
from validation.seeds import corner, marine, motions, pair12, pair16, pair24, settling
from validation.seeds.rows import MODELS, SYSTEMS, VERDICTS, entries, loaded, rows


@pytest.mark.parametrize("system", SYSTEMS)
def test_every_row_has_a_verdict_and_what_is_not_given_or_exact_a_reason(system: str) -> None:
    for line in entries(system):
        assert line["what"]
        assert line["verdict"] in VERDICTS, line
        assert line["verdict"] in ("given", "exact") or line["reason"], line


@pytest.mark.parametrize("system", SYSTEMS)
def test_given_and_exact_rows_give_the_printed_number(system: str) -> None:
    found = rows(system, quick=True)
    assert len(found) > 15
    compared = [row for row in found if isinstance(row.computed, float) and row.printed[:1] in tuple("0123456789+-")]
    assert len(compared) > 10
    assert [row for row in compared if row.printed and not row.agrees] == []


@pytest.mark.parametrize(
    ("file", "dofs", "rigid"),
    [
        ("marine_dual_turbine", 7, 1),
        ("herringbone_pair_24dof", 24, 0),
        ("herringbone_pair_24dof_set2", 24, 0),
        ("herringbone_pair_12dof", 12, 3),
        ("herringbone_pair_16dof", 16, 0),
        ("herringbone_pair_16dof_b", 16, 0),
    ],
)
def test_the_lumped_models_have_their_degrees_of_freedom_and_rigid_motions(file: str, dofs: int, rigid: int) -> None:
    result = rg.modal(loaded(file), modes=6)
    assert (result.dofs, int(result.rigid.sum())) == (dofs, rigid)


def test_all_bodies_of_the_marine_train_turn_together_in_its_rigid_mode() -> None:
    result = rg.modal(loaded("marine_dual_turbine"))
    turns = dict(zip(result.nodes.shaft, np.abs(result.shapes[:, 5, 0]), strict=True))
    expected = {"hp": 3.2, "lp": 3.2, "wheel_hp": 1, "wheel_lp": 1, "second_hp": 1, "second_lp": 1, "bull": 0.3}
    for name, value in expected.items():
        assert turns[name] / turns["wheel_hp"] == pytest.approx(value, rel=1e-9)


def test_check_shows_a_given_damping_whatever_the_direction_of_the_line_of_action() -> None:
    meshes = {row["name"]: row for row in rg.check(loaded("marine_dual_turbine")).to_dict()["meshes"]}
    assert meshes["first_lp"]["damping_n_s_per_m"] == pytest.approx(143457.3)


@pytest.mark.long  # three sweeps with exponents
def test_the_three_regions_of_the_marine_train() -> None:
    ratios = (0.3, 0.6, 1.0)
    found = dict(zip(ratios, marine.contact(ratios), strict=True))
    assert found[0.6].exponent > 0.05 + 3.0 * found[0.6].exponent_error
    assert max(abs(found[gamma].exponent) for gamma in (0.3, 1.0)) < 0.02
    back = [found[gamma].back for gamma in ratios]
    assert back[0] > 0.5 > back[1] > 0.1 > back[2]
    for gamma in (0.6, 1.0):
        # While contact is lost at times, the mean force can't exceed the largest one times the share in contact.
        run = found[gamma]
        amplitude = run.peak_to_peak / (run.net_torque / marine.PITCH_RADIUS / marine.STIFFNESS)
        assert run.apart > 0.0
        assert amplitude * (1.0 + 0.12) * (1.0 - run.back - run.apart) >= 1.0


@pytest.mark.long  # a sweep over the torque
def test_the_file_of_the_marine_train_gives_the_impact_time_ratio_over_the_torque_as_it_is() -> None:
    over = {"loads.lp.torque": [30e3 * gamma / (1.0 + gamma) for gamma in (0.3, 0.6, 1.0)]}
    found = rg.sweep(loaded(marine.MODEL), over, steps=marine.STEPS, discard=400, sample=200)
    back = found.back[:, 0, found.contact.index("first_lp")]
    assert back[0] > 0.5 > back[1] > 0.1 > back[2]


def test_the_branch_below_its_drag_carries_on_the_other_flanks() -> None:
    sheet = rg.check(marine.operating(0.3)).to_dict()
    torques = {row["name"]: row["torque_n_m"] for row in sheet["torques"]}
    assert torques["loads.lp"] + torques["loads.lp_drag"] == pytest.approx(-4276.923, rel=1e-6)


@pytest.mark.parametrize(("file", "factor", "mean"), [("a", 1.229, 12520.0), ("b", 1.181, 14189.0)])
def test_the_pairs_of_16_dofs_give_their_dynamic_factor(file: str, factor: float, mean: float) -> None:
    found = pair16.run(loaded(pair16.FILES[file]))
    assert found[0] == pytest.approx(factor, abs=2e-3)
    assert found[1] == pytest.approx(mean, rel=1e-3)


def test_a_pair_made_by_the_rules_is_that_of_the_file() -> None:
    made = pair16.pair((30, 72), 33.27, 0.054, 1920.0)
    given = loaded(pair16.FILES["b"])
    first = rg.modal(made, modes=16)
    second = rg.modal(given, modes=16)
    np.testing.assert_allclose(first.frequency_hz, second.frequency_hz, rtol=1e-4)


def test_the_pair_of_24_dofs_goes_from_one_period_over_two_to_chaos() -> None:
    found = pair24.route(pair24.MODEL, (5000.0, 5800.0, 5950.0), 250, 64)
    assert [found.motion_at(p) for p in range(3)] == ["1T", "2T", "chaotic"]


@pytest.mark.long  # a sweep that settles for long
def test_set_2_is_of_one_period_again_at_high_speed() -> None:
    found = pair24.route(pair24.SECOND, (8000.0, 9000.0, 20000.0, 35000.0), pair24.SETTLE_2, pair24.KEPT_2)
    assert [found.motion_at(p) == "1T" for p in range(4)] == [True, False, True, True]


@pytest.mark.long  # two sweeps that settle for long
def test_load_closes_the_gap_and_damping_calms() -> None:
    assert pair24.trend(pair24.apart(torques=(300.0,))) == [("1T", 0)]
    assert pair24.trend(pair24.apart(damping=(4.0,)))[0][0] == "1T"


def test_transient_and_sweep_agree_on_a_motion_with_loss_of_contact() -> None:
    model = loaded(pair24.MODEL)
    period = 60.0 / (5800.0 * 22.0)
    sweep = pair24.route(pair24.MODEL, (5800.0,), 250, 64)
    run = rg.transient(
        model,
        speed=5800.0 * math.pi / 30.0,
        method="newmark",
        steps=640,
        discard=250 * period,
        time=64 * period,
        error_estimate=False,
    )
    assert run.contact_time[0, 1] == pytest.approx(sweep.apart[0, 0, 0], abs=0.01)
    assert run.mesh_force[run.counted, 0].max() == pytest.approx(sweep.largest_force[0, 0, 0], rel=0.02)


def test_nothing_depends_on_the_backlash_while_contact_is_kept() -> None:
    assert pair12.backlash_effect() < 1e-12


def test_less_impact_and_ripple_shake_less() -> None:
    first, second, third = (
        pair12.vibration(pair12.at_ratio(pair12.TABLE[i][1], 1e3 * pair12.TABLE[i][3]))[0] for i in (0, 2, 4)
    )
    assert first > second > third


def test_an_impact_in_the_rows_of_rotation_shakes_the_pinion_hardly_along_its_axis() -> None:
    impact = 1e3 * pair12.TABLE[2][3]
    along = pair12.vibration(pair12.at_ratio(3.30, impact))
    rotation = pair12.vibration(pair12.in_rotation_rows(3.30, impact))
    assert 0.02 < rotation[1] / rotation[0] < 0.08 < 1.0 < along[1] / along[0]


def test_a_tip_corner_meets_early_with_the_root_of_the_gap_and_on_the_line_without_one() -> None:
    first, second, mesh = pair12.geometry(0.25)
    slow, fast = (corner.corner_contact(first, second, mesh, 209.0, gap) for gap in (1e-7, 4e-7))
    assert fast.velocity / slow.velocity == pytest.approx(2.0, rel=0.01)
    assert fast.angle / slow.angle == pytest.approx(2.0, rel=0.03)
    assert slow.arm == pytest.approx(second.base_radius, rel=0.01)


def test_numbers_of_chaos_stand_with_students_interval_and_one_digit_of_it() -> None:
    assert motions.stated(0.2071, 0.0123) == "0.21 +- 0.02"
    values = np.array([0.19, 0.20, 0.21, 0.20])
    # 9.22 x 0.00816/2
    assert motions.number(values, ["chaotic"] * 4, 3) == "0.20 +- 0.04"
    assert motions.number(np.array([1.5, 9.0, 1.5]), ["2T", "chaotic", "2T"], 2) == "1.50"
    assert motions.ends(["2T", "chaotic", "2T"]) == "2T 2 of 3, chaotic 1"


def test_what_changes_after_longer_settling_is_told() -> None:
    first = {"a": "0.20 +- 0.02", "b": "1T", "c": "not settled", "d": "1.50", "e": "0.20 +- 0.02", "f": motions.SO_FAR}
    later = {"a": "0.22 +- 0.01", "b": "2T", "c": "2T", "d": "1.51", "e": "0.30 +- 0.02", "f": "1T"}
    assert [line[0] for line in settling.changes(first, later)] == ["b", "e"]


@pytest.mark.long
@pytest.mark.parametrize("name", settling.NAMES)
def test_no_label_changes_when_settling_is_ten_times_as_long(name: str) -> None:
    assert list(settling.changes(settling.labels(name, 1), settling.labels(name, settling.times_of(name)))) == []


# --- misprints ---


def test_the_printed_equations_of_the_marine_train_have_no_equilibrium() -> None:
    rp1 = 0.075
    rg1 = 0.24
    rp2 = 0.09
    rg2 = 0.3
    torques = np.array([15e3, 15e3, 0.0, 0.0, 0.0, 0.0, -320e3])
    # Columns: forces of both first and both second meshes; rows: bodies.
    printed = np.array(
        [[-rp1, 0, 0, 0], [0, -rp1, 0, 0], [rp1, 0, -rp2, 0], [0, rg1, 0, -rp2], [0, 0, rp2, 0], [0, 0, 0, rp2],
         [0, 0, rg2, 0]]
    )  # fmt: skip
    assert np.linalg.matrix_rank(np.column_stack([printed, torques])) > np.linalg.matrix_rank(printed)
    # Corrected: two more unknowns, the torques of the quill shafts.
    corrected = np.array(
        [[-rp1, 0, 0, 0, 0, 0], [0, -rp1, 0, 0, 0, 0], [rg1, 0, 0, 0, -1, 0], [0, rg1, 0, 0, 0, -1],
         [0, 0, -rp2, 0, 1, 0], [0, 0, 0, -rp2, 0, 1], [0, 0, rg2, rg2, 0, 0]]
    )  # fmt: skip
    forces, residual, _, _ = np.linalg.lstsq(corrected, -torques, rcond=None)
    assert residual.size == 0 or residual[0] < 1e-12
    assert corrected @ forces == pytest.approx(-torques, abs=1e-6)


def test_the_printed_stiffness_of_the_marine_train_is_not_symmetric() -> None:
    moved = np.zeros(7)
    pushed = np.zeros(7)
    moved[[0, 3]] = 0.075, -0.24  # delta_1 joins bodies 1 and 4
    pushed[[0, 2]] = 0.075, -0.075  # its force acts on bodies 1 and 3
    printed = np.outer(pushed, moved)
    assert np.abs(printed - printed.T).max() > 0.1 * np.abs(printed).max()


def test_the_same_sign_on_both_gears_of_the_24_dof_pair_lets_it_fly_off() -> None:
    direction = np.array([math.sin(0.349), math.cos(0.349) * math.cos(0.384), math.cos(0.349) * math.sin(0.384)])
    printed = np.outer(np.concatenate([direction, direction]), np.concatenate([direction, -direction]))
    shared = np.tile(np.eye(3), 2)  # the total force on both gears
    assert np.abs(shared @ printed).max() > 0.5
    correct = np.outer(np.concatenate([direction, -direction]), np.concatenate([direction, -direction]))
    assert np.abs(shared @ correct).max() < 1e-15
    assert np.abs(printed - printed.T).max() > 0.5


def test_the_printed_arm_of_the_24_dof_pair_is_that_of_the_reference_radius() -> None:
    gear = pair16.geometry((22, 41), 22.0, 0.12)[0]
    arm = gear.base_radius * math.cos(gear.base_helix_angle)
    angles = math.cos(gear.normal_pressure_angle) * math.cos(gear.helix_angle)
    assert 0.5 * gear.reference_diameter * angles == pytest.approx(arm, rel=1e-12)
    assert gear.base_radius * angles == pytest.approx(0.931 * arm, rel=1e-3)


def test_the_printed_mesh_of_the_split_torque_gearbox_strains_in_a_rigid_tilt() -> None:
    angle = math.radians(28.3)
    helix = math.radians(30.0)
    first = 0.05
    second = 0.2
    distance = (first + second) / math.cos(angle)
    base_helix = math.asin(math.sin(helix) * math.cos(math.radians(25.0)))
    ours = contact_vector(ContactGeometry(1, 1, 0.0, angle, base_helix, first, second, 0.0, 0.0, 0.0))
    # Both gears turn by one rad about the pinion's x or y axis; about y the gear's centre sinks by the centre distance.
    for tilt in ("x", "y"):
        moved = np.zeros(12)
        moved[[3, 9] if tilt == "x" else [4, 10]] = 1.0
        moved[8] = -distance if tilt == "y" else 0.0
        arms = (first + second) * (math.sin(angle) if tilt == "x" else math.cos(angle))
        printed = (arms + moved[8] - moved[2]) * math.sin(helix)
        assert abs(printed) > 0.02
        assert abs(ours @ moved) < 1e-15


def test_the_impact_force_balances_the_energy_of_compliances_only() -> None:
    energy = 0.5
    hit = 2e-9
    carrying = 5e-10
    angle = 0.1
    force = math.sqrt(2.0 * energy / (hit + carrying * math.cos(angle) ** 2))
    given = [(hit * force, hit), (carrying * math.cos(angle) * force, carrying)]
    assert sum(0.5 * d**2 / q for d, q in given) == pytest.approx(energy, rel=1e-12)
    assert sum(0.5 * q * d**2 for d, q in given) < 1e-9 * energy


def test_the_printed_axial_rows_of_the_16_dof_pair_are_not_symmetric() -> None:
    helix = math.radians(20.86)
    angle = math.radians(21.28)
    radius = 0.085
    plane = math.cos(helix) * np.array([math.sin(angle), math.cos(angle), radius])
    relative = np.array([plane[0], plane[1], -math.sin(helix), plane[2]])  # x y z theta in lambda
    pushed = np.array([plane[0], plane[1], math.sin(helix), plane[2]])  # as printed in the rows
    printed = np.outer(pushed, relative)
    assert np.abs(printed - printed.T).max() > 0.3
    assert relative[[0, 1, 3]] == pytest.approx(pushed[[0, 1, 3]])


def test_the_models_name_what_they_assume() -> None:
    for name in (marine.MODEL, pair24.MODEL, pair24.SECOND, pair12.MODEL, *pair16.FILES.values()):
        text = Path(MODELS / f"{name}.toml").read_text(encoding="utf-8")
        assert "ASSUMED" in text
        assert "Given by the source" in text
