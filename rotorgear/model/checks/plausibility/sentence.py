"""The sentence on a value that physics makes unlikely: address, value, usual range and the likely slip of a unit."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.model.layout.layout import Layout

# What a value is asked that may be wrong either way.
ASK = ("is its unit right?", "is its unit right?")
GRAVITY = 9.81


def said(address: str, value: str, usual: str, slip: str) -> str:
    return f"{address}: {value}; usual is {usual}: {slip}"


def outside(
    address: str, value: float, usual: tuple[float, float], words: tuple[str, str], slips: tuple[str, str]
) -> Iterator[str]:
    """The sentence on a value that is below or above what is usual.

    Args:
        address: of the value. value: by which it is judged, such as a ratio. usual: lowest and highest, infinite where none is.
        words: the value, and what is usual, as they are printed. slips: the likely slip of a value below, and of one above.
    """
    if not usual[0] <= value <= usual[1]:
        yield said(address, *words, slips[0] if value < usual[0] else slips[1])


def mass_of(layout: Layout, shaft: str) -> float:
    """Mass of a shaft and of what stands on it, in kg."""
    model = layout.model
    total = 0.0
    for section in model.shafts[shaft].sections:
        outer, bore, outer_end, bore_end = section.mass_diameters()
        area = 0.125 * math.pi * (outer**2 + outer_end**2 - bore**2 - bore_end**2)
        total += model.material_of(shaft, section).density * section.length * area
    return total + sum(body.body.mass for body in layout.bodies if body.shaft == shaft)
