"""Result of a convergence study: error against run time and size over a series of discretisations."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import isfinite
from typing import Any


@dataclass(frozen=True)
class Rung:
    """One discretisation of the study.

    Attributes:
        method: what was asked for, such as "4 basic elements per segment" or "accuracy 1e-05".
        family: rungs of one family form a curve: "elements" or "accuracy".
        setting: the number that was asked for.
        dofs: number of degrees of freedom solved in the last step.
        seconds: median wall time of the whole analysis.
        error: largest relative error of a frequency against the reference; infinite where there are too few modes.
        estimate: largest error that the analysis itself estimated.
        order: measured order of the error in the element length against the rung before; None where it makes no sense.
    """

    method: str
    family: str
    setting: float
    dofs: int
    seconds: float
    error: float
    estimate: float
    order: float | None


@dataclass(frozen=True)
class ConvergenceStudy:
    """Rungs of one model and analysis.

    `reference` says what the errors are measured against; `modes` how many frequencies, or contact forces.
    """

    title: str
    analysis: str
    reference: str
    modes: int
    rungs: tuple[Rung, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are the attributes'."""
        rungs = [{key: _finite(value) for key, value in asdict(rung).items()} for rung in self.rungs]
        return {**asdict(self), "rungs": rungs, "analysis": "accuracy", "of": self.analysis}


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not isfinite(value) else value
