"""Undamped modes that a system keeps from one speed to the next: the same numbers, found once, kept while the system lives."""

from __future__ import annotations

import gc
import tomllib
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.modal import problem
from rotorgear.system.system import System

MODELS = Path(__file__).resolve().parents[3] / "models"
SPEEDS = (100.0, 160.0)


@pytest.fixture
def searches(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """One entry, the number of dofs, for each search for undamped modes."""
    found: list[int] = []

    def counting(M, K, **wanted):
        found.append(M.shape[0])
        return lowest(M, K, **wanted)

    lowest = problem.lowest_modes
    monkeypatch.setattr(problem, "lowest_modes", counting)
    return found


def test_modes_at_another_speed_search_for_no_undamped_ones_and_are_the_same(searches):
    model = rg.load(MODELS / "geared_pair.toml")
    system = System(model, 4)
    kept = [rg.modal(system, speed=speed, modes=10, error_estimate=False) for speed in SPEEDS]
    assert len(searches) == 1
    anew = [rg.modal(System(model, 4), speed=speed, modes=10, error_estimate=False) for speed in SPEEDS]
    assert len(searches) == 3
    for ours, theirs in zip(kept, anew, strict=True):
        np.testing.assert_array_equal(ours.eigenvalues, theirs.eigenvalues)
        np.testing.assert_array_equal(ours.shapes, theirs.shapes)


def test_another_number_of_modes_is_another_request(searches):
    system = System(rg.load(MODELS / "geared_pair.toml"), 4)
    few = rg.modal(system, speed=SPEEDS[0], modes=6, error_estimate=False)
    more = rg.modal(system, speed=SPEEDS[0], modes=10, error_estimate=False)
    assert len(searches) == 2
    np.testing.assert_allclose(few.eigenvalues, more.eigenvalues[:6], rtol=1e-9, atol=1e-6)


def test_a_stiffness_that_depends_on_speed_keeps_nothing(searches):
    data = tomllib.loads((MODELS / "geared_pair.toml").read_text())
    left = data["bearings"]["rotor_1_left"]
    del left["stiffness"], left["damping"]
    left["table"] = [
        {"speed": speed, "stiffness": {"radial": stiffness}} for speed, stiffness in ((50.0, 1.8e8), (200.0, 2.4e8))
    ]
    system = System(rg.Model(**data), 4)
    first, second = (rg.modal(system, speed=speed, modes=10, error_estimate=False) for speed in SPEEDS)
    assert len(searches) == 2
    assert second.frequency_hz[1] != pytest.approx(first.frequency_hz[1], rel=1e-4)


def test_the_modes_go_with_their_system():
    system = System(rg.load(MODELS / "geared_pair.toml"), 2)
    rg.modal(system, speed=SPEEDS[0], modes=6, error_estimate=False)
    assert system in problem._kept
    before = len(problem._kept)
    del system
    gc.collect()
    assert len(problem._kept) < before


def test_a_highest_frequency_below_all_modes_finds_none():
    found = rg.modal(rg.load(MODELS / "jeffcott.toml"), fmax=5.0, speed=100.0, elements=16)
    assert not np.any(found.frequency_hz[~found.rigid] > 0.0)
