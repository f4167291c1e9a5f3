"""Draws a mesh over its cycle: stiffness and transmission error, load sharing, and where the flank carries how much."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.figure import axes_for, figure_for
from rotorgear.results.mesh import MeshResult

_BLUE = "#1f5fa8"
_ORANGE = "#b3541e"
_GREY = "#777777"
_LEVELS = 16


def mesh(result: MeshResult, fig: Any = None) -> np.ndarray:
    """Draw stiffness and transmission error over the mesh cycle, and for loaded teeth sharing and pressure on the flank.

    Args:
        result: a mesh over its cycle.
        fig: figure to draw on; a new one for None.

    Returns:
        The axes, row by row: (1, 2), or (2, 2) for loaded teeth; other loads have a row of their own below.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    rows = (2 if result.helix else 1) + (1 if result.loads else 0)
    load = "" if result.load is None else f", {result.load.pinion_torque_n_m:.5g} N m on the pinion"
    figure = figure_for(fig, (11.0, 3.7 * rows), f"{result.mesh}: {result.stiffness_model}{load}")
    axes = figure.subplots(rows, 2, squeeze=False)
    stiffness = axes[0, 0]
    stiffness.plot(*_closed(result, 1e-6 * result.stiffness), color=_BLUE, lw=1.6, label=result.definition)
    if result.tangent is not None:
        stiffness.plot(*_closed(result, 1e-6 * result.tangent), color=_ORANGE, lw=1.2, label="tangent")
    stiffness.axhline(1e-6 * result.mean_stiffness, color=_GREY, lw=0.9, ls="--", label="mean")
    stiffness.legend(frameon=False, fontsize=8)
    stiffness.set_title(f"stiffness, {'all helices' if result.helices > 1 else 'one helix'}, transverse", fontsize=10)
    _plain_axis(stiffness, "stiffness, N/um")
    _error(axes[0, 1], result)
    if result.helix:
        helix = result.helix[0]
        sharing = axes[1, 0]
        for pair, share in helix.share.items():
            carries = share > 0.0
            carried = np.where(carries, 100.0 * share, np.nan)
            # A pair that carries at single positions only makes no line: a point without an entry in the legend.
            if np.any(carries[1:] & carries[:-1]):
                sharing.plot(result.position, carried, lw=1.6, label=f"pair {pair}")
            elif carries.any():
                sharing.plot(result.position, carried, ".", color=_GREY, ms=3)
        sharing.set_ylim(0.0, None)
        sharing.legend(frameon=False, fontsize=8, ncols=2)
        sharing.set_title(f"load sharing, contact ratio {helix.contact_ratio:.2f} under load", fontsize=10)
        _plain_axis(sharing, "share of the load, %")
        mesh_pressure(result, axes[1, 1])
    if result.loads:
        mesh_loads(result, axes[-1, 0])
        _errors_at_loads(axes[-1, 1], result)
    return np.asarray(axes)


