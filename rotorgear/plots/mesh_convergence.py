"""Draws the convergence study of a mesh: errors of stiffness and transmission error against CPU seconds."""

from __future__ import annotations

from typing import Any

from rotorgear.plots.figure import axes_for
from rotorgear.results.convergence import MeshConvergenceStudy

_CURVES = (
    ("mean_stiffness", "o", "#1f5fa8", "mean stiffness"),
    ("peak_to_peak_stiffness", "s", "#b3541e", "its peak to peak"),
    ("ste_peak_to_peak", "^", "#3a7d44", "transmission error, peak to peak"),
)


def mesh_convergence(result: MeshConvergenceStudy, ax: Any = None) -> Any:
    """Draw the convergence study of a mesh: errors of stiffness and transmission error against CPU seconds.

    Args:
        result: a convergence study of a mesh.
        ax: axes to draw on; those of a new figure for None.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    axis = axes_for(ax, (7.5, 4.6), f"{result.title}: {result.mesh}")
    for name, marker, colour, label in _CURVES:
        seconds = [rung.fe_seconds + rung.contact_seconds for rung in result.rungs]
        errors = [100.0 * max(getattr(rung.error, name), 1e-7) for rung in result.rungs]
        axis.loglog(seconds, errors, marker, color=colour, ms=7, label=label)
        known = [(s, rung.estimate) for s, rung in zip(seconds, result.rungs, strict=True) if rung.estimate]
        # A cross lies over the mark of another curve, not under it.
        estimates = [100.0 * getattr(e, name) for _, e in known]
        axis.loglog([s for s, _ in known], estimates, "x", color=colour, ms=8, mew=1.8, zorder=4)
    for rung in result.rungs:
        top = 100.0 * rung.error.worst
        place = (rung.fe_seconds + rung.contact_seconds, top)
        axis.annotate(rung.method.removeprefix("preset "), place, (6, 6), textcoords="offset points", fontsize=9)
    axis.loglog([], [], "x", color="#444444", ms=8, mew=1.8, label="its own estimate")
    axis.margins(0.12)
    for scale in (axis.xaxis, axis.yaxis):
        scale.set_major_formatter("{x:g}")
    axis.set_xlabel("CPU seconds, teeth and contact of 64 positions")
    axis.set_ylabel("relative error, %")
    axis.grid(True, which="major", alpha=0.25)
    axis.legend(frameon=False, fontsize=9)
    return axis
