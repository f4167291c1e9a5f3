"""Progress of long work: an optional callable (fraction 0..1, text). The command line owns the bar."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

Progress = Callable[[float, str], None]


def silent(fraction: float, text: str) -> None:
    """Report to nobody: the default wherever a `Progress` is asked for."""


def part_of(progress: Progress, start: float, end: float) -> Progress:
    """Progress of one step of longer work, which takes it from `start` to `end`."""
    return lambda fraction, text: progress(start + (end - start) * fraction, text)


_LISTENER: ContextVar[Progress | None] = ContextVar("listener", default=None)


@contextmanager
def listening(progress: Progress) -> Iterator[None]:
    """Let work deep inside, such as teeth that a mesh of the model asks for, tell what it does while this lasts."""
    token = _LISTENER.set(progress)
    try:
        yield
    finally:
        _LISTENER.reset(token)


def listener() -> Progress:
    """Whoever listens now, or nobody."""
    return _LISTENER.get() or silent
