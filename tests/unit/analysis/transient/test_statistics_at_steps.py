"""Statistics of a transient are those of its steps: however many are recorded, in stiff contact, and where a run ends early."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.solvers.time.kernel_time import gather
from rotorgear.solvers.time.statistics import Statistics, blank_gathered
from tests.models import spur_pair

MODELS = Path(__file__).resolve().parents[4] / "models"
IMPACT = {"force": "3000 N", "duration": 0.02}


@pytest.mark.parametrize("method", ["newmark", "exponential", "generalised-alpha"])
def test_statistics_do_not_depend_on_what_is_recorded(method: str) -> None:
    model = spur_pair(meshes__pair__corner_impact=IMPACT, meshes__pair__backlash="40 um")
    how = {"time": 0.01, "discard": 0.01, "steps": 1000, "method": method, "error_estimate": False}
    few, every = (rg.transient(model, records=n, **how) for n in (10, 500))
    assert len(few.time) < 0.1 * len(every.time)
    np.testing.assert_allclose(few.quantity_value, every.quantity_value, rtol=1e-9, atol=1e-12 * 3000.0)
    forces = every.mesh_force[every.counted, 0]
    assert few.contacts[0].largest_force_n == pytest.approx(forces.max(), rel=0.01)
    assert few.contacts[0].mean_force_n == pytest.approx(forces.mean(), rel=1e-3)
    assert few.contacts[0].driving_impulse_n_s == pytest.approx(0.01 * forces.mean(), rel=1e-3)


def test_sums_and_extremes_are_those_of_the_curve_between_the_steps() -> None:
    h = 0.3
    t = h * np.arange(1, 4001)
    x = 5.0 + np.sin(t + 0.1)
    found = blank_gathered(np.array([5.0 + np.sin(0.1)]))
    for value in x:
        gather(found, np.array([value]), 0, False)
    statistics = Statistics.of_steps(found)
    assert statistics.mean[0] == pytest.approx(5.0, abs=2e-3)
    assert statistics.rms[0] == pytest.approx(np.sqrt(0.5), rel=1e-3)
    assert [statistics.least[0], statistics.largest[0]] == pytest.approx([4.0, 6.0], abs=1e-4)


def test_no_curve_is_laid_through_a_force_that_sets_in() -> None:
    found = blank_gathered(np.zeros(1))
    for value in (0.0, 0.0, 0.0, 0.0, 5.0, 7.0, 0.0, 0.0, 9.0, 0.0, 0.0):
        gather(found, np.array([value]), 1, False)
    assert found.extremes.tolist() == [[0.0, 9.0]]


def test_a_pair_ten_thousand_times_stiffer_carries_its_load_in_steps_that_its_accuracy_needs() -> None:
    model = rg.load("models/backlash_pair.toml").with_("meshes.pair.stiffness", "1.6e12 N/m")
    result = rg.transient(model, time=0.0075, discard=0.0075)
    contact = result.contacts[0]
    assert contact.mean_force_n == pytest.approx(10.0 / 0.0564, rel=0.01)
    assert contact.losses > 50
    assert result.status == "success"
    assert not any("by statics" in note for note in result.warnings)
    # The largest force is fourteen times the root mean square: its error is a share of itself.
    largest = list(result.quantity).index("largest force pair")
    assert result.quantity_scale[largest] == pytest.approx(contact.largest_force_n)
    # Impacts of half a period of sqrt(k/m_e) in some twenty steps are enough for 1 %.
    impact = np.pi / np.sqrt(1.6e12 * 2.0 * 0.0564**2 / 3.2e-3)
    assert 15.0 < impact / result.step < 30.0
    begun = rg.transient(model, time=0.0002, steps=1440, error_estimate=False)
    assert any("N by statics" in note for note in begun.warnings)


def test_an_accuracy_out_of_reach_ends_the_search_and_names_the_steps_that_reach_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("rotorgear.analysis.transient.errors._HALVINGS", 2)
    how = {"time": 0.005, "discard": 0.0, "method": "newmark"}
    missed = rg.transient(spur_pair(), accuracy=1e-5, **how)
    assert missed.error_estimate > 1e-4
    named = int(missed.status.split("; about ")[1].split(" steps in a mesh period")[0])
    assert rg.transient(spur_pair(), steps=named, **how).error_estimate == pytest.approx(1e-5, rel=0.2)


def test_a_run_that_ends_while_it_settles_says_so_and_has_no_statistics() -> None:
    def stop(fraction: float, step: str) -> None:
        if "of" in step:
            raise KeyboardInterrupt

    result = rg.transient(spur_pair(), time=0.1, discard=5.0, steps=40, error_estimate=False, progress=stop)
    assert result.status.startswith("interrupted")
    assert np.isnan(result.contacts[0].mean_force_n)
    assert np.isnan(result.dynamic_factor).all()
    assert np.isnan(result.transmission_error_range).all()
    assert any("no statistics" in note for note in result.warnings)
    assert "nothing counts" in str(result)


def test_an_estimate_falls_with_the_square_of_the_step_also_where_three_steps_lie_between_records() -> None:
    # The run of 120 steps is compared with one of 40, three times its step, too; the others with twice theirs.
    model = rg.load(MODELS / "flexible_pair.toml")
    weighed = [
        steps**2
        * rg.transient(model, time=8.0 / 2300.0, discard=0.0, records=40, method="newmark", steps=steps).error_estimate
        for steps in (80, 120, 160)
    ]
    assert weighed[1] == pytest.approx(weighed[0], rel=0.05)
    assert weighed[2] == pytest.approx(weighed[0], rel=0.05)
