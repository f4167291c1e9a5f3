"""All kinds of results, by the word that a file names them with."""

from __future__ import annotations

import pkgutil
from functools import cache
from importlib import import_module

import rotorgear.results
from rotorgear.results.result import Result


@cache
def kinds() -> dict[str, type[Result]]:
    """Return the classes of all results; a new one is here as soon as its file stands in this folder."""
    for module in pkgutil.iter_modules(rotorgear.results.__path__):
        if not module.ispkg:
            import_module(f"{rotorgear.results.__name__}.{module.name}")
    return dict(Result.kinds)
