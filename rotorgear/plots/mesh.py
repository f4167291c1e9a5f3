"""Draws a mesh over its cycle, over torque and misalignment, and the stress in its roots."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.figure import BLUE, GREY, ORANGE, axes_for, figure_for, name_axes
from rotorgear.results.mesh import MeshResult
from rotorgear.results.mesh_map import MeshMap
from rotorgear.results.root_stress import RootStress

_LEVELS = {"pressure": 16, "map": 14}


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
    stiffness.plot(
        *_closed(result.position, 1e-6 * result.stiffness, result.periods), color=BLUE, lw=1.6, label=result.definition
    )
    if result.tangent is not None:
        stiffness.plot(
            *_closed(result.position, 1e-6 * result.tangent, result.periods), color=ORANGE, lw=1.2, label="tangent"
        )
    stiffness.axhline(1e-6 * result.mean_stiffness, color=GREY, lw=0.9, ls="--", label="mean")
    name_axes(
        stiffness, title=f"stiffness, {'all helices' if result.helices > 1 else 'one helix'}, transverse", legend=1
    )
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
                sharing.plot(result.position, carried, ".", color=GREY, ms=3)
        sharing.set_ylim(0.0, None)
        name_axes(sharing, title=f"load sharing, contact ratio {helix.contact_ratio:.2f} under load", legend=2)
        _plain_axis(sharing, "share of the load, %")
        mesh_pressure(result, axes[1, 1])
    if result.loads:
        mesh_loads(result, axes[-1, 0])
        # Transmission error over the cycle at each load, about the middle of its range.
        axis = axes[-1, 1]
        axis.set_title("transmission error about its middle, by load factor", fontsize=10)
        for point in result.loads:
            if point.ste_m is not None and point.position is not None:
                middle = 0.5 * (point.ste_m.max() + point.ste_m.min())
                curve = _closed(point.position, 1e6 * (point.ste_m - middle), result.periods)
                axis.plot(*curve, lw=1.3, label=f"{point.factor:g}")
        axis.legend(frameon=False, fontsize=8, ncols=4)
        _plain_axis(axis, "transmission error, um")
    return np.asarray(axes)


def _closed(position: np.ndarray, values: np.ndarray, periods: int) -> tuple[np.ndarray, np.ndarray]:
    """The curve with its first point again at the end of the last period."""
    return np.append(position, position[0] + periods), np.append(values, values[0])


def _plain_axis(axis: Any, label: str) -> None:
    name_axes(axis, "mesh periods", label, grid=True)
    axis.ticklabel_format(axis="y", useOffset=False)


def _error(axis: Any, result: MeshResult) -> None:
    axis.set_title("transmission error along the line of action", fontsize=10)
    if result.transmission_error is None or result.no_load_error is None:
        axis.text(0.5, 0.5, "no load", ha="center", transform=axis.transAxes)
        return
    axis.plot(
        *_closed(result.position, 1e6 * result.transmission_error, result.periods),
        color=BLUE,
        lw=1.6,
        label="under load",
    )
    if np.ptp(result.no_load_error) > 0.0:
        # Both curves about one mean: what is compared is how much they vary.
        shift = float(np.mean(result.transmission_error) - np.mean(result.no_load_error))
        label = f"without load, {1e6 * shift:+.3g} um"
        axis.plot(
            *_closed(result.position, 1e6 * (result.no_load_error + shift), result.periods),
            color=GREY,
            lw=1.2,
            ls="--",
            label=label,
        )
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
    name_axes(axis, f"roll length on {result.pinion}, mm", title=f"contact pressure on {result.pinion}, whole cycle")
    # Corners touch where the line of action passes too, at another position: they are shown beside it.
    on_line = ~contact.corner
    touching = contact.corner & (contact.force > 0.0)
    roll = 1e3 * contact.roll[:, 0]
    z = 1e3 * contact.z
    pressure = 1e-6 * contact.pressure
    if np.ptp(z) == 0.0:
        order = np.flatnonzero(on_line)[np.argsort(roll[on_line])]
        axis.fill_between(roll[order], pressure[order], color=BLUE, alpha=0.25, lw=0.0)
        axis.plot(roll[order], pressure[order], color=BLUE, lw=1.4, label="on the line of action")
        if touching.any():
            axis.plot(roll[touching], pressure[touching], ".", color=ORANGE, ms=4, label="a tip corner touches")
            _legend_below(axis, 2)
        name_axes(axis, "", "largest pressure, MPa", grid=True)
        axis.set_ylim(0.0, None)
    else:
        from matplotlib.tri import Triangulation

        # Triangles between the places that contact lines pass; both directions to scale, or slender ones would smear.
        near = Triangulation(roll[on_line] / np.ptp(roll), z[on_line] / np.ptp(z)).triangles
        levels = np.linspace(0.0, max(float(pressure.max()), 1e-3), _LEVELS["pressure"])
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
    axis.plot(torque, [1e6 * point[1] for point in points], "o-", ms=3.5, lw=1.6, color=BLUE, label="peak to peak")
    for order in range(min(len(point[2]) for point in points)):
        values = [1e6 * point[2][order] for point in points]
        axis.plot(torque, values, ".--", lw=1.1, label=f"mesh order {order + 1}")
    name_axes(
        axis, f"torque on {result.pinion}, N m", "transmission error, um", title="transmission error over the torque"
    )
    axis.set_ylim(0.0, None)
    name_axes(axis, legend=1, grid=True)
    return axis


# What is drawn by name: its field, the factor to its unit, and its label.
QUANTITIES = {
    "ste": ("ste_peak_to_peak", 1e6, "transmission error, peak to peak, um"),
    "order_1": ("ste_harmonics", 1e6, "transmission error, mesh order 1, um"),
    "order_2": ("ste_harmonics", 1e6, "transmission error, mesh order 2, um"),
    "order_3": ("ste_harmonics", 1e6, "transmission error, mesh order 3, um"),
    "pressure": ("largest_pressure", 1e-6, "largest contact pressure, MPa"),
    "face_load_factor": ("face_load_factor", 1.0, "face load factor K_Hbeta"),
}


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
            filled = axis.contourf(torque, misalignment, values.T, levels=_LEVELS["map"], cmap="viridis")
            axis.contour(
                torque, misalignment, values.T, levels=_LEVELS["map"], colors="white", linewidths=0.4, alpha=0.6
            )
            axis.figure.colorbar(filled, ax=axis)
        else:
            axis.text(0.5, 0.5, f"{values.flat[0]:.4g} everywhere", ha="center", transform=axis.transAxes)
        name_axes(axis, "torque on the pinion, N m", "misalignment over the face, um")
        return axis
    over_torque = len(torque) > 1 or len(misalignment) == 1
    x = torque if over_torque else misalignment
    axis.plot(x, values.ravel(), "o-", ms=3.5, lw=1.5, color=BLUE)
    name_axes(axis, "torque on the pinion, N m" if over_torque else "misalignment over the face, um", label)
    axis.set_ylim(0.0, None)
    axis.grid(True, alpha=0.25)
    return axis


def root_stress(result: RootStress, ax: Any = None) -> Any:
    """Draw the largest principal stress at the 30 degree tangent, and the largest of the fillet.

    Args:
        result: root stresses over the mesh cycle.
        ax: axes to draw on; those of a new figure for None.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    axis = axes_for(ax, (8.0, 4.6), f"{result.mesh}: {result.pinion_torque_n_m:.5g} N m on the pinion")
    for gear, colour in zip(result.gears, (BLUE, ORANGE), strict=True):
        axis.plot(gear.phase, 1e-6 * gear.largest, color=colour, lw=1.6, label=f"{gear.name}, largest of the fillet")
        axis.plot(
            gear.phase, 1e-6 * gear.at_tangent, color=colour, lw=1.2, ls="--", label=f"{gear.name}, 30 deg tangent"
        )
        if gear.nominal is not None:
            axis.axhline(1e-6 * gear.nominal, color=colour, lw=0.8, ls=":", label=f"{gear.name}, nominal by ISO 6336-3")
    axis.axvline(0.0, color=GREY, lw=0.8)
    name_axes(
        axis, "mesh periods from contact at the pitch point", "largest principal stress, MPa", legend=1, grid=True
    )
    return axis
