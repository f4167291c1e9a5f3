"""Result of the convergence study of a sweep: values of one point, their uncertainty and cost over steps and length."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import isfinite
from typing import Any


@dataclass(frozen=True)
class SweepRung:
    """One number of steps and of periods.

    Attributes:
        steps: in a period of the fastest mesh. count: common periods that count. seconds: of integration for one run.
        exponent: mean of the largest Lyapunov exponents of all runs; scatter: their standard deviation; stated: median of
            the standard errors that the runs state.
        peak_to_peak, peak_to_peak_scatter: of the worst contact in m. dynamic_factor, dynamic_factor_scatter: of that contact.
        motion: kinds that occurred.
    """

    steps: int
    count: int
    seconds: float
    exponent: float
    scatter: float
    stated: float
    peak_to_peak: float
    peak_to_peak_scatter: float
    dynamic_factor: float
    dynamic_factor_scatter: float
    motion: tuple[str, ...]


@dataclass(frozen=True)
class SweepConvergenceStudy:
    """Rungs of one model; `runs` is how many states each was run from."""

    title: str
    runs: int
    rungs: tuple[SweepRung, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are the attributes'."""
        rungs = [{key: _finite(value) for key, value in asdict(rung).items()} for rung in self.rungs]
        return {"analysis": "accuracy", "of": "sweep", "title": self.title, "runs": self.runs, "rungs": rungs}


def _finite(value: Any) -> Any:
    if isinstance(value, tuple):
        return list(value)
    return None if isinstance(value, float) and not isfinite(value) else value
