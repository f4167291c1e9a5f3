"""Pictures of a sweep: bifurcation diagram, maps over two parameters, and phase portraits and spectra of chosen points.

Portraits and spectra are drawn as the literature on nonlinear gear dynamics shows them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.figure import COLOURS, figure_for, name_axes, panels_of, parameter_name, save_all, values
from rotorgear.results.portrait import DISPLACEMENT, VELOCITY, Portraits
from rotorgear.results.sweep import SweepResult

_SIZE = (8.0, 6.0)
_EXPONENT = "LE per mesh\nperiod"
_KINDS = ("1T", "2T", "3T", "4T", "longer", "quasi-periodic", "chaotic", "not settled", "failed")
_SHADES = ("#0072B2", "#56B4E9", "#009E73", "#9ad0a5", "#F0E442", "#E69F00", "#D55E00", "#bbbbbb", "#ffffff")


def write_pictures(result: SweepResult, directory: str | Path) -> list[Path]:
    """Write what the result has data for into a folder; returns the paths.

    Raises:
        MissingExtraError: matplotlib is missing. WriteError: the folder can't be written.
    """
    contacts = range(len(result.contact))
    plans: dict[str, Callable[[], Any]] = {}
    if len(result.shape) == 1:
        plans |= {f"bifurcation_{c + 1}.png": partial(bifurcation, result, contact=c) for c in contacts}
        plans["sections.png"] = partial(sections, result)
    else:
        plans["map.png"] = partial(sweep_map, result)
    for c in contacts if result.portraits else ():
        plans[f"portraits_{c + 1}.png"] = partial(portraits, result, contact=c)
        plans[f"spectra_{c + 1}.png"] = partial(portrait_spectra, result, contact=c)
    return save_all(plans, directory)


def sweep(result: SweepResult, fig: Any = None, *, contact: int = 0) -> np.ndarray:
    """Draw the bifurcation diagram over one parameter, or the map over two.

    Args:
        result: a sweep.
        fig: figure to draw on; a new one for None.
        contact: number of the contact in a bifurcation diagram, counted from 0.

    Returns:
        The axes from top to bottom.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    return bifurcation(result, fig, contact=contact) if len(result.shape) == 1 else sweep_map(result, fig)


def bifurcation(result: SweepResult, fig: Any = None, *, contact: int = 0) -> np.ndarray:
    """Draw a contact at the Poincare sections over the parameter, the largest exponent, and shares of time below it.

    Args:
        result: a sweep.
        fig: figure to draw on; a new one for None.
        contact: its number, counted from 0.

    Returns:
        The axes from top to bottom.

    Raises:
        AnalysisError: a sweep over two parameters. MissingExtraError: matplotlib is not installed.
    """
    if len(result.shape) != 1:
        raise AnalysisError("a bifurcation diagram is drawn over one parameter: of two there is a map (sweep_map)")
    exponent = bool(result.lyapunov.shape[2])
    rows = 3 if exponent else 2
    axes = figure_for(fig, _SIZE, "").subplots(rows, 1, sharex=True, height_ratios=(3, 1, 1)[:rows])
    upper, *middle, lower = axes
    over = result.values[:, 0]
    look: dict[str, Any] = {"ms": 3, "lw": 0.7}
    dot = float(np.clip(120.0 / len(over), 0.8, 3.0))  # the finer, the more points stand side by side
    for r, name in enumerate(result.run):
        colour = _colour(result, r)
        y = 1e6 * result.section[:, r, :, contact, 0].ravel()
        x = np.repeat(over, result.count)
        upper.plot(x, y, ".", ms=dot, mew=0, color=colour, alpha=0.7, label=name, rasterized=True)
        for axis in middle:
            errors = result.lyapunov_error[:, r, 0]
            axis.errorbar(over, result.lyapunov[:, r, 0], errors, fmt=".-", color=colour, **look)
    title = f"{result.contact[contact]}: Poincare section once each {result.period_words.removeprefix('the ')}"
    name_axes(upper, "", "displacement at the section, um", title=title)
    if len(result.run) > 1:
        upper.legend(fontsize=7, markerscale=4, loc="best", ncols=2)
    for axis in middle:
        axis.axhline(0.0, color="k", lw=0.6)
        axis.set_ylabel(_EXPONENT)
    whose = f" ({result.run[0]})" if len(result.run) > 1 else ""
    for field, colour in zip(("apart", "back"), COLOURS, strict=False):
        name = result.declarations[field].label + whose
        lower.plot(over, values(result, field, "%")[:, 0, contact], ".-", color=colour, label=name, **look)
    name_axes(lower, parameter_name(result.address[0], result.unit[0]), "share of\ntime, %")
    # Shares lie at 0 or 100 % nearly everywhere, so that no corner of the panel is free.
    lower.figure.legend(*lower.get_legend_handles_labels(), fontsize=7, loc="outside lower center", ncols=2)
    for one in axes:
        one.grid(alpha=0.25)
    return np.asarray(axes)


