"""Results of convergence studies: error against run time and size over a series of discretisations, of a mesh, of a sweep."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.mesh import MeshErrors
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of
from rotorgear.results.table import Block, Column, Line, grid, table_of


class Rung(Record):
    """One discretisation of the study."""

    method: str = of("what was asked for", note=", in words")
    family: str = of(
        "family of rungs that form a curve",
        note=': `"elements"` or `"accuracy"`; the method of a transient; `"steps"` or `"periods"` of a sweep; `"order"`, '
        '`"elements"` or `"fixed modes"` of a casing',
    )
    setting: float = of("the number that was asked for")
    dofs: int = of("degrees of freedom", note=" of the last solution", column="dofs")
    seconds: float = of(
        "CPU time", "s", note=" of the whole analysis on one thread, median of `timed` runs", form=".3f", column="CPU s"
    )
    error: float = of(
        "largest relative error of the quantities compared",
        note=" against the reference; `null` where the discretisation can't tell one of them",
        form=".1e",
        column="error",
    )
    estimate: float = of(
        "largest error of the same quantities that the analysis itself estimated", form=".1e", column="estimate"
    )
    order: float | None = of(
        "measured order of the error", note=" in the length of elements or steps, or `null`", form=".2f", column="order"
    )
    spread: float = of(
        "spread of the times", note=": difference of their quartiles over the median", default=0.0, kw_only=True
    )
    seconds_least: float = of("CPU time of the fastest run", "s", default=0.0, kw_only=True)
    seconds_most: float = of("CPU time of the slowest run", "s", default=0.0, kw_only=True)
    timed: int = of("number of runs timed", default=0, kw_only=True)
    memory: int = of(
        "largest memory of arrays and objects", "byte", note=", without factors of matrices", default=0, kw_only=True
    )
    effectivity: float | None = of(
        "effectivity",
        note=": estimate over error; `null` where the reference does not resolve the error",
        default=None,
        kw_only=True,
        form=".2f",
        column="ratio",
    )
    effectivity_smallest: float | None = of(
        "smallest effectivity of a single quantity", note="; `null` where none is estimated", default=None, kw_only=True
    )
    effectivity_largest: float | None = of("largest effectivity of a single quantity", default=None, kw_only=True)
    notes: tuple[str, ...] = of(
        "what to know of this row", "", "note", note=": a missed accuracy, a noisy time", default=(), kw_only=True
    )


class ConvergenceStudy(Result, kind="convergence", analysis="accuracy"):
    """Rungs of one model and analysis."""

    title: str = of("title of the model")
    analysis: str = of("analysis that is measured", json="of")
    reference: str = of("what the errors are measured against")
    modes: int = of("how many quantities are compared", note=": frequencies, speeds, forces or statistics")
    rungs: tuple[Rung, ...] = of("discretisations", "", "rung", record=Rung)
    compared: str = of("what is compared", default="frequencies", kw_only=True)
    resolution: float = of("relative error below which the reference or rounding decides", default=0.0, kw_only=True)

    def tables(self) -> Iterator[Block]:
        """What was measured, and the rungs, with marks for what there is to know of each."""
        marks: dict[str, str] = {}
        for rung in self.rungs:
            for note in rung.notes:
                marks.setdefault(note, "*+'\"^~"[len(marks) % 6])
        yield Line(self.title, f": {self.analysis}, {self.modes} {self.compared}")
        yield f"error: the largest relative one, against {self.reference}"
        yield "ratio: estimate over error; CPU s: median of the runs, beside the fastest and slowest"
        if self.ended_early:
            yield self.status
        yield from (*(f"{sign} {note}" for note, sign in marks.items()), *self.remarks(), "")

        def known(name: str) -> Column:
            return Column("", name, without="")

        columns = (
            Column("discretisation", lambda rung: rung.method + "".join(marks[note] for note in rung.notes)),
            Column("", "dofs", where=lambda rung: rung.dofs > 0, without=""),
            known("seconds"),
            Column("range", _range, where=lambda rung: rung.timed > 1, without=""),
            Column("MB", lambda r: r.memory / 1e6, ".1f", where=lambda rung: bool(rung.memory), without=""),
        )
        last = (known("estimate"), known("effectivity"), known("order"))
        yield from (table_of(self, "rungs", *columns, "error", *last), "")


def _range(rung: Rung) -> str:
    """The times of the fastest and of the slowest run in words."""
    return f"{rung.seconds_least:.2g}-{rung.seconds_most:.2g}"


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

    def tables(self) -> Iterator[Block]:
        """What was measured, and the meshes with their errors, real and estimated."""
        yield Line(self.title or "Mesh", f": mesh '{self.mesh}', F_bt {self.base_force_n:.6g} N on a helix")
        yield from (f"body: {self.body}", f"errors in % against {self.reference};")
        yield from ("behind the stroke: what the analysis itself estimates", "")
        rows = []
        for rung in self.rungs:
            errors = []
            for name in ("mean_stiffness", "peak_to_peak_stiffness", "ste_peak_to_peak"):
                estimate = "-" if rung.estimate is None else f"{100 * getattr(rung.estimate, name):.2g}"
                errors.append(f"{100 * getattr(rung.error, name):.2g}/{estimate}")
            size = f"{rung.elements}" + (f"x{rung.layers}" if rung.layers else "")
            times = (f"{rung.fe_seconds:.2f} s", f"{rung.contact_seconds:.2f} s")
            rows.append((rung.method.removeprefix("preset "), size, str(rung.dofs), *times, *errors))
        heads = ("mesh", "elements", "dofs", "FE", "contact", "k", "k pp", "STE pp")
        yield from (grid(rows, *heads, caption="Meshes", no_wrap=True), "")


class SweepRung(Record):
    """One number of steps and of periods."""

    steps: int = of("steps", note=" in a period of the fastest mesh", column="steps")
    count: int = of("periods sampled (least common periods)", column="periods")
    seconds: float = of("CPU time", "s", note=" of one run")
    exponent: float = of("mean of the largest Lyapunov exponents", form="+.3f", column="LE")
    scatter: float = of("standard deviation of these exponents over the runs", form=".3f", column="scatter")
    stated: float = of("standard error that one run states", note=", the median", form=".3f", column="stated")
    peak_to_peak: float = of(
        "penetration of the flanks, peak to peak",
        "m",
        note=", of the worst contact",
        form=".2f",
        column="p-p um",
        json="peak_to_peak",
    )
    peak_to_peak_scatter: float = of(
        "standard deviation of peak to peak", "m", form=".2f", column="scatter", shown="um", json="peak_to_peak_scatter"
    )
    dynamic_factor: float = of("dynamic factor", note=" of that contact", form=".2f", column="K_dyn")
    dynamic_factor_scatter: float = of("standard deviation of the dynamic factor")
    motion: tuple[str, ...] = of("response type", "", "kind", note=": those that occurred")
    error: float = of(
        "largest relative error of the statistics of a run",
        default=float("nan"),
        kw_only=True,
        form=".1e",
        column="error",
    )
    estimate: float = of(
        "largest relative error that a run states of them",
        note=", the median over the states",
        default=float("nan"),
        kw_only=True,
        form=".1e",
        column="estimate",
    )
    effectivity: float | None = of(
        "estimate over error",
        note="; `null` where the error is rounding",
        default=None,
        kw_only=True,
        form=".2f",
        column="ratio",
    )


class SweepConvergenceStudy(Result, kind="sweep_convergence", analysis="accuracy"):
    """Rungs of one model; `runs` is how many states each was run from."""

    title: str = of("title of the model")
    analysis: str = of("analysis that is measured", json="of", default="sweep", kw_only=True)
    runs: int = of("number of states that the point was run from")
    rungs: tuple[SweepRung, ...] = of("discretisations", "", "rung", record=SweepRung)
    speed: float | None = of("speed of the input shaft", "rad/s", default=None, kw_only=True)
    reference: str = of("what the errors are measured against", default="", kw_only=True)

    def tables(self) -> Iterator[Block]:
        """Values of a point, their scatter and its cost."""
        kinds = ", ".join(sorted({kind for rung in self.rungs for kind in rung.motion}))
        at = "" if self.speed is None else f" at {self.speed * RPM_PER_RAD_S:.6g} rpm"
        yield from (Line(f"{self.title}: one point{at} from {self.runs} states ({kinds})"), "")
        time = Column("CPU s", "seconds", ".3f")
        values = ("exponent", "scatter", "stated", "peak_to_peak")
        judged = ("error", "estimate", Column("", "effectivity", without=""))
        yield from (table_of(self, "rungs", "steps", "count", time, *values, *judged), "")
        yield (
            "LE: largest Lyapunov exponent per period of the fastest mesh; scatter: standard deviation over the states; stated: "
            "standard error that one run states; CPU s: of one run; error: the largest relative one of forces, shares and "
            f"motions of that contact, against {self.reference}; estimate: what a run states of it; ratio: estimate over error"
        )
        yield from (*self.remarks(), "")
