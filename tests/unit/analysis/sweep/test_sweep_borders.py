"""Sweeps at their borders: odd addresses and requests, parameters that change nothing, dampers that jump."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.axes import axis_of, number_places
from rotorgear.analysis.sweep.classify import period_of
from rotorgear.analysis.sweep.gather import notes
from rotorgear.errors import AnalysisError, RotorgearError
from tests.paths import MODELS

PAIR = MODELS / "backlash_pair.toml"


def test_whole_numbers_of_the_file_are_swept_and_others_fail_alone() -> None:
    found = rg.sweep(rg.load(PAIR), {"gears.*.teeth": "20,30.5,40"}, discard=20, sample=20)
    assert [bool(reason) for reason in found.failure] == [False, True, False]
    assert "whole number" in found.failure[1]
    assert found.frequency[2] == pytest.approx(2.0 * found.frequency[0])


def test_a_point_does_not_depend_on_the_points_beside_it() -> None:
    model = rg.load(PAIR)
    few = {"discard": 0, "sample": 20}
    alone = rg.sweep(model, {"operation.speed": "3000 rpm"}, **few)  # type: ignore[arg-type]
    second = rg.sweep(model, {"operation.speed": "2600 rpm,3000 rpm"}, **few)  # type: ignore[arg-type]
    assert np.array_equal(alone.section[0], second.section[1])


def test_a_parameter_that_changes_nothing_is_named() -> None:
    over = {"gears.pinion.mass": "1 kg,2 kg", "operation.torque": "10 N m,20 N m"}
    found = rg.sweep(rg.load(PAIR), over, discard=5, sample=5)
    idle = [note for note in found.warnings if "has no effect" in note]
    assert len(idle) == 1
    assert idle[0].startswith("gears.pinion.mass ")


@pytest.mark.parametrize("damping", ["adhesive", pytest.param("non-adhesive", marks=pytest.mark.long)])
@pytest.mark.parametrize("rpm", [3560, pytest.param(3300, marks=pytest.mark.long)])
def test_damping_that_sets_in_within_a_step_needs_no_more_steps(damping: str, rpm: int) -> None:
    # The ramp is 22 nm, a fortieth of what flanks pass in a step. Without the impulse from the ends of the steps the pair with
    # adhesive damping is chaotic at 3560 rpm with 200 steps, from all states.
    model = rg.load(PAIR)
    mesh = model.meshes["pair"].model_copy(update={"contact_damping": damping})
    model = model.model_copy(update={"meshes": {"pair": mesh}})
    few, many = (
        rg.sweep(model, {"operation.speed": f"{rpm} rpm"}, steps=steps, discard=1000, sample=200)
        for steps in (200, 1600)
    )
    assert few.motion == many.motion == ("4T" if rpm == 3560 else "2T",)
    assert few.peak_to_peak == pytest.approx(many.peak_to_peak, rel=3e-3)
    assert few.largest_force == pytest.approx(many.largest_force, rel=3e-3)
    assert few.lyapunov == pytest.approx(many.lyapunov, abs=0.02)


@pytest.mark.long  # settles for thousands of periods
def test_runs_that_still_remember_their_start_settle_longer() -> None:
    marine = rg.load(PAIR.with_name("marine_dual_turbine.toml"))  # decays by 5e-4 a mesh period
    over = {"loads.lp.torque": "15.1 kN m,15.4 kN m"}
    early, settled = (rg.sweep(marine, over, discard=400, steps=40, exponents=n) for n in (0, 1))
    assert early.motion != ("2T", "2T")
    assert settled.motion == ("2T", "2T")
    assert any("2 of 2 runs settled for up to" in note for note in settled.warnings)


def test_runs_whose_transient_outlasts_the_settling_are_warned_about() -> None:
    def orbit(exponent: float, settled: int) -> Any:
        return SimpleNamespace(growth=np.full((40, 1), exponent), settled=settled, jumped=False)

    def warned(kind: str, exponent: float, settled: int) -> bool:
        sentences = notes([], [None], [""], [kind], 300, {(0, 0): orbit(exponent, settled)})
        return any("1 of 1 runs with 2T or longer have a transient that outlasts" in text for text in sentences)

    # exp(-2) and exp(-4) of the initial deviation are left.
    assert warned("2T", -0.005, 400)
    assert not warned("2T", -0.005, 800)
    assert not warned("1T", -0.005, 400)


def test_scatter_is_no_period() -> None:
    draw = np.random.default_rng(2).uniform(-1.0, 1.0, (200, 1))
    assert period_of(1.03e-8 * draw, np.array([1e-6])) == 0  # 2.06 % of the peak to peak, in no order
    assert period_of(0.9e-8 * draw, np.array([1e-6])) == 1
    assert period_of(2.4e-8 * np.tile(draw[:5], (40, 1)), np.array([1e-6])) == 5


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"seed": -1}, "seed: got -1, expected 0 or more"),
        ({"discard": -1}, "discard: got -1, expected 0 to"),
        ({"throw": float("nan")}, "throw: got nan"),
    ],
)
def test_requests_that_make_no_sense_are_refused(request_: dict[str, float], words: str) -> None:
    with pytest.raises(AnalysisError, match=words):
        rg.sweep(rg.load(PAIR), {"operation.speed": "3000 rpm"}, **request_)  # type: ignore[arg-type]


def test_too_many_points_and_odd_digits_are_refused_before_memory_ends() -> None:
    with pytest.raises(AnalysisError, match="99999999999 points are too many"):
        axis_of("operation.speed", "1 rpm:2 rpm:99999999999")
    with pytest.raises(AnalysisError, match="FROM:TO:COUNT"):
        axis_of("operation.speed", "1 rpm:2 rpm:²")
    with pytest.raises(AnalysisError, match="'²' is no place in a list of 3"):
        number_places({"a": [1.0, 2.0, 3.0]}, "a.²")


def test_a_folder_in_place_of_the_result_is_refused_before_the_sweep(tmp_path: Path) -> None:
    with pytest.raises(RotorgearError, match="it is a folder"):
        rg.sweep(rg.load(PAIR), {"operation.speed": "3000 rpm"}, stream=rg.stream(tmp_path))
    assert not Path(f"{tmp_path}.parts").exists()
