"""Draws a mesh over its cycle: stiffness and transmission error, load sharing, and where the flank carries how much."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import figure_for
from rotorgear.results.mesh import HelixContact, MeshResult

_BLUE = "#1f5fa8"
_ORANGE = "#b3541e"
_GREY = "#777777"


def mesh(result: MeshResult, fig: Any = None) -> np.ndarray:
    """Draw stiffness and transmission error over the mesh cycle, and for loaded teeth sharing and pressure on the flank.

    Args:
        result: a mesh over its cycle.
        fig: figure to draw on; a new one for None.

    Returns:
        The axes, row by row: (1, 2), or (2, 2) for loaded teeth.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    rows = 2 if result.helix else 1
    load = "" if result.load is None else f", {result.load.pinion_torque_n_m:.5g} N m on the pinion"
    figure = figure_for(fig, (11.0, 3.7 * rows), f"{result.mesh}: {result.stiffness_model}{load}")
    axes = figure.subplots(rows, 2, squeeze=False)
    stiffness = axes[0, 0]
    stiffness.plot(*_closed(result, 1e-9 * result.stiffness), color=_BLUE, lw=1.6, label=result.definition)
    if result.tangent is not None:
        stiffness.plot(*_closed(result, 1e-9 * result.tangent), color=_ORANGE, lw=1.2, label="tangent")
    stiffness.axhline(1e-9 * result.mean_stiffness, color=_GREY, lw=0.9, ls="--", label="mean")
    stiffness.legend(frameon=False, fontsize=8)
    stiffness.set_title(f"stiffness, {'all helices' if result.helices > 1 else 'one helix'}, transverse", fontsize=10)
    _plain_axis(stiffness, "stiffness, N/nm")
    _error(axes[0, 1], result)
    if result.helix:
        helix = result.helix[0]
        sharing = axes[1, 0]
        for pair, share in helix.share.items():
            if np.any(share > 0.0):
                carried = np.where(share > 0.0, 100.0 * share, np.nan)
                sharing.plot(result.position, carried, lw=1.6, label=f"pair {pair}")
        sharing.set_ylim(0.0, None)
        sharing.legend(frameon=False, fontsize=8, ncols=2)
        sharing.set_title(f"load sharing, contact ratio {helix.contact_ratio:.2f} under load", fontsize=10)
        _plain_axis(sharing, "share of the load, %")
        _pressure(axes[1, 1], result, helix)
    return np.asarray(axes)


def _closed(result: MeshResult, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The curve with its first point again at the end of the last period."""
    step = result.position[1] - result.position[0]
    return np.append(result.position, result.position[-1] + step), np.append(values, values[0])


def _plain_axis(axis: Any, label: str) -> None:
    axis.set_xlabel("mesh periods")
    axis.set_ylabel(label)
    axis.grid(True, alpha=0.25)
    axis.ticklabel_format(axis="y", useOffset=False)


def _error(axis: Any, result: MeshResult) -> None:
    axis.set_title("transmission error along the line of action", fontsize=10)
    if result.transmission_error is None or result.no_load_error is None:
        axis.text(0.5, 0.5, "no load", ha="center", transform=axis.transAxes)
        return
    axis.plot(*_closed(result, 1e6 * result.transmission_error), color=_BLUE, lw=1.6, label="under load")
    if np.ptp(result.no_load_error) > 0.0:
        # Both curves about one mean: what is compared is how much they vary.
        shift = float(result.transmission_error.mean() - result.no_load_error.mean())
        label = f"without load, {1e6 * shift:+.3g} um"
        axis.plot(*_closed(result, 1e6 * (result.no_load_error + shift)), color=_GREY, lw=1.2, ls="--", label=label)
        axis.legend(frameon=False, fontsize=8)
    _plain_axis(axis, "transmission error, um")


def _pressure(axis: Any, result: MeshResult, helix: HelixContact) -> None:
    """Largest pressure over the flank: at a helical mesh over face and roll length, at a spur mesh over roll length."""
    carrying = helix.force > 0.0
    roll = 1e3 * helix.roll[carrying, 0]
    pressure = 1e-6 * helix.pressure[carrying]
    axis.set_title(f"contact pressure on {result.pinion}, whole cycle", fontsize=10)
    axis.set_xlabel(f"roll length on {result.pinion}, mm")
    if np.ptp(helix.z) == 0.0:
        order = np.argsort(roll)
        axis.plot(roll[order], pressure[order], ".", color=_BLUE, ms=5)
        axis.set_ylabel("largest pressure, MPa")
        axis.grid(True, alpha=0.25)
        axis.set_ylim(0.0, None)
        return
    points = axis.scatter(roll, 1e3 * helix.z[carrying], c=pressure, s=9, cmap="viridis", linewidths=0.0)
    axis.set_ylabel("place along the face, mm")
    axis.figure.colorbar(points, ax=axis, label="largest pressure, MPa")
