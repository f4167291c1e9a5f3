"""Compilation of inner loops by numba, kept on disk between runs.

Only modules named `kernel_*` and force laws import this one, and they are imported inside the functions that need them.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from rotorgear.cpu import CompilationWatch
from rotorgear.errors import MissingExtraError
from rotorgear.files.cache import folder_of_version
from rotorgear.files.compiled_once import CompiledOnce
from rotorgear.fingerprint import fingerprint

try:
    import numba
    from numba.core import event
    from numba.core.errors import NumbaExperimentalFeatureWarning
except ImportError:
    raise MissingExtraError("Integration in time", "numba", "transient") from None

# The lock is held while a function is compiled, or read from the disk.
event.register("numba:compiler_lock", event.Listener.register(CompilationWatch)())
warnings.filterwarnings("ignore", category=NumbaExperimentalFeatureWarning)
# Places in the package whose functions are compiled, or compiled into others.
COMPILED = ("forces", "solvers/contact", "solvers/time", "solvers/batch", "solvers/periodic")
# Sums may be reordered so that they vectorise; NaN and infinity keep their meaning, so that divergence is seen.
FAST = {"contract", "nsz", "reassoc"}
_vector = numba.types.Array(numba.types.float64, 1, "C")
_number = numba.types.float64
SCHEDULE = numba.types.void(_number, _number, _number, _vector, _vector)
FORCE = numba.types.void(*[_vector] * 8)


@cache
def cache_folder() -> Path | None:
    """Where compiled code of these very sources is kept; None where there is no folder to trust.

    numba marks what it keeps by the file of the outer function alone. Functions of other files are compiled into it, so a change
    of theirs would be answered with old machine code. The folder is therefore named by a hash of all sources that compiled code
    may come from. It lies below NUMBA_CACHE_DIR, ROTORGEAR_CACHE or the user's cache folder.
    """
    return folder_of_version(
        "compiled", fingerprint(*COMPILED), numba.config.CACHE_DIR or os.environ.get("ROTORGEAR_CACHE")
    )


def compiled(
    function: Callable[..., Any] | None = None,
    *,
    signature: Any = None,
    fast: bool = False,
    free: bool = False,
    inner: bool = False,
    entry: bool = True,
    seconds: float = 0.0,
) -> Any:
    """Compile a function with numba and keep the result on disk.

    Args:
        function: what is compiled.
        signature: its only types; else each call with other types compiles anew.
        fast: sums may be reordered.
        free: other threads may run beside it.
        inner: compiled functions alone call it, and it becomes part of each of them. Otherwise the linker takes the first copy of
            it that the process has loaded, and with reordered sums the last bit would depend on what the process did before.
        entry: Python calls it, or its address is handed over. Without, it is compiled once, not three times; Python must not call
            it.
        seconds: CPU seconds that it took to compile on one core, where users feel them.
    """
    if function is None:
        return lambda given: compiled(
            given, signature=signature, fast=fast, free=free, inner=inner, entry=entry, seconds=seconds
        )
    if numba.config.DISABLE_JIT:
        return function
    options: dict[str, Any] = {"fastmath": FAST} if fast else {}
    if free:
        options["nogil"] = True
    if inner:
        options["forceinline"] = True
    if inner or not entry:
        options |= {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    folder = cache_folder()
    made = None
    if folder is not None:
        # numba takes the folder from its settings when a function is decorated; other users of numba keep theirs.
        before = numba.config.CACHE_DIR
        numba.config.CACHE_DIR = str(folder)
        try:
            made = numba.njit(cache=True, **options)(function)
            place = f"{function.__module__}.{function.__qualname__}-{function.__code__.co_firstlineno}"
            lock = folder / (re.sub(r"[^\w.-]", "_", place) + ".lock")
            # numba names its files by the module's last name, the function and its line.
            stem = Path(function.__code__.co_filename).stem
            name = (
                f"{stem}.{function.__qualname__.replace('<', '').replace('>', '')}-{function.__code__.co_firstlineno}."
            )
            made._cache = CompiledOnce(made._cache, lock, name, seconds)
        except (RuntimeError, OSError):  # a function without a file, such as one typed at a prompt
            made = None
        finally:
            numba.config.CACHE_DIR = before
    if made is None:
        made = numba.njit(**options)(function)
    if signature is not None:
        made.compile(signature)
        made.disable_compile()
    return made


def schedule_function(function: Callable[..., Any]) -> Any:
    """Compile the time-dependent part of a force law.

    Args:
        function: (angle, speed, time, parameters, state).

    Returns:
        The compiled function.
    """
    return compiled(function, signature=SCHEDULE)


def force_function(function: Callable[..., Any]) -> Any:
    """Compile the force of a law.

    Args:
        function: (parameters, state, d, v, force, tangent in d, tangent in v, energy).

    Returns:
        The compiled function.
    """
    return compiled(function, signature=FORCE)


class Handed(numba.types.WrapperAddressProtocol):
    """A compiled function as compiled loops take it: its address, found once.

    numba finds type and address of a function anew at each call that it is handed to, which costs more than a thousand
    evaluations of a law.
    """

    def __init__(self, function: Any, signature: Any) -> None:
        kept = function.get_compile_result(signature)
        self._function = function  # its machine code lives as long as it does
        self._signature = signature
        self._address = kept.library.get_pointer_to_function(kept.fndesc.llvm_cfunc_wrapper_name)

    def __wrapper_address__(self) -> int:
        """Address of the machine code."""
        return int(self._address)

    def signature(self) -> Any:
        """What it takes and returns."""
        return self._signature


@cache
def handed(function: Any, signature: Any) -> Any:
    """A compiled function ready to be handed over; where nothing is compiled, the function itself."""
    return function if numba.config.DISABLE_JIT else Handed(function, signature)
