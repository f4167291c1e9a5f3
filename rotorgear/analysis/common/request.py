"""Arguments that several analyses take: their checks, each refused with one sentence."""

from __future__ import annotations

from typing import overload

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.quantity import QuantityError, parse_quantity

# Finest accuracy that can be asked for: below, rounding and the solvers' own errors take over.
FINEST = 1e-11


@overload
def speed_in_si(given: float | str) -> float: ...
@overload
def speed_in_si(given: float | str | None) -> float | None: ...
def speed_in_si(given: float | str | None) -> float | None:
    """Speed in rad/s from a number or a text with its unit."""
    if given is None:
        return None
    try:
        return parse_quantity(given, "speed")
    except QuantityError as error:
        raise AnalysisError(f"speed: got {given!r}, expected {error}") from None


def direction_of(speed: float | None) -> int | None:
    """+1 or -1, the sense of a speed; None without one, which leaves it to the model."""
    return None if not speed else int(np.sign(speed))


def check_request(
    speed: float | None, modes: int | None, fmax: float | None, elements: int | None, accuracy: float | None
) -> None:
    """Refuse a request that can't be meant."""
    for name, value in (("the number of modes", modes), ("the number of elements", elements)):
        if value is not None and value < 1:
            raise AnalysisError(f"{name} must be at least 1, got {value}")
    if elements is not None and accuracy is not None:
        raise AnalysisError("elements and accuracy: give one of the two; elements fixes the mesh, accuracy refines it")
    if accuracy is not None and not FINEST <= accuracy < 1.0:
        raise AnalysisError(f"the accuracy must lie between {FINEST:g} and 1 (1e-3 is 0.1 %), got {accuracy:g}")
    if fmax is not None and not (np.isfinite(fmax) and fmax > 0.0):
        raise AnalysisError(f"the highest frequency must be positive, got {fmax} Hz")
