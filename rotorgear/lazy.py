"""Names that are loaded when they are first used, so that importing a package costs nothing.

The stub of the package (`__init__.pyi`) lists them, one a line:

    from rotorgear.analysis.modal.modal import modal as modal

Type checkers and editors read the stub, and so does `attach`: the names are typed once.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib import import_module
from typing import Any

from rotorgear.files.own import text_of


def homes_of(file: str) -> dict[str, tuple[str, str]]:
    """Public name -> its module and the name that it has there, from the stub beside a package's `__file__`."""
    homes = {}
    # Read as lines rather than parsed: `ast` alone takes longer than the rest of the import.
    for line in text_of(os.path.join(os.path.dirname(file), "__init__.pyi")).splitlines():
        match line.split():
            case ["from", module, "import", name, "as", public]:
                homes[public] = (module, name)
    return homes


def attach(package: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` of a package whose names stand in the stub beside its file.

    Args:
        package: the package's `__name__`.
        file: its `__file__`.
    """
    homes = homes_of(file)

    def load(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        module, own = homes[name]
        return import_module(f"{package}.{own}") if module == package else getattr(import_module(module), own)

    def names() -> list[str]:
        return sorted(homes)

    return load, names, list(homes)
