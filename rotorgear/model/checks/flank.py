"""Checks of a gear's flank modifications: amounts with their places, teeth that exist, depths that are no tooth any more."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.gears.geometry.outline import ToothOutline
from rotorgear.model.parts.flank import Flank
from rotorgear.quantity import millimetres

# Deeper modifications, as a share of the normal module, are a slip of the unit.
_DEEPEST = 0.2


def flank_problems(address: str, flank: Flank, outline: ToothOutline, width: float) -> Iterator[Problem]:
    """Yield what is missing or impossible in the modifications of one gear with a face `width` (m)."""
    # A root relief starts on the involute: between the form circle, where the root fillet ends, and the tip circle.
    start = flank.root_relief_diameter
    keys = ("root_relief", "root_relief_diameter")
    yield from _pair(address, flank.root_relief, start, keys, "where the root relief starts")
    low = 2.0 * outline.form_radius
    high = 2.0 * outline.tip_radius
    if start is not None and not low < start <= high:
        limits = f"a diameter on the involute, above {millimetres(low)} to {millimetres(high)}"
        yield Problem(f"{address}.root_relief_diameter", millimetres(start), limits)
    # Both ends of the face are relieved: beyond half of it they would overlap.
    length = flank.end_relief_length
    keys = ("end_relief", "end_relief_length")
    yield from _pair(address, flank.end_relief, length, keys, "the length of the end relief along the face")
    if length > 0.5 * width:
        limits = f"up to half of the face, {millimetres(0.5 * width)}"
        yield Problem(f"{address}.end_relief_length", millimetres(length), limits)
    deepest = _DEEPEST * outline.geometry.normal_module
    for key in ("root_relief", "crowning", "end_relief", "helix_slope"):
        if abs(getattr(flank, key)) > deepest:
            limits = f"up to {_DEEPEST:g} normal modules, {millimetres(deepest)}"
            yield Problem(f"{address}.{key}", millimetres(getattr(flank, key)), limits)
    teeth = outline.geometry.teeth
    for number in flank.pitch_errors:
        if not number.isdigit() or int(number) >= teeth:
            yield Problem(f"{address}.pitch_errors", f"'{number}'", f"the number of a tooth, from '0' to '{teeth - 1}'")


def _pair(address: str, amount: float, place: object, keys: tuple[str, str], what: str) -> Iterator[Problem]:
    """An amount and its place come together."""
    if amount and not place:
        yield Problem(f"{address}.{keys[1]}", "", "missing", f"required: {what}")
    if place and not amount:
        yield Problem(f"{address}.{keys[0]}", "", "missing", "required: its amount")
