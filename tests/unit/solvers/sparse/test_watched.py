"""Long compiled work is told about and can be left."""

from __future__ import annotations

import threading
import time

import pytest

from rotorgear.errors import ConvergenceError
from rotorgear.progress import listener, listening
from rotorgear.solvers.sparse import large as module
from rotorgear.solvers.sparse.large import watched


@pytest.fixture(autouse=True)
def _often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_TELL_EVERY", 0.01)


def test_an_interrupt_leaves_work_that_goes_on() -> None:
    goes_on = threading.Event()

    def interrupted(_: float) -> None:
        raise KeyboardInterrupt

    started = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        watched(lambda: goes_on.wait(20.0), 100.0, interrupted)
    assert time.perf_counter() - started < 5.0
    goes_on.set()


def test_it_tells_the_share_of_the_forecast_and_returns_what_the_work_does() -> None:
    told: list[float] = []
    assert watched(lambda: time.sleep(0.1) or 7, 2.0, told.append) == 7  # type: ignore[func-returns-value]
    assert told == sorted(told)
    assert 0.0 < told[-1] <= 0.95


def test_what_the_work_raises_is_raised() -> None:
    def fails() -> None:
        raise ConvergenceError("singular")

    with pytest.raises(ConvergenceError, match="singular"):
        watched(fails, 100.0, lambda _: None)


def test_the_work_knows_who_listens_and_short_work_needs_no_thread() -> None:
    def mine(fraction: float, text: str) -> None:
        pass

    with listening(mine):
        assert watched(listener, 100.0, lambda _: None) is mine
    assert watched(threading.current_thread, 0.1, lambda _: None) is threading.current_thread()
