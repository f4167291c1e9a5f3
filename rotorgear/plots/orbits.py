"""Picture of periodic motions over a parameter: stable and unstable branches, special points, size of the multipliers."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import COLOURS, figure_for, label, name_axes, parameter_name
from rotorgear.results.orbits import OrbitsResult

_MARKERS = {"fold": "o", "period doubling": "D", "Neimark-Sacker": "s"}
_SIZE = (7.5, 6.0)


def orbits(result: OrbitsResult, fig: Any = None, *, contact: int | None = None) -> np.ndarray:
    """Draw the peak to peak of a contact's approach over the parameter: solid where stable, dashed where unstable.

    Of a model without meshes it is that of the displacement across a bearing, a nonlinear element or at an unbalance.

    Args:
        result: periodic motions over a parameter.
        fig: figure to draw on; a new one for None.
        contact: its number, counted from 0, or that of the displacement; the one that moves most where not given.

    Returns:
        The axes: peak to peak, the largest Floquet multiplier below it, and the curves of special points where there are any.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    rows = 3 if result.curves else 2
    size = (_SIZE[0], _SIZE[1] * (1.4 if result.curves else 1.0))
    axes = figure_for(fig, size, "").subplots(rows, 1, sharex=True, height_ratios=(3, 1, 2)[:rows])
    sizes = 1e6 * result.peak_to_peak_of(result)
    c = int(np.argmax(sizes.max(axis=0))) if contact is None else contact
    x = result.value / result.per_unit[0]
    largest = np.nanmax(np.abs(result.multipliers), axis=1)
    for number, branch in enumerate(result.branches):
        own = np.flatnonzero(result.branch == number)
        colour = COLOURS[number % len(COLOURS)]
        for stable, style in ((True, "-"), (False, "--")):
            # What lies between two points is drawn as the first of them is.
            kept = result.stable[own] == stable
            shown = kept | np.roll(kept, 1)
            shown[0] = kept[0]
            if kept.any():
                y = np.where(shown, sizes[own, c], np.nan)
                name = f"{branch.name}, {'stable' if stable else 'unstable'}"
                axes[0].plot(x[own], y, style, color=colour, lw=1.4, label=name)
        axes[1].plot(x[own], largest[own], "-", color=colour, lw=1.0)
    for kind, marker in _MARKERS.items():
        points = [one for one in result.special_points if one.kind == kind]
        if points:
            at = [one.value / result.per_unit[0] for one in points]
            height = [1e6 * float(result.peak_to_peak_of(one)[c]) for one in points]
            axes[0].plot(at, height, marker, color="k", mfc="w", ms=6, ls="none", label=kind, zorder=5)
    axes[1].axhline(1.0, color="k", lw=0.6)
    moved = "peak_to_peak_approach" if result.contact else "place_peak_to_peak"
    up = label(result, moved, f"u{result.shown_unit}")
    name_axes(axes[0], "", up, title=f"{result.shown[c]}: periodic motions")
    axes[0].legend(fontsize=7)
    axes[1].set_ylabel("largest |mu|")
    for curve in result.curves:
        style = f"-{_MARKERS[curve.kind]}"
        name = f"{curve.kind}, {result.branches[curve.branch].name}"
        second = curve.second / result.per_unit[1]
        axes[2].plot(curve.value / result.per_unit[0], second, style, ms=3, mfc="w", lw=1.2, label=name)
    if result.curves:
        axes[2].set_ylabel(parameter_name(result.address[1], result.unit[1]))
        axes[2].legend(fontsize=7)
    axes[-1].set_xlabel(parameter_name(result.address[0], result.unit[0]))
    for one in axes:
        one.grid(alpha=0.25)
    return np.asarray(axes)
