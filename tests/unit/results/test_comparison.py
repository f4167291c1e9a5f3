"""The frozen result: its sentence and its plain data."""

from __future__ import annotations

import dataclasses
import json

import pytest

from rotorgear.results.comparison import (
    Candidate,
    Chance,
    Comparison,
    ExcitationLine,
    Match,
    RigLine,
    UnmatchedMode,
    UnmatchedRigLine,
)

MESH = ExcitationLine("stage_2 mesh 1x", 1818.27)


def chance(**changes):
    values = {
        "band_low_hz": 337.4,
        "band_high_hz": 4724.1,
        "modes_in_band": 52,
        "coverage": 0.97,
        "expected_random_matches": 3.9,
        "probability_as_many": 0.9,
        "probability_as_close": 0.4,
        "binomial_expected": 3.88,
        "binomial_probability": 0.885,
        "samples": 2000,
        "seed": 0,
    }
    return Chance(**values | changes)


def match(frequency=361.0, excitations=()):
    runner_up = Candidate(8, 1.02 * frequency, 2.0)
    return Match(
        RigLine(frequency, "A1", 3.0),
        7,
        1.01 * frequency,
        "output bending",
        1.0,
        False,
        runner_up,
        None,
        excitations,
        (),
    )


def comparison(matched=4, missed=0, excitations=(), **changes):
    matches = tuple(match(361.0 + 10 * i, excitations if i == 0 else ()) for i in range(matched))
    unmatched = tuple(UnmatchedRigLine(RigLine(900.0 + i), None, ()) for i in range(missed))
    modes = (UnmatchedMode(12, 1820.0, "bull gear axial", (MESH,)),)
    return Comparison(matches, unmatched, modes, 0.07, 0.005, chance(**changes))


def test_matches_that_chance_gives_too_are_called_no_evidence():
    assert comparison().verdict == (
        "4 of 4 rig lines are within 7 %, but 97 % of the band lies within 7 % of some mode: "
        "a random list would match 3.9 of 4, so the agreement is no evidence for the model."
    )


def test_matches_beyond_chance_are_evidence_unless_fitted_and_what_is_missing_is_said():
    verdict = comparison(3, 1, coverage=0.12, expected_random_matches=0.48, probability_as_many=0.006).verdict
    assert verdict.startswith("3 of 4 rig lines are within 7 %, while 12 % of the band")
    assert verdict.endswith(
        "as many in 0.6 % of cases, so the agreement is evidence for the model if it was not fitted to these lines, "
        "though 1 rig line has no mode."
    )


def test_closeness_beyond_chance_is_told_apart_from_number():
    verdict = comparison(probability_as_close=0.01).verdict
    assert "so that alone is no evidence for the model; only 1 % of random lists come as close" in verdict


def test_each_of_the_two_looks_has_half_of_five_percent_less_twice_the_sampling_error():
    # 2000 random lists: p + 2 sqrt(p (1 - p) / 2000) = 0.025 at p = 0.0189
    assert chance(probability_as_many=0.0188).number_is_evidence
    assert not chance(probability_as_many=0.0190).number_is_evidence
    assert chance(probability_as_close=0.0188).closeness_is_evidence
    assert not chance(probability_as_close=0.0190).closeness_is_evidence
    assert chance(probability_as_close=0.0245, samples=200_000).number_is_evidence is False
    assert chance(probability_as_close=0.0240, samples=200_000).closeness_is_evidence


def test_no_match_at_all_is_said_first():
    assert comparison(0, 4).verdict.startswith("None of the 4 rig lines is within 7 % of a mode")
    assert comparison(0, 1).verdict.startswith("The rig line is not within 7 % of a mode")


def test_lines_that_may_be_forced_response_are_counted_in_the_verdict():
    verdict = comparison(excitations=(MESH,)).verdict
    assert verdict.endswith(
        "; 1 of the 4 rig lines coincides with an excitation line and may be no natural frequency at all."
    )


def test_the_plain_data_survive_json_and_carry_every_key():
    data = json.loads(json.dumps(comparison(2, 1, (MESH,)).to_dict(), allow_nan=False))
    wanted = {
        "verdict",
        "tolerance",
        "excitation_tolerance",
        "rig_lines",
        "matches",
        "unmatched_rig",
        "unmatched_modes",
        "chance",
        "warnings",
    }
    assert wanted <= set(data)
    first = data["matches"][0]
    assert first["rig"] == {"frequency_hz": 361.0, "label": "A1", "uncertainty_hz": 3.0, "damping_ratio": None}
    assert first["runner_up"]["mode_number"] == 8
    assert first["within_tolerance"] is True
    assert first["excitations"] == [{"name": "stage_2 mesh 1x", "frequency_hz": 1818.27}]
    assert data["unmatched_rig"][0]["nearest_mode"] is None
    assert data["unmatched_modes"][0]["description"] == "bull gear axial"
    assert data["chance"]["measure"] == "log frequency"
    assert data["chance"]["number_is_evidence"] is False
    assert data["rig_lines"] == 3


def test_the_result_is_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        comparison().tolerance = 0.5
