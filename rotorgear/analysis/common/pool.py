"""Work that goes to threads here, or to an executor of the caller's, and comes back in its own order."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from functools import partial
from itertools import islice
from typing import Any, Protocol

from rotorgear.analysis.common.stream import Piece
from rotorgear.cpu import taken, timed

# Seconds between two looks at work that takes long.
_EVERY = 1.0


class Pool(Protocol):
    """Where blocks may go: `submit` returns an object with `result()` and `cancel()`, as `concurrent.futures` have it.

    Where it has a number `ahead`, no more blocks than that are handed over before the first of them is done.
    """

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Any:
        """Take a call."""


def in_order(
    function: Callable[..., Any],
    tasks: Iterable[tuple[Any, ...]],
    workers: int | None,
    executor: Pool | None,
    *,
    watch: Callable[[], None] | None = None,
    stop: Callable[[], None] = lambda: None,
    spent: Callable[[float], None] = lambda seconds: None,
) -> Iterator[Any]:
    """Yield function(*task) of every task, in order; what waits is given up where nobody asks on.

    Args:
        function: what is called. tasks: its arguments. workers: threads here. executor: in place of them.
        watch: called every second while threads here are at work. stop: tells them at the end that nobody asks on.
        spent: told the CPU seconds of each task.
    """
    own = None if executor else ThreadPoolExecutor(max_workers=workers or os.cpu_count() or 1)
    pool: Any = executor or own
    waiting: deque[Any] = deque()
    rest = iter(tasks)
    try:
        while True:
            room = getattr(pool, "ahead", 2 * (workers or os.cpu_count() or 1)) - len(waiting)
            some = islice(rest, max(0, room))
            waiting.extend(pool.submit(timed, function, *task) for task in some)
            if not waiting:
                return
            while own and watch and wait([waiting[0]], timeout=_EVERY).not_done:
                watch()
            answer = waiting[0].result()
            spent(answer[-1])
            yield taken(answer)
            waiting.popleft()
    finally:
        stop()
        for future in waiting:
            future.cancel()
        if own:
            own.shutdown(wait=True, cancel_futures=True)


def in_pieces(
    function: Callable[..., dict[str, Any]], tasks: Sequence[tuple[Any, ...]], piece: Piece, executor: Pool | None
) -> Iterator[dict[str, Any]]:
    """Yield function(*task) of every task, in order, each a piece that may be kept; what is not done yet goes to an executor.

    Args:
        function: what is called. tasks: its arguments. piece: does the work of a task, or takes it over.
        executor: does all that is left at once; without one it is done here, when its turn comes.
    """
    answers: Iterator[dict[str, Any]] | None = None

    def work(number: int) -> dict[str, Any]:
        nonlocal answers
        if executor is None:
            return function(*tasks[number])
        if answers is None:  # what was kept comes first
            answers = in_order(function, tasks[number:], None, executor)
        return next(answers)

    for number in range(len(tasks)):
        yield piece(partial(work, number))
