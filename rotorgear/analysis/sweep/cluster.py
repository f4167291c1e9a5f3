"""Workers on other machines, or in other processes, that take the blocks of a sweep: a client of dask's scheduler."""

from __future__ import annotations

import asyncio
import logging
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import cache
from typing import Any

from rotorgear.errors import AnalysisError, MissingExtraError, RotorgearError
from rotorgear.files.numbers import is_count

# Seconds that a scheduler, or its first worker, gets to answer.
TIMEOUT = 10.0
# Seconds between two looks whether any worker is left, and looks without one after which a run is given up.
_LOOK = 5.0
_PATIENCE = 12
# Blocks that are sent for each thread of the workers: enough to keep them busy, and no more to lie in the scheduler's memory.
_AHEAD = 3
_MOST_LOCAL = 256
_FORMS = "the address of a dask scheduler such as tcp://host:8786 or tls://host:8786, or local:N for N processes on this machine"


def cluster(address: Any, *, timeout: float = TIMEOUT) -> Cluster:
    """Return workers as an executor for `rotorgear.sweep(..., executor=...)`; use it in a `with` statement.

    Args:
        address: of a dask scheduler ("tcp://host:8786"), or "local:N" for N processes of one thread on this machine, or a
            `distributed.Client`, which stays open.
        timeout: seconds that the scheduler and its first worker get to answer.

    Raises:
        MissingExtraError: distributed is not installed.
        AnalysisError: no scheduler or no worker answers, or a worker does not run what this computer runs.
    """
    try:
        import distributed
    except ImportError:
        raise MissingExtraError("Work on many machines", "distributed", "cluster") from None
    if not isinstance(address, str):
        return Cluster(address, (), str(address.scheduler.address), timeout)
    if address.startswith("local:"):
        number = address.removeprefix("local:")
        if not is_count(number) or not 1 <= int(number) <= _MOST_LOCAL:
            raise AnalysisError(f"cluster: got '{address}', expected {_FORMS} (1 to {_MOST_LOCAL})")
        own = distributed.LocalCluster(
            n_workers=int(number), threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=logging.CRITICAL
        )
        client = distributed.Client(own, set_as_default=False, timeout=timeout)
        return Cluster(client, (client, own), address, timeout)
    # A client that is made without a scheduler would leave tasks behind: it has to answer first.
    from distributed import Security
    from distributed.comm import connect

    async def knock() -> None:
        comm = await connect(address, timeout=timeout, **Security().get_connection_args("client"))
        await comm.close()

    try:
        with ThreadPoolExecutor(1) as thread:  # a notebook has a loop in this one
            thread.submit(lambda: asyncio.run(knock())).result()
    except (ValueError, TypeError) as error:
        raise AnalysisError(f"cluster: got '{address}', expected {_FORMS} ({error})") from None
    except OSError:
        raise AnalysisError(
            f"no dask scheduler answers at {address} within {timeout:g} s: start one with  dask scheduler"
        ) from None
    client = distributed.Client(address, set_as_default=False, timeout=timeout)
    return Cluster(client, (client,), address, timeout)


