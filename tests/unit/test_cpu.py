"""Run times are CPU seconds: of threads and of workers, not of waiting, with compilation apart."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from typing import Any

import pytest

import rotorgear as rg
from rotorgear.analysis.common.pool import in_order
from rotorgear.cpu import Clock, cpu_seconds
from tests.overhung import overhung_disk
from tests.paths import MODELS


def burn(seconds: float) -> float:
    """Work for so many CPU seconds."""
    begun = time.thread_time()
    while time.thread_time() - begun < seconds:
        pass
    return seconds


def test_waiting_takes_no_seconds() -> None:
    clock = Clock()
    time.sleep(0.3)
    clock.lap("waiting")
    assert clock.total()["total"] < 0.1


@pytest.mark.parametrize("analysis", [rg.modal, rg.critical])
def test_an_analysis_whose_listener_waits_states_the_seconds_of_the_processor(analysis: Callable[..., Any]) -> None:
    heard = []

    def progress(fraction: float, step: str) -> None:
        heard.append(step)
        if len(heard) == 1:
            time.sleep(1.5)

    options = {"stop": "9000 rpm"} if analysis is rg.critical else {}
    begun = cpu_seconds()
    result = analysis(overhung_disk(), progress=progress, **options)
    assert heard
    assert result.seconds["total"] <= cpu_seconds() - begun


def test_seconds_of_other_processes_join_the_clock_and_those_of_threads_are_not_counted_twice() -> None:
    clock = Clock()
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert list(in_order(burn, [(0.2,), (0.2,)], None, pool)) == [0.2, 0.2]
    clock.lap("processes")
    assert list(in_order(burn, [(0.2,), (0.2,)], 2, None)) == [0.2, 0.2]
    clock.lap("threads")
    assert clock.laps["processes"] >= 0.4
    assert 0.4 <= clock.laps["threads"] < 0.7


def test_compilation_is_a_step_of_its_own() -> None:
    import numba

    from rotorgear.solvers.time import compiled

    assert compiled
    clock = Clock()
    burn(0.05)
    assert numba.njit(lambda x: x * x + 1.0)(3.0) == 10.0
    clock.lap("work")
    burn(0.05)
    clock.lap("work")
    assert clock.laps["compilation"] > 0.01
    assert 0.1 <= clock.laps["work"] < 0.1 + clock.laps["compilation"] + 0.2
    assert sum(clock.laps.values()) == pytest.approx(clock.total()["total"])


def test_no_printed_run_time_holds_compilation() -> None:
    found = rg.static(rg.load(MODELS / "split_torque.toml"))
    slow = replace(found, seconds={"work": 1.25, "compilation": 24.5, "total": 25.75})
    assert slow.cost == "1.25 CPU s (and 24.50 of compilation, once)"
