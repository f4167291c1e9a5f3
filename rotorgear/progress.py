"""Progress of long work: an optional callable (fraction 0..1, text). The command line owns the bar."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[float, str], None]


def silent(fraction: float, text: str) -> None:
    """Report to nobody: the default wherever a `Progress` is asked for."""
