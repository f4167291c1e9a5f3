"""Result of a convergence study: error against run time and size over a series of discretisations."""

from __future__ import annotations

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of


class Rung(Record):
    """One discretisation of the study."""

    method: str = of("what was asked for", note=", in words")
    family: str = of(
        "family of rungs that form a curve", note=': `"elements"` or `"accuracy"`; the method of a transient'
    )
    setting: float = of("the number that was asked for")
    dofs: int = of("degrees of freedom", note=" of the last solution")
    seconds: float = of("wall time", "s", note=" of the whole analysis, the median")
    error: float = of(
        "largest relative error of a frequency",
        note=" against the reference; `null` where there are too few modes",
        form=".1e",
    )
    estimate: float = of("largest error that the analysis itself estimated", form=".1e")
    order: float | None = of(
        "measured order of the error in the element length",
        note=" against the rung before; `null` where it makes no sense",
        form=".2f",
    )


class ConvergenceStudy(Result, kind="convergence", analysis="accuracy"):
    """Rungs of one model and analysis."""

    title: str = of("title of the model")
    analysis: str = of("analysis that is measured", json="of")
    reference: str = of("what the errors are measured against")
    modes: int = of("how many frequencies, or contact forces, are compared")
    rungs: tuple[Rung, ...] = of("discretisations", "", "rung", record=Rung)
