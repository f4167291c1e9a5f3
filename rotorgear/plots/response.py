"""Draws a run-up: amplitudes over speed, whole and by order, and a waterfall, the spectrum of one quantity at every speed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.figure import COLOURS, GREY, axes_for, beside, figure_for, label, name_axes, plain_axis, values
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.response import ResponseResult

_MOST_LINES = len(COLOURS)
_WIDTH = 5.6
_HEIGHT = 2.9
# Directions of a point that are rotations.
_TURNING = ("tilt_x", "tilt_y", "torsion")
# Loads that a point reads about an axis.
_MOMENTS = ("torque", "bending")
_HEADROOM = 0.45  # for the legend, as a share of the height of the curves


def response(result: ResponseResult, fig: Any = None) -> np.ndarray:
    """Draw amplitudes over speed: mesh forces, transmission errors, bearing forces, accelerations and internal loads.

    Left: each mesh, bearing or point with all its orders together (root of the sum of squares, of bearings over x, y and z,
    too); right: the strongest of them by order. The eight strongest lines are drawn. The dashed line is the operating speed.

    Args:
        result: a run-up.
        fig: figure to draw on; a new one for None.

    Returns:
        The axes, row by row, (rows, 2).

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    rows = [row for row in _quantities(result) if row[2].size and row[2].any()]
    title = f"{result.model.title or 'Forced response'}: amplitudes over speed"
    figure = figure_for(fig, (2.0 * _WIDTH, _HEIGHT * max(len(rows), 1) + 0.4), title)
    axes = np.atleast_2d(figure.subplots(max(len(rows), 1), 2, sharex=True))
    for (left, right), (quantity, names, size) in zip(axes, rows, strict=False):
        total = np.sqrt((size**2).sum(axis=0))  # (s, lines)
        quantity, _, squares = quantity.partition("; ")
        _lines(left, result, names, total.T, f"{quantity}: root of the sum of squares of {squares}all orders")
        strongest = int(np.argmax(total.max(axis=0)))
        unit = quantity.rpartition(", ")[2]
        _lines(right, result, list(result.orders), size[:, :, strongest], f"{names[strongest]} by order, {unit}")
    for axis in axes[-1]:
        axis.set_xlabel(label(result, "speeds"))
    return axes


def _quantities(result: ResponseResult) -> Iterator[tuple[str, list[str], np.ndarray]]:
    """Yield what is drawn with its unit, names of the lines, amplitudes (o, s, lines)."""
    meshes = list(dict.fromkeys(result.contact_mesh))
    for field, unit in (("mesh_force", "N"), ("transmission_error", "um")) if meshes else ():
        sizes = np.abs(values(result, field, unit))
        of_meshes = [sizes[:, :, result.contacts_of(mesh)].max(axis=2) for mesh in meshes]
        yield label(result, field, unit), meshes, np.stack(of_meshes, axis=2)
    force = f"{label(result, 'bearing_force')}; x, y, z and "
    yield force, list(result.bearings), np.linalg.norm(np.abs(result.bearing_force), axis=3)
    turns = np.array([result.model.points[name].direction in _TURNING for name in result.points], bool)
    for chosen, unit in ((~turns, "m/s$^2$"), (turns, "rad/s$^2$")):
        names = [name for name, drawn in zip(result.points, chosen, strict=True) if drawn]
        yield label(result, "acceleration", unit), names, np.abs(result.acceleration[:, :, chosen])
    moments = np.array([result.model.points[name].quantity in _MOMENTS for name in result.load_points], bool)
    for chosen, unit in ((~moments, "N"), (moments, "N m")):
        names = [name for name, drawn in zip(result.load_points, chosen, strict=True) if drawn]
        if names:
            yield label(result, "internal_load", unit), names, np.abs(result.internal_load[:, :, chosen])
    if result.casings:  # the power of orders adds up, as the squares of amplitudes do
        yield "root of the equivalent radiated power, W$^{1/2}$", list(result.casings), np.sqrt(result.radiated_power)
    if not meshes and not result.bearings:
        orbit = 1e6 * np.abs(result.displacement[:, :, :, :2]).max(axis=3)
        yield "displacement, um", list(result.places), orbit


def _lines(axis: Any, result: ResponseResult, names: list[str], sizes: np.ndarray, title: str) -> None:
    """Draw the strongest lines (lines, s) on a logarithmic scale of four decades at most."""
    ranked = [int(k) for k in np.argsort(-sizes.max(axis=1), kind="stable") if sizes[k].any()]
    marker = "o" if len(result.speeds) == 1 else ""
    for k, colour in zip(sorted(ranked[:_MOST_LINES]), COLOURS, strict=False):
        axis.semilogy(result.speed_rpm, sizes[k], color=colour, lw=1.3, marker=marker, label=names[k])
    more = len(ranked) - _MOST_LINES
    top = float(sizes.max(initial=0.0))
    if top > 0.0:
        low = max(1e-4 * top, 0.5 * float(sizes[sizes > 0.0].min()))
        axis.set_ylim(low, top * (top / low) ** _HEADROOM)
    operating = result.model.operating_speed
    first, last = sorted((float(result.speeds[0]), float(result.speeds[-1])))
    if operating and first <= operating <= last:
        axis.axvline(operating * RPM_PER_RAD_S, color=GREY, lw=0.9, ls="--")
    axis.set_title(title + (f" ({more} weaker left out)" if more > 0 else ""), fontsize=9.5)
    axis.legend(frameon=False, fontsize=7, ncols=2 if len(ranked) > 2 else 1, loc="upper left")
    plain_axis(axis)


