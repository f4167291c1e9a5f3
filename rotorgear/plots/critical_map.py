"""Draws an undamped critical speed map."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import BLUE, GREY, axes_for, label, legend_below, name_axes
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.critical import CriticalMap
from rotorgear.results.modal import WHIRL_WORDS

_MARKERS = {
    "forward": ("^", BLUE, "forward whirl"),
    "backward": ("v", "#c2571a", "backward whirl"),
    "mixed": ("D", "#7a3f9d", "mixed whirl"),
    "planar": ("_", "#2f7d32", "planar"),
    "": (".", GREY, "torsion or axial"),
}


def critical_map(result: CriticalMap, ax: Any = None) -> Any:
    """Draw critical speeds over support stiffness in ascending order, whirl by marker, with the stiffness of the bearings.

    Args:
        result: a map of critical speeds.
        ax: axes to draw on; those of a new figure for None.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    over = "over the radial stiffness of all bearings"
    title = f"{result.model.title or 'Critical speeds'}\nundamped critical speeds of {result.line} {over}"
    axis = axes_for(ax, (9.0, 6.0), title)
    speeds = np.abs(result.critical_speeds) * RPM_PER_RAD_S
    for column in range(speeds.shape[1]):
        # The k-th lowest speed over stiffness: such a curve never falls, while a mode may change its whirl along it.
        axis.loglog(result.stiffness, speeds[:, column], "-", color="#999999", lw=0.9, zorder=2)
    for word, (marker, colour, name) in _MARKERS.items():
        rows, columns = np.nonzero((result.whirl == WHIRL_WORDS.index(word)) & np.isfinite(speeds))
        if rows.size:
            x = result.stiffness[rows]
            y = speeds[rows, columns]
            axis.plot(x, y, marker, color=colour, mfc="white", mew=0.9, ms=4.5, ls="none", label=name, zorder=3)
    # A vertical line at each different stiffness that a bearing has, named after the bearings that have it.
    names: dict[float, list[str]] = {}
    for bearing, (k_x, k_y) in result.bearings.items():
        for value, suffix in ((k_x, "" if k_x == k_y else " x"), (k_y, "" if k_x == k_y else " y")):
            if value > 0.0 and f"{bearing}{suffix}" not in names.setdefault(float(value), []):
                names[float(value)].append(f"{bearing}{suffix}")
    for value, alike in names.items():
        if result.stiffness[0] <= value <= result.stiffness[-1]:
            axis.axvline(value, color="#444444", lw=0.8)
            more = f" and {len(alike) - 3} more" if len(alike) > 3 else ""
            # In the middle of the widest gap that the curves leave there, on the logarithmic axis.
            row = int(np.argmin(np.abs(np.log(result.stiffness / value))))
            near = np.abs(result.critical_speeds[max(row - 1, 0) : row + 2]) * RPM_PER_RAD_S
            edges = np.log(np.sort(np.concatenate([near[np.isfinite(near)], axis.get_ylim()])))
            widest = int(np.argmax(np.diff(edges)))
            middle = float(np.exp(0.5 * (edges[widest] + edges[widest + 1])))
            look = {"rotation": 90, "fontsize": 7, "va": "center", "ha": "right", "color": "#444444"}
            axis.text(value, middle, ", ".join(alike[:3]) + more, **look)
    name_axes(axis, label(result, "stiffness"), label(result, "critical_speeds"))
    axis.set_xlim(result.stiffness[0], result.stiffness[-1])
    axis.grid(True, which="both", alpha=0.2)
    if axis.get_legend_handles_labels()[0]:
        legend_below(axis, 5)
    return axis
