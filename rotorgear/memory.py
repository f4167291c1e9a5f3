"""Memory of this process and of the machine, as far as the system tells."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from rotorgear.errors import AnalysisError
from rotorgear.files.own import text_of


def largest_memory() -> float | None:
    """The most memory that this process has held, in bytes; None where the system does not tell."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return float(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit)


def free_memory() -> float | None:
    """Memory in bytes that the machine can still give, with what its caches would yield; None where the system does not tell."""
    try:
        for line in text_of("/proc/meminfo", "ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return 1024.0 * float(line.split()[1])
        return float(os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (OSError, ValueError, AttributeError):
        return None


def require_memory(needed: float, what: str, remedy: str) -> None:
    """Refuse what the machine can't hold, before it begins.

    Args:
        needed: bytes.
        what: the subject of the sentence, such as "A map of 1360 base pitches".
        remedy: what to do instead.

    Raises:
        AnalysisError: less memory is free.
    """
    free = free_memory()
    if free is not None and needed > free:
        raise AnalysisError(
            f"{what} would take {1e-9 * needed:.2g} GB of memory, and {1e-9 * free:.2g} GB are free: {remedy}"
        )


@contextmanager
def at_most(more: float) -> Iterator[None]:
    """Let this process take so many bytes more within it, and then a MemoryError; no bound where the system has none.

    For readers of other packages, which unpack whatever a file says.
    """
    try:
        import resource

        taken = int(text_of("/proc/self/statm", "ascii").split()[0]) * os.sysconf("SC_PAGE_SIZE")
        before = resource.getrlimit(resource.RLIMIT_AS)
    except (ImportError, OSError, ValueError):
        yield
        return
    bound = int(taken + more)
    soft = bound if before[0] == resource.RLIM_INFINITY else min(bound, before[0])
    try:
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_AS, (soft, before[1]))
        yield
    finally:
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_AS, before)
