"""Pictures of a transient: forces, transmission error, spectra, orbits, energies, and orders over time for a run-up."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.analysis.transient.spectra import spectrum
from rotorgear.errors import MissingExtraError
from rotorgear.export.files import filling, publish
from rotorgear.results.transient import TransientResult

_SHOWN_PERIODS = 6
# Share of the largest line down to which a spectrum is shown.
_SHOWN_SHARE = 1e-4
_SHOWN_DB = 60.0


def draw_transient(result: TransientResult, directory: str | Path) -> list[Path]:
    """Draw all pictures that the result has data for into a folder; returns their paths.

    Raises:
        MissingExtraError: matplotlib is missing. WriteError: the folder can't be written.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtraError("Drawing pictures", "matplotlib", "plots") from None
    plans: dict[str, Callable[[TransientResult, Any], None]] = {
        "mesh_forces.png": draw_mesh_forces,
        "transmission_error.png": draw_transmission_error,
        "spectra.png": draw_spectra,
        "energy.png": draw_energy,
    }
    if _orbits(result):
        plans["orbits.png"] = draw_orbits
    if np.ptp(result.speed) > 0.0:
        plans["spectrogram.png"] = draw_spectrogram
    target = Path(directory)
    names = []
    with filling(target) as scratch:
        for name, draw in plans.items():
            figure = Figure(figsize=(8.0, 5.0), dpi=130, layout="constrained")
            draw(result, figure)
            figure.savefig(scratch / name)
            names.append(name)
        return publish(scratch, target, names)


def _window(result: TransientResult) -> np.ndarray:
    """The last periods of the slowest mesh."""
    slowest = min(result.mesh_frequency.values(), default=0.0)
    start = result.time[-1] - _SHOWN_PERIODS / slowest if slowest and not np.ptp(result.speed) else 0.0
    return np.asarray(result.time >= start)


def _histories(result: TransientResult, figure: Any, table: np.ndarray, label: str) -> Any:
    shown = _window(result)
    axes = figure.subplots()
    for i, name in enumerate(result.contact):
        axes.plot(1e3 * result.time[shown], table[shown, i], lw=1.0, label=name)
    axes.set_xlabel("time, ms")
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7, ncols=2, loc="upper right")
    return axes


def draw_mesh_forces(result: TransientResult, figure: Any) -> None:
    """Mesh force of each contact over the last periods."""
    _histories(result, figure, 1e-3 * result.mesh_force, "mesh force, kN").axhline(0.0, color="k", lw=0.5)


def draw_transmission_error(result: TransientResult, figure: Any) -> None:
    """Dynamic transmission error of each contact over the last periods."""
    _histories(result, figure, 1e6 * result.deflection, "dynamic transmission error along the flank normal, um")


def draw_spectra(result: TransientResult, figure: Any) -> None:
    """Amplitude spectra of the points' accelerations, or of the mesh forces."""
    names = [n for n in result.channel if n.endswith("acceleration")] or [f"force {c}" for c in result.contact]
    names = names[:3]
    orders = bool(np.ptp(result.speed) > 0.0)
    for axes, name in zip(np.atleast_1d(figure.subplots(len(names), 1, sharex=True)), names, strict=True):
        found = spectrum(result, name, orders=orders)
        top = float(found.amplitude.max()) or 1.0
        seen = found.frequency[found.amplitude > _SHOWN_SHARE * top]
        reach = 1.1 * float(seen.max()) if seen.size else float(found.frequency[-1])
        axes.semilogy(found.frequency[1:], found.amplitude[1:], lw=0.8)
        for number, (mesh, f) in enumerate([] if orders else _different(result.mesh_frequency)):
            for k in range(1, int(reach / f) + 1):
                axes.axvline(
                    k * f, color=f"C{number + 1}", lw=0.7, ls=":", label=f"orders of {mesh}" if k == 1 else None
                )
        axes.set_xlim(0.0, reach)
        axes.set_ylim(0.3 * _SHOWN_SHARE * top, 3.0 * top)
        if result.mesh_frequency and not orders:
            axes.legend(fontsize=7, loc="upper right")
        axes.set_ylabel(f"{found.unit}")
        axes.set_title(name, fontsize=9)
        axes.grid(alpha=0.3)
    axes.set_xlabel("order of the input shaft" if orders else "frequency, Hz")


