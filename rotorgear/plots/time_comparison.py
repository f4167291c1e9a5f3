"""Draws a record over time beside the model: measured loads, then each channel with the model and with one without vibration."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import BLUE, COLOURS, GREY, ORANGE, figure_for, legend_below, name_axes, plain_axis
from rotorgear.results.time_comparison import TimeComparison

# More points than this along an axis are not told apart in a picture.
_MOST = 20_000
_MOST_CHANNELS = 8


def compare_time(result: TimeComparison, fig: Any = None) -> np.ndarray:
    """Draw the measured loads over time, and below them each channel: rig, model, and the model without vibration.

    Args:
        result: a record beside a model; of more than eight channels the first eight are drawn.
        fig: figure to draw on; a new one for None.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    shown = result.channels[:_MOST_CHANNELS]
    units = list(dict.fromkeys(row.unit for row in result.inputs))
    rows = len(units) + len(shown)
    title = f"{result.model.title or 'Record over time'}: rig and model"
    figure = figure_for(fig, (9.0, 1.0 + 1.9 * rows), title)
    axes = np.atleast_1d(figure.subplots(rows, 1, sharex=True))
    thin = slice(None, None, max(1, len(result.time) // _MOST))
    time = result.time[thin]
    for axis, unit in zip(axes, units, strict=False):
        of_unit = [k for k, row in enumerate(result.inputs) if row.unit == unit]
        for colour, k in zip(COLOURS, of_unit, strict=False):
            axis.plot(time, result.load[k][thin], color=colour, lw=1.0, label=result.inputs[k].name)
        name_axes(axis, y=f"load, {unit}", legend=len(of_unit))
    for axis, row, rig, model, static in zip(
        axes[len(units) :], shown, result.rig_values, result.model_values, result.baseline_values, strict=False
    ):
        axis.plot(time, static[thin], color=GREY, lw=1.0, ls="--", label="model without vibration")
        axis.plot(time, model[thin], color=ORANGE, lw=1.2, label="model")
        axis.plot(time, rig[thin], color=BLUE, lw=1.0, label="rig")
        share = next(one for one in result.shares if one.name == row.name and one.part == "variance")
        explained = f"model explains {100.0 * share.explained:.1f} % of the variance"
        if np.isfinite(share.quasi_static):
            explained += f", without vibration {100.0 * share.quasi_static:.1f} %"
        name_axes(axis, y=f"{row.quantity}, {row.unit}", title=f"{row.name}: {explained}")
        axis.axvspan(*result.window_s, color=GREY, alpha=0.06, lw=0)
    for axis in axes:
        plain_axis(axis)
    name_axes(axes[-1], x="time, s")
    legend_below(axes[-1], 3, below=0.3, fontsize=8)
    return axes