def _closed(result: MeshResult, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The curve with its first point again at the end of the last period."""
    return _closed_at(result.position, values, result.periods)


def _closed_at(position: np.ndarray, values: np.ndarray, periods: int) -> tuple[np.ndarray, np.ndarray]:
    return np.append(position, position[0] + periods), np.append(values, values[0])


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
        shift = float(np.mean(result.transmission_error) - np.mean(result.no_load_error))
        label = f"without load, {1e6 * shift:+.3g} um"
        axis.plot(*_closed(result, 1e6 * (result.no_load_error + shift)), color=_GREY, lw=1.2, ls="--", label=label)
        axis.legend(frameon=False, fontsize=8)
    _plain_axis(axis, "transmission error, um")


def mesh_pressure(result: MeshResult, ax: Any = None, *, helix: int = 0) -> Any:
    """Draw the largest pressure that each place of the flank sees in the cycle, with start A, pitch line C and end E of contact.

    Args:
        result: a mesh with loaded teeth.
        ax: axes to draw on; those of a new figure for None.
        helix: number of the helix.

    Returns:
        The axes: pressure over roll length for teeth that are alike along the face, else filled over roll length and face.

    Raises:
        AnalysisError: a mesh without loaded teeth. MissingExtraError: matplotlib is not installed.
    """
    if helix >= len(result.helix):
        raise AnalysisError(
            "a picture of the contact pressure needs a mesh with loaded teeth: take stiffness='tooth_fe'"
        )
    contact = result.helix[helix]
    axis = axes_for(ax, (6.4, 4.4), "")
    axis.set_title(f"contact pressure on {result.pinion}, whole cycle", fontsize=10)
    axis.set_xlabel(f"roll length on {result.pinion}, mm")
    # Corners touch where the line of action passes too, at another position: they are shown beside it.
    on_line = ~contact.corner
    touching = contact.corner & (contact.force > 0.0)
    roll = 1e3 * contact.roll[:, 0]
    z = 1e3 * contact.z
    pressure = 1e-6 * contact.pressure
    if np.ptp(z) == 0.0:
        order = np.flatnonzero(on_line)[np.argsort(roll[on_line])]
        axis.fill_between(roll[order], pressure[order], color=_BLUE, alpha=0.25, lw=0.0)
        axis.plot(roll[order], pressure[order], color=_BLUE, lw=1.4, label="on the line of action")
        if touching.any():
            axis.plot(roll[touching], pressure[touching], ".", color=_ORANGE, ms=4, label="a tip corner touches")
            _legend_below(axis, 2)
        axis.set_ylabel("largest pressure, MPa")
        axis.grid(True, alpha=0.25)
        axis.set_ylim(0.0, None)
    else:
        from matplotlib.tri import Triangulation

        # Triangles between the places that contact lines pass; both directions to scale, or slender ones would smear.
        near = Triangulation(roll[on_line] / np.ptp(roll), z[on_line] / np.ptp(z)).triangles
        levels = np.linspace(0.0, max(float(pressure.max()), 1e-3), _LEVELS)
        filled = axis.tricontourf(
            Triangulation(roll[on_line], z[on_line], near), pressure[on_line], levels=levels, cmap="viridis"
        )
        if touching.any():
            axis.scatter(
                roll[touching],
                z[touching],
                c=pressure[touching],
                label="a tip corner touches",
                cmap="viridis",
                vmin=0.0,
                vmax=levels[-1],
                edgecolors="white",
                linewidths=0.3,
                s=14,
            )
            _legend_below(axis, 1)
        axis.set_ylabel("place along the face, mm")
        axis.figure.colorbar(filled, ax=axis, label="largest pressure, MPa", format="%.0f")
    for name, place in zip("ACE", contact.path_of_contact, strict=True):
        axis.axvline(
            1e3 * place, color="#c00000" if name == "C" else "#333333", lw=1.0, ls="-." if name == "C" else "--"
        )
        axis.annotate(
            name,
            (1e3 * place, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(2, -10),
            textcoords="offset points",
            fontsize=8,
        )
    return axis


def _legend_below(axis: Any, columns: int) -> None:
    """A legend beside the label below axes that curves or colours fill."""
    axis.set_xlabel(axis.get_xlabel(), loc="left")
    axis.legend(frameon=False, fontsize=8, ncols=columns, loc="upper right", bbox_to_anchor=(1.03, -0.07))


def mesh_loads(result: MeshResult, ax: Any = None) -> Any:
    """Draw peak to peak and first mesh orders of the transmission error over the torque.

    Args:
        result: a mesh with load factors.
        ax: axes to draw on; those of a new figure for None.

    Returns:
        The axes.

    Raises:
        AnalysisError: a mesh at one load only. MissingExtraError: matplotlib is not installed.
    """
    if not result.loads or result.load is None:
        raise AnalysisError("a picture over the torque needs other loads: ask for load_factors")
    axis = axes_for(ax, (6.4, 4.4), "")
    orders = result.ste_harmonics(3)
    own_orders = () if orders is None else tuple(np.abs(orders).tolist())
    points = [(point.factor, point.ste_peak_to_peak_m, point.ste_harmonics_m) for point in result.loads]
    points.append((1.0, result.ste_peak_to_peak or 0.0, own_orders))
    points = sorted({factor: (factor, size, orders) for factor, size, orders in points}.values())
    torque = abs(result.load.pinion_torque_n_m) * np.array([point[0] for point in points])
    axis.plot(torque, [1e6 * point[1] for point in points], "o-", ms=3.5, lw=1.6, color=_BLUE, label="peak to peak")
    for order in range(min(len(point[2]) for point in points)):
        values = [1e6 * point[2][order] for point in points]
        axis.plot(torque, values, ".--", lw=1.1, label=f"mesh order {order + 1}")
    axis.set_title("transmission error over the torque", fontsize=10)
    axis.set_xlabel(f"torque on {result.pinion}, N m")
    axis.set_ylabel("transmission error, um")
    axis.set_ylim(0.0, None)
    axis.grid(True, alpha=0.25)
    axis.legend(frameon=False, fontsize=8)
    return axis


def _errors_at_loads(axis: Any, result: MeshResult) -> None:
    """Transmission error over the cycle at each load, about the middle of its range."""
    axis.set_title("transmission error about its middle, by load factor", fontsize=10)
    for point in result.loads:
        if point.ste_m is not None and point.position is not None:
            middle = 0.5 * (point.ste_m.max() + point.ste_m.min())
            curve = _closed_at(point.position, 1e6 * (point.ste_m - middle), result.periods)
            axis.plot(*curve, lw=1.3, label=f"{point.factor:g}")
    axis.legend(frameon=False, fontsize=8, ncols=4)
    _plain_axis(axis, "transmission error, um")
