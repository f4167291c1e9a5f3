"""What a long run keeps: as many records as a bound of memory holds, with statistics of every step."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.transient import histories, request
from tests.paths import ROOT

# Under a torque at which its teeth stay together: what chaos scatters by is told by the records that are kept.
PAIR = rg.load(ROOT / "models" / "backlash_pair.toml").with_("operation.torque", 500.0)
RUN = {"time": 0.02, "steps": 80}


def test_histories_beyond_a_bound_are_thinned_and_no_statistic_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = rg.transient(PAIR, **RUN)
    width = 8 * (whole.values.shape[1] + 3 * len(whole.contact) + 1)
    monkeypatch.setattr(request, "MOST_HISTORY", len(whole.time) * width / 6.5)
    monkeypatch.setattr("rotorgear.solvers.time.run.CHUNK", 50)  # the places of those that are kept go on over chunks
    thin = rg.transient(PAIR, **RUN)
    assert thin.every == 7 * whole.every
    assert np.array_equal(thin.time, whole.time[::-1][::7][::-1])
    assert np.ptp(np.diff(thin.time)) < 1e-9 * thin.spacing == pytest.approx(7e-9 * whole.spacing)
    assert np.array_equal(thin.mesh_force, whole.mesh_force[::-1][::7][::-1])
    for name in ("force_mean", "force_rms", "force_range", "approach_range", "value_rms", "value_range"):
        assert getattr(thin, name) == pytest.approx(getattr(whole, name), rel=1e-9), name
    assert thin.error_estimate == pytest.approx(whole.error_estimate, rel=1e-6)
    assert any(note.startswith("6 of 7 records of the histories") and "--records" in note for note in thin.left_out)
    assert not any("records of the histories" in note for note in whole.left_out)
    # Who asks for records gets them.
    assert len(rg.transient(PAIR, **RUN, records=40).time) == len(whole.time)


def test_records_that_the_machine_cannot_hold_are_refused_before_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(request, "free_memory", lambda: 1e5)
    with pytest.raises(rg.AnalysisError, match=r"GB are free: ask for fewer records .*--records"):
        rg.transient(PAIR, **RUN, records=400)
    monkeypatch.setattr(request, "free_memory", lambda: None)
    assert rg.transient(PAIR, time=0.001, steps=80, records=40).status == "success"


def test_a_run_that_only_serves_another_one_keeps_the_records_that_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rotorgear.solvers.time.run.CHUNK", 50)
    task = request.prepare(PAIR, None, None)
    grid, _ = request.grid_of(task, 0.01, 0.01, 80, None)
    integrator, _ = request.integrator_of(task, grid, "newmark", None, None, None, None)
    serving = histories.run_task(task, integrator, grid, lambda *_: None, text="twice the step")
    whole = histories.run_task(task, integrator, grid, lambda *_: None)
    assert len(whole.parts) > 3
    counted = whole.table("t") > 0.01
    assert counted.sum() < len(serving.table("t")) <= counted.sum() + 50
    assert np.array_equal(serving.table("F")[-counted.sum() :], whole.table("F")[counted])
