"""Machine code with reordered sums is never shared by name between compiled loops.

A function that stays a call inside a loop is linked to whichever copy of it the process has loaded first: that of another loop,
or one that was compiled alone. Without reordered sums all copies give the same bits; with them they do not.
"""

from __future__ import annotations

import dis
import importlib
import pkgutil
from collections.abc import Iterator
from typing import Any

from numba.core.registry import CPUDispatcher

from rotorgear.solvers.time.compiled import COMPILED


def compiled_functions() -> dict[str, Any]:
    found = {}
    for place in COMPILED:
        package = importlib.import_module("rotorgear." + place.replace("/", "."))
        for module in pkgutil.iter_modules(package.__path__, package.__name__ + "."):
            for each in vars(importlib.import_module(module.name)).values():
                if isinstance(each, CPUDispatcher):
                    found[f"{each.py_func.__module__}.{each.py_func.__name__}"] = each
    return found


def called_by(function: Any) -> Iterator[Any]:
    """Compiled functions that a compiled function names."""
    for step in dis.get_instructions(function.py_func):
        other = function.py_func.__globals__.get(step.argval) if step.opname == "LOAD_GLOBAL" else None
        if isinstance(other, CPUDispatcher):
            yield other


def reorders(function: Any) -> bool:
    return bool(function.targetoptions.get("fastmath")) or any(map(reorders, called_by(function)))


def test_what_reorders_sums_becomes_part_of_who_calls_it() -> None:
    functions = compiled_functions()
    called = {other for function in functions.values() for other in called_by(function)}
    shared = [
        name
        for name, each in functions.items()
        if each in called and reorders(each) and not each.targetoptions.get("forceinline")
    ]
    assert sum(map(reorders, functions.values())) > 20, "none found: this test looks in the wrong place"
    assert shared == []
