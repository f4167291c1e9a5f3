"""Points that differ in one number alone are those of models of their own, with hash and failures; of the speed to the bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.axes import Axis, along, axis_of
from rotorgear.analysis.sweep.between_ends import BetweenEnds
from rotorgear.analysis.sweep.point import PointMaker, table_of
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


# With how many systems are built: a torque from nothing on makes a step, and an end may be refused.
LINES: list[tuple[str, dict[str, Any], int]] = [
    ("backlash_pair", {"operation.torque": "3 N m:95 N m:9"}, 3),
    ("backlash_pair", {"operation.torque": "0 N m:95 N m:9"}, 12),
    ("backlash_pair", {"meshes.*.backlash": "0 um:90 um:7", "operation.speed": [300.0, 650.0]}, 6),
    ("backlash_pair", {"meshes.pair.transmission_error[0].amplitude": "-1 um:9 um:8"}, 7),
    ("backlash_pair", {"meshes.pair.stiffness_variation.0.amplitude": "0.05:0.4:8"}, 3),
    ("backlash_pair", {"meshes.pair.damping": "5 N s/m:9 N s/m:7"}, 0),
    ("helical_pair", {"meshes.*.backlash": "50 um:90 um:7"}, 3),
]


@pytest.mark.parametrize(("name", "over", "built"), LINES)
def test_points_between_ends_are_those_of_their_own_models(
    name: str, over: dict[str, Any], built: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = rg.load(ROOT / "models" / f"{name}.toml")
    axes = axes_of(over)
    alone = ready_points(model, axes, along(model, axes), REQUEST, silent)
    count = 0
    whole = PointMaker.built

    def counted(maker: PointMaker, own: Model, speed: float) -> Any:
        nonlocal count
        count += 1
        return whole(maker, own, speed)

    monkeypatch.setattr(PointMaker, "built", counted)
    texts, points, failure, *_ = ready_points(model, axes, None, REQUEST, silent)
    assert (texts, failure) == (alone[0], alone[2])
    assert count == built
    for point, other in zip(points, alone[1], strict=True):
        assert (point is None) is (other is None)
        if point is None or other is None:
            continue
        assert (point.kind, point.order, point.drift) == (other.kind, other.order, other.drift)
        np.testing.assert_allclose(point.static_force, other.static_force, rtol=1e-10)
        np.testing.assert_allclose(point.system.columns.values, other.system.columns.values, rtol=1e-12)
        np.testing.assert_allclose(
            table_of(point, 20), table_of(other, 20), rtol=1e-12, atol=1e-15 * abs(table_of(other, 20)).max()
        )
        for part in ("K", "D", "load", "B", "rigid", "rest", "energy", "fastest"):
            near = getattr(other.system, part)
            np.testing.assert_allclose(getattr(point.system, part), near, atol=1e-12 * np.abs(near).max(initial=0.0))


def test_only_both_ends_of_the_speeds_are_made_as_models() -> None:
    model = rg.load(ROOT / "models" / "backlash_pair.toml")
    axes = axes_of({"operation.speed": "3000 rpm:9000 rpm:9"})
    made: list[float] = []
    change = along(model, axes)

    def counted(of: Model, values: tuple[float, ...]) -> Model:
        made.append(values[0])
        return change(of, values)

    over = BetweenEnds(model, axes, counted, PointMaker())
    found = [over((speed,)) for speed in axes[0].values]
    assert all(one is not None for one in found)
    assert made == [3000.0, 9000.0]


def test_speeds_that_films_or_tables_feel_have_models_of_their_own() -> None:
    model = rg.load(ROOT / "models" / "split_torque_journals.toml")
    axes = axes_of({"operation.speed": [1000.0, 1200.0, 1700.0]})
    over = BetweenEnds(model, axes, along(model, axes), PointMaker())
    assert over((1200.0,)) is None
