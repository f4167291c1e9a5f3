"""Points of a sweep between two ends of an axis, made ready without a model of each.

Both ends are checked as whole models. What the checks say of a speed, a torque, a backlash or an amplitude are limits of its
size, so that they hold between two ends of one sense, too. With the speed, the rotation alone goes. The other numbers enter loads
and laws in proportion, while all matrices stay: both ends and the middle are built, and where they lie on no line, or differ in
anything else, each point has a model of its own.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import scipy.sparse as sp
from pydantic import ValidationError

from rotorgear.analysis.sweep.axes import Axis, number_places
from rotorgear.analysis.sweep.point import AtRest, Built, Point, PointMaker, ready, speed_of_all
from rotorgear.analysis.sweep.reduce import Large
from rotorgear.errors import RotorgearError
from rotorgear.model.address import changed, tables_of, value_at
from rotorgear.model.model import Model, hashes_over
from rotorgear.solvers.time.contact_equilibrium import Expanded
from rotorgear.solvers.time.local_system import LocalSystem

_SPEED = "operation.speed"
# Numbers that loads and laws are in proportion to.
_IN_PROPORTION = re.compile(
    r"operation\.torque|loads\.[^.]+\.torque|unbalances\.[^.]+\.magnitude|meshes\.[^.]+\.(backlash|damping)"
    r"|meshes\.[^.]+\.(transmission_error|stiffness_variation)[\[.][0-9*]+\]?\.amplitude"
)
# Points from which on three models, and what they share, are less work than one for each.
_WORTH = 6
# Relative to the larger end, by which the middle may be off the line.
_STRAIGHT = 1e-12

Change = Callable[[Model, tuple[float, ...]], Model]
# Hash of the model at a point, and what makes the point ready.
Known = tuple[str, Callable[[], Point | Large]]


class BetweenEnds:
    """Hash and point at each value of the axes, with what is the same along one of them made once for all its values.

    Args:
        model: of the sweep. axes: its parameters. change: gives the model at a point.
        maker: makes models ready.
    """

    def __init__(self, model: Model, axes: Sequence[Axis], change: Change, maker: PointMaker) -> None:
        self._model = model
        self._change = change
        self._maker = maker
        self._axes = axes
        lengths = {k: len(axis.values) for k, axis in enumerate(axes) if _has_ends(axis)}
        self._axis = max(lengths, key=lambda k: (lengths[k], axes[k].address == _SPEED), default=None)
        # By the values of the other axis.
        self._known: dict[tuple[float, ...], _Speeds | _Line | None] = {}

    def __call__(self, values: tuple[float, ...]) -> Known | None:
        """Hash of the model at the values of the axes, and what makes the point ready; None where it needs a model of its own."""
        k = self._axis
        if k is None:
            return None
        other = values[:k] + values[k + 1 :]
        if other not in self._known:
            self._known[other] = self._along(k, values)
        known = self._known[other]
        return None if known is None else known.at(values[k])

    def _along(self, k: int, values: tuple[float, ...]) -> _Speeds | _Line | None:
        """What the values of an axis beside some of the other one share; None where an end fails, or each is its own."""
        axis = self._axes[k]
        ends = min(axis.values), max(axis.values)
        at = ends if axis.address == _SPEED else (ends[0], 0.5 * (ends[0] + ends[1]), ends[1])
        try:
            models = [self._change(self._model, (*values[:k], value, *values[k + 1 :])) for value in at]
            if models[0].carriers:
                return None
            if axis.address == _SPEED:
                return _Speeds(models[0], axis, self._maker) if self._maker.is_one_over_speed(models[0]) else None
            return _Line.through(models, axis, self._maker)
        except RotorgearError:
            return None


def _has_ends(axis: Axis) -> bool:
    """Whether what lies between the ends of an axis follows from them: numbers of one sign, more of them than their ends."""
    low, high = min(axis.values), max(axis.values)
    if axis.address == _SPEED:
        return len(axis.values) > 2 and low * high > 0.0
    return _IN_PROPORTION.fullmatch(axis.address) is not None and len(axis.values) >= _WORTH and 0.0 <= low < high


class _Speeds:
    """The points of one model at any speed."""

    def __init__(self, model: Model, axis: Axis, maker: PointMaker) -> None:
        self._parts = _Parts(model, axis)
        self._made = maker.over_speed(model)

    def at(self, value: float) -> Known | None:
        """Hash at a value of the axis, and what makes the point ready."""
        hashed, speed = self._parts.at(value)
        return hashed, partial(self._made, speed)


class _Line:
    """The points between two ends of which loads and laws lie on a line, and all else is the same."""

    def __init__(
        self, low: Built, high: LocalSystem, parts: _Parts, ends: tuple[float, float], maker: PointMaker
    ) -> None:
        self._low = low
        self._rise = high.load - low.local.load
        self._laws = [(a, _moving(a, b)) for a, b in zip(low.local.forces.laws, high.forces.laws, strict=True)]
        self._ends = ends
        self._parts = parts
        self._maker = maker
        self._expanded = Expanded(low.local)
        self._first: AtRest | None = None

    @staticmethod
    def through(models: Sequence[Model], axis: Axis, maker: PointMaker) -> _Line | None:
        """The line through models at the lowest value of an axis, in the middle and at the highest; None where there is none.

        Raises:
            RotorgearError: one of them can't be made ready.
        """
        speed = models[0].operating_speed
        if not speed or any(bearing.has_film for bearing in models[0].bearings.values()):
            return None
        at = speed_of_all(models[0]) if maker.is_one_over_speed(models[0]) else speed
        low, middle, high = (maker.built(model, at) for model in models)
        if not _is_line(low, middle, high):
            return None
        maker.left_out.append(low.left_out)
        parts = _Parts(models[0], axis)
        first, last = (parts.at(value)[1] for value in (min(axis.values), max(axis.values)))
        return _Line(replace(low, speed=speed), high.local, parts, (first, last), maker)

    def at(self, value: float) -> Known | None:
        """Hash at a value of the axis, and what makes the point ready; None where the part does not take it."""
        try:
            hashed, number = self._parts.at(value)
        except ValidationError:
            return None
        low, high = self._ends
        return hashed, partial(self._made, (number - low) / (high - low))

    def _made(self, share: float) -> Point | Large:
        """The point at a share of the way from the lowest value to the highest."""
        low = self._low.local
        forces = low.forces.with_numbers_of(tuple(_between(law, moving, share) for law, moving in self._laws))
        local = replace(low, load=low.load + share * self._rise, forces=forces)
        made = self._maker.made(replace(self._low, local=local), self._expanded)
        if isinstance(made, Large):
            return made
        known = made.about(self._first) if self._first else made
        self._first = self._first or known
        return ready(known, self._low.speed, self._low.modal_ratio)


class _Parts:
    """The parts that an axis changes, each made anew at a value as the model file gives it, and the hash with them.

    Args:
        model: without planets. axis: of a number in its parts.
    """

    def __init__(self, model: Model, axis: Axis) -> None:
        self._axis = axis
        data = tables_of(model)
        self._places = number_places(data, axis.address)
        owners = [place[:1] if place[0] == "operation" else place[:2] for place in self._places]
        self._owners = list(dict.fromkeys(tuple(map(str, owner)) for owner in owners))
        self._kinds = [type(_part(model, owner)) for owner in self._owners]
        # The tables of these parts alone.
        self._data: dict[str, Any] = {}
        for table, *name in self._owners:
            own = {name[0]: data[table][name[0]]} if name else data[table]
            self._data[table] = {**self._data.get(table, {}), **own}
        self._hash = hashes_over(model, self._owners)

    def at(self, value: float) -> tuple[str, float]:
        """Hash of the model, and the number in SI, at a value of the axis.

        Raises:
            ValidationError: a part does not take it.
        """
        data = changed(self._data, [(self._places, self._axis.text(value))])
        parts = [kind(**value_at(data, owner)) for kind, owner in zip(self._kinds, self._owners, strict=True)]
        first = self._places[0]
        number: Any = parts[0]
        for key in first[len(self._owners[0]) :]:
            number = number[key] if isinstance(key, int) else getattr(number, key)
        return self._hash(parts), float(number)


def _part(model: Model, place: tuple[str, ...]) -> Any:
    part = getattr(model, place[0])
    return part[place[1]] if len(place) == 2 else part


def _is_line(low: Built, middle: Built, high: Built) -> bool:
    """Whether three systems are the same but for loads and numbers of laws, of which the middle one has the mean of both ends."""
    for one in (middle, high):
        if any(getattr(one, name) != getattr(low, name) for name in ("orders", "contact", "left_out", "is_large")):
            return False
        if not (_same(one, low) and np.array_equal(one.local.watched_vectors, low.local.watched_vectors)):
            return False
        if [type(law) for law in one.local.forces.laws] != [type(law) for law in low.local.forces.laws]:
            return False
        if not np.array_equal(one.local.forces.reference_stiffness, low.local.forces.reference_stiffness):
            return False
    laws = zip(*(one.local.forces.laws for one in (low, middle, high)), strict=True)
    return _straight(low.local.load, middle.local.load, high.local.load) and all(_straight(*three) for three in laws)


def _same(one: Built, other: Built) -> bool:
    def equal(A: sp.csc_array | None, B: sp.csc_array | None) -> bool:
        if A is None or B is None:
            return A is B
        return all(np.array_equal(getattr(A, part), getattr(B, part)) for part in ("indptr", "indices", "data"))

    return all(equal(getattr(one.local, name), getattr(other.local, name)) for name in "MDKBG")


def _straight(low: Any, middle: Any, high: Any) -> bool:
    """Whether numbers, tuples or arrays of them, or laws made of these lie on a line; anything else has to be the same thrice."""
    if is_dataclass(low) and type(low) is type(middle) is type(high):
        return all(_straight(*(getattr(one, item.name) for one in (low, middle, high))) for item in fields(low))
    if isinstance(low, float | tuple | np.ndarray):
        try:
            a, b, c = (np.asarray(value, dtype=float) for value in (low, middle, high))
        except (TypeError, ValueError):  # words, or laws among them
            return _equal(low, middle) and _equal(low, high)
        if not a.shape == b.shape == c.shape:
            return False
        most = np.maximum(np.abs(a), np.abs(c)).max(initial=0.0)
        return bool(np.all((a == c) & (a == b) | (np.abs(0.5 * (a + c) - b) <= _STRAIGHT * most)))
    return _equal(low, middle) and _equal(low, high)


def _equal(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray):
        return np.array_equal(one, other)
    return one is other or bool(one == other)


def _moving(low: Any, high: Any) -> dict[str, tuple[Any, Any]]:
    """The fields of two laws on a line that are not the same."""
    own = {item.name: (getattr(low, item.name), getattr(high, item.name)) for item in fields(low)}
    return {name: (a, b) for name, (a, b) in own.items() if (_moving(a, b) if is_dataclass(a) else not _equal(a, b))}


def _between(low: Any, moving: dict[str, tuple[Any, Any]], share: float) -> Any:
    """A law at a share of the way from one to another, of which some fields differ."""
    return replace(low, **{name: _number_between(a, b, share) for name, (a, b) in moving.items()}) if moving else low


def _number_between(low: Any, high: Any, share: float) -> Any:
    if is_dataclass(low):
        return _between(low, _moving(low, high), share)
    if isinstance(low, tuple):
        return tuple(_number_between(a, b, share) for a, b in zip(low, high, strict=True))
    return low + share * (high - low)
