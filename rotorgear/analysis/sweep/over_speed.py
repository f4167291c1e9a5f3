"""Points of a sweep that differ in the speed alone, made ready without a model of each.

Both ends of the speeds are checked as whole models. What the checks say of a speed are limits of its size, so that they hold
between two ends of one sense, too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from rotorgear.analysis.sweep.axes import Axis
from rotorgear.analysis.sweep.point import Point, PointMaker
from rotorgear.analysis.sweep.reduce import Large
from rotorgear.errors import RotorgearError
from rotorgear.model.model import Model, hashes_over_operation

_SPEED = "operation.speed"
Change = Callable[[Model, tuple[float, ...]], Model]


class OverSpeed:
    """Hash and point at each value of the axes, with one model for all speeds where only the rotation goes with them.

    Args:
        model: of the sweep. axes: its parameters. change: gives the model at a point.
        maker: makes models ready.
    """

    def __init__(self, model: Model, axes: Sequence[Axis], change: Change, maker: PointMaker) -> None:
        self._model = model
        self._axis = next((k for k, axis in enumerate(axes) if axis.address == _SPEED), None)
        self._texts = axes[self._axis].text if self._axis is not None else None
        speeds = axes[self._axis].values if self._axis is not None else ()
        # Two points are their own ends.
        self._ends = (min(speeds), max(speeds)) if len(speeds) > 2 and min(speeds) * max(speeds) > 0.0 else ()
        self._change = change
        self._maker = maker
        # By the values of the other axis.
        self._known: dict[tuple[float, ...], _Speeds | None] = {}

    def __call__(self, values: tuple[float, ...]) -> tuple[str, Callable[[], Point | Large]] | None:
        """Hash of the model at the values of the axes, and what makes the point ready; None where it needs a model of its own."""
        if self._axis is None or self._texts is None or not self._ends:
            return None
        other = values[: self._axis] + values[self._axis + 1 :]
        if other not in self._known:
            self._known[other] = self._between_ends(values)
        known = self._known[other]
        return None if known is None else known.at(self._texts(values[self._axis]))

    def _between_ends(self, values: tuple[float, ...]) -> _Speeds | None:
        """What the speeds beside some values of the other axis share; None where one of the ends fails, or each is its own."""
        k = self._axis
        assert k is not None
        try:
            for end in self._ends:
                self._change(self._model, (*values[:k], end, *values[k + 1 :]))
            first = self._change(self._model, values)
        except RotorgearError:
            return None
        if first.carriers or not self._maker.is_one_over_speed(first):
            return None
        return _Speeds(first, self._maker)


class _Speeds:
    """The points of one model at any speed."""

    def __init__(self, model: Model, maker: PointMaker) -> None:
        assert model.operation is not None
        self._operation = model.operation.model_dump(mode="json", exclude_none=True)
        self._kind = type(model.operation)
        self._hash = hashes_over_operation(model)
        self._made = maker.over_speed(model)

    def at(self, speed: float | str) -> tuple[str, Callable[[], Point | Large]]:
        """Hash at a speed as the model file gives it, and what makes the point ready."""
        operation = self._kind(**{**self._operation, "speed": speed})
        assert operation.speed is not None
        return self._hash(operation), partial(self._made, operation.speed)
