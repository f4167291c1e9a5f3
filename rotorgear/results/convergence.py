"""Results of convergence studies: error against run time and size over a series of discretisations, of a mesh, of a sweep."""

from __future__ import annotations

from rotorgear.results.mesh import MeshErrors
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


class MeshRung(Record):
    """One mesh of the teeth."""

    method: str = of("what was asked for", note=": a preset, or a mesh between them")
    elements: int = of("elements of a pitch in the transverse plane")
    layers: int = of("layers along the face", note="; 0: a plane model")
    dofs: int = of("degrees of freedom", note=" of both gears")
    fe_seconds: float = of("CPU time of both compliances", "s")
    contact_seconds: float = of("CPU time of the contact over a cycle", "s")
    mean_stiffness_n_per_m: float = of("mean stiffness", "N/m")
    peak_to_peak_stiffness_n_per_m: float = of("peak to peak of the stiffness", "N/m")
    ste_peak_to_peak_m: float = of("peak to peak of the transmission error", "m")
    error: MeshErrors = of("relative errors against the reference", record=MeshErrors)
    estimate: MeshErrors | None = of(
        "what an analysis with this preset estimates itself", record=MeshErrors, note="; `null` for other meshes"
    )


class MeshConvergenceStudy(Result, kind="mesh_convergence", analysis="accuracy"):
    """Rungs of one mesh at one load; `reference` says what the errors are measured against."""

    title: str = of("title of the model")
    analysis: str = of("analysis that is measured", json="of", default="mesh", kw_only=True)
    mesh: str = of("mesh")
    body: str = of("what the teeth stand on")
    base_force_n: float = of("tangential force F_bt at the base circle", "N", note=" of the helix")
    reference: str = of("what the errors are measured against")
    rungs: tuple[MeshRung, ...] = of("discretisations", "", "rung", record=MeshRung)


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
