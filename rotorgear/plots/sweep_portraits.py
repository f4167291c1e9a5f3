"""Phase portraits and spectra of chosen points of a sweep, as the literature on nonlinear gear dynamics shows them."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.colours import COLOURS
from rotorgear.plots.figure import figure_for
from rotorgear.results.portrait import DISPLACEMENT, VELOCITY, Portraits
from rotorgear.results.sweep import SweepResult

# Mesh orders that a spectrum shows, and decades below its largest line.
_ORDERS = 4.0
_DECADES = 5


def portraits(result: SweepResult, fig: Any = None, *, contact: int = 0) -> np.ndarray:
    """Draw velocity over displacement of a contact through some periods, with the Poincare points on top.

    Args:
        result: a sweep.
        fig: figure to draw on; a new one for None.
        contact: its number, counted from 0.

    Returns:
        One axes a point.

    Raises:
        AnalysisError: the sweep kept no trajectories. MissingExtraError: matplotlib is not installed.
    """
    kept, figure, panels = _panels(result, fig)
    for k, one in enumerate(panels):
        for j in range(len(kept.run)):
            path = 1e6 * kept.trajectory(k, j)[:, contact]
            points = 1e6 * kept.section(k, j)[:, contact]
            line, dot = _colours(kept, j)
            one.plot(
                path[:, DISPLACEMENT],
                1e-3 * path[:, VELOCITY],
                lw=0.4,
                color=line,
                label=_name(result, k, j),
                rasterized=True,
            )
            one.plot(points[:, DISPLACEMENT], 1e-3 * points[:, VELOCITY], ".", ms=4, mew=0, color=dot, zorder=3)
        _legend(result, k, one)
        one.margins(0.08)
        one.ticklabel_format(useOffset=False)
    figure.supxlabel(f"displacement of {result.contact[contact]}, um", fontsize=9)
    figure.supylabel("velocity, mm/s", fontsize=9)
    return np.array(panels)


def portrait_spectra(result: SweepResult, fig: Any = None, *, contact: int = 0) -> np.ndarray:
    """Draw amplitudes of the displacement of a contact over the frequency as a multiple of the mesh frequency.

    Args:
        result: a sweep.
        fig: figure to draw on; a new one for None.
        contact: its number, counted from 0.

    Returns:
        One axes a point.

    Raises:
        AnalysisError: the sweep kept no trajectories. MissingExtraError: matplotlib is not installed.
    """
    kept, figure, panels = _panels(result, fig)
    for k, one in enumerate(panels):
        largest = 0.0
        for j in range(len(kept.run)):
            order, amplitude = kept.spectrum(k, j, contact)
            shown = (order > 0.0) & (order <= _ORDERS + 0.2)
            one.semilogy(
                order[shown], 1e6 * amplitude[shown], lw=0.6, color=_colours(kept, j)[1], label=_name(result, k, j)
            )
            largest = max(largest, float(np.nanmax(1e6 * amplitude[shown], initial=0.0)))
        one.set_xlim(0.0, _ORDERS + 0.2)
        _legend(result, k, one)
        if largest > 0.0:
            one.set_ylim(10.0**-_DECADES * largest, 3.0 * largest)
        one.set_xticks(np.arange(0.0, _ORDERS + 0.5))
        one.set_xticks(np.arange(0.5, _ORDERS, 1.0), minor=True)
        one.grid(which="both", axis="x", lw=0.4, alpha=0.35)
    which = "that of the fastest mesh" if kept.turns.max() > 1 else "the mesh frequency"
    figure.supxlabel(f"frequency over {which}", fontsize=9)
    figure.supylabel(f"amplitude of the displacement of {result.contact[contact]}, um", fontsize=9)
    return np.array(panels)


def _panels(result: SweepResult, fig: Any) -> tuple[Portraits, Any, list[Any]]:
    """One pair of axes for each point, named by its values and response types."""
    kept = result.portraits
    if kept is None:
        raise AnalysisError("the sweep kept no trajectories: ask for them (portraits, --portraits)")
    count = len(kept.point)
    inches = (5.0, 4.0) if count == 1 else (8.0, 6.0) if count <= 9 else (10.5, 8.0)
    figure = figure_for(fig, inches, "")
    columns = int(np.ceil(np.sqrt(count)))
    grid = list(figure.subplots(int(np.ceil(count / columns)), columns, squeeze=False).flat)
    for one in grid[count:]:
        one.set_visible(False)
    for one, p in zip(grid, kept.point.tolist(), strict=False):
        values = ", ".join(f"{x:.6g} {unit}".strip() for x, unit in zip(result.values[p], result.unit, strict=True))
        kinds = [result.motion_at(p, r) for r in kept.run.tolist()]
        if len(kinds) > 1:
            kinds = [f"{result.run[r]} {kind}" for r, kind in zip(kept.run.tolist(), kinds, strict=True)]
        one.set_title(f"{values}: {', '.join(kinds)}", fontsize=8)
        one.tick_params(labelsize=7)
    return kept, figure, grid[:count]


def _name(result: SweepResult, k: int, j: int) -> str | None:
    """Name of a run where the legend of the first panel tells several apart."""
    kept = result.portraits
    return result.run[kept.run[j]] if kept is not None and k == 0 and len(kept.run) > 1 else None


def _legend(result: SweepResult, k: int, one: Any) -> None:
    if _name(result, k, 0):
        one.legend(fontsize=6, loc="best", frameon=False)


def _colours(kept: Portraits, j: int) -> tuple[str, str]:
    """Of the trajectory of a run, and of its Poincare points."""
    return ("#888888", "k") if len(kept.run) == 1 else (COLOURS[j % len(COLOURS)], COLOURS[j % len(COLOURS)])
