"""The five published systems: exact rows, the chosen sets, and the misprinted equations, each shown to fail."""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from validation.seeds import corner, kept, marine, misprints, motions, pair12, pair16, pair24, rules, settling
from validation.seeds.models import MODELS, loaded
from validation.seeds.rows import SYSTEMS, Row, counts, entries, known, rows
from validation.seeds.rules import VERDICTS

VERDICT_OF = {
    "input": "given",
    "follows": "exact",
    "within": "assumed",
    "outside": "not reproducible",
    "shown": "shown",
}


@pytest.mark.parametrize("system", SYSTEMS)
def test_every_row_has_a_rule_and_no_verdict_is_written_by_hand(system: str) -> None:
    lines = entries(system)
    assert len({tuple(line.values()) for line in lines}) == len(lines)
    for line in lines:
        assert set(line) == {"where", "what", "printed", "unit", "key", "rule", "reason", "runs"}, line
        assert line["what"], line
        assert line["rule"], line
        assert "not tried" not in line["reason"], line
        words = [test.partition(" if ")[0].split(" ")[0] for test in rules.tests(line["rule"])]
        assert all(word in VERDICT_OF or word in {v.split(" ")[0] for v in VERDICTS} for word in words), line
        # What is only shown is not printed; what is printed is judged.
        assert (line["rule"] == "shown") <= (line["printed"] == ""), line
        if line["rule"] != "shown":
            assert line["key"] or rules.used(line["rule"]), line


@pytest.mark.parametrize("system", SYSTEMS)
def test_the_verdicts_follow_from_values_that_are_kept_or_computed_now(system: str) -> None:
    names = known(system)
    for line, row in zip(entries(system), rows(system), strict=True):
        assert row.verdict in VERDICTS, row
        assert rules.used(line["rule"]) <= set(names), line
        assert line["rule"].startswith(("input", "given")) == (row.verdict == "given"), row


@pytest.mark.parametrize("system", SYSTEMS)
def test_not_reproducible_rests_on_a_trial_and_inconsistent_on_the_account_alone(system: str) -> None:
    """A trial is a value of a run or the end of a swept assumption; an inconsistency follows from given data without a run."""
    at_once = set().union(*(import_module(f"validation.seeds.{name}").quick() for name in SYSTEMS[system]))
    for line, row in zip(entries(system), rows(system), strict=True):
        (deciding,) = [test for test in rules.tests(line["rule"]) if _gives(test, row.verdict)] or [""]
        names = rules.used(deciding) or {line["key"]}
        if row.verdict == "not reproducible":
            assert {name for name in names if SWEPT.search(name)} or names - at_once, line
        elif row.verdict == "inconsistent":
            assert names <= at_once, line


SWEPT = re.compile(r"_(low|high|least|most)(_|$)")


def _gives(test: str, verdict: str) -> bool:
    """Whether a test can give a verdict; each rule has one at most for each of these two."""
    words = {"not reproducible": ("not reproducible if ", "outside "), "inconsistent": ("inconsistent if ", "follows")}
    return test.startswith(words.get(verdict, ("-",)))


def test_a_rule_gives_its_verdict_by_the_first_test_that_holds() -> None:
    names = {"a": 2.0, "b": "1.9 +- 0.3", "c": "4.9 to 5.6", "way": "1T, 2T, chaotic"}
    cases = {
        ("within 5 %; trend if a < c", "2.05", 2.0): "assumed",
        ("within 5 %; trend if a < c", "3", 2.0): "trend",
        ("within 5 %; trend if a > c", "3", 2.0): "differs",
        ("trend if b < a", "", None): "open",
        ("trend if a < c < 5", "", None): "open",
        ("outside a .. c", "6", 2.0): "not reproducible",
        ("outside a .. c", "5", 2.0): "open",
        ("follows", "772", 772.7): "exact",
        ("follows", "1.2e8", 1.25e8): "exact",
        ("follows", "2.72", 3.015): "inconsistent",
        ("follows", "< 5", 3.9): "exact",
        ("follows", ">5", 3.9): "inconsistent",
        ("input", "40", 40.0): "given",
        ("input", "40", 41.5): "differs",
        ('trend if "2T" in way', "", None): "trend",
        ('trend if "4T" in way; not reproducible if abs(0 - a) > 1', "4T", "1T"): "not reproducible",
        ('exact if way == "1T"', "", None): "differs",
        ("within 10 %", "-0.02", -0.021): "assumed",
        ("shown", "", 1.0): "shown",
    }
    found = {key: rules.judged(*key, names)[0] for key in cases}
    assert found == cases
    assert rules.judged("trend if b < a", "", None, names)[1] == "trend if 1.9 +- 0.3 < 2"


