"""Result of the convergence study of a sweep: values of one point, their uncertainty and cost over steps and length."""

from __future__ import annotations

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of


class SweepRung(Record):
    """One number of steps and of periods."""

    steps: int = of("steps", note=" in a period of the fastest mesh")
    count: int = of("periods sampled (least common periods)")
    seconds: float = of("wall time", "s", note=" of one run, CPU time")
    exponent: float = of("mean of the largest Lyapunov exponents")
    scatter: float = of("standard deviation of these exponents over the runs")
    stated: float = of("standard error that one run states", note=", the median")
    peak_to_peak: float = of("penetration of the flanks, peak to peak", "m", note=", of the worst contact")
    peak_to_peak_scatter: float = of("standard deviation of the peak to peak", "m")
    dynamic_factor: float = of("dynamic factor", note=" of that contact")
    dynamic_factor_scatter: float = of("standard deviation of the dynamic factor")
    motion: tuple[str, ...] = of("response type", "", "kind", note=": those that occurred")
    error: float = of(
        "largest relative difference of peak to peak and dynamic factor from the reference",
        form=".1e",
        default=float("nan"),
        kw_only=True,
    )


class SweepConvergenceStudy(Result, kind="sweep_convergence", analysis="accuracy"):
    """Rungs of one model; `runs` is how many states each was run from."""

    title: str = of("title of the model")
    analysis: str = of("analysis that is measured", json="of", default="sweep", kw_only=True)
    runs: int = of("number of states that the point was run from")
    rungs: tuple[SweepRung, ...] = of("discretisations", "", "rung", record=SweepRung)
    speed: float | None = of("speed of the input shaft", "rad/s", json="speed_rpm", default=None, kw_only=True)
    reference: str = of("what the errors are measured against", default="", kw_only=True)
