"""All kinds of results, by the word that a file names them with."""

from __future__ import annotations

import pkgutil
from functools import cache
from importlib import import_module

import rotorgear.results
from rotorgear.results.result import Result


@cache
def kinds() -> dict[str, type[Result]]:
    """Return the classes of all results; a new one is here as soon as its file stands in a room of this folder."""
    name = rotorgear.results.__name__
    for module in pkgutil.walk_packages(rotorgear.results.__path__, f"{name}."):
        if not module.ispkg and not module.name.startswith(f"{name}.tables."):
            import_module(module.name)
    return dict(Result.kinds)
