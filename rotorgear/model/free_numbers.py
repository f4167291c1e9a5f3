"""Numbers of a model that are left free, by address: what they are now, and the model with each times a factor."""

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
from rotorgear.model.model import Model
from rotorgear.model.parts.problems import shown
from rotorgear.quantity import QuantityError, nearest, parse_quantity

# What is known of a number before a test where nobody says.
DEFAULT_PRIOR = 0.30
# Beyond a factor of e^2 a number is no longer uncertain but unknown, and a log-normal spread means little.
LARGEST_PRIOR = 2.0


@dataclass(frozen=True)
class FreeNumbers:
    """Free numbers p_j = p_j0 exp(x_j) of a model.

    A stiffness given by several numbers (a matrix, or values over a mesh period) has one factor for all of them.

    Attributes:
        model: with p_0.
        addresses: of the p numbers.
        prior: relative standard deviation of each before any test (p,).
    """

    model: Model
    addresses: tuple[str, ...]
    prior: NDArray[np.float64]

    @cached_property
    def _tables(self) -> dict[str, Any]:
        return tables_of(self.model)

    @cached_property
    def _places(self) -> tuple[Place, ...]:
        return tuple(places_of(self._tables, address)[0] for address in self.addresses)

    def at(self, x: NDArray[np.float64]) -> Model:
        """The model with each number times exp(x_j), x (p,)."""
        copy: dict[str, Any] = json.loads(json.dumps(self._tables))
        for place, factor in zip(self._places, np.exp(x), strict=True):
            owner = value_at(copy, place[:-1])
            owner[place[-1]] = times(owner[place[-1]], float(factor))
        return Model(**copy)

    def values(self, x: NDArray[np.float64]) -> tuple[Any, ...]:
        """Each value in SI, as the tables of a model hold it, times exp(x_j)."""
        pairs = zip(self._places, np.exp(x), strict=True)
        return tuple(times(value_at(self._tables, place), float(factor)) for place, factor in pairs)


def free_numbers(
    model: Model, free: str | Iterable[str], prior: float | str | Mapping[str, float | str] = DEFAULT_PRIOR
) -> FreeNumbers:
    """Return the free numbers that some addresses name.

    Args:
        model: the model.
        free: addresses such as "bearings.*.stiffness", in a list or with commas between; "*" stands for all names or places
            there.
        prior: relative standard deviation before the test, such as 0.3 or "30 %", of all or by address ("*" as above).

    Raises:
        ModelError: an address that leads nowhere, or to something that is no positive number; a prior that is none.
    """
    patterns = [part.strip() for part in free.split(",")] if isinstance(free, str) else [part.strip() for part in free]
    patterns = [pattern for pattern in patterns if pattern]
    tables = tables_of(model)
    if not patterns:
        raise ModelError([Problem("free", "", "addresses of numbers, such as 'bearings.*.stiffness'")])
    addresses: list[str] = []
    for pattern in patterns:
        for place in given_places(tables, pattern):
            address = address_of(place)
            if not is_number(value_at(tables, place)):
                got = shown(value_at(tables, place))
                hint = "only numbers have a spread; leave it out, or give a number in its place"
                raise ModelError([Problem(address, got, "a number other than 0, or several", hint)])
            if isinstance(value_at(tables, place), int):
                raise ModelError([whole_number(address, value_at(tables, place))])
            if address not in addresses:
                addresses.append(address)
    twice = overlapping(addresses)
    if twice:
        raise ModelError(twice)
    if isinstance(prior, Mapping):
        for pattern in prior:
            if not any(fnmatch.fnmatchcase(address, pattern) for address in addresses):
                hint = nearest(pattern, addresses)
                expected = "an address of the free numbers, or a pattern of some"
                raise ModelError([Problem("prior", pattern, expected, f"did you mean '{hint}'?" if hint else "")])
    return FreeNumbers(model, tuple(addresses), np.array([_prior_of(address, prior) for address in addresses]))


def address_of(place: Place) -> str:
    """A place in the tables as an address, such as "shafts.rotor.sections[0].length"."""
    text = ""
    for key in place:
        text += f"[{key}]" if isinstance(key, int) else f".{key}"
    return text.removeprefix(".")


def whole_number(address: str, value: int) -> Problem:
    """A count, such as a number of teeth, in place of a number that can vary."""
    return Problem(address, shown(value), "a number that can vary little by little; this one is whole", "leave it out")


def overlapping(addresses: Iterable[str]) -> list[Problem]:
    """Addresses that are a part of another one, which would be changed twice."""
    known = list(addresses)
    found = []
    for address in known:
        whole = next((other for other in known if address.startswith((f"{other}.", f"{other}["))), None)
        if whole:
            found.append(Problem(address, "", f"it is a part of {whole}, which is named too: leave one of them out"))
    return found


def _prior_of(address: str, prior: float | str | Mapping[str, float | str]) -> float:
    if isinstance(prior, Mapping):
        fitting = [value for pattern, value in prior.items() if fnmatch.fnmatchcase(address, pattern)]
        prior = fitting[-1] if fitting else DEFAULT_PRIOR
    try:
        spread = parse_quantity(prior, "ratio") if isinstance(prior, str) else float(prior)
    except QuantityError:
        spread = float("nan")
    if not 0.0 < spread <= LARGEST_PRIOR:
        expected = f"a relative standard deviation above 0 and up to {LARGEST_PRIOR:g}, such as '30 %'"
        raise ModelError([Problem(f"prior of {address}", repr(prior), expected)])
    return spread


def given_places(tables: dict[str, Any], pattern: str) -> list[Place]:
    """Where an address leads to something that the file gives; `places_of` lets its last key be missing.

    Raises:
        ModelError: nowhere, with the nearest name.
    """
    places = places_of(tables, pattern)
    owners = [value_at(tables, place[:-1]) for place in places]
    found = [
        place for place, owner in zip(places, owners, strict=True) if not isinstance(owner, dict) or place[-1] in owner
    ]
    if not found:
        name = str(places[0][-1])
        guess = nearest(name, [key for owner in owners for key in owner])
        hint = f"did you mean '{guess}'?" if guess else ""
        raise ModelError([Problem(pattern, f"'{name}'", "a number that the file gives there", hint)])
    return found


def is_number(value: Any) -> bool:
    """Whether a value is a number other than 0, or several that are not all 0."""
    if isinstance(value, dict):
        return bool(value) and all(is_number(entry) or entry == 0.0 for entry in value.values()) and any(value.values())
    if isinstance(value, list):
        return bool(value) and all(is_number(entry) or entry == 0.0 for entry in value)
    return isinstance(value, int | float) and not isinstance(value, bool) and value != 0.0


def times(value: Any, factor: float) -> Any:
    """A number, or all numbers of a table or list, times a factor."""
    if isinstance(value, dict):
        return {key: times(entry, factor) for key, entry in value.items()}
    if isinstance(value, list):
        return [times(entry, factor) for entry in value]
    return value * factor
