"""Numbers of a model by address, as coordinates: what they are now, and the model with others in their place.

A plain number is its own coordinate, in SI. A stiffness given by several numbers (a matrix, or values over a mesh period) has one
factor for all of them, 1 as the file has it. A place "start" or "end" of a shaft is the z that it means.
"""

from __future__ import annotations

import fnmatch
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotorgear.errors import ModelError, Problem
from rotorgear.model.address import Place, changed, places_of, tables_of, value_at
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import Part, si_unit
from rotorgear.model.parts.problems import shown
from rotorgear.quantity import DIMENSIONS, QuantityError, did_you_mean, parse_quantity

# What is known of a number before a test where nobody says.
DEFAULT_PRIOR = 0.30
# Beyond a factor of e^2 a number is no longer uncertain but unknown, and a log-normal spread means little.
LARGEST_PRIOR = 2.0


@dataclass(frozen=True)
class Numbers:
    """Numbers of a model.

    Attributes:
        model: with the numbers as they are.
        addresses: of the p numbers.
        start: their coordinates as they are (p,).
        factor: whether the coordinate is a factor of several numbers (p,).
    """

    model: Model
    addresses: tuple[str, ...]
    start: NDArray[np.float64]
    factor: NDArray[np.bool_]

    @cached_property
    def _tables(self) -> dict[str, Any]:
        return tables_of(self.model)

    @cached_property
    def _places(self) -> tuple[Place, ...]:
        return tuple(places_of(self._tables, address)[0] for address in self.addresses)

    @cached_property
    def unit(self) -> tuple[str, ...]:
        """SI unit of each coordinate; "" of a factor or ratio."""
        found = []
        for place, factor in zip(self._places, self.factor, strict=True):
            owner: Any = self.model.written
            for key in place[:-1]:
                owner = getattr(owner, str(key)) if isinstance(owner, Part) else owner[key]
            is_field = isinstance(owner, Part) and not factor
            found.append(si_unit(type(owner).model_fields[str(place[-1])]) if is_field else "")
        return tuple(found)

    def at(self, values: NDArray[np.float64]) -> Model:
        """The model with other coordinates (p,).

        Raises:
            ModelError: values that the model can't have.
        """
        changes: list[tuple[list[Place], Any]] = []
        for place, value, start, factor in zip(self._places, values, self.start, self.factor, strict=True):
            # A number that stays is not written, so that a place "end" stays a word.
            if value != start:
                changes.append(([place], _times(value_at(self._tables, place), value) if factor else float(value)))
        return Model(**changed(self._tables, changes))

    def matching(self, pattern: str) -> list[int]:
        """Which of the numbers a pattern of an address names, "*" as in `numbers_of`."""
        plain = [address.replace("[", ".").replace("]", "") for address in self.addresses]
        pattern = pattern.strip().replace("[", ".").replace("]", "")
        return [j for j, address in enumerate(plain) if fnmatch.fnmatchcase(address, pattern)]

    def size(self, j: int, given: float | str, what: str) -> float:
        """A size such as "10 %", 0.1 or "0.1 mm" of number j, in its coordinate: a share of its value, or with its unit.

        Raises:
            ModelError: neither a share nor a quantity of the number's unit; a share of 0.
        """
        start = abs(float(self.start[j]))
        share = _parsed(given, "ratio")
        if share is not None and (share == 0.0 or start > 0.0):
            return share * start
        unit = self.unit[j].replace(" ", "*")
        dimension = next((name for name, item in DIMENSIONS.items() if item.unit == unit and unit), None)
        size = None if dimension is None or share is not None else _parsed(given, dimension)
        if size is None:
            hint = "a share of 0 is nothing: give a size with its unit" if share is not None else ""
            example = f" or '{DIMENSIONS[dimension].example}'" if dimension else ""
            address = f"{what} of {self.addresses[j]}"
            raise ModelError([Problem(address, repr(given), f"a share such as '10 %'{example}", hint)])
        return size


@dataclass(frozen=True)
class FreeNumbers(Numbers):
    """Numbers p_j = p_j0 exp(x_j) that are not 0, in the coordinates x.

    Attributes:
        prior: standard deviation of each x before any test, about the relative one of p (p,).
    """

    prior: NDArray[np.float64]

    def at(self, x: NDArray[np.float64]) -> Model:
        """The model with each number times exp(x_j), x (p,)."""
        return super().at(self.start * np.exp(x))


