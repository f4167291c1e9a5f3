"""Bearings whose stiffness and damping stand in a table: straight between its rows, at the speed of their own shaft."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.model.layout.spring import Spring, constant_spring, given_spring
from rotorgear.model.parts.supports import Bearing

ROWS = [
    {"speed": 100.0, "stiffness": {"x": 1e8, "y": 3e8, "xy": 2e7, "yx": -4e7}, "damping": {"x": 100.0, "y": 700.0}},
    {"speed": 300.0, "stiffness": {"x": 2e8, "y": 1e8, "xy": -1e7, "yx": 5e6}, "damping": {"x": 300.0, "y": 500.0}},
    {"speed": 350.0, "stiffness": {"x": 9e8, "y": 4e8}, "damping": {"x": 50.0}},
]


@pytest.fixture
def spring() -> Spring:
    return given_spring(Bearing(shaft="a", at=0.0, table=ROWS))


@pytest.mark.parametrize(
    ("speed", "row", "share"),
    [(100.0, 0, 0.0), (150.0, 0, 0.25), (300.0, 0, 1.0), (320.0, 1, 0.4), (350.0, 1, 1.0), (350.0 + 1e-11, 1, 1.0)],
)
def test_between_two_rows_stiffness_and_damping_are_straight(
    spring: Spring, speed: float, row: int, share: float
) -> None:
    K, C = spring.at(speed, "bearings.a")
    below, above = ROWS[row], ROWS[row + 1]
    for found, key in ((K, "stiffness"), (C, "damping")):
        for (i, j), name in {(0, 0): "x", (1, 1): "y", (0, 1): "xy", (1, 0): "yx"}.items():
            a, b = (part[key].get(name, 0.0) for part in (below, above))  # type: ignore[attr-defined]
            assert found[i, j] == pytest.approx(a + share * (b - a), rel=1e-9, abs=1e-3)
    assert spring.varies


@pytest.mark.parametrize("speed", [99.0, 351.0])
def test_beyond_its_rows_a_table_says_nothing(spring: Spring, speed: float) -> None:
    with pytest.raises(AnalysisError, match=r"bearings.a: its shaft turns at .* covers 954\.93 to 3342\.25 rpm"):
        spring.at(speed, "bearings.a")


def test_a_pair_without_rows_holds_at_all_speeds() -> None:
    K, C = np.diag(np.arange(1.0, 7.0)), 2.0 * np.eye(6)
    spring = constant_spring(K, C)
    assert not spring.varies
    for speed in (0.0, 1e4):
        found = spring.at(speed, "bearings.a")
        assert np.array_equal(found[0], K)
        assert np.array_equal(found[1], C)
