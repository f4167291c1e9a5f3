"""Compilation of inner loops by numba, kept on disk between runs.

Only modules named `kernel_*` and force laws import this one, and they are imported inside the functions that need them.
"""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rotorgear.errors import MissingExtraError

try:
    import numba
    from numba.core.errors import NumbaExperimentalFeatureWarning
except ImportError:
    raise MissingExtraError("The transient analysis", "numba", "transient") from None

warnings.filterwarnings("ignore", category=NumbaExperimentalFeatureWarning)
# Sums may be reordered so that they vectorise; NaN and infinity keep their meaning, so that divergence is seen.
FAST = {"contract", "nsz", "reassoc"}
_vector = numba.types.Array(numba.types.float64, 1, "C")
_number = numba.types.float64
SCHEDULE = numba.types.void(_number, _number, _number, _vector, _vector)
FORCE = numba.types.void(*[_vector] * 8)


def compiled(
    function: Callable[..., Any] | None = None, *, signature: Any = None, fast: bool = False, free: bool = False
) -> Any:
    """Compile a function with numba and keep the result on disk; a `free` one lets other threads run beside it.

    Where neither the package's nor the user's cache folder can be written, the cache goes to the temporary folder.
    """
    if function is None:
        return lambda given: compiled(given, signature=signature, fast=fast, free=free)
    options: dict[str, Any] = {"fastmath": FAST} if fast else {}
    if free:
        options["nogil"] = True
    arguments = (signature,) if signature is not None else ()
    try:
        return numba.njit(*arguments, cache=True, **options)(function)
    except RuntimeError:  # numba: no locator available
        numba.config.CACHE_DIR = str(Path(tempfile.gettempdir()) / "rotorgear-numba")
    try:
        return numba.njit(*arguments, cache=True, **options)(function)
    except (RuntimeError, OSError):
        return numba.njit(*arguments, **options)(function)


def schedule_function(function: Callable[..., Any]) -> Any:
    """Compile the time-dependent part of a force law: (angle, speed, time, parameters, state)."""
    return compiled(function, signature=SCHEDULE)


def force_function(function: Callable[..., Any]) -> Any:
    """Compile the force of a law: (parameters, state, d, v, force, tangent in d, tangent in v, energy)."""
    return compiled(function, signature=FORCE)
