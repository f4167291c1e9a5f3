"""The rig comparison: who matches whom, what is said of it, and what chance gives."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from rotorgear.analysis.rig.compare import binomial_tail
from rotorgear.analysis.rig.compare import compare_lines as compare
from rotorgear.errors import AnalysisError, ModelError
from rotorgear.results.comparison import ExcitationLine, RigLine

MODES = [0.0, 50.0, 120.0, 333.0, 700.0, 1500.0]


def lines(*frequencies, **fields):
    return [RigLine(float(frequency), **fields) for frequency in frequencies]


def names(modes):
    return [f"mode shape {number + 1}" for number in range(len(modes))]


def run(rig, modes=MODES, **options):
    options.setdefault("samples", 50)
    return compare(modes, names(modes), rig, **options)


def numbers(comparison):
    return {match.rig.frequency_hz: match.mode_number for match in comparison.matches}


def test_lines_meet_their_modes_with_the_error_of_the_mode_relative_to_the_rig():
    result = run(lines(51, 118))
    assert numbers(result) == {51.0: 2, 118.0: 3}
    assert [match.error_percent for match in result.matches] == pytest.approx(
        [100 * (50 / 51 - 1), 100 * (120 / 118 - 1)]
    )
    assert result.matches[0].mode_description == "mode shape 2"


def test_a_pair_outside_the_tolerance_is_unmatched_on_both_sides_and_its_nearest_mode_is_named():
    result = run(lines(51, 370, 705))
    (left,) = result.unmatched_rig
    assert left.rig.frequency_hz == 370.0
    assert (left.nearest_mode.mode_number, left.nearest_mode.frequency_hz) == (4, 333.0)
    assert left.nearest_mode.error_percent == pytest.approx(-10.0)
    assert not left.nearest_mode.matched_elsewhere
    assert [mode.mode_number for mode in result.unmatched_modes] == [3, 4]


def test_a_line_whose_only_mode_belongs_to_another_line_says_so():
    result = run(lines(119, 121.5))
    (left,) = result.unmatched_rig
    assert left.rig.frequency_hz == 121.5
    assert left.nearest_mode.mode_number == 3
    assert left.nearest_mode.matched_elsewhere


def test_rigid_modes_are_never_matched():
    modes = [0.0, 100.0, 100.4]
    assert numbers(run(lines(100), modes, rigid=[True, True, False])) == {100.0: 3}
    assert numbers(run(lines(100), modes)) == {100.0: 2}


def test_the_order_of_rig_lines_and_modes_changes_nothing():
    random = np.random.default_rng(5)
    modes = np.sort(random.uniform(50, 900, 30))
    rig = lines(*random.uniform(50, 900, 6))
    plain = run(rig, modes)
    assert len(plain.matches) >= 3
    order = random.permutation(30)
    shuffled = run(rig[::-1], modes[order])
    back = {line: int(order[number - 1]) + 1 for line, number in numbers(shuffled).items()}
    assert back == numbers(plain)
    assert shuffled.chance == plain.chance


def test_a_common_factor_on_all_frequencies_changes_no_match_and_no_chance():
    random = np.random.default_rng(6)
    modes = random.uniform(50, 900, 30)
    rig = random.uniform(50, 900, 6)
    plain = run(lines(*rig), modes)
    scaled = run(lines(*(10 * rig)), 10 * modes)
    assert list(numbers(scaled).values()) == list(numbers(plain).values())
    assert scaled.chance.coverage == pytest.approx(plain.chance.coverage, rel=1e-12)
    assert scaled.chance.expected_random_matches == plain.chance.expected_random_matches
    assert scaled.chance.probability_as_close == plain.chance.probability_as_close


def test_the_stated_uncertainty_of_a_line_decides_whether_the_mode_is_within_it():
    rig = [RigLine(100.0, uncertainty_hz=0.5), RigLine(200.0, uncertainty_hz=2.0), RigLine(300.0)]
    assert [m.within_uncertainty for m in run(rig, [101.0, 201.0, 301.0]).matches] == [False, True, None]


def test_a_mode_within_twice_the_error_is_a_runner_up_and_one_beyond_is_none():
    assert run(lines(100), [101.0, 98.1]).matches[0].runner_up.mode_number == 2
    assert run(lines(100), [101.0, 97.9]).matches[0].runner_up is None


def test_a_runner_up_outside_the_tolerance_is_none():
    assert run(lines(100), [103.0, 94.5], tolerance=0.05).matches[0].runner_up is None
    assert run(lines(100), [103.0, 94.5], tolerance=0.06).matches[0].runner_up.mode_number == 2


def test_two_modes_inside_the_reading_accuracy_are_ambiguous_even_where_one_hits_exactly():
    assert run(lines(100), [100.0, 100.09]).matches[0].runner_up is not None
    assert run(lines(100), [100.0, 100.11]).matches[0].runner_up is None
    assert run(lines(100, uncertainty_hz=0.05), [100.0, 100.09]).matches[0].runner_up is None
    assert run(lines(100, uncertainty_hz=2.0), [100.0, 101.9]).matches[0].runner_up is not None


def test_a_runner_up_that_belongs_to_another_line_says_so():
    first, second = run(lines(100, 101), [100.5, 101.6]).matches
    assert (first.runner_up, second.runner_up.mode_number) == (None, 1)
    assert second.runner_up.matched_elsewhere


def test_excitation_lines_on_a_rig_line_and_on_modes_are_named():
    mesh = ExcitationLine("stage_2 mesh 1x", 1818.27)
    order = ExcitationLine("input 1x", 272.5)
    result = run(lines(1818, 361, 200), [200.0, 272.0, 368.7, 1830.0], excitations=[mesh, order])
    by_line = {match.rig.frequency_hz: match for match in result.matches}
    assert by_line[1818.0].excitations == (mesh,)
    assert by_line[1818.0].mode_excitations == ()
    assert by_line[361.0].excitations == ()
    assert [mode.excitations for mode in result.unmatched_modes] == [(order,)]
    assert str(ExcitationLine("stage_1 mesh 1x", 7902.5)) == "stage_1 mesh 1x 7902.5 Hz"


def test_a_large_uncertainty_of_the_line_widens_what_coincides_with_it():
    mesh = ExcitationLine("mesh 1x", 1018.0)
    assert run(lines(1000), [1000.0], excitations=[mesh]).matches[0].excitations == ()
    assert run(lines(1000, uncertainty_hz=20.0), [1000.0], excitations=[mesh]).matches[0].excitations == (mesh,)


def test_damping_of_rig_and_mode_stand_side_by_side():
    result = run([RigLine(100.0, damping_ratio=0.02)], [100.0, 900.0], damping_ratio=[0.01, np.nan])
    assert (result.matches[0].rig.damping_ratio, result.matches[0].mode_damping_ratio) == (0.02, 0.01)
    assert run(lines(900), [100.0, 900.0], damping_ratio=[0.01, np.nan]).matches[0].mode_damping_ratio is None


def test_the_band_spans_the_rig_lines_widened_by_the_tolerance():
    chance = run(lines(100, 1000)).chance
    assert (chance.band_low_hz, chance.band_high_hz) == pytest.approx((100 / 1.05, 1050.0))
    assert chance.modes_in_band == 3


def test_a_dense_list_of_modes_matches_any_list_and_is_called_no_evidence():
    modes = np.geomspace(90, 1100, 60)
    result = run(lines(110, 250, 480, 930), modes)
    assert result.chance.coverage == pytest.approx(1.0)
    assert result.chance.probability_as_many > 0.9
    assert "no evidence" in result.verdict


def test_close_agreement_in_a_dense_list_is_told_from_mere_agreement_within_the_tolerance():
    modes = np.geomspace(90, 1100, 60)
    result = run(lines(*(1.00001 * modes[[5, 20, 40, 55]])), modes, samples=400)
    assert not result.chance.number_is_evidence
    assert result.chance.probability_as_close == 1 / 401
    assert "only 0.249 % of random lists come as close" in result.verdict


def occupancy(count, intervals, share, at_least):
    """Probability that `count` random points hit at least so many of `intervals` disjoint intervals of equal share."""
    weights = [share] * intervals + [1.0 - intervals * share]
    outcomes = itertools.product(range(intervals + 1), repeat=count)
    return math.fsum(math.prod(weights[i] for i in hit) for hit in outcomes if len(set(hit) - {intervals}) >= at_least)


@pytest.mark.parametrize(("rig", "matched"), [((200, 410, 1000), 2), ((200, 410, 800), 3), ((250, 410, 600), 1)])
def test_the_sampled_probability_agrees_with_the_enumeration_for_widely_separated_modes(rig, matched):
    modes = [200.0, 400.0, 800.0]
    band = (100.0, 1600.0)
    samples = 4000
    share = math.log(1.1 / 0.9) / math.log(16.0)
    result = run(lines(*rig), modes, tolerance=0.1, band=band, samples=samples)
    assert len(result.matches) == matched
    exact = occupancy(3, 3, share, matched)
    spread = math.sqrt(exact * (1 - exact) / samples)
    assert abs(result.chance.probability_as_many - exact) < 4 * spread + 1 / samples
    mean = math.fsum(occupancy(3, 3, share, k) for k in (1, 2, 3))
    assert abs(result.chance.expected_random_matches - mean) < 4 * math.sqrt(0.75 / samples)


def test_the_binomial_closed_form_agrees_with_the_samples_where_lines_hardly_compete():
    modes = 100.0 * 1.1 ** np.arange(25)
    samples = 2000
    result = run(lines(*modes[[3, 11, 17]]), modes, tolerance=0.01, band=(100.0, 1000.0), samples=samples)
    p = result.chance.coverage
    assert result.chance.binomial_probability == pytest.approx(p**3)
    assert result.chance.binomial_expected == pytest.approx(3 * p)
    assert abs(result.chance.expected_random_matches - 3 * p) < 4 * math.sqrt(3 * p / samples) + 3 * p / 25


def test_the_binomial_tail_sums_to_one_and_ends_in_a_power():
    assert binomial_tail(6, 0, 0.3) == pytest.approx(1.0, abs=1e-15)
    assert binomial_tail(6, 6, 0.3) == pytest.approx(0.3**6)
    assert binomial_tail(2, 1, 0.25) == pytest.approx(1 - 0.75**2)


def test_one_mode_can_serve_one_line_only_also_by_chance():
    # Both lines always lie near the only mode: the second must remain without, for the rig and for every random list.
    result = run(lines(100, 101), [100.5], band=(99.0, 102.0))
    assert len(result.matches) == 1
    assert result.chance.coverage == 1.0
    assert result.chance.expected_random_matches == 1.0
    assert result.chance.binomial_expected == 2.0


def test_closeness_follows_the_closed_form_of_a_single_line_and_a_single_mode():
    # One line, one mode in mid-band: P(|ln(f/r)| <= d) = 2 d / ln(high/low).
    result = run(lines(300 * 1.02), [300.0], band=(100.0, 900.0), samples=4000)
    exact = 2 * math.log(1.02) / math.log(9.0)
    assert abs(result.chance.probability_as_close - exact) < 4 * math.sqrt(exact / 4000) + 1 / 4000


def test_the_same_seed_gives_the_same_chance_and_another_seed_another_sample():
    random = np.random.default_rng(8)
    modes = random.uniform(50, 900, 20)
    rig = lines(*random.uniform(50, 900, 5))
    assert run(rig, modes, seed=3).chance == run(rig, modes, seed=3).chance
    assert (
        run(rig, modes, seed=3).chance.expected_random_matches != run(rig, modes, seed=4).chance.expected_random_matches
    )


def test_modes_that_end_below_the_rig_lines_raise_a_warning():
    (warning,) = run(lines(51, 2000)).warnings
    assert "end at 1500.0 Hz" in warning
    assert "2100.0 Hz" in warning
    assert run(lines(51, 1400)).warnings == ()


def test_a_single_line_warns_that_it_spans_no_band_unless_a_band_is_given():
    assert "band" in run(lines(120)).warnings[0]
    assert run(lines(120), band=(20.0, 1500.0)).warnings == ()


def test_rigid_modes_alone_leave_every_line_unmatched():
    result = run(lines(100, 200), [0.0, 0.0], rigid=[True, True])
    assert [line.nearest_mode for line in result.unmatched_rig] == [None, None]
    assert (result.chance.coverage, result.chance.probability_as_many) == (0.0, 1.0)
    assert result.verdict.startswith("None of the 2 rig lines")


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"rig": []}, "no rig lines"),
        ({"rig": lines(100, 100)}, "given twice"),
        ({"tolerance": 5.0}, "share between 0 and 1, such as 0.05"),
        ({"tolerance": float("nan")}, "tolerance"),
        ({"excitation_tolerance": -0.1}, "excitation_tolerance"),
        ({"samples": 0}, "must be at least 1"),
        ({"band": (200.0, 1000.0)}, "contain the rig lines"),
        ({"band": (0.0, 1000.0)}, "must be positive"),
        ({"modes": [100.0, float("nan")]}, "finite"),
        ({"rigid": [True]}, "one entry a mode"),
    ],
)
def test_what_makes_no_sense_is_refused_in_a_sentence(change, text):
    options = {"rig": lines(100), **change}
    with pytest.raises(AnalysisError, match=text):
        run(options.pop("rig"), options.pop("modes", MODES), **options)


def test_a_rig_line_names_all_its_impossible_numbers_at_once():
    with pytest.raises(ModelError) as caught:
        RigLine(-5.0, damping_ratio=1.5)
    assert [problem.address for problem in caught.value.problems] == ["frequency_hz", "damping_ratio"]


def test_a_spring_that_holds_all_energy_is_learnt_as_well_as_its_line_is_read():
    # f ~ sqrt(k): a line known to 0.5 % knows k to 1 %; one known to 1 % knows it to 2 %. With a prior of 30 % beside it.
    shares = {"bearings.a": [1.0, 0.0], "shafts.rotor": [0.0, 0.5], "supports.b": [0.0, 0.5]}
    result = compare(
        [100.0, 300.0], ["", ""], [RigLine(100.0), RigLine(300.0, uncertainty_hz=3.0)], strain_energy=shares
    )
    a, b = result.stiffnesses
    assert (a.address, b.address) == ("bearings.a.stiffness", "supports.b.stiffness")
    assert a.sigma == pytest.approx((0.01**-2 + 0.3**-2) ** -0.5, rel=1e-12)
    assert b.sigma == pytest.approx((0.04**-2 + 0.3**-2) ** -0.5, rel=1e-12)
    assert result.learnt_parameters == pytest.approx(2.0 - (a.sigma**2 + b.sigma**2) / 0.3**2, rel=1e-12)


def test_frequencies_alone_teach_nothing_of_stiffnesses():
    result = run(lines(MODES[1]))
    assert result.stiffnesses == ()
    assert result.learnt_parameters is None
