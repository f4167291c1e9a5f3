"""What lets a small command start fast: of half a second of processor time these settings take a third away."""

from __future__ import annotations

import atexit
import gc
import os
import sys
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import LazyLoader
from typing import Any

# Power of two of the cycles for which OpenBLAS's threads wait at full load before they sleep, 4 to 30: a thousandth of a second.
_IDLE = "20"
# Objects more than there were before at which rings of them that nothing holds are looked for; Python's own number is 700.
_OBJECTS = 200_000


def start_fast() -> None:
    """Set Python, linear algebra and pydantic up for one command, before any of them is loaded."""
    # Classes and functions of imported modules stay, and each look for garbage goes through all of them. Arrays are no part of
    # it, they go when nothing holds them any more. At the end nothing need be looked for.
    gc.set_threshold(_OBJECTS, *gc.get_threshold()[1:])
    atexit.register(gc.freeze)
    one_blas_thread()
    sys.meta_path.insert(0, LaterFinder)
    # pydantic would read the metadata of every installed package to look for plugins.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")


def one_blas_thread() -> None:
    """Have linear algebra run on one thread where the user has not said on how many.

    Matrices of one gearbox are small or sparse: more threads gain nothing on them, and on a busy machine they wait for each
    other. This is read when numpy is loaded, so it comes first. Threads of sweeps and transients are numba's, and stay.

    Where there are more, one that has no work is to sleep soon: by default those of numpy and of scipy wait for work at full
    load when they are made, for a tenth of a second of processor time.
    """
    os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", _IDLE)
    names = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    if not any(name in os.environ for name in (*names, "OMP_NUM_THREADS")):
        for name in names:
            os.environ[name] = "1"


class LaterFinder:
    """Finds modules that are run when something of them is first used.

    scipy takes all names of numpy, and with them numpy.f2py, numpy.testing and numpy.ma, of which it uses nothing here: an
    eighth of what a small command costs.
    """

    names = ("numpy.f2py", "numpy.testing", "numpy.ma")

    @classmethod
    def find_spec(cls, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """The module with a loader that waits; None for all others."""
        if name not in cls.names:
            return None
        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and spec.loader is not None:
            spec.loader = LazyLoader(spec.loader)
        return spec
