"""Draws what a layout is judged by: bands of frequencies that scatter, and margins from excitations before and after."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import BLUE, figure_for, label, legend_below, name_axes
from rotorgear.quantity import counted
from rotorgear.results.optimise import LayoutMode, OptimiseResult
from rotorgear.results.scatter import HIGH, LOW, FrequencyBand, ScatterResult

# Participations below this share are not drawn.
_LEAST = 1e-3
# Numbers that the lower panel tells apart; the rest stands together.
_TOLD = 6
_COLOURS = (BLUE, "#c2571a", "#2f7d32", "#7a3f9d", "#a8841f", "#1f9aa8")


def scatter(result: ScatterResult, fig: Any = None) -> Any:
    """Draw bands of frequencies with excitations at the operating speed, and the share of each number in their variance.

    Args:
        result: of `rg.scatter`.
        fig: figure or subfigure to draw on; a new figure for None.

    Returns:
        The two axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    at = "at standstill" if result.speed_rpm is None else f"at {result.speed_rpm:.6g} rpm"
    title = f"{result.model.title or 'Scatter'}\nfrequencies {at}, {counted(result.sample_count, 'samples')}"
    figure = figure_for(fig, (9.0, 7.5), title)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    numbers = np.arange(1, len(result.bands) + 1)
    for k, row in zip(numbers, result.bands, strict=True):
        hz = result.sample_hz[:, k - 1]
        if np.isfinite(hz).any():
            shape = upper.violinplot(hz[np.isfinite(hz)], positions=[k], widths=0.8, showextrema=False)
            for body in shape["bodies"]:
                body.set(facecolor=BLUE, alpha=0.35, edgecolor="none")
        upper.plot([k, k], [row.low_hz, row.high_hz], color=BLUE, lw=2.0)
        upper.plot([k - 0.3, k + 0.3], [row.nominal_hz] * 2, color="#222222", lw=1.2)
    upper.plot([], [], color=BLUE, lw=2.0, label=f"{100 * LOW:.0f} to {100 * HIGH:.0f} % of the samples")
    upper.plot([], [], color="#222222", lw=1.2, label="nominal")
    for line in result.margins:
        reach = (line.frequency_hz * (1.0 - result.least_margin), line.frequency_hz * (1.0 + result.least_margin))
        upper.axhspan(*reach, color="#c2571a", alpha=0.08, lw=0.0)
        upper.axhline(line.frequency_hz, color="#c2571a", lw=0.7)
        place = {"transform": upper.get_yaxis_transform(), "ha": "right", "va": "bottom"}
        upper.text(1.0, line.frequency_hz, line.line, fontsize=7, **place)
    upper.set_ylabel(label(FrequencyBand, "nominal_hz"))
    upper.legend(frameon=False, loc="upper left")
    upper.grid(True, axis="y", alpha=0.2)
    shares = result.first_order_share[: len(result.bands)]
    order = np.argsort(-shares.sum(axis=0), kind="stable")
    bottom = np.zeros(len(numbers))
    for colour, j in zip(_COLOURS, order[:_TOLD], strict=False):
        lower.bar(numbers, shares[:, j], bottom=bottom, color=colour, width=0.8, label=result.numbers[j].address)
        bottom = bottom + shares[:, j]
    if len(order) > _TOLD:
        lower.bar(numbers, shares.sum(axis=1) - bottom, bottom=bottom, color="#bbbbbb", width=0.8, label="others")
    lower.set_ylim(0.0, 1.0)
    name_axes(lower, "mode", label(result, "first_order_share"))
    lower.set_xticks(numbers)
    legend_below(lower, 3, 0.22, fontsize=7)
    return np.array([upper, lower])


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
        for name, modes, colour in (("before", result.modes_before, "#999999"), ("after", result.modes_after, BLUE)):
            near = [one for one in modes if one.line == line.line and one.speed == line.speed]
            x = [100.0 * one.margin for one in near]
            y = [100.0 * one.participation for one in near]
            axis.vlines(x, 100.0 * _LEAST, y, color=colour, lw=1.2)
            axis.plot(x, y, "o", color=colour, ms=4, label=name)
        axis.set_yscale("log")
        axis.set_ylim(100.0 * _LEAST, 100.0)
        axis.set_title(f"{line.line}: {line.frequency_hz:.1f} Hz", fontsize=9, loc="left")
    figure.supylabel(label(LayoutMode, "participation", "%"), fontsize=9)
    rows[-1].set_xlabel(label(LayoutMode, "margin", "%"))
    rows[-1].set_xlim(-3.0 * asked, 3.0 * asked)
    rows[0].legend(frameon=False, fontsize=8, loc="upper right", ncols=2)
    return rows
