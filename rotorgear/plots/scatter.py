"""Draws the scatter of a model: bands of frequencies beside excitations, and which numbers make them."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import figure_for
from rotorgear.results.scatter import HIGH, LOW, ScatterResult

# Numbers that the lower panel tells apart; the rest stands together.
_TOLD = 6
_COLOURS = ("#1f5fa8", "#c2571a", "#2f7d32", "#7a3f9d", "#a8841f", "#1f9aa8")


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
    title = f"{result.model.title or 'Scatter'}\nfrequencies {at}, {result.sample_count} samples"
    figure = figure_for(fig, (9.0, 7.5), title)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    numbers = np.arange(1, len(result.bands) + 1)
    for k, row in zip(numbers, result.bands, strict=True):
        hz = result.sample_hz[:, k - 1]
        if np.isfinite(hz).any():
            shape = upper.violinplot(hz[np.isfinite(hz)], positions=[k], widths=0.8, showextrema=False)
            for body in shape["bodies"]:
                body.set(facecolor="#1f5fa8", alpha=0.35, edgecolor="none")
        upper.plot([k, k], [row.low_hz, row.high_hz], color="#1f5fa8", lw=2.0)
        upper.plot([k - 0.3, k + 0.3], [row.nominal_hz] * 2, color="#222222", lw=1.2)
    name = f"{100 * LOW:.0f} to {100 * HIGH:.0f} % of the samples"
    upper.plot([], [], color="#1f5fa8", lw=2.0, label=name)
    upper.plot([], [], color="#222222", lw=1.2, label="nominal")
    for line in result.margins:
        reach = (line.frequency_hz * (1.0 - result.least_margin), line.frequency_hz * (1.0 + result.least_margin))
        upper.axhspan(*reach, color="#c2571a", alpha=0.08, lw=0.0)
        upper.axhline(line.frequency_hz, color="#c2571a", lw=0.7)
        upper.annotate(
            line.line, (1.0, line.frequency_hz), xycoords=("axes fraction", "data"), fontsize=7, ha="right", va="bottom"
        )
    upper.set_ylabel("frequency, Hz")
    upper.legend(frameon=False, loc="upper left")
    upper.grid(True, axis="y", alpha=0.2)
    _shares(lower, result, numbers)
    return np.array([upper, lower])


def _shares(axis: Any, result: ScatterResult, numbers: np.ndarray) -> None:
    shares = result.first_order_share[: len(result.bands)]
    order = np.argsort(-shares.sum(axis=0), kind="stable")
    bottom = np.zeros(len(numbers))
    for colour, j in zip(_COLOURS, order[:_TOLD], strict=False):
        axis.bar(numbers, shares[:, j], bottom=bottom, color=colour, width=0.8, label=result.numbers[j].address)
        bottom = bottom + shares[:, j]
    if len(order) > _TOLD:
        axis.bar(numbers, shares.sum(axis=1) - bottom, bottom=bottom, color="#bbbbbb", width=0.8, label="others")
    axis.set_ylim(0.0, 1.0)
    axis.set_xlabel("mode")
    axis.set_ylabel("share in the variance")
    axis.set_xticks(numbers)
    axis.legend(frameon=False, fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.22), ncols=3)
