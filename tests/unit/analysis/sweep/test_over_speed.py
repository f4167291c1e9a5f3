"""Points that differ in the speed alone are those of a model of their own, to the last bit, with the same hash and failures."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.axes import Axis, along, axis_of
from rotorgear.analysis.sweep.over_speed import OverSpeed
from rotorgear.analysis.sweep.point import PointMaker
from rotorgear.analysis.sweep.request import Request
from rotorgear.analysis.sweep.sweep import ready_points
from rotorgear.model.model import Model
from rotorgear.progress import silent
from tests.paths import ROOT

REQUEST = Request("each", 1, 2, 10, 0, 50, 1e-3, 1e-3, 0)
OVERS: list[tuple[str, dict[str, Any]]] = [
    ("backlash_pair", {"operation.speed": "3000 rpm:9000 rpm:7"}),
    ("helical_pair", {"operation.speed": [-310.0, -900.5, -404.7]}),
    ("herringbone_pair_12dof", {"operation.speed": [110.0, 350.0, 777.0], "meshes.*.damping": [10.0, 35.0]}),
    ("backlash_pair", {"operation.torque": [60.0, -1e9, 110.0], "operation.speed": "-3000 rpm:9000 rpm:5"}),
]


def axes_of(over: dict[str, Any]) -> list[Axis]:
    return [axis_of(address, values) for address, values in over.items()]


@pytest.mark.parametrize(("name", "over"), OVERS, ids=["in rpm", "turning back", "two axes", "through zero"])
def test_points_over_speed_are_those_of_their_own_models(name: str, over: dict[str, Any]) -> None:
    model = rg.load(ROOT / "models" / f"{name}.toml")
    axes = axes_of(over)
    texts, points, failure, *_ = ready_points(model, axes, None, REQUEST, silent)
    alone = ready_points(model, axes, along(model, axes), REQUEST, silent)
    assert texts == alone[0]
    assert failure == alone[2]
    for point, other in zip(points, alone[1], strict=True):
        assert (point is None) is (other is None)
        if point is None or other is None:
            continue
        assert (point.order, point.contact, point.shape) == (other.order, other.contact, other.shape)
        for part in ("K", "D", "load", "B", "W", "rigid", "rest", "energy", "fastest"):
            np.testing.assert_array_equal(getattr(point.system, part), getattr(other.system, part))


def test_only_both_ends_of_the_speeds_are_made_as_models() -> None:
    model = rg.load(ROOT / "models" / "backlash_pair.toml")
    axes = axes_of({"operation.speed": "3000 rpm:9000 rpm:9"})
    made: list[float] = []
    change = along(model, axes)

    def counted(of: Model, values: tuple[float, ...]) -> Model:
        made.append(values[0])
        return change(of, values)

    over = OverSpeed(model, axes, counted, PointMaker())
    found = [over((speed,)) for speed in axes[0].values]
    assert all(one is not None for one in found)
    assert made == [3000.0, 9000.0, 3000.0]


def test_speeds_that_films_or_tables_feel_have_models_of_their_own() -> None:
    model = rg.load(ROOT / "models" / "split_torque_journals.toml")
    axes = axes_of({"operation.speed": [1000.0, 1200.0, 1700.0]})
    over = OverSpeed(model, axes, along(model, axes), PointMaker())
    assert over((1200.0,)) is None
