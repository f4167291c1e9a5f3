"""Result of a convergence study: error against run time and size over a series of discretisations."""

from __future__ import annotations

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of


class Rung(Record):
    """One discretisation of the study."""

    method: str = of("what was asked for", note=", in words")
    family: str = of(
        "family of rungs that form a curve",
        note=': `"elements"` or `"accuracy"`; the method of a transient; `"steps"` or `"periods"` of a sweep; `"order"`, '
        '`"elements"` or `"fixed modes"` of a casing',
    )
    setting: float = of("the number that was asked for")
    dofs: int = of("degrees of freedom", note=" of the last solution")
    seconds: float = of("CPU time", "s", note=" of the whole analysis on one thread, the median of `timed` runs")
    error: float = of(
        "largest relative error of the quantities compared",
        note=" against the reference; `null` where the discretisation can't tell one of them",
        form=".1e",
    )
    estimate: float = of("largest error of the same quantities that the analysis itself estimated", form=".1e")
    order: float | None = of(
        "measured order of the error in the length of elements or steps",
        note=" against the rung before; `null` where it makes no sense",
        form=".2f",
    )
    spread: float = of(
        "spread of the times", note=": difference of their quartiles over the median", default=0.0, kw_only=True
    )
    timed: int = of("number of runs timed", default=0, kw_only=True)
    memory: int = of(
        "largest memory of arrays and objects",
        "byte",
        json="memory_bytes",
        note=", without the factors of sparse matrices",
        default=0,
        kw_only=True,
    )
    effectivity: float | None = of(
        "effectivity",
        note=": estimate over error; `null` where the reference does not resolve the error",
        form=".2f",
        default=None,
        kw_only=True,
    )
    effectivity_smallest: float | None = of(
        "smallest effectivity of a single quantity",
        note="; `null` where they have no estimates of their own",
        form=".2f",
        default=None,
        kw_only=True,
    )
    effectivity_largest: float | None = of(
        "largest effectivity of a single quantity", form=".2f", default=None, kw_only=True
    )
    notes: tuple[str, ...] = of(
        "what to know of this row",
        "",
        "note",
        note=": a missed accuracy, a time that is noise",
        default=(),
        kw_only=True,
    )


class ConvergenceStudy(Result, kind="convergence", analysis="accuracy"):
    """Rungs of one model and analysis."""

    title: str = of("title of the model")
    analysis: str = of("analysis that is measured", json="of")
    reference: str = of("what the errors are measured against")
    modes: int = of("how many quantities are compared", note=": frequencies, speeds, forces or statistics")
    rungs: tuple[Rung, ...] = of("discretisations", "", "rung", record=Rung)
    compared: str = of("what is compared", default="frequencies", kw_only=True)
    resolution: float = of(
        "relative error below which the reference or rounding decides", form=".0e", default=0.0, kw_only=True
    )
