"""Draws a mesh over torque and misalignment: as filled contours, or as curves where one of them has a single value."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.figure import axes_for, figure_for
from rotorgear.results.mesh_map import MeshMap

# What is drawn by name: its field, the factor to its unit, and its label.
QUANTITIES = {
    "ste": ("ste_peak_to_peak", 1e6, "transmission error, peak to peak, um"),
    "order_1": ("ste_harmonics", 1e6, "transmission error, mesh order 1, um"),
    "order_2": ("ste_harmonics", 1e6, "transmission error, mesh order 2, um"),
    "order_3": ("ste_harmonics", 1e6, "transmission error, mesh order 3, um"),
    "pressure": ("largest_pressure", 1e-6, "largest contact pressure, MPa"),
    "face_load_factor": ("face_load_factor", 1.0, "face load factor K_Hbeta"),
}
_LEVELS = 14


def mesh_map(result: MeshMap, fig: Any = None) -> np.ndarray:
    """Draw transmission error, its first three orders, pressure and face load factor.

    Args:
        result: a mesh over torque and misalignment.
        fig: figure to draw on; a new one for None.

    Returns:
        The axes (2, 3).

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    figure = figure_for(fig, (13.0, 7.2), f"{result.mesh}: {result.pinion} and {result.gear}")
    axes = np.asarray(figure.subplots(2, 3, squeeze=False))
    for axis, quantity in zip(
        axes.flat, ("ste", "order_1", "order_2", "pressure", "face_load_factor", "order_3"), strict=True
    ):
        mesh_quantity(result, axis, quantity=quantity)
    return axes


def mesh_quantity(result: MeshMap, ax: Any = None, *, quantity: str = "ste") -> Any:
    """Draw one quantity over torque and misalignment.

    Args:
        result: a mesh over torque and misalignment.
        ax: axes to draw on; those of a new figure for None.
        quantity: "ste" (peak to peak), "order_1" to "order_3", "pressure" or "face_load_factor".

    Returns:
        The axes.

    Raises:
        AnalysisError: no such quantity. MissingExtraError: matplotlib is not installed.
    """
    if quantity not in QUANTITIES:
        raise AnalysisError(f"a mesh map has no '{quantity}': there are {', '.join(QUANTITIES)}")
    field, factor, label = QUANTITIES[quantity]
    values = factor * getattr(result, field)
    if field == "ste_harmonics":
        values = values[:, :, int(quantity[-1]) - 1]
    axis = axes_for(ax, (6.4, 4.4), "")
    torque = result.pinion_torque
    misalignment = 1e6 * result.misalignment
    # A constant up to rounding has no contours.
    if min(values.shape) > 1:
        axis.set_title(label, fontsize=10)
        if np.ptp(values) > 1e-9 * np.abs(values).max():
            filled = axis.contourf(torque, misalignment, values.T, levels=_LEVELS, cmap="viridis")
            axis.contour(torque, misalignment, values.T, levels=_LEVELS, colors="white", linewidths=0.4, alpha=0.6)
            axis.figure.colorbar(filled, ax=axis)
        else:
            axis.text(0.5, 0.5, f"{values.flat[0]:.4g} everywhere", ha="center", transform=axis.transAxes)
        axis.set_xlabel("torque on the pinion, N m")
        axis.set_ylabel("misalignment over the face, um")
        return axis
    over_torque = len(torque) > 1 or len(misalignment) == 1
    x = torque if over_torque else misalignment
    axis.plot(x, values.ravel(), "o-", ms=3.5, lw=1.5, color="#1f5fa8")
    axis.set_xlabel("torque on the pinion, N m" if over_torque else "misalignment over the face, um")
    axis.set_ylabel(label)
    axis.set_ylim(0.0, None)
    axis.grid(True, alpha=0.25)
    return axis
