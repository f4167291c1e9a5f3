"""Pictures of a sweep: bifurcation diagram with Lyapunov exponent and indicators, or maps over two parameters."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.colours import COLOURS
from rotorgear.plots.figure import figure_for, save_all
from rotorgear.plots.sweep_portraits import portrait_spectra, portraits
from rotorgear.results.sweep import SweepResult

_SIZE = (8.0, 6.0)
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


def _label(result: SweepResult, axis: int) -> str:
    return f"{result.address[axis]}{', ' + result.unit[axis] if result.unit[axis] else ''}"


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
    dot = float(np.clip(120.0 / len(result.values), 0.8, 3.0))  # the finer, the more points stand side by side
    for r, name in enumerate(result.run):
        x = np.repeat(result.values[:, 0], result.count)
        y = 1e6 * result.section[:, r, :, contact, 0].ravel()
        axes[0].plot(x, y, ".", ms=dot, mew=0, color=_colour(result, r), alpha=0.7, label=name, rasterized=True)
        if exponent:
            axes[1].errorbar(
                result.values[:, 0],
                result.lyapunov[:, r, 0],
                result.lyapunov_error[:, r, 0],
                fmt=".-",
                ms=3,
                lw=0.7,
                color=_colour(result, r),
            )
    axes[0].set_ylabel("displacement at the section, um")
    axes[0].set_title(
        f"{result.contact[contact]}: Poincare section once each {result.period_words.removeprefix('the ')}", fontsize=9
    )
    if len(result.run) > 1:
        axes[0].legend(fontsize=7, markerscale=4, loc="best", ncols=2)
    if exponent:
        axes[1].axhline(0.0, color="k", lw=0.6)
        axes[1].set_ylabel("LE per mesh\nperiod")
    whose = f" ({result.run[0]})" if len(result.run) > 1 else ""
    for values, name, colour in ((result.apart, "contact loss", 0), (result.back, "coast flank", 1)):
        axes[-1].plot(
            result.values[:, 0],
            100.0 * values[:, 0, contact],
            ".-",
            ms=3,
            lw=0.7,
            color=COLOURS[colour],
            label=name + whose,
        )
    axes[-1].set_ylabel("share of\ntime, %")
    axes[-1].legend(fontsize=7)
    axes[-1].set_xlabel(_label(result, 0))
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
    columns = int(np.ceil(np.sqrt(len(chosen))))
    figure = figure_for(fig, _SIZE, "")
    grid = figure.subplots(int(np.ceil(len(chosen) / columns)), columns, squeeze=False)
    for one in grid.flat[len(chosen) :]:
        one.set_visible(False)
    for one, p in zip(grid.flat, chosen, strict=False):
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
    return np.asarray(grid.flat[: len(chosen)])


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
    kinds = np.array([_class(result.motion_at(p)) for p in range(n1 * n2)], dtype=float).reshape(n1, n2).T
    exponent = bool(result.lyapunov.shape[2])
    axes = np.atleast_1d(figure.subplots(2 if exponent else 1, 1, sharex=True))
    shades = ListedColormap(list(_SHADES))
    picture = axes[0].pcolormesh(
        x,
        y,
        kinds,
        cmap=shades,
        norm=BoundaryNorm(np.arange(-0.5, len(_KINDS)), len(_KINDS)),
        shading="nearest",
        rasterized=True,
    )
    bar = figure.colorbar(picture, ax=axes[0], ticks=range(len(_KINDS)))
    bar.ax.set_yticklabels(_KINDS, fontsize=7)
    if exponent:
        values = result.lyapunov[:, 0, 0].reshape(n1, n2).T
        reach = float(np.nanmax(np.abs(values), initial=1e-12))
        picture = axes[1].pcolormesh(
            x, y, values, cmap="RdBu_r", vmin=-reach, vmax=reach, shading="nearest", rasterized=True
        )
        figure.colorbar(picture, ax=axes[1], label="LE per mesh period")
    for one in axes:
        one.set_ylabel(_label(result, 1), fontsize=8)
    axes[-1].set_xlabel(_label(result, 0))
    return axes


def _class(kind: str) -> int:
    """Place of a kind among the shades."""
    if kind in _KINDS:
        return _KINDS.index(kind)
    return _KINDS.index("longer") if kind.endswith("T") else _KINDS.index("not settled")
