"""What can go wrong, in sentences a user can act on.

Every error that a user can cause derives from `RotorgearError`; the command line prints its text and exits with code 2.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


class RotorgearError(Exception):
    """Base of every error that is the input's fault, or that the user can remedy."""


@dataclass(frozen=True)
class Problem:
    """One mistake in a model: where it is, what stands there, what was expected.

    `hint` carries the remedy or the nearest valid name; it may be empty. Without a value, `expected` is a whole sentence.
    """

    address: str
    value: str
    expected: str
    hint: str = ""

    def __str__(self) -> str:
        got = f"got {self.value}, " if self.value else ""
        hint = f" ({self.hint})" if self.hint else ""
        wanted = f"expected {self.expected}" if self.value else self.expected
        return f"{self.address}: {got}{wanted}{hint}"


MOST_SHOWN = 100  # problems of one model that are printed; `problems` holds them all


class ModelError(RotorgearError):
    """All the problems of a model at once, found before any matrix is built."""

    def __init__(self, problems: Iterable[Problem], source: str = "model") -> None:
        self.problems = tuple(problems)
        self.source = source
        count = len(self.problems)
        head = f"{source}: {count} problem{'s' if count != 1 else ''}"
        lines = [f"  {problem}" for problem in self.problems[:MOST_SHOWN]]
        if count > MOST_SHOWN:
            lines.append(f"  and {count - MOST_SHOWN} more")
        super().__init__("\n".join([head, *lines]))


class AnalysisError(RotorgearError):
    """An analysis was asked for something that it can't give; the text says what and how to go on."""


class ConvergenceError(AnalysisError):
    """A solver's guard was not met. `partial` holds what was found so far."""

    def __init__(self, message: str, partial: Any = None) -> None:
        super().__init__(message)
        self.partial = partial


class Interrupted(KeyboardInterrupt):
    """Ctrl-C in a long analysis. `result` holds what was done until then; its status says how much that is."""

    def __init__(self, result: Any) -> None:
        super().__init__()
        self.result = result


class MissingExtraError(RotorgearError):
    """An optional dependency is needed for what was asked; the text names the extra to install."""

    def __init__(self, purpose: str, package: str, extra: str) -> None:
        super().__init__(f"{purpose} needs the package {package}: install it with  pip install 'rotorgear[{extra}]'")
