"""What long work in many pieces will take in all, told once, from the CPU seconds of its first pieces."""

from __future__ import annotations

from rotorgear.cpu import compiling_seconds, cpu_seconds
from rotorgear.progress import Progress, foretell

# Pieces that are measured, where the work has some times as many.
_MEASURED = 3
_TIMES = 4
# Share of work that tells its progress, from which on it is measured.
_SHARE = 0.03


class Forecast:
    """The forecast of an analysis.

    Args:
        what: the analysis. before: CPU seconds that it has taken already. pieces: how many are to come, about equal ones,
            where it is told of each.
        whole: of what it is the forecast.
    """

    def __init__(self, what: str, before: float, pieces: int = 0, whole: str = "in all") -> None:
        self._what = what
        self._whole = whole
        self._before = before
        self._pieces = pieces
        self._compiled = compiling_seconds()
        self._seconds: list[float] = []
        self._told = False

    @property
    def few(self) -> bool:
        """Whether the first piece alone is a large part of the work."""
        return self._pieces < _TIMES

    def add(self, seconds: float) -> None:
        """Hear the CPU seconds of a piece, compilation included."""
        self._seconds.append(seconds)
        if not self.few and len(self._seconds) == min(_MEASURED, max(self._pieces // _TIMES, 1)):
            spent = sum(self._seconds) - (compiling_seconds() - self._compiled)
            self.tell(self._pieces * max(spent, 0.0) / len(self._seconds))

    def measuring(self, progress: Progress, end: float = 1.0) -> Progress:
        """A progress that is passed on; the work up to `end` of it is foretold from what a first share of it has taken."""
        first: list[tuple[float, float]] = []

        def told(fraction: float, step: str) -> None:
            progress(fraction, step)
            used = cpu_seconds() - compiling_seconds()
            # From the first word on: what a run takes over from another one takes no time.
            first.append((fraction, used))
            begin, start = first[0]
            del first[1:]
            if fraction - begin >= _SHARE * (end - begin) > 0.0:
                self.tell((used - start) * (end - begin) / (fraction - begin))

        return told

    def tell(self, seconds: float, more: str = "") -> None:
        """Say that all pieces take these seconds, unless it has been said."""
        if not self._told:
            foretell(self._what, self._before + seconds, more or self._whole)
        self._told = True
