"""Progress of long work: an optional callable (fraction 0..1, text). The command line owns the bar."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[float, str], None]


def silent(fraction: float, text: str) -> None:
    """Report to nobody: the default wherever a `Progress` is asked for."""


def part_of(progress: Progress, start: float, end: float) -> Progress:
    """Progress of one step of longer work, which takes it from `start` to `end`."""
    return lambda fraction, text: progress(start + (end - start) * fraction, text)
