"""Draws convergence studies: error against CPU seconds and against degrees of freedom."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rotorgear.plots.figure import BLUE, GREY, ORANGE, axes_for, beside, figure_for, label, name_axes
from rotorgear.results.convergence import ConvergenceStudy, MeshConvergenceStudy, Rung
from rotorgear.results.mesh import MeshResult

_STYLE = {"elements": ("s", GREY, "basic elements"), "accuracy": ("o", BLUE, "refined to an accuracy")}
# An error of exactly zero has no place on a logarithmic axis.
_NONE = 1e-16
# Points nearer than this, in decades of both axes, share a label.
_NEAR = 0.03


def convergence(result: ConvergenceStudy, fig: Any = None) -> np.ndarray:
    """Draw a convergence study: error against CPU seconds and, where meshes differ, against degrees of freedom.

    Every point is labelled with what was asked for: elements, an accuracy, or steps; its bar goes from the fastest run
    to the slowest, and a point that was timed once is hollow.

    Args:
        result: a convergence study of any analysis but teeth.
        fig: figure to draw on; a new one for None.

    Returns:
        One or two axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    figure = figure_for(fig, (10.0, 4.4), result.title)
    reached = [rung for rung in result.rungs if math.isfinite(rung.error) and math.isfinite(rung.seconds)]
    # Where only steps or lengths differ, all rungs stand over the same number of dofs.
    panels = ("seconds", "dofs") if len({rung.dofs for rung in reached}) > 1 else ("seconds",)
    axes = np.atleast_1d(figure.subplots(1, len(panels), sharey=True))
    for axis, key in zip(axes, panels, strict=True):
        _curves(axis, reached, key)
        axis.set_xlabel(label(Rung, key))
    name_axes(axes[0], "", f"{result.analysis}: largest relative error\nof {result.modes} {result.compared}", legend=1)
    return axes


# Letters of a label that the margin holds.
_SHORT = 6


def _curves(axis: Any, reached: Sequence[Rung], key: str) -> None:
    families = dict.fromkeys(rung.family for rung in reached)
    sizes = [float(getattr(rung, key)) for rung in reached]
    far_right = min(sizes) ** 0.3 * max(sizes) ** 0.7 if reached else np.inf  # in the last third of the axis
    for number, family in enumerate(families):
        marker, colour, name = _STYLE.get(family, ("osd^v<>"[number % 7], f"C{number}", family))
        rungs = [rung for rung in reached if rung.family == family]
        x = np.array([float(getattr(rung, key)) for rung in rungs])
        y = np.array([max(rung.error, _NONE) for rung in rungs])
        bar = None
        if key == "seconds":
            ends = [(r.seconds - r.seconds_least, r.seconds_most - r.seconds) for r in rungs]
            bar = np.maximum(np.array(ends).T, 0.0) if any(r.timed > 1 for r in rungs) else None
        axis.errorbar(x, y, xerr=bar, marker=marker, color=colour, lw=1.2, ms=5, elinewidth=0.8, label=name)
        once = np.array([rung.timed < 2 for rung in rungs], bool)
        if key == "seconds":  # one run says nothing of its spread
            axis.plot(x[once], y[once], marker, color=colour, mfc="white", ms=5, zorder=3)
        axis.plot(x, [max(rung.estimate, _NONE) for rung in rungs], "x", color=colour, ms=6, alpha=0.7)
        for place, text in _labels(x, y, [rung.setting for rung in rungs]):
            # Inside the axes, and those of one family above, of the next below: different families may meet in a point.
            to_the_left = place[0] > far_right and len(text) > _SHORT
            offset = (-4 if to_the_left else 4, -9 if number % 2 else 4)
            beside(axis, text, place, offset, ha="right" if to_the_left else "left", color=colour)
    axis.plot([], [], "x", color="#444444", alpha=0.7, label="its own estimate")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.margins(x=0.12)
    if reached:
        # As many ticks as stand beside each other without touching.
        from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter, NullLocator

        decades = math.log10(max(sizes) / min(sizes)) if min(sizes) > 0.0 else 0.0
        subs = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0) if decades < 0.7 else ((1.0, 2.0, 5.0) if decades < 2.0 else (1.0,))
        axis.xaxis.set_major_locator(LogLocator(subs=subs, numticks=12))
        axis.xaxis.set_major_formatter(FormatStrFormatter("%g"))
        axis.xaxis.set_minor_locator(NullLocator())
        axis.xaxis.set_minor_formatter(NullFormatter())
    axis.grid(True, which="major", alpha=0.25)


def _labels(x: np.ndarray, y: np.ndarray, settings: Sequence[float]) -> list[tuple[tuple[float, float], str]]:
    """Places and words of the points; those that fall together share a label."""
    groups: list[tuple[int, list[str]]] = []
    for k, setting in enumerate(settings):
        word = f"{setting:g}" if setting >= 1.0 else f"{setting:.0e}".replace("e-0", "e-")
        near = [
            words
            for first, words in groups
            if math.hypot(math.log10(x[k] / x[first]), math.log10(y[k] / y[first])) < _NEAR
        ]
        if near:
            near[0].append(word)
        else:
            groups.append((k, [word]))
    return [((float(x[k]), float(y[k])), ", ".join(words)) for k, words in groups]


_CURVES = (
    ("mean_stiffness", "o", BLUE),
    ("peak_to_peak_stiffness", "s", ORANGE),
    ("ste_peak_to_peak", "^", "#3a7d44"),
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
    for name, marker, colour in _CURVES:
        seconds = [rung.fe_seconds + rung.contact_seconds for rung in result.rungs]
        errors = [100.0 * max(getattr(rung.error, name), 1e-7) for rung in result.rungs]
        axis.loglog(seconds, errors, marker, color=colour, ms=7, label=MeshResult.declarations[name].label)
        known = [(s, rung.estimate) for s, rung in zip(seconds, result.rungs, strict=True) if rung.estimate]
        # A cross lies over the mark of another curve, not under it.
        estimates = [100.0 * getattr(e, name) for _, e in known]
        axis.loglog([s for s, _ in known], estimates, "x", color=colour, ms=8, mew=1.8, zorder=4)
    for rung in result.rungs:
        top = 100.0 * rung.error.worst
        place = (rung.fe_seconds + rung.contact_seconds, top)
        beside(axis, rung.method.removeprefix("preset "), place, (6, 6), fontsize=9)
    axis.loglog([], [], "x", color="#444444", ms=8, mew=1.8, label="its own estimate")
    axis.margins(0.12)
    for scale in (axis.xaxis, axis.yaxis):
        scale.set_major_formatter("{x:g}")
    name_axes(axis, "CPU seconds, teeth and contact of 64 positions", "relative error, %")
    axis.grid(True, which="major", alpha=0.25)
    axis.legend(frameon=False, fontsize=9)
    return axis