class Cluster:
    """An executor: `submit(function, *arguments)` returns an object with `result()` and `cancel()`."""

    def __init__(self, client: Any, own: tuple[Any, ...], address: str, timeout: float) -> None:
        self.client = client
        self.address = address
        self._own = own
        self._logger = logging.getLogger("distributed.client")
        self._level = self._logger.level
        if own:  # what goes wrong is said once, in a sentence
            self._logger.setLevel(logging.CRITICAL)
        try:
            self._check(timeout)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Cluster:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Leave the scheduler, and end what was started here."""
        own = self._own
        self._own = ()
        for one in own:
            one.close()
        if own:
            self._logger.setLevel(self._level)

    @property
    def threads(self) -> int:
        """Threads of all workers together; AnalysisError where the scheduler is gone."""
        try:
            return sum(self.client.nthreads().values())
        except (OSError, RuntimeError, TimeoutError):
            raise self.lost() from None

    @property
    def ahead(self) -> int:
        """Blocks that may be on their way at a time."""
        return _AHEAD * max(1, self.threads)

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Block:
        """Hand work to some worker; where that one dies, to another."""
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="Sending large graph")
            # Not pure: equal work has no common name, so that arguments are not hashed.
            return Block(self, self.client.submit(_on_worker, versions(), function, *arguments, pure=False))

    def lost(self) -> AnalysisError:
        """The scheduler is gone."""
        return AnalysisError(f"the scheduler at {self.address} is gone, and with it all blocks that were not done")

    def _check(self, timeout: float) -> None:
        """AnalysisError where there is no worker, or one that runs something else."""
        try:
            self.client.wait_for_workers(1, timeout=timeout)
        except TimeoutError:
            raise AnalysisError(
                f"no worker has joined the scheduler at {self.address}: start some with  dask worker {self.address}"
            ) from None
        here = versions()
        for worker, there in self.client.run(_look(), on_error="return").items():
            words = difference(here, there) if isinstance(there, dict) else f"can't be asked what it runs ({there})"
            if words:
                raise AnalysisError(f"the worker {worker} {words}: install the same on all machines")


class Block:
    """Work that some worker does."""

    def __init__(self, owner: Cluster, future: Any) -> None:
        self._owner = owner
        self._future = future

    def cancel(self) -> None:
        """Give the work up; what a worker has begun it finishes, and the result is dropped."""
        with suppress(OSError, RuntimeError, TimeoutError):
            self._future.cancel()

    def result(self) -> Any:
        """Wait for it.

        Raises:
            AnalysisError: it failed, its workers died, the scheduler is gone, or no worker was left for a minute.
        """
        from distributed import CancelledError, KilledWorker

        missed = 0
        while True:
            try:
                return self._future.result(timeout=_LOOK)
            except RotorgearError:
                raise
            except CancelledError:
                raise self._owner.lost() from None
            except KilledWorker:
                from dask import config

                deaths = int(config.get("distributed.scheduler.allowed-failures", 3)) + 1
                raise AnalysisError(
                    f"a block of points ended {deaths} workers at {self._owner.address}, one after the other: their logs say "
                    "why (too little memory?)"
                ) from None
            except Exception as error:
                if not isinstance(error, TimeoutError) or self._future.done():
                    raise AnalysisError(
                        f"a block of points failed on a worker: {type(error).__name__}: {error}"
                    ) from error
                missed = 0 if self._owner.threads else missed + 1
                if missed >= _PATIENCE:
                    raise AnalysisError(f"no worker is left at {self._owner.address}: start some, and go on") from None


def _on_worker(caller: dict[str, str], function: Callable[..., Any], *arguments: Any) -> Any:
    """What a worker does; it may have joined after the others were checked."""
    from rotorgear.solvers.sparse.factor import single_thread

    words = difference(caller, versions())
    if words:
        raise AnalysisError(f"a worker {words}: install the same on all machines")
    with single_thread(0):
        return function(*arguments)


def difference(here: dict[str, str], there: dict[str, str]) -> str:
    """The first thing that a worker runs another version of, in words; "" where there is none."""
    others = ((name, there.get(name, "none"), version) for name, version in here.items())
    told = (f"runs {name} {other}, and this computer {version}" for name, other, version in others if other != version)
    return next(told, "")


@cache
def versions() -> dict[str, str]:
    """Versions that a result depends on, here."""
    by_name: dict[str, str] = _look()()
    return by_name


def _look() -> Callable[[], dict[str, str]]:
    """A function that tells versions where it runs; being local, it goes to workers whole, even to those without rotorgear."""

    def look() -> dict[str, str]:
        import hashlib
        import platform
        from importlib import import_module
        from pathlib import Path

        by_name = {"Python": ".".join(platform.python_version_tuple()[:2])}
        for name in ("rotorgear", "numpy", "numba"):
            try:
                by_name[name] = str(import_module(name).__version__)
            except ImportError:
                by_name[name] = "none"
        if by_name["rotorgear"] != "none":
            home = Path(str(import_module("rotorgear").__file__)).parent
            mark = hashlib.sha256()
            for file in sorted(home.rglob("*.py"), key=lambda one: one.relative_to(home).as_posix()):
                mark.update(file.relative_to(home).as_posix().encode() + file.read_bytes().replace(b"\r\n", b"\n"))
            by_name["rotorgear with the source"] = mark.hexdigest()[:8]
        return by_name

    return look
