"""The parameters of a sweep: addresses in the model file, their values, and the model at each point."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from math import prod
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.model.parts.old_names import current_address
from rotorgear.quantity import nearest

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

    A value is a number with its unit; a unit that stands with one value only serves them all.

    Raises:
        AnalysisError: no numbers, two units, or fewer than one value.
    """
    address = current_address(address)
    if isinstance(values, str) and ":" in values:
        parts = values.split(":")
        if len(parts) != 3 or not parts[2].strip().isdecimal() or int(parts[2]) < 2:
            raise AnalysisError(
                f"over {address}: got '{values}', expected FROM:TO:COUNT such as '3000 rpm:6000 rpm:31'"
            )
        ends, unit = _numbers(address, parts[:2])
        _refuse_many(int(parts[2]))
        return Axis(address, tuple(float(x) for x in np.linspace(ends[0], ends[1], int(parts[2]))), unit)
    listed = values.split(",") if isinstance(values, str) else list(values)
    numbers, unit = _numbers(address, listed)
    if not numbers:
        raise AnalysisError(f"over {address}: expected at least one value")
    return Axis(address, tuple(numbers), unit)


def axis_of_option(text: str) -> Axis:
    """Return an axis from an option's text, "ADDRESS=VALUES"."""
    address, sign, values = text.partition("=")
    if not sign or not address.strip() or not values.strip():
        raise AnalysisError(
            f"over: got '{text}', expected ADDRESS=FROM:TO:COUNT or ADDRESS=VALUE,VALUE,... such as "
            "'operation.speed=3000 rpm:6000 rpm:31'"
        )
    return axis_of(address.strip(), values.strip())


def number_in(axis: Axis, value: float | str, what: str) -> float:
    """A number, or a text with one and at most the unit of an axis; AnalysisError about `what` for anything else."""
    match = _NUMBER.match(str(value))
    if not match or match[2] not in ("", axis.unit):
        raise AnalysisError(f"{what}: got '{value}', expected a number {f'in {axis.unit}' if axis.unit else 'in SI'}")
    return float(match[1])


def _numbers(address: str, texts: Sequence[float | str]) -> tuple[list[float], str]:
    numbers = []
    units = []
    for text in texts:
        match = _NUMBER.match(text) if isinstance(text, str) else None
        if isinstance(text, str) and match is None:
            raise AnalysisError(f"over {address}: got '{text}', expected a number with its unit")
        numbers.append(float(match[1]) if match else float(text))
        if match and match[2]:
            units.append(match[2])
    if len(set(units)) > 1:
        raise AnalysisError(f"over {address}: got the units {', '.join(sorted(set(units)))}, expected one")
    return numbers, units[0] if units else ""


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


class Family:
    """A model whose parameters at some addresses change."""

    def __init__(self, model: Model, axes: Sequence[Axis]) -> None:
        self._data: dict[str, Any] = json.loads(model.model_dump_json(exclude_none=True))
        self._axes = axes
        self._places = [places_of(self._data, axis.address) for axis in axes]

    def at(self, values: Sequence[float]) -> Model:
        """Return the model at a point.

        Raises:
            ModelError: it does not pass the checks.
        """
        data: dict[str, Any] = json.loads(json.dumps(self._data))
        for axis, places, value in zip(self._axes, self._places, values, strict=True):
            for place in places:
                owner: Any = data
                for key in place[:-1]:
                    owner = owner[key]
                owner[place[-1]] = _as_before(owner, place[-1], axis.text(value))
        return Model(**data)


def _as_before(owner: Any, key: Any, value: float | str) -> float | str:
    """A value, as a whole number where one stands: teeth, harmonics."""
    old = owner[key] if isinstance(owner, list) else owner.get(key)
    whole = isinstance(old, int) and isinstance(value, float) and value.is_integer()
    return int(value) if whole else value


def places_of(data: dict[str, Any], address: str) -> list[tuple[str | int, ...]]:
    """Where an address leads; a part "*" stands for all names there.

    Raises:
        AnalysisError: it leads nowhere, or to no number.
    """
    found: list[tuple[str | int, ...]] = [()]
    parts = address.split(".")
    for depth, part in enumerate(parts):
        longer: list[tuple[str | int, ...]] = []
        for place in found:
            longer += [(*place, key) for key in _keys(_value(data, place), part, address, last=depth == len(parts) - 1)]
        found = longer
    for place in found:
        value = _value(data, place[:-1])
        if isinstance(value, dict) and isinstance(value.get(place[-1]), dict | list):
            raise AnalysisError(f"over {address}: it is a table, expected the address of a number")
    if not found:
        raise AnalysisError(f"over {address}: the model has nothing there")
    return found


def _value(data: Any, place: tuple[str | int, ...]) -> Any:
    for key in place:
        data = data[key]
    return data


def _keys(value: Any, part: str, address: str, *, last: bool) -> list[str | int]:
    """Keys of a table, or places of a list, that a part of an address means."""
    if isinstance(value, list):
        if part == "*":
            return list(range(len(value)))
        if part.isdecimal() and int(part) < len(value):
            return [int(part)]
        raise AnalysisError(f"over {address}: '{part}' is no place in a list of {len(value)} (the first is 0)")
    if isinstance(value, dict):
        if part == "*":
            return list(value)
        if part in value or last:  # a key with its default may be missing; the checks of the model know all names
            return [part]
        guess = nearest(part, list(value))
        hint = f"did you mean '{guess}'?" if guess else "there are " + (", ".join(value) or "none")
        raise AnalysisError(f"over {address}: the model has no '{part}' there; {hint}")
    raise AnalysisError(f"over {address}: nothing lies below a number")
