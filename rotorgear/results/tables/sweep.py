"""The result of a sweep as a table for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.results.tables.common import TRANSMISSION_WORDS, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.sweep import SweepResult

# Lines of a spectrum in a row, with the columns before them.
_LINES = 5
# Lines of a table and stretches of a route that are shown at most; the rest is in the files.
_MOST = 60
_STRETCHES = 16


def sweep_table(result: SweepResult) -> RenderableType:
    """Return the route, the points and the notes as one rich renderable that fits 80 columns."""
    from rich.console import Group
    from rich.text import Text

    title = f"{result.model.title or 'Sweep'}: {len(result.values)} points over {' and '.join(result.address)}"
    parts: list[RenderableType] = [Text(title, style="bold"), Text("")]
    if len(result.shape) == 1:
        parts += [Text(_route(result, r)) for r in range(len(result.run))]
        parts.append(Text(""))
    rows = len(result.values) * len(result.run)
    parts += [_points(result, range(min(rows, _MOST)))]
    if rows > _MOST:
        parts.append(Text(f"... {rows - _MOST} more lines: see --json, --save and --plot"))
    parts += _portraits(result)
    columns = "p-p, TE, approach, K_dyn, contact loss and coast flank: of the worst contact"
    if result.lyapunov.shape[2]:
        columns = f"LE: largest Lyapunov exponent per period of the fastest mesh, +- one standard error; {columns}"
    steps = result.steps[result.steps > 0]  # a point that failed has none
    fewest = int(steps.min())
    most = int(steps.max())
    notes = [
        "",
        columns,
        f"p-p: penetration of the flanks; TE: {TRANSMISSION_WORDS}; all three peak to peak",
        f"T is {result.period_words}; {result.settle} periods discarded, {result.count} sampled; repeats within "
        f"{100.0 * result.tolerance:g} % of the peak to peak; chaotic: LE > {result.chaos:g}",
        f"{result.dofs} dofs, {fewest if fewest == most else f'{fewest} to {most}'} steps a mesh period, "
        f"{result.seconds['total']:.2f} s",
        result.method,
    ]
    if result.reduction:
        notes.append(result.reduction.sentence)
    notes += notes_of(result)
    return Group(*parts, *(Text(note) for note in notes), "")


def _route(result: SweepResult, run: int) -> str:
    """Response types along the parameter: "1T 4600 to 4900, chaotic from 4950"."""

    def at(p: int) -> str:
        return f"{result.values[p, 0]:.6g}"

    parts = [f"{kind} {at(a)}" + (f" to {at(b)}" if b > a else "") for kind, a, b in result.route(run)]
    if len(parts) > _STRETCHES:
        parts = [*parts[:_STRETCHES], f"... and {len(parts) - _STRETCHES} more changes"]
    label = f"route ({result.run[run]})" if len(result.run) > 1 else "route"
    unit = f" ({result.unit[0]})" if result.unit[0] else ""
    return f"{label}{unit}: " + ", ".join(parts)


def _points(result: SweepResult, rows: range) -> Any:
    several = len(result.run) > 1
    names = [f"{a.rpartition('.')[2]} {u}".strip() for a, u in zip(result.address, result.unit, strict=True)]
    names += ["start"] if several else []
    names += ["response"] + (["LE", "+-"] if result.lyapunov.shape[2] else [])
    out = table(*names, "p-p\num", "TE\num", "appr.\num", "K_dyn", "loss\n%", "coast\n%", left=0)
    out.collapse_padding = True
    for row in rows:
        p, r = divmod(row, len(result.run))
        cells = [f"{x:.6g}" for x in result.values[p]] + ([result.run[r]] if several else [])
        cells.append(result.motion_at(p, r))
        if result.lyapunov.shape[2]:
            cells += [_number(result.lyapunov[p, r, 0], "+.3f"), _number(result.lyapunov_error[p, r, 0], ".3f")]
        out.add_row(
            *cells,
            _largest(1e6 * result.peak_to_peak[p, r], ".2f"),
            _largest(1e6 * result.peak_to_peak_transmission_error[p, r], ".2f"),
            _largest(1e6 * result.peak_to_peak_approach[p, r], ".2f"),
            _largest(result.dynamic_factor[p, r], ".2f"),
            _largest(100.0 * result.apart[p, r], ".1f"),
            _largest(100.0 * result.back[p, r], ".1f"),
        )
    return out


def _portraits(result: SweepResult) -> list[Any]:
    """The strongest lines in the spectra of the points that keep their trajectory."""
    from rich.text import Text

    kept = result.portraits
    if kept is None:
        return []
    several = len(kept.run) > 1
    names = [f"{a.rpartition('.')[2]} {u}".strip() for a, u in zip(result.address, result.unit, strict=True)]
    most = _LINES - len(names) - several
    out = table(*names, *(["start"] if several else []), "response", *["f: um"] * most, left=0)
    for k, p in enumerate(kept.point.tolist()):
        for j, r in enumerate(kept.run.tolist()):
            worst = int(np.nanargmax(np.nan_to_num(result.peak_to_peak[p, r])))
            lines = [f"{f:.3g}: {1e6 * a:.3g}" for f, a in kept.lines(k, j, worst)[:most]]
            cells = [f"{x:.6g}" for x in result.values[p]] + ([result.run[r]] if several else [])
            out.add_row(*cells, result.motion_at(p, r), *(lines or ["-"]))
    head = "Strongest lines of the displacement: f over the mesh frequency, amplitude"
    return [Text(""), Text(head, style="bold"), out]


def _largest(values: Any, form: str) -> str:
    sound = [x for x in values if x == x]
    return _number(max(sound), form) if sound else "-"


def _number(value: float, form: str) -> str:
    return format(value, form) if value == value else "-"
