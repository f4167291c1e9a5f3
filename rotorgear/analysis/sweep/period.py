"""What repeats in a model that turns: orders of all laws, and the period that they have in common."""

from __future__ import annotations

from fractions import Fraction
from math import gcd, lcm
from typing import TYPE_CHECKING

from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from rotorgear.solvers.time.local_forces import LocalLaw

# Periods of the fastest mesh in the common one, at most.
MOST_TURNS = 1000
_WHOLE = 1e-9  # relative error of a fraction that stands for a ratio of speeds


def shared_period(orders: list[Fraction]) -> tuple[Fraction, int]:
    """The highest order, and how many of its periods everything that varies has in common, however many.

    Raises:
        AnalysisError: nothing varies.
    """
    if not orders:
        raise AnalysisError("nothing repeats: a sweep needs a mesh with teeth, or an unbalance, that turns")
    fastest = max(orders)
    base = Fraction(gcd(*(o.numerator for o in orders)), lcm(*(o.denominator for o in orders)))
    return fastest, int(fastest / base)


def common_period(orders: list[Fraction]) -> tuple[Fraction, int]:
    """The highest order, and how many of its periods everything that varies has in common.

    Raises:
        AnalysisError: nothing varies, or the common period is too long.
    """
    fastest, turns = shared_period(orders)
    if turns > MOST_TURNS:
        raise AnalysisError(
            f"the meshes repeat together after {turns} periods of the fastest only (at most {MOST_TURNS}); choose "
            "numbers of teeth with common factors"
        )
    return fastest, turns


def refuse_long(meshes: list[Fraction], orders: list[Fraction]) -> None:
    """AnalysisError where unbalances or torque ripples make the common period too long, and meshes alone don't."""
    try:
        common_period(orders)
    except AnalysisError as error:
        if not meshes or len(meshes) == len(orders):
            raise
        raise AnalysisError(
            f"{error}; without unbalances and torque ripples the meshes repeat after {common_period(meshes)[1]}: leave these "
            "out, as by --over 'unbalances.*.magnitude=0 kg m'"
        ) from None


def orders_of(law: LocalLaw, label: str) -> list[Fraction]:
    """Orders of what varies in a law and belongs to the common period; none where it stays the same."""
    orders = []
    for each in law.repeats():
        if not each.common:
            continue
        order = Fraction(each.order).limit_denominator(100000)
        if abs(float(order) - each.order) > _WHOLE * each.order:
            raise AnalysisError(
                f"{label}: its order {each.order:.9g} of the input shaft is no ratio of whole numbers, so nothing repeats"
            )
        orders.append(order)
    return orders
