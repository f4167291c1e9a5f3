"""Up to which frequency modes get the damping ratio that is added to all, for excitation up to another one."""

from __future__ import annotations

import numpy as np

from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# So far above the highest excitation modes of large systems get it.
_ABOVE = 1.5
# Degrees of freedom with one element in each segment up to which all modes get it, and those of any mesh at which they cost much.
_ALL = 60
_MOST = 600


def all_damped(system: System) -> bool:
    """Whether all modes get it. Those far above excitation still lose energy, 2 zeta w/w_n of what they store.

    The coarsest mesh decides, so that what is damped does not change where a mesh is refined.
    """
    return system.n <= _MOST and (system.n <= _ALL or system.with_plan(Plan(1)).n <= _ALL)


def damped_up_to(system: System, highest: float) -> float:
    """Frequency in rad/s up to which modes get the ratio, for excitation up to the highest one; inf where all do."""
    return np.inf if all_damped(system) else _ABOVE * highest


def undamped_above(limit: float, zeta: float) -> tuple[str, ...]:
    """A sentence on what modes above a frequency in rad/s lack, where there is one."""
    if not zeta or not np.isfinite(limit):
        return ()
    hertz = limit / (2.0 * np.pi)
    return (f"the damping ratio of modes above {hertz:.4g} Hz, {_ABOVE:g} times the highest excitation",)
