"""Where long work keeps what is done, so that an interrupted run goes on from there."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any, Protocol


class Stream(Protocol):
    """Where a run writes its chunks, and from where an interrupted run continues."""

    def begin(self, settings: dict[str, str]) -> list[dict[str, Any]]:
        """Say what is run; returns the chunks that are there already of the same run, all or none."""

    def write(self, chunk: dict[str, Any]) -> None:
        """Keep a chunk, whole or not at all: arrays, numbers, texts, records, and tuples of them."""


Piece = Callable[[Callable[[], dict[str, Any]]], dict[str, Any]]


def pieces(stream: Stream | None, settings: dict[str, str]) -> Piece:
    """Return a function that does a piece of work, or takes over what an interrupted run of these settings kept of it.

    A run asks for its pieces in an order that depends on nothing but its settings and on the pieces before.

    Args:
        stream: keeps the pieces; without one each is done.
        settings: tell this run from another one.

    Raises:
        RotorgearError: the stream holds another run.
    """
    if stream is None:
        return unkept
    kept = deque(stream.begin(settings))

    def piece(work: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        if kept:
            return kept.popleft()
        done = work()
        stream.write(done)
        return done

    return piece


def unkept(work: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """Do a piece of work and keep it nowhere."""
    return work()