@pytest.mark.parametrize(
    ("rule", "verdict", "because", "by"),
    [
        ("follows", "inconsistent", "follows", "does not follow"),
        ("follows", "exact", "follows", "follows"),
        ("within 2 %", "differs", "within 2 %", "not within 2 %"),
        ("trend if a < b", "differs", "trend if 3 < 2", "trend only if 3 < 2"),
        ("trend if a < b", "trend", "trend if 1 < 2", "if 1 < 2"),
        ("outside a .. b", "not reproducible", "outside 1 .. 2", "outside 1 .. 2"),
        ("shown", "shown", "shown", ""),
    ],
)
def test_a_row_says_by_what_it_was_judged(rule: str, verdict: str, because: str, by: str) -> None:
    assert Row("text", "a", "3", "", 2.0, rule, verdict, because, "").by == by


@pytest.mark.parametrize(
    "rule", ["", "nearly", "trend if a", "trend if a == 2", 'trend if way < "2T"', "wrong if a > 1"]
)
def test_a_rule_that_says_nothing_is_refused(rule: str) -> None:
    with pytest.raises((ValueError, SyntaxError)):
        rules.judged(rule, "3", 2.0, {"a": 2.0, "way": "1T"})


@pytest.mark.parametrize("system", SYSTEMS)
def test_given_and_exact_rows_give_the_printed_number(system: str) -> None:
    found = [row for row in rows(system) if row.because in ("input", "follows") and row.verdict in ("given", "exact")]
    assert len(found) > 15
    assert [row for row in found if not rules.agrees(row.printed, row.computed)] == []


def test_the_page_counts_the_verdicts_of_the_tables() -> None:
    page = (MODELS.parent / "docs" / "validation.md").read_text(encoding="utf-8")
    assert counts() in page
    for verdict in VERDICTS:
        assert f"\n| {verdict} |" in page


CHEAP = [
    (name, piece)
    for names in SYSTEMS.values()
    for name in names
    for piece, kept_piece in kept.stored(name).items()
    if (kept_piece["cpu_s"] or 99.0) < 3.0
]


@pytest.mark.parametrize(("name", "piece"), [CHEAP[datetime.date.today().toordinal() % len(CHEAP)]])
def test_a_piece_gives_the_values_that_are_kept(name: str, piece: str) -> None:
    """Another one every day: values that no longer follow are found, whatever made them wrong."""
    assert_same(name, piece)


@pytest.mark.long
@pytest.mark.parametrize(("name", "piece"), CHEAP)
def test_all_quick_pieces_give_the_values_that_are_kept(name: str, piece: str) -> None:
    assert_same(name, piece)


def assert_same(name: str, piece: str) -> None:
    found = import_module(f"validation.seeds.{name}").PIECES[piece]()
    stored = kept.stored(name)[piece]["values"]
    assert set(found) == set(stored)
    for key, value in found.items():
        if isinstance(value, str):
            assert settling.agree(value, stored[key]), key
        else:
            assert value == pytest.approx(stored[key], rel=1e-4, abs=1e-9), key


def test_every_module_with_pieces_has_values_of_all_of_them() -> None:
    for names in SYSTEMS.values():
        for name in names:
            assert list(kept.stored(name)) == list(import_module(f"validation.seeds.{name}").PIECES), name


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


