"""The parameters of a sweep: addresses in the model file, their values, and the model at each point."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from math import prod
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError, ModelError
from rotorgear.files.numbers import is_count
from rotorgear.model.address import Place, changed, places_of, tables_of, value_at
from rotorgear.model.model import Model

MOST_POINTS = 100_000
_NUMBER = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(.*?)\s*\Z")


@dataclass(frozen=True)
class Axis:
    """An address, values (v,) and their unit ("" for SI)."""

    address: str
    values: tuple[float, ...]
    unit: str

    def text(self, value: float) -> float | str:
        """A value as the model file takes it."""
        return f"{value!r} {self.unit}" if self.unit else value


def axis_of(address: str, values: str | Sequence[float | str]) -> Axis:
    """Return an axis from a text "FROM:TO:COUNT", a text of values with commas, or a sequence of numbers or texts.

    A value is a number with its unit; a unit that one value alone has is that of all.

    Raises:
        AnalysisError: no numbers, two units, or fewer than one value.
    """
    if isinstance(values, str) and ":" in values:
        parts = values.split(":")
        if len(parts) != 3 or not is_count(parts[2].strip()) or int(parts[2]) < 2:
            raise AnalysisError(
                f"over {address}: got '{values}', expected FROM:TO:COUNT such as '3000 rpm:6000 rpm:31'"
            )
        ends, unit = _numbers(address, parts[:2])
        _refuse_many(int(parts[2]))
        return Axis(address, tuple(np.linspace(ends[0], ends[1], int(parts[2])).tolist()), unit)
    listed = values.split(",") if isinstance(values, str) else list(values)
    numbers, unit = _numbers(address, listed)
    if not numbers:
        raise AnalysisError(f"over {address}: expected at least one value")
    return Axis(address, tuple(numbers), unit)


def number_in(axis: Axis, value: float | str, what: str) -> float:
    """A number, or a text with one and at most the unit of an axis; AnalysisError about `what` for anything else."""
    match = _NUMBER.match(str(value))
    if not match or match[2] not in ("", axis.unit):
        raise AnalysisError(f"{what}: got '{value}', expected a number {f'in {axis.unit}' if axis.unit else 'in SI'}")
    return float(match[1])


def _numbers(address: str, texts: Sequence[float | str]) -> tuple[list[float], str]:
    numbers = []
    units = set()
    for text in texts:
        match = _NUMBER.match(text) if isinstance(text, str) else None
        if isinstance(text, str) and match is None:
            raise AnalysisError(f"over {address}: got '{text}', expected a number with its unit")
        numbers.append(float(match[1] if match else text))
        units |= {match[2]} if match else set()
    units -= {""}
    if len(units) > 1:
        raise AnalysisError(f"over {address}: got the units {', '.join(sorted(units))}, expected one")
    return numbers, units.pop() if units else ""


def points_of(axes: Sequence[Axis]) -> list[tuple[float, ...]]:
    """All points: the last axis runs fastest.

    Raises:
        AnalysisError: none or more than two axes, one address twice, or too many points.
    """
    if not 1 <= len(axes) <= 2:
        raise AnalysisError(f"over: got {len(axes)} parameters, expected one or two")
    if len({axis.address for axis in axes}) < len(axes):
        raise AnalysisError(f"over: '{axes[0].address}' is given twice")
    _refuse_many(prod(len(axis.values) for axis in axes))
    return list(product(*(axis.values for axis in axes)))


def _refuse_many(count: int) -> None:
    if count > MOST_POINTS:
        raise AnalysisError(f"over: {count} points are too many (at most {MOST_POINTS})")


def along(model: Model, axes: Sequence[Axis]) -> Callable[[Model, tuple[float, ...]], Model]:
    """What gives the model at a point from the model and the values there; ModelError where it does not pass the checks."""
    data = tables_of(model)
    places = [number_places(data, axis.address) for axis in axes]

    def change(_: Model, values: tuple[float, ...]) -> Model:
        texts = [axis.text(value) for axis, value in zip(axes, values, strict=True)]
        return Model(**changed(data, zip(places, texts, strict=True)))

    return change


def number_places(data: dict[str, Any], address: str) -> list[Place]:
    """Where the address of a number leads.

    Raises:
        AnalysisError: it leads nowhere, or to a table.
    """
    try:
        places = places_of(data, address)
    except ModelError as error:
        problem = error.problems[0]
        raise AnalysisError(
            f"over {address}: {problem.expected}{f'; {problem.hint}' if problem.hint else ''}"
        ) from None
    for place in places:
        owner = value_at(data, place[:-1])
        if isinstance(owner, dict) and isinstance(owner.get(place[-1]), dict | list):
            raise AnalysisError(f"over {address}: it is a table, expected the address of a number")
    return places
