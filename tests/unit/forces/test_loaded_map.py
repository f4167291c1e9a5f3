"""The inverted map of many positions: made by blocks, with memory that its rows alone set."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.forces import loaded_map
from rotorgear.forces.loaded_map import inverted


def teeth(positions: int, tilts: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Loads, approaches and moments that rise, each position with a touch and a stiffness of its own."""
    rng = np.random.default_rng(positions)
    load = np.concatenate([[0.0], np.cumsum(50.0 + 100.0 * rng.random(30))])
    softness = 1e-9 * (1.0 + 0.3 * rng.random((tilts, positions, 1)))
    approach = 3e-6 * rng.random((1, positions, 1)) + softness * load**0.95
    return load, approach, 1e-3 * load * rng.random((tilts, positions, 1)) if tilts > 1 else np.zeros(0)


@pytest.mark.parametrize("tilts", [1, 3])
def test_blocks_of_positions_change_no_number(tilts: int, monkeypatch: pytest.MonkeyPatch) -> None:
    given = teeth(23, tilts)
    monkeypatch.setattr(loaded_map, "_LARGE", 0.0)
    spacing, whole = inverted(*given)
    monkeypatch.setattr(loaded_map, "_TOGETHER", 5)
    step, parts = inverted(*given)
    assert step == spacing
    assert np.array_equal(parts, whole)


def test_memory_goes_with_the_rows_alone() -> None:
    given = teeth(2000, 1)
    tracemalloc.start()
    try:
        _, rows = inverted(*given)
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    # All positions at once held 3000 loads between for each, in several copies: fifteen times the rows.
    assert most < rows.nbytes + 60e6


def test_a_map_that_is_inverted_among_parameters_is_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    given = teeth(30, 1)
    spacing, rows = inverted(*given)
    monkeypatch.setattr(loaded_map, "_LARGE", 0.0)
    place = np.full(7 + rows.size, np.nan)
    step, _ = inverted(*given, place[7:].reshape(rows.shape))
    assert step == spacing
    assert np.array_equal(place[7:].reshape(rows.shape), rows)


def test_what_no_machine_holds_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loaded_map, "_LARGE", 0.0)
    monkeypatch.setattr("rotorgear.memory.free_memory", lambda: 1e5)
    with pytest.raises(AnalysisError, match=r"over 40 positions in time would take .* GB of memory, and 0\.0001 GB"):
        inverted(*teeth(40, 1))
