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


# Told of what, how many CPU seconds it will take, and for what of it.
Foretold = Callable[[str, float, str], None]
_FORETOLD: ContextVar[Foretold | None] = ContextVar("foretold", default=None)


@contextmanager
def hearing_forecasts(heard: Foretold) -> Iterator[None]:
    """Let analyses tell what they will take while this lasts, once they have measured a first small part of their work."""
    token = _FORETOLD.set(heard)
    try:
        yield
    finally:
        _FORETOLD.reset(token)


def foretell(what: str, seconds: float, more: str = "in all") -> None:
    """Tell whoever hears forecasts how many CPU seconds an analysis will take, without compilation; `more`: for what of it."""
    if heard := _FORETOLD.get():
        heard(what, seconds, more)
