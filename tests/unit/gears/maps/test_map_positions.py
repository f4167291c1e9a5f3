"""Positions of a contact map and the curves between them."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.gears.maps.map_positions import MapPositions

LOADS = 5
WORKING = 3


def shapes(u: np.ndarray) -> np.ndarray:
    """Approach (n, 5) that rises with the load by a share that changes over the cycle."""
    angle = 2.0 * np.pi * u[:, None]
    load = np.arange(LOADS)
    return np.cos(angle) + load * (2.0 + np.sin(angle) + 0.5 * np.cos(2.0 * angle))


def error(count: int, load: int) -> float:
    """Largest error of one load's curve from so many positions of a base pitch without kinks."""
    u = np.arange(count) / count
    zero = np.zeros(count, bool)
    values = shapes(u)
    even, approach, compliance, moment = MapPositions(u, zero).kept(values, values + 5.0, values, WORKING)
    np.testing.assert_allclose(compliance[:, load], approach[:, load] + 5.0, atol=20.0 / count**2)
    np.testing.assert_allclose(moment[:, load], approach[:, load], atol=20.0 / count**2)
    return float(np.abs(approach[:, load] - shapes(even)[:, load]).max())


@pytest.mark.parametrize("load", range(LOADS))
def test_curves_of_all_loads_converge_as_cubics(load: int) -> None:
    """Slopes are those of parabolas: of order 3, where straight lines have order 2."""
    assert error(32, load) / error(64, load) == pytest.approx(8.0, rel=0.25)


def test_approach_rises_with_the_load_beside_a_steep_change() -> None:
    u = np.arange(16) / 16
    values = np.column_stack([np.zeros(16), np.where(u < 0.5, 1e-3, 1.0), np.where(u < 0.5, 2e-3, 1.0 + 1e-3)])
    approach = MapPositions(u, np.zeros(16, bool)).kept(values, np.ones((16, 3)), values, 1)[1]
    assert np.diff(approach, axis=1).min() > 0.0


def test_beside_kinks_other_loads_stay_straight() -> None:
    """Their own kinks lie elsewhere, and a cubic would swing there."""
    u = np.arange(16) / 16
    values = np.column_stack([np.zeros(16), 1.0 + u * 0.0, 2.0 + np.maximum(u - 0.3, 0.0)])
    event = np.zeros(16, bool)
    event[4] = True
    even, approach, _, _ = MapPositions(u, event).kept(values, values + 1.0, values, 1)
    np.testing.assert_allclose(approach[:, 2], np.interp(even, u, values[:, 2], period=1.0), rtol=1e-12)