def numbers_of(model: Model, free: str | Iterable[str]) -> Numbers:
    """Return the numbers that some addresses name.

    Args:
        model: the model.
        free: addresses such as "bearings.*.stiffness", in a list or with commas between; "*" stands for all names or places
            there.

    Raises:
        ModelError: an address that leads nowhere, or to something that is no number.
    """
    patterns = [part.strip() for part in (free.split(",") if isinstance(free, str) else free) if part.strip()]
    if not patterns:
        raise ModelError([Problem("free", "", "addresses of numbers, such as 'bearings.*.stiffness'")])
    tables = tables_of(model)
    places = {_address(place): place for pattern in patterns for place in _given_places(tables, pattern)}
    twice = [
        Problem(address, "", f"it is a part of {whole}, which is named too: leave one of them out")
        for address in places
        for whole in [other for other in places if address.startswith((f"{other}.", f"{other}["))][:1]
    ]
    if twice:
        raise ModelError(twice)
    start = []
    factor = []
    for address, place in places.items():
        value = _station(model, tables, place)
        several = isinstance(value, dict | list)
        if not (several and is_number(value)) and (not isinstance(value, int | float) or isinstance(value, bool)):
            hint = "only numbers can vary; leave it out, or give a number in its place"
            raise ModelError([Problem(address, shown(value), "a number, or several", hint)])
        if isinstance(value, int):
            expected = "a number that can vary little by little; this one is whole"
            raise ModelError([Problem(address, shown(value), expected, "leave it out")])
        start.append(1.0 if several else float(value))
        factor.append(several)
    return Numbers(model, tuple(places), np.array(start), np.array(factor, dtype=bool))


def free_numbers(
    model: Model, free: str | Iterable[str], prior: float | str | Mapping[str, float | str] = DEFAULT_PRIOR
) -> FreeNumbers:
    """Return the free numbers that some addresses name, each with what is known of it.

    Args:
        model, free: as in `numbers_of`.
        prior: relative standard deviation before the test, such as 0.3 or "30 %", of all or by address ("*" as above).

    Raises:
        ModelError: as `numbers_of`; a number that is 0; a prior that is none.
    """
    numbers = numbers_of(model, free)
    tables = tables_of(model)
    for address in numbers.addresses:
        value = value_at(tables, places_of(tables, address)[0])
        if not is_number(value):
            hint = "its spread is a share of it; leave it out, or give a number in its place"
            raise ModelError([Problem(address, shown(value), "a number other than 0, or several", hint)])
    given: list[float | str] = [DEFAULT_PRIOR if isinstance(prior, Mapping) else prior] * len(numbers.addresses)
    for pattern, value in prior.items() if isinstance(prior, Mapping) else ():
        named = numbers.matching(pattern)
        if not named:
            expected = "an address of the free numbers, or a pattern of some"
            raise ModelError([Problem("prior", pattern, expected, did_you_mean(pattern, numbers.addresses))])
        for j in named:
            given[j] = value
    spreads = []
    for address, value in zip(numbers.addresses, given, strict=True):
        spread = _parsed(value, "ratio") if isinstance(value, str) else float(value)
        if spread is None or not 0.0 < spread <= LARGEST_PRIOR:
            expected = f"a relative standard deviation above 0 and up to {LARGEST_PRIOR:g}, such as '30 %'"
            raise ModelError([Problem(f"prior of {address}", repr(value), expected)])
        spreads.append(spread)
    return FreeNumbers(model, numbers.addresses, numbers.start, numbers.factor, np.array(spreads))


def is_number(value: Any) -> bool:
    """Whether a value is a number other than 0, or several that are not all 0."""
    if isinstance(value, dict):
        return bool(value) and all(is_number(entry) or entry == 0.0 for entry in value.values()) and any(value.values())
    if isinstance(value, list):
        return bool(value) and all(is_number(entry) or entry == 0.0 for entry in value)
    return isinstance(value, int | float) and not isinstance(value, bool) and value != 0.0


def _times(value: Any, factor: float) -> Any:
    """A number, or all numbers of a table or list, times a factor."""
    if isinstance(value, dict):
        return {key: _times(entry, factor) for key, entry in value.items()}
    if isinstance(value, list):
        return [_times(entry, factor) for entry in value]
    return value * float(factor)


def _address(place: Place) -> str:
    """A place in the tables as an address, such as "shafts.rotor.sections[0].length"."""
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in place).removeprefix(".")


def _given_places(tables: dict[str, Any], pattern: str) -> list[Place]:
    """Where an address leads to something that the file gives; `places_of` lets its last key be missing.

    Raises:
        ModelError: nowhere, with the nearest name.
    """
    places = places_of(tables, pattern)
    owners = [value_at(tables, place[:-1]) for place in places]
    pairs = zip(places, owners, strict=True)
    found = [place for place, owner in pairs if not isinstance(owner, dict) or place[-1] in owner]
    if not found:
        name = str(places[0][-1])
        hint = did_you_mean(name, (key for owner in owners for key in owner))
        raise ModelError([Problem(pattern, f"'{name}'", "a number that the file gives there", hint)])
    return found


def _station(model: Model, tables: Mapping[str, Any], place: Place) -> Any:
    """The value at a place; of "start" and "end" of a shaft the z."""
    value = value_at(tables, place)
    owner = value_at(tables, place[:-1])
    shaft = owner.get("shaft") if isinstance(owner, dict) else None
    shafts = model.written.shafts
    if not isinstance(value, str) or value not in ("start", "end") or shaft not in shafts:
        return value
    return shafts[shaft].station(value)


def _parsed(given: float | str, dimension: str) -> float | None:
    try:
        return parse_quantity(given, dimension)
    except QuantityError:
        return None
