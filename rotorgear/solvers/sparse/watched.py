"""Long work in compiled code, told about while it goes on and left at once by an interrupt.

Python meets a signal between two of its own steps only, and a factorisation is one step of a minute. SuperLU and Pardiso let
Python go on beside them: the work runs in a thread, and the main thread waits for it and for Ctrl-C.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextvars import copy_context
from typing import Any, TypeVar

T = TypeVar("T")
# Shorter work than this is waited for.
_SHORT = 2.0
_TELL_EVERY = 0.5
# A forecast that was too short leaves the bar here.
_MOST = 0.95


def watched(work: Callable[[], T], seconds: float, tell: Callable[[float], None]) -> T:
    """What `work()` returns, or raises.

    An interrupt leaves it at once. The thread is a daemon: with the process it ends; a session that goes on has it compute to its
    end, for nobody.

    Args:
        work: compiled code that lets go of Python's lock.
        seconds: that it takes, about.
        tell: told the share that is done, by the clock.
    """
    if seconds < _SHORT or threading.current_thread() is not threading.main_thread():
        return work()
    done: dict[str, Any] = {}
    context = copy_context()

    def run() -> None:
        try:
            done["value"] = context.run(work)
        except BaseException as error:  # raised where it is waited for
            done["error"] = error

    thread = threading.Thread(target=run, daemon=True)
    started = time.perf_counter()
    thread.start()
    while thread.is_alive():
        thread.join(_TELL_EVERY)
        tell(min((time.perf_counter() - started) / seconds, _MOST))
    if "error" in done:
        raise done["error"]
    found: T = done["value"]
    return found