def _different(frequencies: dict[str, float]) -> list[tuple[str, float]]:
    """Meshes of one frequency under one name."""
    found: dict[float, str] = {}
    for name, f in frequencies.items():
        found[round(f, 6)] = f"{found[round(f, 6)]}, {name}" if round(f, 6) in found else name
    return [(name, f) for f, name in found.items()]


def _orbits(result: TransientResult) -> list[str]:
    ends = [name.removesuffix(" displacement x") for name in result.channel if name.endswith(" displacement x")]
    return [name for name in ends if f"{name} displacement y" in result.channel and name.startswith("bearings.")]


def draw_orbits(result: TransientResult, figure: Any) -> None:
    """Path of the shaft in each bearing about its mean, over the last periods."""
    names = _orbits(result)
    shown = _window(result)
    columns = int(np.ceil(np.sqrt(len(names))))
    grid = figure.subplots(int(np.ceil(len(names) / columns)), columns, squeeze=False)
    for axes in grid.flat[len(names) :]:
        axes.set_visible(False)
    for axes, name in zip(grid.flat, names, strict=False):
        x, y = (1e6 * result.history(f"{name} displacement {axis}")[shown] for axis in "xy")
        axes.plot(x - x.mean(), y - y.mean(), lw=0.6)
        axes.set_aspect("equal", "datalim")
        axes.set_title(name.removeprefix("bearings."), fontsize=8)
        axes.tick_params(labelsize=7)
    figure.supxlabel("x, um")
    figure.supylabel("y, um")


def draw_energy(result: TransientResult, figure: Any) -> None:
    """The terms of the energy ledger since the start, and below the energy error of the integration."""
    e = result.energy
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    stored = e.strain + e.contact
    terms = {
        "kinetic": e.kinetic - e.kinetic[0],
        "stored in springs and contacts": stored - stored[0],
        "work of the loads": e.load_work,
        "work of the excitation": e.excitation_work,
        "dissipated": e.dissipated,
    }
    for name, values in terms.items():
        upper.plot(1e3 * e.time, values, lw=1.0, label=name)
    upper.set_ylabel("energy since the start, J")
    upper.legend(fontsize=7)
    lower.plot(1e3 * e.time, e.numerical, lw=1.0, color="tab:red")
    lower.set_ylabel("energy error, J")
    lower.set_xlabel("time, ms")
    for axes in (upper, lower):
        axes.grid(alpha=0.3)


def draw_spectrogram(result: TransientResult, figure: Any) -> None:
    """Spectrogram of the first acceleration, or mesh force, over the speed."""
    from scipy.signal import spectrogram

    name = next((n for n in result.channel if n.endswith("acceleration")), f"force {result.contact[0]}")
    values = result.history(name)[result.counted]
    size = int(min(max(values.size // 60, 64), 4096))
    f, t, power = spectrogram(
        values - values.mean(),
        1.0 / result.spacing,
        nperseg=size,
        noverlap=size // 2,
        window="hann",
        scaling="spectrum",
    )
    axes = figure.subplots()
    speeds = np.interp(result.settle + t, result.time, result.speed) * 30.0 / np.pi
    level = 10.0 * np.log10(np.maximum(2.0 * power, 1e-12 * power.max()))
    picture = axes.pcolormesh(speeds, f, level, vmin=level.max() - _SHOWN_DB, shading="auto", rasterized=True)
    figure.colorbar(picture, label="dB of the amplitude squared")
    seen = f[level.max(axis=1) > level.max() - _SHOWN_DB]
    axes.set_ylim(0.0, 1.1 * float(seen.max(initial=f[1])))
    axes.set_xlabel("speed of the input shaft, rpm")
    axes.set_ylabel("frequency, Hz")
    axes.set_title(name, fontsize=9)