_SPECTRA = 45
# The largest line is so many steps between two spectra high; a line is a peak of this share of the width.
_STEPS_HIGH = 7.0
_PEAK_WIDTH = 0.0035
# Heights are logarithmic over so many decades below the highest peak: orders that stay below are left out.
_DECADES = 3.0
_SHOWN = 10.0**-_DECADES
# Labels stand so far apart.
_LABELS_APART = 0.03


def waterfall(result: ResponseResult, ax: Any = None, *, at: str | None = None) -> Any:
    """Draw the spectra of one quantity over speed, one above the other.

    Heights are logarithmic over three decades: weak orders are seen beside the strongest.

    Args:
        result: a run-up.
        ax: axes to draw on; those of a new figure for None.
        at: name of a mesh (its most loaded helix), a bearing (all three forces) or a point; None: mesh of the largest force,
            else the first bearing.

    Returns:
        The axes.

    Raises:
        AnalysisError: no such mesh, bearing or point, or a single speed. MissingExtraError: matplotlib is not installed.
    """
    if len(result.speeds) < 2:
        raise AnalysisError("a waterfall needs more than one speed")
    title, unit, size = waterfall_of(result, at)
    rpm = np.abs(result.speed_rpm)
    # The highest peak of all speeds is drawn, wherever it lies between the spectra.
    highest = int(np.argmax(size.max(axis=0)))
    evenly = np.arange(len(result.speeds) - 1, -1, -(len(result.speeds) // _SPECTRA + 1))
    chosen = np.union1d(evenly, [highest])
    top = float(size.max()) or 1.0
    step = float(rpm[chosen[-1]] - rpm[chosen[0]]) / len(chosen)
    shown = [o for o in range(len(result.orders)) if size[o].max() >= _SHOWN * top]
    widest = 1.03 * float(result.frequency_hz[shown].max())
    weak = len(result.orders) - len(shown)
    left_out = f", {weak} weaker order{'s'[: weak != 1]} left out" if weak else ""
    at_rpm = f"at {rpm[highest]:.0f} rpm"
    peak = f"{title}: highest peak {top:.4g} {unit} {at_rpm}, logarithmic over {_DECADES:g} decades{left_out}"
    axis = axes_for(ax, (10.0, 7.0), f"{result.model.title}\n{peak}")
    labelled = -widest
    for order in shown:  # the way of each order, lowest first
        axis.plot(result.frequency_hz[order], rpm, color="#999999", lw=0.7, ls=":", zorder=0)
        here = float(result.frequency_hz[order, -1])
        if here - labelled < _LABELS_APART * widest:
            continue
        labelled = here
        look = {"fontsize": 7.5, "rotation": 35, "color": "#333333", "annotation_clip": False, "zorder": 200}
        beside(axis, result.orders[order], (here, rpm[-1]), (2, 4), **look)
    for number, s in enumerate(chosen[::-1]):
        # Heights from 0 to 1 of shares of the highest peak, logarithmic.
        height = 1.0 + np.log10(np.maximum(size[shown, s] / top, _SHOWN)) / _DECADES
        # A line along the axis with a narrow triangle of each height at its frequency.
        width = _PEAK_WIDTH * widest
        middle = result.frequency_hz[shown, s]
        hz = np.unique(np.concatenate([[0.0, widest], middle - width, middle, middle + width]))
        hz = hz[(hz >= 0.0) & (hz <= widest)]
        peaks = np.clip(1.0 - np.abs(hz[:, None] - middle) / width, 0.0, None) * height
        line = rpm[s] + _STEPS_HIGH * step * peaks.max(axis=1)
        axis.fill_between(hz, rpm[s], line, where=line > rpm[s], color="white", zorder=2 * number + 1, lw=0)
        axis.plot(hz, line, color=COLOURS[0], lw=0.8, zorder=2 * number + 2)
    axis.set_xlim(0.0, widest)
    axis.set_ylim(rpm[0] - step, rpm[-1] + (_STEPS_HIGH + 3.0) * step)
    name_axes(axis, label(result, "frequency_hz"), label(result, "speeds"))
    plain_axis(axis)
    return axis


# Levels of an order map reach so far below the highest, dB.
_DEEP = 60.0
# Reference of a level by its unit: ISO 1683 for forces and accelerations; there is none for the others.
_REFERENCES = {"N": (1e-6, "1 uN"), "m/s$^2$": (1e-6, "1 um/s$^2$")}


def order_map(result: ResponseResult, fig: Any = None, *, at: str | None = None) -> np.ndarray:
    """Draw the levels of one quantity over speed and frequency, an order a ray, and above them the overall level.

    A level is 20 log10 of the effective value, amplitude over the root of two, over the reference that the bar names; the overall
    level is that of all orders together.

    Args:
        result: a run-up.
        fig: figure to draw on; a new one for None.
        at: as in `waterfall`.

    Returns:
        Two axes: the overall level, and the map.

    Raises:
        AnalysisError: no such mesh, bearing or point, or a single speed. MissingExtraError: matplotlib is not installed.
    """
    if len(result.speeds) < 2:
        raise AnalysisError("an order map needs more than one speed")
    title, unit, size = waterfall_of(result, at)
    reference, words = _REFERENCES.get(unit, (1.0, f"1 {unit}"))
    rms = size / np.sqrt(2.0)
    levels = _decibel(rms, reference)
    overall = _decibel(np.sqrt(np.sum(rms**2, axis=0)), reference)
    top = float(levels.max())
    rpm = np.abs(result.speed_rpm)
    figure = figure_for(fig, (10.0, 7.4), f"{result.model.title}\n{title}")
    above, axis = figure.subplots(2, 1, sharex=True, height_ratios=(1, 4))
    above.plot(rpm, overall, color=COLOURS[0], lw=1.4)
    above.set_ylabel("overall, dB")
    plain_axis(above)
    from matplotlib import colormaps
    from matplotlib.collections import LineCollection

    points = np.stack([np.broadcast_to(rpm, result.frequency_hz.shape), result.frequency_hz], axis=-1)
    segments = np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 2)
    middle = (0.5 * (levels[:, :-1] + levels[:, 1:])).ravel()
    loudest = np.argsort(middle)  # the strongest orders above the others
    lines = LineCollection(list(segments[loudest]), array=middle[loudest], cmap="viridis", lw=2.6, capstyle="round")
    lines.set_clim(top - _DEEP, top)
    axis.set_facecolor(colormaps["viridis"](0.0))
    axis.add_collection(lines)
    shown = levels.max(axis=1) > top - _DEEP
    axis.set_xlim(float(rpm.min()), float(rpm.max()))
    axis.set_ylim(0.0, 1.03 * float(result.frequency_hz[shown].max()))
    operating = result.model.operating_speed
    for one, colour in ((above, GREY), (axis, "white")):
        if operating and rpm.min() <= abs(operating) * RPM_PER_RAD_S <= rpm.max():
            one.axvline(abs(operating) * RPM_PER_RAD_S, color=colour, lw=0.9, ls="--")
    edge = -np.inf
    for order in np.flatnonzero(shown)[np.argsort(result.frequency_hz[shown, -1])]:
        height = float(result.frequency_hz[order, -1]) / axis.get_ylim()[1]
        if height - edge >= _LABELS_APART:
            edge = height
            beside(axis, result.orders[order], (rpm[-1], result.frequency_hz[order, -1]), (4, -2))
    name_axes(axis, label(result, "speeds"), "frequency, Hz")
    figure.colorbar(lines, ax=[above, axis], label=f"level in dB re {words} (effective value)", pad=0.02, fraction=0.04)
    return np.array([above, axis])


def _decibel(values: np.ndarray, reference: float) -> np.ndarray:
    return np.asarray(20.0 * np.log10(np.maximum(values, 1e-30) / reference))


def waterfall_of(result: ResponseResult, at: str | None) -> tuple[str, str, np.ndarray]:
    """Title, unit and amplitudes (o, s) of a mesh, a bearing or a point."""
    if at is None:
        at = max(result.peaks(), key=lambda row: row[4])[0] if result.contact_mesh else next(iter(result.bearings), "")
    name = at.rpartition(".")[2]
    if name in result.contact_mesh:
        force = np.abs(result.mesh_force[:, :, result.contacts_of(name)])
        return f"dynamic force of mesh {name}", "N", force.max(axis=2)
    if name in result.bearings:
        force = result.bearing_force[:, :, result.bearings.index(name)]
        return (
            f"force of bearing {name} (root of the sum of squares of x, y, z)",
            "N",
            np.linalg.norm(np.abs(force), axis=2),
        )
    if name in result.points:
        turns = result.model.points[name].direction in _TURNING
        size = np.abs(result.acceleration[:, :, result.points.index(name)])
        return f"acceleration at {name}", "rad/s$^2$" if turns else "m/s$^2$", size
    if name in result.load_points:
        size = np.abs(result.internal_load[:, :, result.load_points.index(name)])
        return f"load at {name}", "N m" if result.model.points[name].quantity in _MOMENTS else "N", size
    known = [*dict.fromkeys(result.contact_mesh), *result.bearings, *result.points, *result.load_points]
    raise AnalysisError(
        f"'{at}' is no mesh, bearing or point of the model: expected one of {', '.join(known) or 'none'}"
    )
