"""Compiled functions on disk: processes that need the same one at once, and files that are not what was written.

Processes that need the same compiled function at once: one compiles it, the others wait and take what it keeps.

Machine code depends on which of the inner functions were compiled along and which came from the disk, in the last bit of sums
too. With one version for all, runs of several workers and runs that go on after a kill are the same bit for bit from the first.

A file that was cut, or in which a bit has turned, ends Python where it is loaded. So each has its SHA-256 beside it, and without
that one it counts as not there.
"""

from __future__ import annotations

import hashlib
import logging
import os
import time
import uuid
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

from rotorgear.progress import foretell

# The longest compilation is some 20 s; after this, whoever holds the lock has failed or hangs.
LONGEST_WAIT = 120.0
_PAUSE = 0.05
_SUM = ".sha256"
_logger = logging.getLogger(__name__)


class CompiledOnce:
    """The cache of one compiled function, with a lock from where nothing is found until what was compiled is kept."""

    def __init__(self, cache: Any, lock: Path, beginning: str = "", seconds: float = 0.0) -> None:
        """`beginning` is that of the names of its files, in the folder that the cache names `cache_path`; "" to check none.

        `seconds`: CPU seconds that the function takes to compile, which are foretold before it does; 0 for what is not felt.
        """
        self._cache = cache
        self._path = lock
        self._beginning = beginning
        self._seconds = seconds
        self._foretold = False
        self._held: IO[bytes] | None = None

    def __getattr__(self, name: str) -> Any:
        return getattr(self._cache, name)

    def load_overload(self, signature: Any, context: Any) -> Any:
        """What is kept for a signature; None after which the caller compiles, and no other process does."""
        found = None if self._damaged() else self._cache.load_overload(signature, context)
        if found is not None:
            return found
        self._foretell()
        self._acquire()
        # Who held the lock may have written in between; what is still damaged now stays so.
        if damaged := self._damaged():
            _logger.warning("compiled code in %s is damaged: it is compiled anew", self._cache.cache_path)
            for file in damaged:
                for one in (file, _sum_of(file)):
                    with suppress(OSError):
                        one.unlink()
        found = self._cache.load_overload(signature, context)
        if found is not None:
            self._release()
        return found

    def save_overload(self, signature: Any, data: Any) -> None:
        """Keep what was compiled, and let the others have it; a full disk costs time only."""
        self._foretold = False
        try:
            with suppress(OSError):
                self._cache.save_overload(signature, data)
                for file in self._files():
                    if _sum_of(file).exists() and _is_whole(file):
                        continue
                    scratch = file.with_name(f".{uuid.uuid4().hex}")
                    scratch.write_text(hashlib.sha256(file.read_bytes()).hexdigest(), encoding="ascii")
                    os.replace(scratch, _sum_of(file))
        finally:
            self._release()

    def foretell_unless_kept(self) -> None:
        """Tell whoever hears forecasts what compilation will take if nothing is on the disk; where others compile, unheard."""
        if not self._files():
            self._foretell()

    def _foretell(self) -> None:
        if self._seconds and not self._foretold:
            self._foretold = True
            foretell("compiling, once", self._seconds, "that no run time holds; rotorgear compile does it ahead")

    def _files(self) -> list[Path]:
        """The files of the function; the dot behind its line tells it from one whose line has more digits."""
        if not self._beginning:
            return []
        try:
            with os.scandir(self._cache.cache_path) as entries:
                names = [one.name for one in entries if one.name.startswith(self._beginning)]
        except OSError:
            return []
        return [Path(self._cache.cache_path, name) for name in names if name.endswith((".nbi", ".nbc"))]

    def _damaged(self) -> list[Path]:
        return [file for file in self._files() if not _is_whole(file)]

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


def _sum_of(file: Path) -> Path:
    return file.with_name(file.name + _SUM)


def _is_whole(file: Path) -> bool:
    """Whether a file has the sum that stands beside it."""
    try:
        return _sum_of(file).read_text(encoding="ascii") == hashlib.sha256(file.read_bytes()).hexdigest()
    except (OSError, ValueError):
        return False
