"""Pictures of a transient: forces, transmission error, spectra, orbits, energies, and orders over time for a run-up."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.analysis.transient.spectra import spectrum
from rotorgear.errors import AnalysisError
from rotorgear.plots.figure import axes_for, figure_for, label, legend_below, name_axes, panels_of, save_all, values
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.transient import TransientResult

_SIZE = (8.0, 5.0)
_SHOWN_PERIODS = 6
# Share of the largest line down to which a spectrum is shown.
_SHOWN_SHARE = 1e-4
_SHOWN_DB = 60.0


def write_pictures(result: TransientResult, directory: str | Path) -> list[Path]:
    """Write all pictures that the result has data for into a folder; returns their paths.

    Raises:
        MissingExtraError: matplotlib is missing. WriteError: the folder can't be written.
    """
    # A rotor without gears has neither contacts nor their spectra.
    plans: list[Callable[..., Any]] = [mesh_forces, transmission_error, spectra] if result.contact else []
    plans.append(energy)
    if _orbits(result):
        plans.append(shaft_orbits)
    if np.ptp(result.speed) > 0.0:
        plans.append(spectrogram)
    return save_all({f"{draw.__name__}.png": partial(draw, result) for draw in plans}, directory)


def transient(result: TransientResult, fig: Any = None) -> np.ndarray:
    """Draw mesh forces and transmission errors over the last periods, one above the other.

    Args:
        result: a transient.
        fig: figure to draw on; a new one for None.

    Returns:
        Both axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    axes = figure_for(fig, (8.0, 7.0), result.model.title).subplots(2, 1, sharex=True)
    mesh_forces(result, axes[0])
    transmission_error(result, axes[1])
    axes[0].set_xlabel("")
    return np.asarray(axes)


def _window(result: TransientResult) -> np.ndarray:
    """The last periods of the slowest mesh."""
    slowest = min(result.mesh_frequency.values(), default=0.0)
    start = result.time[-1] - _SHOWN_PERIODS / slowest if slowest and not np.ptp(result.speed) else 0.0
    return np.asarray(result.time >= start)


def _histories(result: TransientResult, ax: Any, field: str, unit: str) -> Any:
    """A field of the contacts over the last periods."""
    shown = _window(result)
    axes = axes_for(ax, _SIZE, result.model.title)
    time = values(result, "time", "ms")[shown]
    for name, history in zip(result.contact, values(result, field, unit)[shown].T, strict=True):
        axes.plot(time, history, lw=1.0, label=name)
    name_axes(axes, label(result, "time", "ms"), label(result, field, unit), grid=True)
    legend_below(axes, 4, fontsize=7)
    return axes


def mesh_forces(result: TransientResult, ax: Any = None) -> Any:
    """Draw the mesh force of each contact over the last periods.

    Args:
        result: a transient.
        ax: axes to draw on; those of a new figure for None.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    axes = _histories(result, ax, "mesh_force", "kN")
    axes.axhline(0.0, color="k", lw=0.5)
    return axes


def transmission_error(result: TransientResult, ax: Any = None) -> Any:
    """Draw the transmission error of each contact, the rotation at the base circles, over the last periods.

    Args:
        result: a transient.
        ax: axes to draw on; those of a new figure for None.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    return _histories(result, ax, "transmission_error", "um")


