"""Arguments that several analyses take: their checks, each refused with one sentence."""

from __future__ import annotations

import numbers
from collections.abc import Iterable
from typing import overload

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.quantity import QuantityError, parse_quantity

# Finest accuracy that can be asked for: below, rounding and the solvers' own errors take over.
FINEST = 1e-11


@overload
def speed_in_si(given: float | str) -> float: ...
@overload
def speed_in_si(given: float | str | None) -> float | None: ...
def speed_in_si(given: float | str | None) -> float | None:
    """Speed in rad/s from a number or a text with its unit."""
    return None if given is None else quantity(given, "speed", "speed")


def quantity(value: object, dimension: str, name: str) -> float:
    """A number in SI, or a text with its unit, in SI; AnalysisError with the name of the argument where it is neither."""
    try:
        return parse_quantity(value, dimension)
    except QuantityError as error:
        raise AnalysisError(f"{name}: got {value!r}, expected {error}") from None


def speed_or_operating(given: float | str | None, model: Model) -> float | None:
    """The speed that is asked for in rad/s, that of operation where none is; None where the model has none either."""
    return model.operating_speed if given is None else speed_in_si(given)


def needed_speed(given: float | str | None, model: Model) -> float:
    """The speed that is asked for in rad/s, or the operating one; AnalysisError where there is neither."""
    speed = speed_or_operating(given, model)
    if speed is None:
        raise AnalysisError("the model gives no speed of operation: ask for one (speed, or --speed)")
    return speed


def direction_of(speed: float | None) -> int | None:
    """+1 or -1, the sense of a speed; None without one, which leaves it to the model."""
    return None if not speed else int(np.sign(speed))


def share_of(given: float | str, what: str, example: str = "'15 %'") -> float:
    """A share between 0 and 1 from a number or a text such as "15 %"."""
    try:
        share = parse_quantity(given, "ratio")
    except QuantityError:
        share = -1.0
    if not 0.0 < share < 1.0:
        raise AnalysisError(f"{what}: got '{given}', expected a share between 0 and 1, such as {example}")
    return share


def check_whole(name: str, value: object, least: int = 1) -> None:
    """Refuse a count that is no whole number of at least `least`.

    Raises:
        AnalysisError: with the name of what is counted, such as "the number of modes".
    """
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise AnalysisError(f"{name} must be a whole number, got {value!r}")
    if value < 0 == least:
        raise AnalysisError(f"{name} can't be negative, got {value}")
    if value < least:
        raise AnalysisError(f"{name} must be at least {least}, got {value}")


def check_request(
    *, modes: int | None = None, fmax: float | None = None, elements: int | None = None, accuracy: float | None = None
) -> None:
    """Refuse a request that can't be meant."""
    for name, value in (("the number of modes", modes), ("the number of elements", elements)):
        if value is not None:
            check_whole(name, value)
    for name, size in (("the accuracy", accuracy), ("the highest frequency", fmax)):
        if size is not None and (isinstance(size, bool) or not isinstance(size, numbers.Real)):
            raise AnalysisError(f"{name} must be a number, got {size!r}")
    if elements is not None and accuracy is not None:
        raise AnalysisError("elements and accuracy: give one of the two; elements fixes the mesh, accuracy refines it")
    if accuracy is not None and not FINEST <= accuracy < 1.0:
        raise AnalysisError(f"the accuracy must lie between {FINEST:g} and 1 (1e-3 is 0.1 %), got {accuracy:g}")
    if fmax is not None and not (np.isfinite(fmax) and fmax > 0.0):
        raise AnalysisError(f"the highest frequency must be positive, got {fmax} Hz")


def check_modal_damping(ratio: float) -> None:
    """Refuse a damping ratio of modes that is none.

    Raises:
        AnalysisError: it is negative, or 1 and more.
    """
    if not 0.0 <= ratio < 1.0:
        raise AnalysisError(f"the modal damping ratio must lie between 0 and 1, got {ratio:g}")


def check_grade(grade: float) -> None:
    """Refuse a balance quality grade in mm/s that is none.

    Raises:
        AnalysisError: it is not positive and finite.
    """
    if not 0.0 < grade < float("inf"):
        raise AnalysisError(f"grade: expected a balance quality grade above 0 mm/s, got {grade:g}")


def check_speed_is_fixed(addresses: Iterable[str], instead: str) -> None:
    """Refuse the operating speed among numbers that vary: modes and excitations are those at the speed that is asked for.

    Raises:
        AnalysisError: with what to give in place of it.
    """
    if "operation.speed" in addresses:
        raise AnalysisError(f"operation.speed can't vary: modes and excitations are those at one speed; give {instead}")


def missed(wanted: float | None, estimate: float, remedy: str) -> str:
    """A sentence where an accuracy was asked for and is not reached; "" else.

    Args:
        wanted: the accuracy; None where none was asked for.
        estimate: what the result is estimated to be off by.
        remedy: what to do.
    """
    if wanted is None or estimate <= wanted:
        return ""
    said = f"the error is estimated at {estimate:.2g}" if np.isfinite(estimate) else "there is no estimate of the error"
    return f"accuracy {wanted:g} not reached: {said}; {remedy}"
