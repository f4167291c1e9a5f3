"""Positions of a contact map and the curves between them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rotorgear.gears.geometry.flank import FlankModification
from rotorgear.gears.maps.map_positions import MapPositions, errors_by_period, families, load_groups

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


@pytest.mark.parametrize("near", [True, False])
def test_loads_of_helical_pairs_are_three_times_as_close_about_the_working_one(near: bool) -> None:
    spur_problem: Any = SimpleNamespace(one_slice=False, oblique=False)
    helical_problem: Any = SimpleNamespace(one_slice=False, oblique=True)
    coarse, fine = load_groups(spur_problem, near), load_groups(helical_problem, near)
    flat = [0.0, *(load for group in coarse for load in group)]
    assert flat[1:] == sorted(flat[1:])
    expected = []
    for group in coarse:
        own: list[float] = []
        for load in group:
            before = flat[flat.index(load) - 1]
            if before > 0.2 and load < 2.3:
                own += [before + (load - before) / 3.0, before + (load - before) * 2.0 / 3.0]
            own.append(load)
        expected.append(own)
    assert [list(group) for group in fine] == [pytest.approx(group) for group in expected]
    # Of a spur pair slices are those of loads up to the working one, up to 2.5 times it, and above.
    parts = families(spur_problem, coarse)
    assert [part[-1][-1] for part in parts] == [pytest.approx(end) for end in ((1.0, 2.0) if near else (1.0, 2.2, 5.0))]
    assert tuple(group for part in parts for group in part) == coarse
    assert families(helical_problem, fine) == [fine]


def test_periods_differ_while_a_wrong_tooth_can_touch() -> None:
    """Pairs that can touch lie between the ends of the path, a corner and the whole face farther."""
    line: Any = SimpleNamespace(start=10e-3, end=35e-3, base_pitch=14e-3, base_helix_angle=0.3)
    flanks = (FlankModification(pitch_error=((5, 8e-6),)), FlankModification())
    problem: Any = SimpleNamespace(line=line, width=40e-3, flanks=flanks, teeth=(34, 80))
    found = errors_by_period(problem)
    assert len(found) == 34
    pairs = int(np.ceil((25e-3 + 14e-3 + 40e-3 * np.tan(0.3)) / 14e-3))
    differ = [n for n, row in enumerate(found) if row != found[20]]
    assert differ == [n for n in range(34) if abs((n - 5 + 17) % 34 - 17) <= pairs]
