"""Undamped modes of a group of dofs, kept as long as the system lives where its stiffness does not depend on the speed.

Damped modes are built on undamped ones. A Campbell diagram, and whoever asks for modes at one speed after another, needs the
same ones each time.
"""

from __future__ import annotations

from collections.abc import Callable
from weakref import WeakKeyDictionary

from rotorgear.solvers.eigen.eigen import UndampedModes
from rotorgear.system.system import System

# Dofs of the group, how many modes, up to which frequency in rad/s, and whether they are counted.
Request = tuple[bytes, int | None, float | None, bool]
# So many requests of a system are kept, the latest ones: as many groups, mostly of one request.
_MOST = 16
_kept: WeakKeyDictionary[System, dict[Request, UndampedModes]] = WeakKeyDictionary()


def kept_undamped(system: System, request: Request, find: Callable[[], UndampedModes]) -> UndampedModes:
    """What `find()` returns, or what it returned when the same was asked of this system before.

    Args:
        system: whose modes they are.
        request: what is asked for.
        find: computes them.
    """
    if system.has_tables:
        return find()
    known = _kept.setdefault(system, {})
    if request not in known:
        found = find()
        while len(known) >= _MOST:
            known.pop(next(iter(known)))
        known[request] = found
    return known[request]
