"""What long work in many pieces will take in all, told once, from the CPU seconds of its first pieces."""

from __future__ import annotations

from rotorgear.cpu import compiling_seconds
from rotorgear.progress import foretell

# Pieces that are measured, where the work has some times as many.
_MEASURED = 3
_TIMES = 4


class Forecast:
    """The forecast of an analysis.

    Args:
        what: the analysis. before: CPU seconds that it has taken already. pieces: how many are to come, about equal ones.
        whole: of what it is the forecast.
    """

    def __init__(self, what: str, before: float, pieces: int, whole: str = "in all") -> None:
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

    def tell(self, seconds: float, more: str = "") -> None:
        """Say that all pieces take these seconds, unless it has been said."""
        if not self._told:
            foretell(self._what, self._before + seconds, more or self._whole)
        self._told = True
