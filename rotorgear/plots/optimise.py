"""Draws the margins of a layout before and after: the modes near each excitation, by how much they take part in it."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import figure_for
from rotorgear.results.optimise import LayoutMode, OptimiseResult

_LEAST = 1e-3


def optimise(result: OptimiseResult, fig: Any = None) -> Any:
    """Draw, for every excitation at every speed, the modes around it before and after, with the margin and what counts.

    Args:
        result: of `rg.optimise`.
        fig: figure or subfigure to draw on; a new figure for None.

    Returns:
        The axes, one a row.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    title = f"{result.model.title or 'Layout'}\nmodes near excitations, before and after"
    figure = figure_for(fig, (9.0, 1.6 + 1.6 * len(result.lines)), title)
    rows = np.atleast_1d(figure.subplots(len(result.lines), 1, sharex=True))
    asked = 100.0 * result.least_margin
    for axis, line in zip(rows, result.lines, strict=True):
        axis.axvspan(-asked, asked, color="#c2571a", alpha=0.10, lw=0.0)
        axis.axhline(100.0 * result.participation, color="#444444", lw=0.7, ls="--")
        for modes, colour, name in (
            (result.modes_before, "#999999", "before"),
            (result.modes_after, "#1f5fa8", "after"),
        ):
            _stems(axis, [one for one in modes if one.line == line.line and one.speed == line.speed], colour, name)
        axis.set_yscale("log")
        axis.set_ylim(100.0 * _LEAST, 100.0)
        axis.set_ylabel("takes part, %", fontsize=8)
        axis.set_title(f"{line.line}: {line.frequency_hz:.1f} Hz", fontsize=9, loc="left")
    rows[-1].set_xlabel("distance of the mode from the excitation, %")
    rows[-1].set_xlim(-3.0 * asked, 3.0 * asked)
    rows[0].legend(frameon=False, fontsize=8, loc="upper right", ncols=2)
    return rows


def _stems(axis: Any, modes: list[LayoutMode], colour: str, name: str) -> None:
    x = [100.0 * one.margin for one in modes]
    y = [100.0 * one.participation for one in modes]
    axis.vlines(x, 100.0 * _LEAST, y, color=colour, lw=1.2)
    axis.plot(x, y, "o", color=colour, ms=4, label=name)
