"""The scatter of a model as tables: bands of modes, of margins and of load shares, with what makes them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.results.scatter import ScatterResult
from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

# Of the Sobol indices the table shows this many numbers a mode.
_RANKED = 3


def scatter_table(result: ScatterResult) -> RenderableType:
    """What `rotorgear scatter` prints."""
    from rich.console import Group

    at = "at standstill" if result.speed_rpm is None else f"at {result.speed_rpm:.6g} rpm"
    bands = table("mode", "Hz", "1st order", "sampled", "5 %", "95 %", "group", "mostly by", left=0)
    bands.columns[-1].justify = "left"
    bands.columns[-1].overflow = "fold"
    names = _short_names(result)
    for row in result.bands:
        cells = (f"±{100 * value:.2f} %" for value in (row.sigma_first_order, row.sigma))
        group = str(row.group) if any(row.group == one.group for one in result.groups) else ""
        leading = f"{100 * row.leading_share:.0f} % {names[row.leading]}" if row.leading else ""
        bands.add_row(
            str(row.mode_number),
            f"{row.nominal_hz:.2f}",
            *cells,
            f"{row.low_hz:.2f}",
            f"{row.high_hz:.2f}",
            group,
            leading,
        )
    title = result.title or "Scatter"
    parts: list[Any] = [heading(title, f": scatter {at}, {result.sample_count} samples"), bands]
    if result.groups:
        parts += lines("", "Modes of a group turn into each other; a row of theirs follows one shape.")
    for one in result.groups:
        modes = ", ".join(map(str, one.modes))
        parts += lines(f"group {one.group}: modes {modes} lie from {one.lowest_hz:.2f} to {one.highest_hz:.2f} Hz")
    if result.margins:
        parts += [*lines(""), _margins(result)]
    if result.shares:
        parts += [*lines(""), _shares(result)]
    if result.sobol_first.size:
        parts += [*lines(""), _ranks(result)]
    return Group(*parts, *lines("", *_said(result)))


def _short_names(result: ScatterResult) -> dict[str, str]:
    """Addresses without their last key where that tells them apart all the same."""
    whole = [row.address for row in result.numbers]
    short = [address.rpartition(".")[0] for address in whole]
    return {a: b if short.count(b) == 1 else a for a, b in zip(whole, short, strict=True)}


def _margins(result: ScatterResult) -> Any:
    name = f"below {100 * result.least_margin:.3g} %"
    out = table("excitation", "Hz", "margin", "5 % have under", "median", name)
    for row in result.margins:
        if np.isfinite(row.median):
            values = (
                f"{100 * row.nominal:+.2f} %",
                f"{100 * row.low:.2f} %",
                f"{100 * row.median:.2f} %",
                f"{100 * row.below:.1f} %",
            )
        else:
            values = ("no mode", "-", "-", "-")
        out.add_row(row.line, f"{row.frequency_hz:.2f}", *values)
    return out


def _shares(result: ScatterResult) -> Any:
    out = table("shared by", "mesh", "share", "1st order", "sampled", "5 %", "95 %", "mostly by", left=2)
    out.columns[-1].justify = "left"
    names = _short_names(result)
    for row in result.shares:
        cells = (f"±{value:.4f}" for value in (row.sigma_first_order, row.sigma))
        leading = f"{100 * row.leading_share:.0f} % {names[row.leading]}" if row.leading else ""
        out.add_row(row.gear, row.mesh, f"{row.nominal:.4f}", *cells, f"{row.low:.4f}", f"{row.high:.4f}", leading)
    return out


def _ranks(result: ScatterResult) -> Any:
    out = table("of", "number", "first", "total", left=2)
    names = [f"mode {row.mode_number}" for row in result.bands] + [f"{row.gear}, {row.mesh}" for row in result.shares]
    for k, name in enumerate(names):
        for place, j in enumerate(np.argsort(-result.sobol_total[k], kind="stable")[:_RANKED]):
            first = f"{result.sobol_first[k, j]:.3f} ±{result.sobol_first_error[k, j]:.3f}"
            total = f"{result.sobol_total[k, j]:.3f} ±{result.sobol_total_error[k, j]:.3f}"
            out.add_row("" if place else name, result.numbers[j].address, first, total)
    return out


def _said(result: ScatterResult) -> list[str]:
    said = [
        f"basis of {result.basis_size} shapes: frequencies within {result.frequency_basis_error:.0e} of the whole system's at "
        f"{result.checked_samples} samples that it was not made from"
    ]
    lost = [row for row in result.bands if row.found < 0.95]
    if lost:
        modes = ", ".join(f"{row.mode_number} ({100 * row.found:.0f} %)" for row in lost)
        said.append(f"found again in fewer than 95 % of the samples: modes {modes}")
    if result.failed:
        said.append(f"{result.failed} samples have numbers that the model can't have")
    return said + notes_of(result)
