"""Former names of arguments, options and keys: still read for one version, with a warning that says the new one.

The tables stand beside what they name: `model/parts/old_names.py` for keys of the model file, `cli/old_options.py` for options.
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Mapping
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


class OldNameWarning(FutureWarning):
    """A name was used that the next version no longer reads; the text says the new one."""


def warn_old(what: str, old: str, new: str, stacklevel: int = 3) -> None:
    """Warn that `old` is now called `new`; `what` says what it names, such as "argument of sweep"."""
    warnings.warn(
        f"{what} '{old}' is now '{new}'; the old name is read for the last time in this version",
        OldNameWarning,
        stacklevel=stacklevel,
    )


def renamed_arguments(**names: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Let a function take former names of its keyword arguments: `@renamed_arguments(old="new")`.

    Raises:
        TypeError: by the decorated function, where both names are given.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @functools.wraps(function)
        def with_old_names(*args: P.args, **kwargs: P.kwargs) -> R:
            return function(*args, **_current(kwargs, names, f"{function.__name__}: argument"))

        return with_old_names

    return decorate


def _current(kwargs: Mapping[str, Any], names: Mapping[str, str], what: str) -> dict[str, Any]:
    """Arguments by their present names. One given by both stays as it is, so that the function refuses the old one."""
    current = {}
    for key, value in kwargs.items():
        new = names.get(key, key)
        if new != key and new not in kwargs:
            warn_old(what, key, new, stacklevel=4)
            current[new] = value
        else:
            current[key] = value
    return current
