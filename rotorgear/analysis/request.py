"""What the verbs make of a speed that is asked for."""

from __future__ import annotations

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.quantity import QuantityError, parse_quantity


def speed_in_rad_s(given: float | str | None) -> float | None:
    """Speed in rad/s from a number or a text with its unit.

    Raises:
        AnalysisError: not a rotational speed.
    """
    if given is None:
        return None
    try:
        return parse_quantity(given, "speed")
    except QuantityError as error:
        raise AnalysisError(f"speed: got {given!r}, expected {error}") from None


def direction_of(speed: float | None) -> int | None:
    """+1 or -1, the sense of a speed; None without one, which leaves it to the model."""
    return None if not speed else int(np.sign(speed))
