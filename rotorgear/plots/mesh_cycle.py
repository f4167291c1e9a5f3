"""Draws a mesh over its cycle: stiffness and transmission error, load sharing, and where the flank carries how much."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.export.files import replacing
from rotorgear.results.mesh import HelixContact, MeshResult

_BLUE, _ORANGE, _GREY = "#1f5fa8", "#b3541e", "#777777"


def draw_mesh_cycle(found: MeshResult, path: str | Path) -> Path:
    """Write the curves, and for loaded teeth sharing and pressure on the flank, as PNG or SVG and return the path.

    Raises:
        AnalysisError: another ending.
        MissingExtraError: matplotlib is not installed.
        WriteError: the file can't be written.
    """
    target = Path(path)
    if target.suffix.lower() not in (".png", ".svg"):
        raise AnalysisError(f"A picture ends with .png or .svg, not '{target.suffix}'.")
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtraError("A plot", "matplotlib", "plots") from None
    rows = 2 if found.helix else 1
    figure = Figure(figsize=(11.0, 3.7 * rows), layout="constrained")
    axes = np.atleast_2d(figure.subplots(rows, 2))
    _stiffness(axes[0, 0], found)
    _error(axes[0, 1], found)
    if found.helix:
        _sharing(axes[1, 0], found, found.helix[0])
        _pressure(figure, axes[1, 1], found, found.helix[0])
    load = "" if found.load is None else f", {found.load.pinion_torque_n_m:.5g} N m on the pinion"
    figure.suptitle(f"{found.mesh}: {found.stiffness_model}{load}", fontsize=11)
    with replacing(target) as scratch:
        plain = target.suffix.lower() == ".svg"
        figure.savefig(scratch, dpi=130, format=target.suffix[1:].lower(), metadata={"Date": None} if plain else None)
    return target


def _closed(found: MeshResult, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The curve with its first point again at the end of the last period."""
    step = found.position[1] - found.position[0]
    return np.append(found.position, found.position[-1] + step), np.append(values, values[0])


def _plain_axis(axis: Any, label: str) -> None:
    axis.set_xlabel("mesh periods")
    axis.set_ylabel(label)
    axis.grid(True, alpha=0.25)
    axis.ticklabel_format(axis="y", useOffset=False)


def _stiffness(axis: Any, found: MeshResult) -> None:
    axis.plot(*_closed(found, 1e-9 * found.stiffness), color=_BLUE, lw=1.6, label=found.definition)
    if found.tangent is not None:
        axis.plot(*_closed(found, 1e-9 * found.tangent), color=_ORANGE, lw=1.2, label="tangent")
    axis.axhline(1e-9 * found.mean_stiffness, color=_GREY, lw=0.9, ls="--", label="mean")
    axis.legend(frameon=False, fontsize=8)
    axis.set_title(f"stiffness, {'all helices' if found.helices > 1 else 'one helix'}, transverse", fontsize=10)
    _plain_axis(axis, "N/nm")


def _error(axis: Any, found: MeshResult) -> None:
    axis.set_title("transmission error along the line of action", fontsize=10)
    if found.transmission_error is None or found.no_load_error is None:
        axis.text(0.5, 0.5, "no load", ha="center", transform=axis.transAxes)
        return
    axis.plot(*_closed(found, 1e6 * found.transmission_error), color=_BLUE, lw=1.6, label="under load")
    if np.ptp(found.no_load_error) > 0.0:
        shift = float(found.transmission_error.mean() - found.no_load_error.mean())
        label = f"without load, {1e6 * shift:+.3g} um"
        axis.plot(*_closed(found, 1e6 * (found.no_load_error + shift)), color=_GREY, lw=1.2, ls="--", label=label)
        axis.legend(frameon=False, fontsize=8)
    _plain_axis(axis, "um")


def _sharing(axis: Any, found: MeshResult, helix: HelixContact) -> None:
    for pair, share in helix.share.items():
        if not np.any(share > 0.0):
            continue
        own = np.where(share > 0.0, 100.0 * share, np.nan)
        axis.plot(found.position, own, lw=1.6, label=f"pair {pair}")
    axis.set_ylim(0.0, None)
    axis.legend(frameon=False, fontsize=8, ncols=2)
    axis.set_title(f"load sharing, contact ratio {helix.contact_ratio:.2f} under load", fontsize=10)
    _plain_axis(axis, "share of the load, %")


def _pressure(figure: Any, axis: Any, found: MeshResult, helix: HelixContact) -> None:
    """Largest pressure over the flank: at a helical mesh over face and roll length, at a spur mesh over roll length."""
    carrying = helix.force > 0.0
    roll = 1e3 * helix.roll[carrying, 0]
    pressure = 1e-6 * helix.pressure[carrying]
    axis.set_title(f"contact pressure on {found.pinion}, whole cycle", fontsize=10)
    axis.set_xlabel(f"roll length on {found.pinion}, mm")
    if np.ptp(helix.z) == 0.0:
        order = np.argsort(roll)
        axis.plot(roll[order], pressure[order], ".", color=_BLUE, ms=5)
        axis.set_ylabel("largest pressure, MPa")
        axis.grid(True, alpha=0.25)
        axis.set_ylim(0.0, None)
        return
    points = axis.scatter(roll, 1e3 * helix.z[carrying], c=pressure, s=9, cmap="viridis", linewidths=0.0)
    axis.set_ylabel("place along the face, mm")
    figure.colorbar(points, ax=axis, label="largest pressure, MPa")
