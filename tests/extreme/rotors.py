"""Shafts that several extreme cases share."""

from __future__ import annotations

from tests.extreme.references import Segment, Spring

ALL = 100_000  # more modes than any case has


def even(length: float = 0.1, outer: float = 0.05, count: int = 5, inner: float = 0.0) -> list[Segment]:
    return [Segment(length, outer, inner) for _ in range(count)]


def on(stiffness: float, other: float | None = None, damping: float = 0.0, last: int = 5) -> dict[int, Spring]:
    return {0: Spring(stiffness, damping=damping), last: Spring(stiffness if other is None else other, damping=damping)}