@pytest.mark.long  # three sweeps that settle for long
def test_the_pair_of_24_dofs_goes_from_one_period_over_two_to_chaos() -> None:
    found = pair24.route(pair24.MODEL, (5000.0, 5800.0, 5950.0), 250, 64)
    assert [found.motion_at(p) for p in range(3)] == ["1T", "2T", "chaotic"]


@pytest.mark.long  # a sweep that settles for long
def test_set_2_is_of_one_period_again_at_high_speed() -> None:
    found = pair24.route(pair24.SECOND, (8000.0, 9000.0, 20000.0, 35000.0), pair24.SETTLE_2, pair24.KEPT_2)
    assert [found.motion_at(p) == "1T" for p in range(2)] == [True, False]
    # The hold of the rotation decays over millions of periods, so that labels at high speed stay open; the motion is stable.
    largest = found.lyapunov[:, 0, 0] + 3.0 * found.lyapunov_error[:, 0, 0]
    assert [largest[p] < 0.0 for p in (0, 2, 3)] == [True, True, True]


@pytest.mark.long  # two sweeps that settle for long
def test_load_closes_the_gap_and_damping_calms() -> None:
    assert pair24.trend(pair24.apart(torques=(300.0,))) == [("1T", 0)]
    assert pair24.trend(pair24.apart(damping=(4.0,)))[0][0] == "1T"


def test_transient_and_sweep_agree_on_a_motion_with_loss_of_contact() -> None:
    model = loaded(pair24.MODEL)
    period = 60.0 / (5800.0 * 22.0)
    sweep = pair24.route(pair24.MODEL, (5800.0,), 120, 32)
    run = rg.transient(
        model,
        speed=5800.0 * math.pi / 30.0,
        method="newmark",
        steps=640,
        discard=120 * period,
        time=32 * period,
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


def test_the_printed_equations_of_the_marine_train_have_no_equilibrium_and_those_meant_have_one() -> None:
    printed, meant = misprints.marine_balance()
    assert printed > 1e3
    assert meant < 1e-6


@pytest.mark.parametrize("asymmetry", [misprints.marine_stiffness, misprints.pair16_axial])
def test_the_printed_stiffness_is_not_symmetric(asymmetry: Callable[[], float]) -> None:
    assert asymmetry() > 0.3


def test_a_stiffness_that_keeps_work_has_no_asymmetry() -> None:
    along = np.array([0.3, -0.2, 0.9])
    assert misprints.asymmetry(along, along) == 0.0
    assert misprints.asymmetry(along * [1.0, 1.0, -1.0], along) == pytest.approx(2.0 * 0.27 / 0.81)


def test_the_same_sign_on_both_gears_of_the_24_dof_pair_lets_it_fly_off() -> None:
    assert misprints.pair24_force() == pytest.approx((2.0, 0.0), abs=1e-12)


def test_the_printed_arm_of_the_24_dof_pair_is_that_of_the_reference_radius() -> None:
    gear = pair16.geometry((22, 41), 22.0, 0.12)[0]
    arm = gear.base_radius * math.cos(gear.base_helix_angle)
    angles = math.cos(gear.normal_pressure_angle) * math.cos(gear.helix_angle)
    assert 0.5 * gear.reference_diameter * angles == pytest.approx(arm, rel=1e-12)
    assert gear.base_radius * angles == pytest.approx(0.931 * arm, rel=1e-3)


def test_the_printed_mesh_of_the_split_torque_gearbox_strains_in_a_rigid_tilt() -> None:
    printed, ours = misprints.split_tilt()
    assert printed > 0.02
    assert ours < 1e-15


def test_the_impact_force_balances_the_energy_of_compliances_only() -> None:
    printed, balanced = misprints.impact_energy()
    assert balanced == pytest.approx(1.0, rel=1e-12)
    assert printed < 1e-9


def test_the_models_name_what_they_assume() -> None:
    for name in (marine.MODEL, pair24.MODEL, pair24.SECOND, pair12.MODEL, *pair16.FILES.values()):
        text = Path(MODELS / f"{name}.toml").read_text(encoding="utf-8")
        assert "ASSUMED" in text
        assert "Given by the source" in text
