"""What work will take, from its first pieces; blocks of a sweep begin all over its range; the command says it in one line."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.common.forecast import Forecast
from rotorgear.analysis.sweep.blocks import Job, blocks
from rotorgear.cli.console import progress_bar
from rotorgear.progress import foretell, hearing_forecasts
from validation.studies.dead_zone import DeadZone

Told = list[tuple[str, float, str]]


def heard_of(pieces: int, seconds: list[float]) -> Told:
    """What is told of pieces of these CPU seconds."""
    told: Told = []
    with hearing_forecasts(lambda *said: told.append(said)):
        forecast = Forecast("sweep", 7.0, pieces)
        for each in seconds:
            forecast.add(each)
    return told


@pytest.mark.parametrize(("pieces", "first"), [(4, [2.0]), (8, [1.0, 3.0]), (200, [1.0, 2.0, 3.0])])
def test_a_forecast_is_the_mean_of_the_first_pieces_times_their_number_told_once(
    pieces: int, first: list[float]
) -> None:
    assert heard_of(pieces, first[:-1]) == []
    assert heard_of(pieces, [*first, 50.0, 50.0]) == [("sweep", pytest.approx(7.0 + 2.0 * pieces), "in all")]


def test_few_pieces_are_measured_by_whoever_does_them_and_told_once() -> None:
    assert heard_of(3, [1.0, 1.0, 1.0]) == []
    forecast = Forecast("sweep", 7.0, 3)
    assert forecast.few
    assert not Forecast("sweep", 7.0, 4).few
    told: Told = []
    with hearing_forecasts(lambda *said: told.append(said)):
        forecast.tell(20.0, "for all of it")
        forecast.tell(30.0)
    assert told == [("sweep", 27.0, "for all of it")]


def test_work_that_tells_its_progress_is_measured_from_its_first_word_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that goes on at 60 % with 2 s for each per cent, after 3 s on its own: 40 times 2 s are left."""
    clock = iter([100.0, 102.0, 108.0, 110.0])
    monkeypatch.setattr("rotorgear.analysis.common.forecast.cpu_seconds", lambda: next(clock))
    told: Told = []
    steps: list[float] = []
    with hearing_forecasts(lambda *said: told.append(said)):
        measuring = Forecast("transient", 3.0).measuring(lambda fraction, step: steps.append(fraction))
        for fraction in (0.60, 0.61, 0.64, 0.65):
            measuring(fraction, "step")
    assert steps == [0.60, 0.61, 0.64, 0.65]
    assert told == [("transient", pytest.approx(3.0 + 40.0 * 2.0), "in all")]


@pytest.mark.parametrize("what", ["transient", "response", "campbell"])
def test_analyses_of_many_pieces_tell_what_they_take(what: str) -> None:
    unbalance = {"shaft": "rotor", "at": "0.3 m", "magnitude": "1 kg mm"}
    model = rg.load("models/jeffcott.toml").with_("unbalances.u", unbalance)
    run = {
        "transient": lambda: rg.transient(model, time=2.0, discard=0.0, steps=400, error_estimate=False),
        "response": lambda: rg.response(model, points=60, method="direct", elements=1),
        "campbell": lambda: rg.campbell(model, points=60, modes=4, elements=1),
    }[what]
    told: Told = []
    with hearing_forecasts(lambda *said: told.append(said)):
        run()
    assert [what for what, seconds, _ in told if what != "compiling, once" and seconds > 0.0] == [what]


def test_the_first_blocks_of_a_sweep_are_from_all_over_its_range(monkeypatch: pytest.MonkeyPatch) -> None:
    one: Any = type("Point", (), {"kind": "pair"})()
    monkeypatch.setattr("rotorgear.analysis.sweep.blocks._width", lambda points, steps: 5)
    jobs = [Job(number, 0) for number in range(80)]
    found = blocks(jobs, [one] * 80, np.full(80, 200))
    assert sorted(job.point for block in found for job in block) == list(range(80))
    assert all(block[-1].point - block[0].point == 4 for block in found)
    assert [block[0].point // 20 for block in found[:4]] == [0, 2, 1, 3]


def test_orbits_tell_what_the_first_branch_will_take_before_half_of_it_is_there() -> None:
    steps: list[str] = []
    told: list[tuple[str, float, str, int]] = []
    with hearing_forecasts(lambda *said: told.append((*said, len(steps)))):
        case = DeadZone(amplitude=0.05)
        ends = [case.speed(W) for W in (1.1, 1.3)]
        over = {"operation.speed": ends}
        found = rg.orbits(rg.loads(case.text()), over, step=0.1, progress=lambda fraction, text: steps.append(text))
    # On an empty cache the compilation is told first.
    (seconds, more, at), *again = [said for what, *said in told if what == "orbits"]
    assert not again
    assert seconds > 0.0
    assert more.startswith("for the first branch, up to ")
    # Beside the points steps are told at the begin.
    assert at < 0.6 * len(found.value)


def test_the_command_writes_a_long_forecast_in_one_line_and_a_short_one_not(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_bar("sweep"):
        foretell("sweep", 9.0)
        foretell("sweep", 1234.5, "in all, up to 8 times as long where motions do not settle")
        foretell("sweep", 4321.0)
    with progress_bar("report", lines=True):
        foretell("critical map", 18.2)
    foretell("sweep", 99.0)
    written = capsys.readouterr()
    assert written.out == ""
    assert written.err.splitlines() == [
        "sweep: about 1200 CPU s in all, up to 8 times as long where motions do not settle",
        "report: critical map, about 18 CPU s in all",
    ]
