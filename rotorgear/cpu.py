"""The one clock of all run times: CPU seconds of this process with its threads, and of processes that worked for it.

Compilation of machine code is counted apart: it happens once in the life of a cache, in whichever run comes first.
"""

from __future__ import annotations

import os
import platform
import threading
import time
from collections.abc import Callable
from typing import Any

_lock = threading.Lock()
_elsewhere = 0.0
_compiling = 0.0


def cpu_seconds() -> float:
    """CPU seconds so far; differences of two calls are run times."""
    return time.process_time() + _elsewhere


def compiling_seconds() -> float:
    """Those of them that went into compilation."""
    return _compiling


def timed(function: Callable[..., Any], *arguments: Any) -> tuple[Any, tuple[str, int], float]:
    """What a function returns, where it ran, and the CPU seconds of its thread: what a worker sends back."""
    begun = time.thread_time()
    result = function(*arguments)
    return result, _place(), time.thread_time() - begun


def taken(answer: tuple[Any, tuple[str, int], float]) -> Any:
    """The result in what `timed` returned; the seconds of another process join the clock here."""
    global _elsewhere
    result, place, seconds = answer
    if place != _place():  # threads here are on the clock already
        with _lock:
            _elsewhere += seconds
    return result


def _place() -> tuple[str, int]:
    return platform.node(), os.getpid()


class CompilationWatch(threading.local):
    """Told of begin and end of compilations in each thread, which may lie in one another."""

    depth = 0
    begun = 0.0

    def notify(self, event: Any) -> None:
        """A compilation begins, or waits for one in another thread, or ends; the seconds of the outermost one count."""
        global _compiling
        now = time.thread_time()
        if event.is_start:
            self.begun = self.begun if self.depth else now
            self.depth += 1
            return
        self.depth -= 1
        if self.depth == 0:
            with _lock:
                _compiling += now - self.begun


class Clock:
    """CPU seconds that went into each step; those of compilation are a step of their own."""

    def __init__(self) -> None:
        self.laps: dict[str, float] = {}
        self._last = cpu_seconds(), compiling_seconds()

    def lap(self, name: str) -> None:
        """Add the seconds since the last lap to a step."""
        now = cpu_seconds(), compiling_seconds()
        whole, compiling = (here - before for here, before in zip(now, self._last, strict=True))
        self._last = now
        self._add(name, whole - compiling)
        if compiling:
            self._add("compilation", compiling)

    def total(self) -> dict[str, float]:
        """Seconds by step, and their sum as "total"."""
        return {**self.laps, "total": sum(self.laps.values())}

    @property
    def worked(self) -> float:
        """Seconds of all steps so far, without compilation."""
        return sum(self.laps.values()) - self.laps.get("compilation", 0.0)

    def _add(self, name: str, seconds: float) -> None:
        self.laps[name] = self.laps.get(name, 0.0) + max(seconds, 0.0)
