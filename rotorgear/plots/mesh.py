"""Draws a mesh over its cycle, over torque and misalignment, and the stress in its roots."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.figure import BLUE, GREY, ORANGE, axes_for, beside, figure_for, label, name_axes, values
from rotorgear.results.mesh import HelixContact, MeshResult
from rotorgear.results.mesh_map import MeshMap
from rotorgear.results.root_stress import GearRootStress, RootStress
from rotorgear.results.schema import Record

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
    _plot(stiffness, result, values(result, "stiffness", "N/um"), color=BLUE, lw=1.6, label=result.definition)
    if result.tangent is not None:
        _plot(stiffness, result, values(result, "tangent", "N/um"), color=ORANGE, lw=1.2, label="tangent")
    stiffness.axhline(values(result, "mean_stiffness", "N/um"), color=GREY, lw=0.9, ls="--", label="mean")
    helices = "all helices" if result.helices > 1 else "one helix"
    _name_cycle(stiffness, "stiffness", "N/um", title=f"stiffness, {helices}, transverse", legend=1)
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
        title = f"load sharing, contact ratio {helix.contact_ratio:.2f} under load"
        _name_cycle(sharing, "share", "%", of=HelixContact, title=title, legend=2)
        mesh_pressure(result, axes[1, 1])
    if result.loads:
        mesh_loads(result, axes[-1, 0])
        # Transmission error over the cycle at each load, about the middle of its range.
        axis = axes[-1, 1]
        for point in result.loads:
            if point.ste_m is not None and point.position is not None:
                error = values(point, "ste_m", "um")
                middle = 0.5 * (error.max() + error.min())
                _plot(axis, result, error - middle, point.position, lw=1.3, label=f"{point.factor:g}")
        title = "transmission error about its middle, by load factor"
        _name_cycle(axis, "transmission_error", "um", title=title, legend=4)
    return np.asarray(axes)


def _plot(axis: Any, result: MeshResult, curve: np.ndarray, position: np.ndarray | None = None, **look: Any) -> None:
    """Draw a curve over the mesh cycle, with its first point again at the end of the last period."""
    at = result.position if position is None else position
    axis.plot(np.append(at, at[0] + result.periods), np.append(curve, curve[0]), **look)


def _name_cycle(axis: Any, field: str, shown: str, of: type[Record] = MeshResult, **names: Any) -> None:
    name_axes(axis, label(MeshResult, "position"), label(of, field, shown), grid=True, **names)
    axis.ticklabel_format(axis="y", useOffset=False)


def _error(axis: Any, result: MeshResult) -> None:
    axis.set_title("transmission error along the line of action", fontsize=10)
    if result.transmission_error is None or result.no_load_error is None:
        axis.text(0.5, 0.5, "no load", ha="center", transform=axis.transAxes)
        return
    loaded = values(result, "transmission_error", "um")
    _plot(axis, result, loaded, color=BLUE, lw=1.6, label="under load")
    without = values(result, "no_load_error", "um")
    varies = bool(np.ptp(without) > 0.0)
    if varies:
        # Both curves about one mean: what is compared is how much they vary.
        shift = float(np.mean(loaded) - np.mean(without))
        _plot(axis, result, without + shift, color=GREY, lw=1.2, ls="--", label=f"without load, {shift:+.3g} um")
    _name_cycle(axis, "transmission_error", "um", legend=int(varies))


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
    roll = values(contact, "roll", "mm")[:, 0]
    z = values(contact, "z", "mm")
    pressure = values(contact, "pressure", "MPa")
    pressures = label(contact, "pressure", "MPa")
    corners = "a tip corner touches"
    if np.ptp(z) == 0.0:
        order = np.flatnonzero(on_line)[np.argsort(roll[on_line])]
        axis.fill_between(roll[order], pressure[order], color=BLUE, alpha=0.25, lw=0.0)
        axis.plot(roll[order], pressure[order], color=BLUE, lw=1.4, label="on the line of action")
        if touching.any():
            axis.plot(roll[touching], pressure[touching], ".", color=ORANGE, ms=4, label=corners)
            _legend_below(axis, 2)
        name_axes(axis, "", pressures, grid=True)
        axis.set_ylim(0.0, None)
    else:
        from matplotlib.tri import Triangulation

        # Triangles between the places that contact lines pass; both directions to scale, or slender ones would smear.
        near = Triangulation(roll[on_line] / np.ptp(roll), z[on_line] / np.ptp(z)).triangles
        levels = np.linspace(0.0, max(float(pressure.max()), 1e-3), _LEVELS["pressure"])
        flank = Triangulation(roll[on_line], z[on_line], near)
        filled = axis.tricontourf(flank, pressure[on_line], levels=levels, cmap="viridis")
        if touching.any():
            look = {
                "cmap": "viridis",
                "vmin": 0.0,
                "vmax": levels[-1],
                "edgecolors": "white",
                "linewidths": 0.3,
                "s": 14,
            }
            axis.scatter(roll[touching], z[touching], c=pressure[touching], label=corners, **look)
            _legend_below(axis, 1)
        axis.set_ylabel(label(contact, "z", "mm"))
        axis.figure.colorbar(filled, ax=axis, label=pressures, format="%.0f")
    for name, place in zip("ACE", values(contact, "path_of_contact", "mm"), strict=True):
        axis.axvline(place, color="#c00000" if name == "C" else "#333333", lw=1.0, ls="-." if name == "C" else "--")
        beside(axis, name, (place, 1.0), (2, -10), xycoords=("data", "axes fraction"), fontsize=8)
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
        amplitudes = [1e6 * point[2][order] for point in points]
        axis.plot(torque, amplitudes, ".--", lw=1.1, label=f"mesh order {order + 1}")
    axis.set_ylim(0.0, None)
    title = "transmission error over the torque"
    error = label(result, "transmission_error", "um")
    name_axes(axis, f"torque on {result.pinion}, N m", error, title=title, legend=1, grid=True)
    return axis


# What is drawn by name: its field, and the unit that is shown.
QUANTITIES = {
    "ste": ("ste_peak_to_peak", "um"),
    "order_1": ("ste_harmonics", "um"),
    "order_2": ("ste_harmonics", "um"),
    "order_3": ("ste_harmonics", "um"),
    "pressure": ("largest_pressure", "MPa"),
    "face_load_factor": ("face_load_factor", ""),
}


# Those of a map, row by row.
_MAPS = ("ste", "order_1", "order_2", "pressure", "face_load_factor", "order_3")


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
    for axis, quantity in zip(axes.flat, _MAPS, strict=True):
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
    field, unit = QUANTITIES[quantity]
    shown = values(result, field, unit)
    name = label(result, field, unit)
    if field == "ste_harmonics":
        order = int(quantity[-1])
        shown = shown[:, :, order - 1]
        name = f"transmission error, mesh order {order}, {unit}"
    axis = axes_for(ax, (6.4, 4.4), "")
    torque = result.pinion_torque
    misalignment = values(result, "misalignment", "um")
    along = (label(result, "pinion_torque"), label(result, "misalignment", "um"))
    # A constant up to rounding has no contours.
    if min(shown.shape) > 1:
        name_axes(axis, *along, title=name)
        if np.ptp(shown) > 1e-9 * np.abs(shown).max():
            levels = _LEVELS["map"]
            filled = axis.contourf(torque, misalignment, shown.T, levels=levels, cmap="viridis")
            axis.contour(torque, misalignment, shown.T, levels=levels, colors="white", linewidths=0.4, alpha=0.6)
            axis.figure.colorbar(filled, ax=axis)
        else:
            axis.text(0.5, 0.5, f"{shown.flat[0]:.4g} everywhere", ha="center", transform=axis.transAxes)
        return axis
    x, name_of_x = (torque, along[0]) if len(torque) > 1 or len(misalignment) == 1 else (misalignment, along[1])
    axis.plot(x, shown.ravel(), "o-", ms=3.5, lw=1.5, color=BLUE)
    name_axes(axis, name_of_x, name, grid=True)
    axis.set_ylim(0.0, None)
    return axis


def root_stress(result: RootStress, ax: Any = None) -> Any:
    """Draw the largest principal stress at the root section, and the largest of the fillet.

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
        for field, style in (("largest", {"lw": 1.6}), ("at_tangent", {"lw": 1.2, "ls": "--"})):
            name = f"{gear.name}, {gear.declarations[field].label}"
            axis.plot(gear.phase, values(gear, field, "MPa"), color=colour, label=name, **style)
        if gear.nominal is not None:
            nominal = f"{gear.name}, nominal by ISO 6336-3"
            axis.axhline(values(gear, "nominal", "MPa"), color=colour, lw=0.8, ls=":", label=nominal)
    axis.axvline(0.0, color=GREY, lw=0.8)
    name_axes(axis, label(GearRootStress, "phase"), "largest principal stress, MPa", legend=1, grid=True)
    return axis
