"""Bounds of free numbers: those that are given, and what a layout allows by itself.

A place on a shaft stays within it, and on its side of the gears, disks and bearings beside it. Where the model refuses a value
within the bounds, the bound is drawn in until it takes it.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from rotorgear.errors import AnalysisError, ModelError
from rotorgear.model.model import Model
from rotorgear.model.numbers import Numbers

DEFAULT_BOUNDS = "-20 %:20 %"
# A place moves by so much of its shaft where nothing is said.
_OF_SHAFT = 0.1
# It keeps this share of the shaft's length from its neighbours.
_APART = 0.01
_BISECTIONS = 8


def bounds_of(
    numbers: Numbers, given: Mapping[str, str]
) -> tuple[NDArray[np.float64], NDArray[np.float64], tuple[str, ...]]:
    """Return lower and upper bounds (p,) and sentences on those that were drawn in.

    Args:
        numbers: the free numbers.
        given: pattern of addresses -> "LOW:HIGH", each a share of the value added to it ("-20 %:20 %") or a value with its unit.

    Raises:
        AnalysisError: bounds that are none, or do not hold the value of the file.
    """
    low = np.zeros(len(numbers.addresses))
    high = np.zeros(len(numbers.addresses))
    notes: list[str] = []
    texts: dict[int, str] = {}
    for pattern, text in given.items():
        found = numbers.matching(pattern)
        if not found:
            raise AnalysisError(f"bounds: '{pattern}' is none of the free numbers")
        texts |= dict.fromkeys(found, text)
    for j, address in enumerate(numbers.addresses):
        place = address.endswith(".at")
        if j in texts or not place:
            low[j], high[j] = _parsed(numbers, j, texts.get(j, DEFAULT_BOUNDS))
        else:
            reach = _OF_SHAFT * _length(numbers.model, address)
            low[j] = numbers.start[j] - reach
            high[j] = numbers.start[j] + reach
        if low[j] >= high[j]:
            raise AnalysisError(
                f"bounds of {address}: {low[j]:g} to {high[j]:g} leave no room; give the lower one first"
            )
        if not low[j] <= numbers.start[j] <= high[j]:
            raise AnalysisError(
                f"bounds of {address}: {low[j]:g} to {high[j]:g} do not hold its value {numbers.start[j]:g}"
            )
        if place:
            first, last = _room(numbers.model, address, float(numbers.start[j]))
            # Rounding of sums of lengths must not shut out the place where the file has it.
            low[j] = min(max(low[j], first), numbers.start[j])
            high[j] = max(min(high[j], last), numbers.start[j])
            if low[j] == high[j]:
                raise AnalysisError(f"{address}: there is no room beside it; leave it out, or move what stands there")
        for side, bound in ((-1, low), (1, high)):
            taken = _taken(numbers, j, float(bound[j]))
            if taken != bound[j]:
                name = "lower" if side < 0 else "upper"
                notes.append(
                    f"{address}: its {name} bound is {taken:.6g} and not {bound[j]:.6g}, which the model refuses"
                )
                bound[j] = taken
    return low, high, tuple(notes)


def _parsed(numbers: Numbers, j: int, text: str) -> tuple[float, float]:
    ends = text.split(":")
    if len(ends) != 2:
        raise AnalysisError(f"bounds of {numbers.addresses[j]}: got '{text}', expected LOW:HIGH such as '-20 %:20 %'")
    found = []
    for end in ends:
        own = end.strip()
        share = own.endswith("%")
        sign = -1.0 if own.startswith("-") and share else 1.0
        size = numbers.size(j, own.lstrip("+-") if share else own, "bounds")
        found.append(float(numbers.start[j]) + sign * size if share else size)
    return found[0], found[1]


def _length(model: Model, address: str) -> float:
    shaft = _shaft(model, address)
    return float(sum(section.length for section in model.shafts[shaft].sections))


def _shaft(model: Model, address: str) -> str:
    table, name, _ = address.split(".")
    return str(getattr(model, table)[name].shaft)


def _room(model: Model, address: str, here: float) -> tuple[float, float]:
    """Where a part may stand without a jump over its neighbours or off its shaft."""
    shaft = _shaft(model, address)
    part = model.shafts[shaft]
    first = float(part.start)
    last = first + _length(model, address)
    apart = _APART * (last - first)
    own = address.removesuffix(".at")
    low = first
    high = last
    for table in ("gears", "disks", "bearings"):
        for name, other in getattr(model, table).items():
            if f"{table}.{name}" == own or other.shaft != shaft:
                continue
            z, half = _span(other, first, last)
            if z - half <= here <= z + half:
                continue  # it stands there already, as a disk on a bearing's place
            if z < here:
                low = max(low, min(z + half + apart, here))
            else:
                high = min(high, max(z - half - apart, here))
    return low, high


def _span(part: object, first: float, last: float) -> tuple[float, float]:
    at = getattr(part, "at", 0.0)
    z = first if at == "start" else last if at == "end" else float(at)
    width = getattr(part, "width", None) or 0.0
    if getattr(part, "kind", "") == "herringbone":
        width = 2.0 * width + (getattr(part, "gap", None) or 0.0)
    return z, 0.5 * width


def _taken(numbers: Numbers, j: int, bound: float) -> float:
    """The bound, or the last value towards it that the model takes."""

    def refuses(value: float) -> bool:
        values = numbers.start.copy()
        values[j] = value
        try:
            numbers.at(values)
        except ModelError:
            return True
        return False

    if not refuses(bound):
        return bound
    good = float(numbers.start[j])
    bad = bound
    for _ in range(_BISECTIONS):
        middle = 0.5 * (good + bad)
        if refuses(middle):
            bad = middle
        else:
            good = middle
    return good
