"""Result of a sweep: Poincare sections, Lyapunov exponents, response types and indicators over one or two parameters."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.quantity import counted
from rotorgear.results.portrait import ContactLines, Portrait, Portraits, SpectrumLine
from rotorgear.results.result import ModelResult, statistic_names
from rotorgear.results.schema import Record, derived, of, rows
from rotorgear.results.table import TRANSMISSION_WORDS, Block, Line, Table, error_words, grid, written

# Lines of a spectrum in a row, with the columns before them.
_LINES = 5
# Lines of a table and stretches of a route that are shown at most; the rest is in the files.
_MOST = 60
_STRETCHES = 16


class Reduction(Record):
    """A basis of modes and static shapes in place of all degrees of freedom; of several bases, the largest values."""

    dofs: int = of("degrees of freedom", note=" before the reduction; of several bases, the largest values")
    coordinates: int = of("coordinates after the reduction")
    modes: int = of("elastic modes among them")
    highest: float = of("frequency of the highest of these modes", "Hz", json="highest_mode_hz")
    rigid: int = of("rigid-body motions among them", json="rigid_motions")
    static: int = of("static shapes of loads and contacts among them", json="static_shapes")
    closed: float = of(
        "FRF error at the contacts, all closed", json="error_closed", note=": relative, against the whole system"
    )
    apart: float = of("FRF error at the contacts, all open", json="error_apart")
    up_to: float = of("frequency up to which they were compared", "Hz")
    frequencies: int = of("at how many frequencies")
    bases: int = of("how many bases there are")
    seconds: float = of("CPU time", "s", note=" to find and check them")
    loads: float = of(
        "FRF error of loads inside shafts and couplings",
        json="error_loads",
        note=", closed; 0 where none is read",
        default=0.0,
    )

    @property
    def error(self) -> float:
        """The larger of the two differences."""
        return max(self.closed, self.apart)

    @property
    def sentence(self) -> str:
        """One sentence that describes the reduction."""
        parts = [f"{counted(self.modes, 'modes')} up to {_hertz(self.highest)}"] if self.modes else []
        parts += [f"{self.rigid} rigid"] if self.rigid else []
        parts += [counted(self.static, "static shapes")] if self.static else []
        return (
            f"{self.dofs} dofs reduced to {self.coordinates} ({', '.join(parts)}): FRF error at the contacts "
            f"{100.0 * self.error:.2g} % up to {_hertz(self.up_to)}"
        )


def _hertz(value: float) -> str:
    return f"{value / 1000.0:.3g} kHz" if value >= 1000.0 else f"{value:.3g} Hz"


class SweepResult(ModelResult, kind="sweep"):
    """p points with r runs each, c mesh contacts, s sections a run, t exponents. NaN where a point or run failed.

    `section` holds displacement and velocity of the contacts along their normal (without the error e of the teeth) at the end of
    each least common period T of all meshes. `peak_to_peak_transmission_error` is of the rotation at the base circles,
    `peak_to_peak_approach` of v.q / cos(beta_b) in the transverse plane, `peak_to_peak` of the penetration d - e. The criterion
    that `tolerance` and `chaos` belong to stands in analysis/sweep/classify.py.
    """

    parameters = rows("parameters", "parameter")
    address: tuple[str, ...] = of("address of a parameter", "", "parameter", note=": what was changed")
    unit: tuple[str, ...] = of("unit", "", "parameter", note=' of its values, or `""` for SI')
    shape: np.ndarray = of("points along each parameter", "", "parameter", json=None)
    points = rows("points", "point", runs="run", contacts="contact")
    values: np.ndarray = of("values", "", "point", "parameter", note=" of the parameters")
    frequency: np.ndarray = of("frequency of the fastest mesh", "Hz", "point", json="mesh_frequency_hz")
    turns: np.ndarray = of("periods of the fastest mesh in a least common period", "", "point", json="mesh_periods")
    steps: np.ndarray = of("steps", "", "point", note=" in a period of the fastest mesh")
    failure: tuple[str, ...] = of("why the point failed", "", "point", note=', or `""`')
    run: tuple[str, ...] = of(
        "where the runs started", "", "run", note=': `"static"`, `"start 2"`, `"up"`, `"down"`', json="start"
    )
    motion: tuple[str, ...] = of("response type", "", "point_and_run", json=None)

    @derived(
        "response type",
        "",
        "point",
        "run",
        json="motion",
        note=': `"1T"`, `"2T"`, ..., `"quasi-periodic"`, `"chaotic"`, `"not settled"`, `"not periodic"` (without exponents), '
        '`"failed"`',
    )
    def motions(self) -> np.ndarray:
        """(p, r)."""
        return np.array(self.motion, dtype=object).reshape(len(self.values), len(self.run))

    lyapunov: np.ndarray = of(
        "Lyapunov exponents", "", "point", "run", "exponent", note=" per period of the fastest mesh, largest first"
    )
    lyapunov_error: np.ndarray = of("standard errors of the Lyapunov exponents", "", "point", "run", "exponent")
    section: np.ndarray = of("Poincare points", "m, m/s", "point", "run", "period", "contact", "phase_space", json=None)
    contact: tuple[str, ...] = of("name of the contact", "", "contact", note=": mesh and helix", json="name")
    static_force: np.ndarray = of(
        "static force", "N", "point", "contact", note=" along the flank normal; negative on the coast flank"
    )
    static_deflection: np.ndarray = of("static force over mean stiffness", "m", "point", "contact")
    peak_to_peak: np.ndarray = of("penetration of the flanks, peak to peak", "m", "point", "run", "contact")
    peak_to_peak_transmission_error: np.ndarray = of("transmission error, peak to peak", "m", "point", "run", "contact")
    peak_to_peak_approach: np.ndarray = of("approach, peak to peak", "m", "point", "run", "contact")
    rms_approach: np.ndarray = of("root mean square of the approach about its mean", "m", "point", "run", "contact")
    mean_force: np.ndarray = of("mean force", "N", "point", "run", "contact")
    rms_force: np.ndarray = of("root mean square of the force about its mean", "N", "point", "run", "contact")
    largest_force: np.ndarray = of("largest force", "N", "point", "run", "contact")

    @derived("dynamic factor", "", "point", "run", "contact", note=": largest over static force; `null` without load")
    def dynamic_factor(self) -> np.ndarray:
        """(p, r, c) largest force over the static one; NaN where no load flows."""
        static = self.static_force[:, None, :]
        return np.where(static > 0.0, self.largest_force / np.where(static > 0.0, static, 1.0), np.nan)

    driving: np.ndarray = of(
        "share of the time on the working flank", "", "point", "run", "contact", json="driving_share"
    )
    apart: np.ndarray = of("contact-loss ratio", "", "point", "run", "contact", json="apart_share")
    back: np.ndarray = of("share of the time on the coast flank", "", "point", "run", "contact", json="back_share")
    losses: np.ndarray = of(
        "contact losses in a period of the fastest mesh", "", "point", "run", "contact", json="losses_per_mesh_period"
    )
    settle: int = of("transient periods discarded (least common periods)", json="settle_periods")
    count: int = of("periods sampled (least common periods)", json="counted_periods")
    tolerance: float = of("tolerance", note=": share of the peak to peak within which a motion repeats")
    chaos: float = of("exponent above which a motion is chaotic")
    reduction: Reduction | None = of(
        "reduction of large systems", record=Reduction, default=None, note="; `null` where there was none"
    )
    portraits: Portraits | None = of("trajectories of some points", record=Portraits, json=None, default=None)
    statistic: tuple[str, ...] = statistic_names()
    statistics_error: np.ndarray = of(
        "estimated errors of the statistics",
        "",
        "point",
        "run",
        "contact",
        "statistic",
        note=", each in its unit: by a run of a third of the step; where nothing repeats, by how much runs as long differ",
        default_factory=lambda: np.zeros((0, 0, 0, 0)),
    )

    load_points: tuple[str, ...] = of("names of the points that read a load", "", "gauge", default=(), kw_only=True)
    load_unit: tuple[str, ...] = of("unit of the load that a point reads", "", "gauge", default=(), kw_only=True)
    load_statistics: np.ndarray = of(
        "mean, rms about it, largest and smallest load inside a shaft or coupling",
        "N, N m",
        "point",
        "run",
        "gauge",
        "load_statistic",
        default_factory=lambda: np.zeros((0, 0, 0, 4)),
        kw_only=True,
    )
    load_error: np.ndarray = of(
        "estimated errors of these loads",
        "N, N m",
        "point",
        "run",
        "gauge",
        "load_statistic",
        default_factory=lambda: np.zeros((0, 0, 0, 4)),
        kw_only=True,
    )

    @derived("lines of the points that keep their trajectory", "", "portrait", record=Portrait, json="portraits")
    def portrait_lines(self) -> tuple[Portrait, ...]:
        """Length and lines of the trajectories; none where none were kept."""
        kept = self.portraits
        if kept is None:
            return ()
        return tuple(
            Portrait(
                values=tuple(self.values[p].tolist()),
                start=self.run[r],
                periods=int(kept.periods[k]),
                records_per_period=int(kept.records[k]),
                contacts=tuple(
                    ContactLines(name, tuple(SpectrumLine(order, a) for order, a in kept.lines(k, j, c)))
                    for c, name in enumerate(self.contact)
                ),
            )
            for k, p in enumerate(kept.point.tolist())
            for j, r in enumerate(kept.run.tolist())
        )

    @property
    def period_words(self) -> str:
        """The least common period T in words."""
        turns = sorted({int(n) for n in self.turns if n})
        if turns == [1]:
            return "the mesh period"
        return f"{turns[0]}{f' to {turns[-1]}' if len(turns) > 1 else ''} periods of the fastest mesh"

    def motion_at(self, point: int, run: int = 0) -> str:
        """Response type of a run."""
        return self.motion[point * len(self.run) + run]

    def route(self, run: int = 0) -> list[tuple[str, int, int]]:
        """Response types along the points with the first and last point of each."""
        stretches: list[tuple[str, int, int]] = []
        for p in range(len(self.values)):
            kind = self.motion_at(p, run)
            if stretches and stretches[-1][0] == kind:
                stretches[-1] = (kind, stretches[-1][1], p)
            else:
                stretches.append((kind, p, p))
        return stretches

    def tables(self) -> Iterator[Block]:
        """The route, the points, the lines of the trajectories that are kept, and notes."""
        yield Line(
            f"{self.model.title or 'Sweep'}: {counted(len(self.values), 'points')} over {' and '.join(self.address)}"
        )
        yield ""
        if len(self.shape) == 1:
            yield from (self._route(r) for r in range(len(self.run)))
            yield ""
        runs = [(p, r) for p in range(len(self.values)) for r in range(len(self.run))]
        yield self._points(runs[:_MOST])
        if len(runs) > _MOST:
            yield f"... {counted(len(runs) - _MOST, 'more lines')}: see --json, --save and --plot"
        if np.any(np.isfinite(self.statistics_error)):
            yield from (
                "",
                "Estimated errors, relative; of contact loss and coast flank in %",
                self._errors(runs[:_MOST]),
            )
        yield from self._loads(runs[:_MOST])
        if self.portraits is not None:
            yield from self._strongest_lines(self.portraits)
        columns = "p-p, TE, approach, K_dyn, contact loss and coast flank: each the largest of all contacts"
        if self.lyapunov.shape[2]:
            columns = f"LE: largest Lyapunov exponent per period of the fastest mesh, +- one standard error; {columns}"
        steps = self.steps[self.steps > 0]  # a point that failed has none
        fewest = int(steps.min())
        most = int(steps.max())
        yield from ("", columns, f"p-p: penetration of the flanks; TE: {TRANSMISSION_WORDS}; all three peak to peak")
        yield (
            f"T is {self.period_words}; {self.settle} periods discarded, {self.count} sampled; repeats within "
            f"{100.0 * self.tolerance:g} % of the peak to peak; chaotic: LE > {self.chaos:g}"
        )
        a_period = f"{fewest if fewest == most else f'{fewest} to {most}'} steps a mesh period"
        yield from (f"{self.dofs} dofs, {a_period}, {self.cost}", self.method)
        if self.reduction:
            yield self.reduction.sentence
        yield from (*self.remarks(), "")

    def _route(self, run: int) -> str:
        """Response types along the parameter: "1T 4600 to 4900, chaotic from 4950"."""
        values = [f"{x:.6g}" for x in self.values[:, 0]]
        parts = [f"{kind} {values[a]}" + (f" to {values[b]}" if b > a else "") for kind, a, b in self.route(run)]
        if len(parts) > _STRETCHES:
            parts = [*parts[:_STRETCHES], f"... and {len(parts) - _STRETCHES} more changes"]
        label = f"route ({self.run[run]})" if len(self.run) > 1 else "route"
        unit = f" ({self.unit[0]})" if self.unit[0] else ""
        return f"{label}{unit}: " + ", ".join(parts)

    def _heads(self) -> list[str]:
        """Headings of the parameters, and of the start of a run where there are several."""
        names = [f"{a.rpartition('.')[2]} {u}".strip() for a, u in zip(self.address, self.unit, strict=True)]
        return names + ["start"] * (len(self.run) > 1)

    def _cells(self, p: int, r: int) -> list[str]:
        """Values of the parameters, start where there are several, and response type of a run."""
        return [f"{x:.6g}" for x in self.values[p]] + [self.run[r]] * (len(self.run) > 1) + [self.motion_at(p, r)]

    def _points(self, runs: list[tuple[int, int]]) -> Table:
        exponents = bool(self.lyapunov.shape[2])
        worst = (
            ("p-p\num", self.peak_to_peak, 1e6, ".2f"),
            ("TE\num", self.peak_to_peak_transmission_error, 1e6, ".2f"),
            ("appr.\num", self.peak_to_peak_approach, 1e6, ".2f"),
            ("K_dyn", self.dynamic_factor, 1.0, ".2f"),
            ("loss\n%", self.apart, 100.0, ".1f"),
            ("coast\n%", self.back, 100.0, ".1f"),
        )
        rows = []
        for p, r in runs:
            cells = self._cells(p, r)
            if exponents:
                cells += [written(self.lyapunov[p, r, 0], "+.3f"), written(self.lyapunov_error[p, r, 0], ".3f")]
            for _, values, factor, form in worst:
                known = [factor * x for x in values[p, r] if x == x]
                cells.append(written(max(known, default=None), form))
            rows.append(cells)
        heads = [*self._heads(), "response", *(["LE", "+-"] if exponents else []), *(head for head, *_ in worst)]
        return grid(rows, *heads, left=0, caption="Points", tight=True)

    def _errors(self, runs: list[tuple[int, int]]) -> Table:
        """Errors of what the table of the points shows, relative to it."""
        shown = (
            ("p-p", "penetration", self.peak_to_peak),
            ("TE", "transmission error", self.peak_to_peak_transmission_error),
            ("appr.", "approach", self.peak_to_peak_approach),
            ("K_dyn", "largest force", self.largest_force),
            ("loss", "contact loss", self.apart),
            ("coast", "coast contact", self.back),
        )
        rows = []
        for p, r in runs:
            cells = self._cells(p, r)
            for _, what, values in shown:
                own = values[p, r]
                worst = int(np.nanargmax(own)) if np.any(own == own) else 0
                error = float(self.statistics_error[p, r, worst, self.statistic.index(what)])
                size = 0.01 if values is self.apart or values is self.back else abs(float(own[worst]))
                cells.append(written(error / size if size else error, error_words))
            rows.append(cells)
        heads = [*self._heads(), "response", *(head for head, *_ in shown)]
        return grid(rows, *heads, left=0, caption="Estimated errors of the points", tight=True)

    def _loads(self, runs: list[tuple[int, int]]) -> Iterator[Block]:
        """Loads inside shafts and couplings: the mean, rms about it, both ends, and the error of the larger one."""
        for k, (name, unit) in enumerate(zip(self.load_points, self.load_unit, strict=True)):
            rows = []
            for p, r in runs:
                values = self.load_statistics[p, r, k]
                end = 2 if abs(values[2]) >= abs(values[3]) else 3
                error = float(self.load_error[p, r, k, end]) / (abs(float(values[end])) or np.nan)
                rows.append(
                    [*self._cells(p, r), *(written(float(x), ".5g") for x in values), written(error, error_words)]
                )
            yield from ("", Line(f"Load at {name}"))
            heads = (f"mean\n{unit}", f"rms\n{unit}", f"largest\n{unit}", f"smallest\n{unit}", "error")
            yield grid(rows, *self._heads(), "response", *heads, left=0, caption=f"Load at {name}", tight=True)

    def _strongest_lines(self, kept: Portraits) -> Iterator[Block]:
        """The strongest lines in the spectra of the points that keep their trajectory."""
        most = _LINES - len(self.address) - (len(kept.run) > 1)
        several = len(kept.run) > 1
        rows = []
        for k, p in enumerate(kept.point.tolist()):
            for j, r in enumerate(kept.run.tolist()):
                worst = int(np.nanargmax(np.nan_to_num(self.peak_to_peak[p, r])))
                lines = [f"{f:.3g}: {1e6 * a:.3g}" for f, a in kept.lines(k, j, worst)[:most]] or ["-"]
                cells = [f"{x:.6g}" for x in self.values[p]] + [self.run[r]] * several + [self.motion_at(p, r)]
                rows.append([*cells, *lines, *[""] * (most - len(lines))])
        heads = self._heads()[: len(self.address)] + ["start"] * several
        yield from ("", Line("Strongest lines of the displacement: f over the mesh frequency, amplitude"))
        yield grid(rows, *heads, "response", *["f: um"] * most, left=0, caption="Strongest lines")
