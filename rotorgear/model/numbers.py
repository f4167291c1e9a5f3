"""Numbers of a model by address, as coordinates: what they are now, and the model with others in their place.

A plain number is its own coordinate, in SI. A stiffness of several numbers has one factor for all of them, 1 as the file stands.
A place "start" or "end" of a shaft is the z that it means.
"""

from __future__ import annotations

import fnmatch
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotorgear.errors import ModelError, Problem
from rotorgear.model.address import Place, places_of, tables_of, value_at
from rotorgear.model.free_numbers import address_of, given_places, is_number, overlapping, times, whole_number
from rotorgear.model.model import Model
from rotorgear.model.parts.problems import shown
from rotorgear.quantity import DIMENSIONS, QuantityError, parse_quantity


@dataclass(frozen=True)
class Numbers:
    """Numbers of a model.

    Attributes:
        model: with the numbers as they are.
        addresses: of the p numbers.
        start: their coordinates as they are (p,).
        unit: SI unit of each coordinate; "" of a ratio.
        factor: whether the coordinate is a factor of several numbers (p,).
    """

    model: Model
    addresses: tuple[str, ...]
    start: NDArray[np.float64]
    unit: tuple[str, ...]
    factor: NDArray[np.bool_]

    @cached_property
    def _tables(self) -> dict[str, Any]:
        return tables_of(self.model)

    @cached_property
    def _places(self) -> tuple[Place, ...]:
        return tuple(places_of(self._tables, address)[0] for address in self.addresses)

    def at(self, values: NDArray[np.float64]) -> Model:
        """The model with other coordinates (p,).

        Raises:
            ModelError: values that the model can't have.
        """
        copy: dict[str, Any] = json.loads(json.dumps(self._tables))
        for place, value, start, factor in zip(self._places, values, self.start, self.factor, strict=True):
            if value != start:
                owner = value_at(copy, place[:-1])
                owner[place[-1]] = times(owner[place[-1]], float(value)) if factor else float(value)
        return Model(**copy)


def numbers_of(model: Model, free: str | Iterable[str]) -> Numbers:
    """Return the numbers that some addresses name.

    Args:
        model: the model.
        free: addresses such as "bearings.*.stiffness", in a list or with commas between; "*" stands for all names or places
            there.

    Raises:
        ModelError: an address that leads nowhere, or to something that is no number.
    """
    parts = free.split(",") if isinstance(free, str) else free
    patterns = [part.strip() for part in parts if part.strip()]
    if not patterns:
        raise ModelError([Problem("free", "", "addresses of numbers, such as 'bearings.*.stiffness'")])
    tables = tables_of(model)
    places: dict[str, Place] = {}
    for pattern in patterns:
        places |= {address_of(place): place for place in given_places(tables, pattern)}
    twice = overlapping(places)
    if twice:
        raise ModelError(twice)
    start = []
    factor = []
    for address, place in places.items():
        value = _station(model, tables, place)
        several = isinstance(value, dict | list)
        if not (several and is_number(value)) and (not isinstance(value, int | float) or isinstance(value, bool)):
            hint = "leave it out, or give a number in its place"
            raise ModelError([Problem(address, shown(value), "a number, or several", hint)])
        if isinstance(value, int):
            raise ModelError([whole_number(address, value)])
        start.append(1.0 if several else float(value))
        factor.append(several)
    units = ("" if many else _unit(model, places[address]) for address, many in zip(places, factor, strict=True))
    return Numbers(model, tuple(places), np.array(start), tuple(units), np.array(factor, dtype=bool))


def matching(numbers: Numbers, pattern: str) -> list[int]:
    """Which numbers a pattern of an address names, "*" as in `numbers_of`."""
    plain = [address.replace("[", ".").replace("]", "") for address in numbers.addresses]
    own = pattern.strip().replace("[", ".").replace("]", "")
    return [j for j, address in enumerate(plain) if fnmatch.fnmatchcase(address, own)]


def size_of(numbers: Numbers, j: int, given: float | str, what: str) -> float:
    """A size such as "10 %", 0.1 or "0.1 mm" of number j, in its coordinate: a share of its value, or with its unit.

    Raises:
        ModelError: neither a share nor a quantity of the number's unit; a share of 0.
    """
    address = numbers.addresses[j]
    start = abs(float(numbers.start[j]))
    share = _parsed(given, "ratio")
    if share is not None and (share == 0.0 or start > 0.0):
        return share * start
    unit = numbers.unit[j].replace(" ", "*")
    dimension = next((name for name, item in DIMENSIONS.items() if item.unit == unit and unit), None)
    size = None if dimension is None or share is not None else _parsed(given, dimension)
    if size is None:
        hint = "a share of 0 is nothing: give a size with its unit" if share is not None else ""
        example = f" or '{DIMENSIONS[dimension].example}'" if dimension else ""
        raise ModelError([Problem(f"{what} of {address}", repr(given), f"a share such as '10 %'{example}", hint)])
    return size


def _parsed(given: float | str, dimension: str) -> float | None:
    try:
        return parse_quantity(given, dimension)
    except QuantityError:
        return None


def _station(model: Model, tables: Mapping[str, Any], place: Place) -> Any:
    """The value at a place; of "start" and "end" of a shaft the z."""
    value = value_at(tables, place)
    if value not in ("start", "end") if isinstance(value, str) else True:
        return value
    owner = value_at(tables, place[:-1])
    shaft = owner.get("shaft") if isinstance(owner, dict) else None
    if shaft not in model.shafts:
        return value
    part = model.shafts[shaft]
    return part.start if value == "start" else part.start + sum(section.length for section in part.sections)


def _unit(model: Model, place: Place) -> str:
    """SI unit of a plain number, from the field that it stands in."""
    owner: Any = model
    for key in place[:-1]:
        owner = getattr(owner, key) if isinstance(key, str) and hasattr(type(owner), "model_fields") else owner[key]
    if not hasattr(type(owner), "model_fields"):
        return ""
    schema = type(owner).model_json_schema()["properties"].get(str(place[-1]), {})
    return next(iter(_units(schema)), "")


def _units(schema: Any) -> Iterable[Any]:
    if isinstance(schema, dict):
        if "x-unit" in schema:
            yield schema["x-unit"]
        for entry in schema.values():
            yield from _units(entry)
    if isinstance(schema, list):
        for entry in schema:
            yield from _units(entry)
