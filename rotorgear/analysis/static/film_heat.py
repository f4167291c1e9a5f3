"""Oil films in heat balance: an equilibrium and the viscosities of its films agree.

At one place of its shaft a film has one temperature, but the place follows from the viscosity. With x = ln mu of
each film and phi(x) that of the place where the equilibrium with x puts its shaft, x = phi(x) is solved by a secant for each:
thicker oil lifts the shaft, less oil leaves, the film is warmer, so that phi falls by less than it is given, -1 < phi' < 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.quantity import RPM_PER_RAD_S

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw

Found = TypeVar("Found")
# Viscosities agree to this share.
_AGREED = 1e-9
_PASSES = 40
# Of phi(x) - x: before two passes tell it, and within which it is believed.
_SLOPE = -1.3
_SLOPES = (-3.0, -0.7)


def in_heat_balance(
    laws: Sequence[ForceLaw],
    speed: float,
    settled: Callable[[Sequence[ForceLaw]], tuple[Found, Sequence[np.ndarray]]],
) -> tuple[list[ForceLaw], Found]:
    """Return the laws at the viscosities of their films, and the equilibrium with them.

    Args:
        laws: those without a film of oil with a grade stay as they are.
        speed: of the reference in rad/s.
        settled: the equilibrium with given laws, and the displacements (k,) of each.

    Raises:
        AnalysisError: they don't come to agree.
    """
    laws = list(laws)
    films = [i for i, law in enumerate(laws) if getattr(law, "heats", False)]
    x = np.array([np.log(laws[i].viscosity) for i in films])  # type: ignore[attr-defined]
    slope = np.full(len(films), _SLOPE)
    last: tuple[np.ndarray, np.ndarray] | None = None
    for _ in range(_PASSES):
        found, places = settled(laws)
        warmed = [laws[i].warmed(places[i], speed) for i in films]  # type: ignore[attr-defined]
        rest = np.array([np.log(law.viscosity) for law in warmed]) - x
        if np.abs(rest).max(initial=0.0) <= _AGREED:
            return laws, found
        if last is not None:
            moved = x - last[0]
            there = np.divide(rest - last[1], moved, out=slope.copy(), where=np.abs(moved) > _AGREED)
            slope = np.clip(there, *_SLOPES)
        last = (x, rest)
        x = x - rest / slope
        for i, value in zip(films, x, strict=True):
            laws[i] = replace(laws[i], viscosity=float(np.exp(value)))  # type: ignore[call-arg]
    raise AnalysisError(
        f"the heat balance of the oil films was not found at {speed * RPM_PER_RAD_S:.6g} rpm; give the viscosity of the film"
    )
