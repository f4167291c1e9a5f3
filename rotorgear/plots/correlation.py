"""Draws the MAC of measured and computed shapes, and of either among themselves."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import figure_for
from rotorgear.results.correlation import ShapeComparison

# Modes outside of the measured band that are drawn beside it.
_BESIDE = 2


def compare_shapes(result: ShapeComparison, fig: Any = None) -> np.ndarray:
    """Draw three tables of MAC side by side: rig and model with the pairs marked, the rig by itself, the model at the sensors.

    Args:
        result: measured shapes beside those of a model.
        fig: figure to draw on; a new one for None.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    figure = figure_for(fig, (13.0, 4.8), result.model.title or "Measured and computed shapes")
    axes = figure.subplots(1, 3)
    paired = [int(np.flatnonzero(result.mode_number == match.mode_number)[0]) for match in result.matches]
    last = min(len(result.mode_hz), max(paired, default=len(result.mode_hz) - 1) + 1 + _BESIDE)
    first = max(0, min(paired, default=0) - _BESIDE)
    shown = slice(first, last)
    rig = [f"{hz:.5g}" for hz in result.rig_hz]
    model = [f"{number}: {hz:.5g}" for number, hz in zip(result.mode_number[shown], result.mode_hz[shown], strict=True)]
    tables = (
        (result.mac[:, shown], rig, model, "rig, Hz", "mode: Hz", "rig and model"),
        (result.auto_mac, rig, rig, "rig, Hz", "rig, Hz", "rig by itself"),
        (result.model_auto_mac[shown, shown], model, model, "mode: Hz", "mode: Hz", "model at the sensors"),
    )
    for axis, (values, rows, columns, up, along, title) in zip(axes, tables, strict=True):
        image = axis.imshow(values, vmin=0.0, vmax=1.0, cmap="Blues", origin="lower", aspect="auto")
        axis.set_title(title, fontsize=10)
        axis.set_xlabel(along, fontsize=9)
        axis.set_ylabel(up, fontsize=9)
        every = max(1, len(columns) // 24)
        axis.set_xticks(range(0, len(columns), every), columns[::every], fontsize=7, rotation=90)
        every = max(1, len(rows) // 24)
        axis.set_yticks(range(0, len(rows), every), rows[::every], fontsize=7)
    for match, k in zip(result.matches, paired, strict=True):
        row = int(np.flatnonzero(result.rig_hz == match.rig.frequency_hz)[0])
        axes[0].plot(k - first, row, "s", mfc="none", mec="#c2571a", ms=9, mew=1.4)
    figure.colorbar(image, ax=list(axes), label="MAC", shrink=0.9)
    return np.asarray(axes)
