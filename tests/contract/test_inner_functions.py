"""Machine code with reordered sums is never shared by name between compiled loops.

A function that stays a call inside a loop is linked to whichever copy of it the process has loaded first: that of another loop,
or one that was compiled alone. Without reordered sums all copies give the same bits; with them they do not.
"""

from __future__ import annotations

import ast
import dis
import importlib
import pkgutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from numba.core.registry import CPUDispatcher

from rotorgear.solvers.time.compiled import COMPILED
from tests.paths import ROOT


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


def has_entry(function: Any) -> bool:
    return not function.targetoptions.get("no_cpython_wrapper")


def named_in_python(path: Path) -> Iterator[tuple[str, str]]:
    """Names that the plain Python functions of a file use, with the function; those of functions that are compiled not."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef) and not is_compiled(node):
            yield from ((name, node.name) for name in names_in_python(node))


def names_in_python(node: ast.AST) -> Iterator[str]:
    """Names below a node, but for those in functions that are compiled."""
    for inside in ast.iter_child_nodes(node):
        if isinstance(inside, ast.Name):
            yield inside.id
        if not (isinstance(inside, ast.FunctionDef) and is_compiled(inside)):
            yield from names_in_python(inside)


def is_compiled(function: ast.FunctionDef) -> bool:
    return any(map(compiles, function.decorator_list))


def compiles(decorator: ast.expr) -> bool:
    made = decorator.func if isinstance(decorator, ast.Call) else decorator
    return isinstance(made, ast.Name) and made.id in {
        "compiled",
        "formula",
        "intrinsic",
        "force_function",
        "schedule_function",
    }


def test_python_calls_no_function_that_has_no_entry_for_it() -> None:
    # Some versions of numba end the process where it does.
    without = [name for name, each in compiled_functions().items() if not has_entry(each)]
    assert len(without) > 50, "none found: this test looks in the wrong place"
    for place in COMPILED:
        for file in (ROOT / "rotorgear" / place).glob("*.py"):
            module = importlib.import_module(f"rotorgear.{place.replace('/', '.')}.{file.stem}")
            for name, function in named_in_python(file):
                used = getattr(module, name, None)
                assert not isinstance(used, CPUDispatcher) or has_entry(used), f"{file.name}: {function} calls {name}"
