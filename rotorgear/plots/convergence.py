"""Draws a convergence study: error against seconds and against degrees of freedom."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import figure_for
from rotorgear.results.convergence import ConvergenceStudy

_STYLE = {"elements": ("s", "#777777", "basic elements"), "accuracy": ("o", "#1f5fa8", "refined to an accuracy")}


def convergence(result: ConvergenceStudy, fig: Any = None) -> np.ndarray:
    """Draw a convergence study: error against seconds and, of modes, against degrees of freedom.

    Args:
        result: a convergence study of modes or of a transient.
        fig: figure to draw on; a new one for None.

    Returns:
        One or two axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    figure = figure_for(fig, (9.0, 4.0), result.title)
    if result.analysis == "transient":
        axes = np.array([figure.subplots()])
        _curve(axes[0], result, "seconds", "seconds, integration")
        axes[0].set_ylabel(f"rms error of {result.modes} contact forces over their change")
    else:
        axes = figure.subplots(1, 2, sharey=True)
        _curve(axes[0], result, "seconds", "seconds, whole analysis")
        _curve(axes[1], result, "dofs", "degrees of freedom")
        axes[0].set_ylabel(f"largest relative error of {result.modes} frequencies")
    axes[0].legend(frameon=False)
    return axes


def _curve(axis: Any, study: ConvergenceStudy, key: str, label: str) -> None:
    families = dict.fromkeys(rung.family for rung in study.rungs)
    others = {family: ("osd^v<>"[i % 7], f"C{i}", family) for i, family in enumerate(families)}
    for family, (marker, colour, name) in {**others, **{key: _STYLE[key] for key in _STYLE if key in families}}.items():
        rungs = [rung for rung in study.rungs if rung.family == family and rung.error < float("inf")]
        if rungs:
            # An error of exactly zero has no place on a logarithmic axis.
            x = [getattr(rung, key) for rung in rungs]
            y = [max(rung.error, 1e-16) for rung in rungs]
            axis.loglog(x, y, marker=marker, color=colour, lw=1.2, ms=5, label=name)
            axis.loglog(x, [max(rung.estimate, 1e-16) for rung in rungs], "x", color=colour, ms=5, alpha=0.6)
    axis.loglog([], [], "x", color="#444444", alpha=0.6, label="its own estimate")
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

    axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.set_xlabel(label)
    axis.grid(True, which="major", alpha=0.25)
