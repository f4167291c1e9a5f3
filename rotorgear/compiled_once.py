"""Processes that need the same compiled function at once: one compiles it, the others wait and take what it keeps.

Machine code depends on which of the inner functions were compiled along and which came from the disk, in the last bit of sums
too. With one version for all, runs of several workers and runs that go on after a kill are the same bit for bit from the first.
"""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import IO, Any

# The longest compilation is some 20 s; after this, whoever holds the lock has failed or hangs.
LONGEST_WAIT = 120.0
_PAUSE = 0.05


class CompiledOnce:
    """The cache of one compiled function, with a lock from where nothing is found until what was compiled is kept."""

    def __init__(self, cache: Any, lock: Path) -> None:
        self._cache = cache
        self._path = lock
        self._held: IO[bytes] | None = None

    def __getattr__(self, name: str) -> Any:
        return getattr(self._cache, name)

    def load_overload(self, signature: Any, context: Any) -> Any:
        """What is kept for a signature; None after which the caller compiles, and no other process does."""
        found = self._cache.load_overload(signature, context)
        if found is not None:
            return found
        self._acquire()
        found = self._cache.load_overload(signature, context)
        if found is not None:
            self._release()
        return found

    def save_overload(self, signature: Any, data: Any) -> None:
        """Keep what was compiled, and let the others have it."""
        try:
            self._cache.save_overload(signature, data)
        finally:
            self._release()

    def _acquire(self) -> None:
        # Held still where compiling failed before.
        if self._held is not None:
            return
        try:
            file = self._path.open("ab")
        except OSError:
            return
        end = time.monotonic() + LONGEST_WAIT
        while not _locked(file):
            if time.monotonic() > end:
                file.close()
                return
            time.sleep(_PAUSE)
        self._held = file

    def _release(self) -> None:
        # The system lets go of a lock when its file is closed, also by a kill.
        if self._held is not None:
            self._held.close()
            self._held = None


def _locked(file: IO[bytes]) -> bool:
    """Take the lock on an open file if nobody has it."""
    try:
        if os.name == "nt":
            import msvcrt

            file.seek(0)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