def _colour(result: SweepResult, run: int) -> str:
    return "k" if len(result.run) == 1 else COLOURS[run % len(COLOURS)]


def sections(result: SweepResult, fig: Any = None) -> np.ndarray:
    """Draw Poincare sections of the first contact at up to nine points, spread over the sweep.

    Args:
        result: a sweep.
        fig: figure to draw on; a new one for None.

    Returns:
        One axes a point.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    sound = [p for p in range(len(result.values)) if not result.failure[p]]
    chosen = [sound[i] for i in np.unique(np.linspace(0, len(sound) - 1, min(9, len(sound))).round().astype(int))]
    figure = figure_for(fig, _SIZE, "")
    panels = panels_of(figure, len(chosen))
    for one, p in zip(panels, chosen, strict=True):
        for r in range(len(result.run)):
            x = 1e6 * result.section[p, r, :, 0, 0]
            v = 1e3 * result.section[p, r, :, 0, 1]
            one.plot(x, v, ".", ms=2, color=_colour(result, r))
        one.set_title(f"{result.values[p, 0]:.6g} {result.unit[0]}: {result.motion_at(p)}", fontsize=8)
        one.tick_params(labelsize=7)
        one.margins(0.15)
        one.ticklabel_format(useOffset=False)
    figure.supxlabel(f"displacement of {result.contact[0]}, um", fontsize=9)
    figure.supylabel("velocity, mm/s", fontsize=9)
    return np.asarray(panels)


def sweep_map(result: SweepResult, fig: Any = None) -> np.ndarray:
    """Draw response types, and the largest exponent, over both parameters.

    Args:
        result: a sweep.
        fig: figure to draw on; a new one for None.

    Returns:
        One or two axes.

    Raises:
        AnalysisError: a sweep over one parameter. MissingExtraError: matplotlib is not installed.
    """
    if len(result.shape) != 2:
        raise AnalysisError("a map is drawn over two parameters: of one there is a bifurcation diagram (bifurcation)")
    figure = figure_for(fig, _SIZE, "")
    from matplotlib.colors import BoundaryNorm, ListedColormap

    n1, n2 = (int(n) for n in result.shape)
    x = result.values[::n2, 0]
    y = result.values[:n2, 1]
    words = [result.motion_at(p) for p in range(n1 * n2)]
    words = [word if word in _KINDS else "longer" if word.endswith("T") else "not settled" for word in words]
    kinds = np.array([_KINDS.index(word) for word in words], dtype=float).reshape(n1, n2).T
    exponent = bool(result.lyapunov.shape[2])
    axes = np.atleast_1d(figure.subplots(2 if exponent else 1, 1, sharex=True))
    look: dict[str, Any] = {"shading": "nearest", "rasterized": True}
    norm = BoundaryNorm(np.arange(-0.5, len(_KINDS)), len(_KINDS))
    picture = axes[0].pcolormesh(x, y, kinds, cmap=ListedColormap(list(_SHADES)), norm=norm, **look)
    bar = figure.colorbar(picture, ax=axes[0], ticks=range(len(_KINDS)))
    bar.ax.set_yticklabels(_KINDS, fontsize=7)
    if exponent:
        exponents = result.lyapunov[:, 0, 0].reshape(n1, n2).T
        reach = float(np.nanmax(np.abs(exponents), initial=1e-12))
        picture = axes[1].pcolormesh(x, y, exponents, cmap="RdBu_r", vmin=-reach, vmax=reach, **look)
        figure.colorbar(picture, ax=axes[1], label=_EXPONENT.replace("\n", " "))
    for one in axes:
        one.set_ylabel(parameter_name(result.address[1], result.unit[1]), fontsize=8)
    axes[-1].set_xlabel(parameter_name(result.address[0], result.unit[0]))
    return axes


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
            name = _name(result, k, j)
            one.plot(path[:, DISPLACEMENT], 1e-3 * path[:, VELOCITY], lw=0.4, color=line, label=name, rasterized=True)
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
            size = 1e6 * amplitude[shown]
            one.semilogy(order[shown], size, lw=0.6, color=_colours(kept, j)[1], label=_name(result, k, j))
            largest = max(largest, float(np.nanmax(size, initial=0.0)))
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
    panels = panels_of(figure, count)
    for one, p in zip(panels, kept.point.tolist(), strict=True):
        at = ", ".join(f"{x:.6g} {unit}".strip() for x, unit in zip(result.values[p], result.unit, strict=True))
        kinds = [result.motion_at(p, r) for r in kept.run.tolist()]
        if len(kinds) > 1:
            kinds = [f"{result.run[r]} {kind}" for r, kind in zip(kept.run.tolist(), kinds, strict=True)]
        one.set_title(f"{at}: {', '.join(kinds)}", fontsize=8)
        one.tick_params(labelsize=7)
    return kept, figure, panels


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