def spectra(result: TransientResult, fig: Any = None) -> np.ndarray:
    """Draw amplitude spectra of the accelerations of three points, or of the mesh forces.

    Args:
        result: a transient.
        fig: figure to draw on; a new one for None.

    Returns:
        One axes a quantity.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    names = [n for n in result.channel if n.endswith("acceleration")] or [f"force {c}" for c in result.contact]
    names = names[:3]
    orders = bool(np.ptp(result.speed) > 0.0)
    # Meshes of one frequency share their lines, which then carry the names of all of them.
    meshes_of: dict[float, list[str]] = {}
    for mesh, frequency in result.mesh_frequency.items():
        meshes_of.setdefault(round(frequency, 6), []).append(mesh)
    figure = figure_for(fig, _SIZE, result.model.title)
    panels = np.atleast_1d(figure.subplots(len(names), 1, sharex=True))
    for axes, name in zip(panels, names, strict=True):
        lines = spectrum(result, name, orders=orders)
        top = float(lines.amplitude.max()) or 1.0
        seen = lines.frequency[lines.amplitude > _SHOWN_SHARE * top]
        reach = 1.1 * float(seen.max()) if seen.size else float(lines.frequency[-1])
        axes.semilogy(lines.frequency[1:], lines.amplitude[1:], lw=0.8)
        for number, (f, meshes) in enumerate([] if orders else meshes_of.items(), 1):
            for k in range(1, int(reach / f) + 1):
                name_of_line = f"orders of {', '.join(meshes)}" if k == 1 else None
                axes.axvline(k * f, color=f"C{number}", lw=0.7, ls=":", label=name_of_line)
        axes.set_xlim(0.0, reach)
        axes.set_ylim(0.3 * _SHOWN_SHARE * top, 3.0 * top)
        if result.mesh_frequency and not orders:
            axes.legend(fontsize=7, loc="upper right")
        name_axes(axes, "", f"amplitude, {lines.unit}", title=name, grid=True)
    axes.set_xlabel("order of the input shaft" if orders else "frequency, Hz")
    return panels


def _orbits(result: TransientResult) -> list[str]:
    ends = [name.removesuffix(" displacement x") for name in result.channel if name.endswith(" displacement x")]
    return [name for name in ends if f"{name} displacement y" in result.channel and name.startswith("bearings.")]


def shaft_orbits(result: TransientResult, fig: Any = None) -> np.ndarray:
    """Draw the path of the shaft in each bearing about its mean, over the last periods.

    Args:
        result: a transient.
        fig: figure to draw on; a new one for None.

    Returns:
        One axes a bearing.

    Raises:
        AnalysisError: the model has no bearing with both displacements. MissingExtraError: matplotlib is not installed.
    """
    names = _orbits(result)
    if not names:
        raise AnalysisError("there are no orbits to draw: no bearing of the model has displacements along x and y")
    figure = figure_for(fig, _SIZE, result.model.title)
    shown = _window(result)
    panels = panels_of(figure, len(names))
    for axes, name in zip(panels, names, strict=True):
        x, y = (1e6 * result.history(f"{name} displacement {axis}")[shown] for axis in "xy")
        axes.plot(x - x.mean(), y - y.mean(), lw=0.6)
        axes.set_aspect("equal", "datalim")
        axes.set_title(name.removeprefix("bearings."), fontsize=8)
        axes.tick_params(labelsize=7)
    figure.supxlabel("x, um")
    figure.supylabel("y, um")
    return np.asarray(panels)


def energy(result: TransientResult, fig: Any = None) -> np.ndarray:
    """Draw the terms of the energy ledger since the start, and below the energy error of the integration.

    Args:
        result: a transient.
        fig: figure to draw on; a new one for None.

    Returns:
        Both axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    e = result.energy
    figure = figure_for(fig, _SIZE, result.model.title)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    time = values(e, "time", "ms")
    stored = e.strain + e.contact
    terms = {
        e.declarations["kinetic"].label: e.kinetic - e.kinetic[0],
        "stored in springs and contacts": stored - stored[0],
    }
    terms |= {e.declarations[name].label: getattr(e, name) for name in ("load_work", "excitation_work", "dissipated")}
    for name, term in terms.items():
        upper.plot(time, term, lw=1.0, label=name)
    upper.set_ylabel("energy since the start, J")
    # Above the panel: the terms take its whole height.
    upper.legend(fontsize=7, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)
    lower.plot(time, e.numerical, lw=1.0, color="tab:red")
    name_axes(lower, label(e, "time", "ms"), label(e, "numerical"))
    for axes in (upper, lower):
        axes.grid(alpha=0.3)
    return np.array([upper, lower])


def spectrogram(result: TransientResult, ax: Any = None) -> Any:
    """Draw the spectrogram of the first acceleration, or mesh force, over the speed of a run-up.

    Args:
        result: a transient.
        ax: axes to draw on; those of a new figure for None.

    Returns:
        The axes.

    Raises:
        AnalysisError: the speed does not change. MissingExtraError: matplotlib is not installed.
    """
    from scipy import signal

    if not np.ptp(result.speed):
        raise AnalysisError("a spectrogram is drawn over the speed: it needs a run-up (speed_to, --speed-to)")
    name = next((n for n in result.channel if n.endswith("acceleration")), f"force {result.contact[0]}")
    history = result.history(name)[result.counted]
    size = int(min(max(history.size // 60, 64), 4096))
    settings = {"nperseg": size, "noverlap": size // 2, "window": "hann", "scaling": "spectrum"}
    f, t, power = signal.spectrogram(history - history.mean(), 1.0 / result.spacing, **settings)
    axes = axes_for(ax, _SIZE, result.model.title)
    speeds = np.interp(result.settle + t, result.time, result.speed) * RPM_PER_RAD_S
    level = 10.0 * np.log10(np.maximum(2.0 * power, 1e-12 * power.max()))
    picture = axes.pcolormesh(speeds, f, level, vmin=level.max() - _SHOWN_DB, shading="auto", rasterized=True)
    axes.figure.colorbar(picture, ax=axes, label="dB of the amplitude squared")
    seen = f[level.max(axis=1) > level.max() - _SHOWN_DB]
    axes.set_ylim(0.0, 1.1 * float(seen.max(initial=f[1])))
    name_axes(axes, label(result, "speed", "rpm"), "frequency, Hz", title=name)
    return axes
