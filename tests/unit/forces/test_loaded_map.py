"""The inverted map of many positions: made by blocks, with memory that its rows alone set."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.forces import loaded_map
from rotorgear.forces.loaded_map import FORCE, NODE, inverted
from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.system.local import teeth_law


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


def test_the_curve_between_loads_is_that_of_the_slopes_that_are_given() -> None:
    """Hermite's cubics are exact for delta = t + a F - b F^2, whose inverse is a square root; monotone ones are not."""
    load = np.array([0.0, 400.0, 900.0, 2000.0])
    touch = np.array([[1e-6], [-2e-6], [3e-6]])
    a = np.array([[2e-9], [3e-9], [2.5e-9]])
    b = 4e-13
    approach = (touch + a * load - b * load**2)[None]
    slope = (a - 2.0 * b * load)[None]
    spacing, rows = inverted(load, approach, np.zeros(0), slope=slope)
    x = spacing * np.arange(loaded_map.STEPS + 1)
    _, monotone = inverted(load, approach, np.zeros(0))
    for k in range(3):
        inside = x < a[k] * load[-1] - b * load[-1] ** 2
        exact = (a[k] - np.sqrt(a[k] ** 2 - 4.0 * b * x[inside])) / (2.0 * b)
        force = rows[k, 1 + FORCE :: NODE][inside]
        assert force == pytest.approx(exact, abs=1e-6 * load[-1])
        assert np.abs(monotone[k, 1 + FORCE :: NODE][inside] - exact).max() > 1e-4 * load[-1]


def test_a_large_map_keeps_no_loads_between_and_has_the_same_curves(monkeypatch: pytest.MonkeyPatch) -> None:
    u = np.arange(16) / 16
    load = np.concatenate([[0.0], np.geomspace(1.0, 5000.0, 40)])
    soft = (1.0 + 0.2 * np.cos(2.0 * np.pi * u))[:, None] / 3e8
    teeth_map = ContactMap(
        u, 1, load, 2e-6 * np.sin(2.0 * np.pi * u)[:, None] + soft * load + 1e-6 * (load / 1e3) ** 0.7
    )
    usual = teeth_law(teeth_map, 3e8, 1e-6)
    monkeypatch.setattr(loaded_map, "_LARGE", 0.0)
    large = teeth_law(teeth_map, 3e8, 1e-6)
    assert large.approach.size < usual.approach.size / 7
    for one, other in zip(large.inverse, usual.inverse, strict=True):
        assert one == pytest.approx(other, rel=2e-3, abs=1e-3 * np.abs(other).max())
    force = [law.inverse[1][:, 1 + FORCE :: NODE] for law in (large, usual)]
    assert force[0] == pytest.approx(force[1], abs=1e-4 * load[-1])
    assert large.mean().slope == pytest.approx(teeth_map.slopes.mean(axis=0)[None])
