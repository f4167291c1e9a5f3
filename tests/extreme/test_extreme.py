"""Stiff and extreme cases are right or refused with a clear sentence; never silently wrong, never a traceback."""

from __future__ import annotations

import mpmath as mp
import pytest

import rotorgear as rg
from rotorgear.errors import RotorgearError
from tests.extreme.cases import CASES, CONDITIONING, FLAGGED, REFUSED, measured
from tests.extreme.models import rotor_model
from tests.extreme.references import DIGITS, Rotor, Segment, Spring
from tests.extreme.undamped_errors import assembled_error

# Long: 40 digits of 123 bodies; a period of a hundred oscillations.
LONG = ("120 planets that go round", "orbits: a hundredth of the resonance")


@pytest.mark.parametrize(
    "case",
    [pytest.param(case, id=case.name, marks=[pytest.mark.long] if case.name in LONG else []) for case in CASES],
)
def test_an_extreme_case_is_accurate(case):
    assert measured(case) < case.bound


@pytest.mark.parametrize("case", REFUSED, ids=lambda case: case.name)
def test_an_impossible_case_is_refused_with_a_clear_sentence(case):
    with pytest.raises(RotorgearError) as caught:
        case.act()
    assert case.sentence in str(caught.value)


@pytest.mark.parametrize("case", FLAGGED, ids=lambda case: case.name)
def test_a_doubtful_case_is_told(case):
    assert any(case.sentence in warning for warning in case.act().warnings)


def test_there_are_cases_of_every_analysis():
    names = [case.name for case in (*CASES, *REFUSED, *FLAGGED)]
    assert len(set(names)) == len(names) >= 150
    motions = ("transient", "sweep", "orbits")
    linear = ("static", "frf", "response", "campbell", "critical", "state space")
    for analysis in (*linear, *motions, "gear", "mesh", "bearing", "casing", "scatter", "update"):
        assert any(name.startswith(f"{analysis}: ") for name in names), analysis


@pytest.mark.parametrize("row", [row for row in CONDITIONING if row.alone], ids=lambda row: row.name)
def test_the_assembled_stiffness_alone_is_worse(row):
    with mp.workdps(DIGITS):
        assert assembled_error(row.rotor) > row.alone


def _warnings(rotor, **how):
    return " ".join(rg.modal(rotor_model(rotor), modes=8, **how).warnings)


def test_a_short_segment_is_named_as_the_cause_of_ill_conditioning():
    segments = [Segment(0.1, 0.05), Segment(0.1, 0.05), Segment(1e-4, 0.05), Segment(0.1, 0.05)]
    said = _warnings(Rotor(segments, {0: Spring(1.0), 4: Spring(1.0)}), elements=1)
    assert "section 3 of shaft s is 0.1 mm long" in said
    assert "apart in omega^2" in said


def test_a_stiff_bearing_is_named_as_the_cause_of_ill_conditioning():
    said = _warnings(Rotor([Segment(0.1, 0.02)] * 4, {0: Spring(1e13), 4: Spring(1e-3)}), elements=1)
    assert "bearings.b0 has 1e+13 N/m" in said
    assert "mostly bearings.b4" in said


def test_a_sound_model_is_not_warned_about():
    assert _warnings(Rotor([Segment(0.1, 0.05)] * 4, {0: Spring(1e8), 4: Spring(1e8)})) == ""


def test_large_and_small_groups_of_soft_damped_modes_agree(monkeypatch):
    """Above a size the basis is a part of all modes: the same eigenvalues come out."""
    springs = {0: Spring(1e-3, damping=1e3), 4: Spring(1e3, damping=10.0)}
    model = rotor_model(Rotor([Segment(0.1, 0.05)] * 4, springs), motions=("bending",))
    part = rg.modal(model, elements=12, modes=12, speed=1e3, error_estimate=False)
    monkeypatch.setattr("rotorgear.analysis.modal.damped_solve._ALL_UP_TO", 10_000)
    whole = rg.modal(model, elements=12, modes=12, speed=1e3, error_estimate=False)
    assert "modal coordinates" in part.method
    assert part.eigenvalues == pytest.approx(whole.eigenvalues, rel=1e-11)
