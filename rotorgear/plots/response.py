"""Draws a run-up: amplitudes over speed, whole and by order, and a waterfall, the spectrum of one quantity at every speed."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.figure import (
    COLOURS,
    DASHES,
    GREY,
    ORANGE,
    axes_for,
    beside,
    figure_for,
    label,
    legend_below,
    name_axes,
    plain_axis,
    values,
)
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.response import LimitLine, ResponseResult, reference_of

_MOST_LINES = len(COLOURS)
_WIDTH = 5.6
_HEIGHT = 2.9
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
    for (left, right), (quantity, names, size, is_limited) in zip(axes, rows, strict=False):
        total = np.sqrt((size**2).sum(axis=0))  # (s, lines)
        quantity, _, squares = quantity.partition("; ")
        known = {(line.at, line.order): line for line in result.limits} if is_limited else {}
        targets = {name: known[name, ""] for name in names if (name, "") in known}
        _lines(left, result, names, total.T, f"{quantity}: root of the sum of squares of {squares}all orders", targets)
        strongest = int(np.argmax(total.max(axis=0)))
        unit = quantity.rpartition(", ")[2]
        targets = {order: line for (name, order), line in known.items() if name == names[strongest] and order}
        title = f"{names[strongest]} by order, {unit}"
        _lines(right, result, list(result.orders), size[:, :, strongest], title, targets)
    for axis in axes[-1]:
        axis.set_xlabel(label(result, "speeds"))
    return axes


def _quantities(result: ResponseResult) -> Iterator[tuple[str, list[str], np.ndarray, bool]]:
    """Yield what is drawn with its unit, names of the lines, amplitudes (o, s, lines), and whether limits are about it."""
    meshes = list(dict.fromkeys(result.contact_mesh))
    for field, unit in (("mesh_force", "N"), ("transmission_error", "um")) if meshes else ():
        sizes = np.abs(values(result, field, unit))
        of_meshes = [sizes[:, :, result.contacts_of(mesh)].max(axis=2) for mesh in meshes]
        yield label(result, field, unit), meshes, np.stack(of_meshes, axis=2), field == "mesh_force"
    force = f"{label(result, 'bearing_force')}; x, y, z and "
    yield force, list(result.bearings), np.linalg.norm(np.abs(result.bearing_force), axis=3), True
    turns = np.array([result.model.points[name].turns for name in result.points], bool)
    for chosen, unit in ((~turns, "m/s$^2$"), (turns, "rad/s$^2$")):
        names = [name for name, drawn in zip(result.points, chosen, strict=True) if drawn]
        yield label(result, "acceleration", unit), names, np.abs(result.acceleration[:, :, chosen]), True
    moments = np.array([result.model.points[name].load_unit == "N m" for name in result.load_points], bool)
    for chosen, unit in ((~moments, "N"), (moments, "N m")):
        names = [name for name, drawn in zip(result.load_points, chosen, strict=True) if drawn]
        if names:
            yield label(result, "internal_load", unit), names, np.abs(result.internal_load[:, :, chosen]), True
    if result.casings:  # the power of orders adds up, as the squares of amplitudes do
        yield (
            "root of the equivalent radiated power, W$^{1/2}$",
            list(result.casings),
            np.sqrt(result.radiated_power),
            False,
        )
    if not meshes and not result.bearings:
        orbit = 1e6 * np.abs(result.displacement[:, :, :, :2]).max(axis=3)
        yield "displacement, um", list(result.places), orbit, False


def _lines(
    axis: Any, result: ResponseResult, names: list[str], sizes: np.ndarray, title: str, targets: dict[str, LimitLine]
) -> None:
    """Draw the strongest lines (lines, s) on a logarithmic scale of four decades at most, those with limits first."""
    ranked = [int(k) for k in np.argsort(-sizes.max(axis=1), kind="stable") if sizes[k].any()]
    ranked.sort(key=lambda k: names[k] not in targets)  # stable: the strongest first, behind those with a limit
    marker = "o" if len(result.speeds) == 1 else ""
    for k, colour, dashes in zip(sorted(ranked[:_MOST_LINES]), COLOURS, cycle(DASHES), strict=False):
        look = {"color": colour, "ls": dashes, "lw": 1.3, "marker": marker}
        axis.semilogy(result.speed_rpm, sizes[k], label=names[k], **look)
        if names[k] in targets:
            line = targets[names[k]]
            sense = 1.0 if result.speed_rpm[-1] >= 0.0 else -1.0
            axis.plot(
                sense * line.speed_rpm,
                line.amplitude,
                color=colour,
                lw=1.6,
                ls=(0, (1, 1)),
                label=f"limit of {names[k]}",
            )
    more = len(ranked) - _MOST_LINES
    top = max(float(sizes.max(initial=0.0)), *(float(line.amplitude.max()) for line in targets.values()), 0.0)
    if top > 0.0:
        low = max(1e-4 * top, 0.5 * float(sizes[sizes > 0.0].min()))
        axis.set_ylim(low, top * (top / low) ** _HEADROOM)
    operating = result.model.operating_speed
    first, last = sorted((float(result.speeds[0]), float(result.speeds[-1])))
    if targets and first < last:  # a limit may go on beyond the run-up
        axis.set_xlim(*(RPM_PER_RAD_S * np.array([first - 0.02 * (last - first), last + 0.02 * (last - first)])))
    if operating and first <= operating <= last:
        axis.axvline(operating * RPM_PER_RAD_S, color=GREY, lw=0.9, ls="--")
    axis.set_title(title + (f" ({more} weaker left out)" if more > 0 else ""), fontsize=9.5)
    axis.legend(frameon=False, fontsize=7, ncols=2 if len(ranked) > 2 else 1, loc="upper left", handlelength=3.2)
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
    title, unit, size = result.amplitudes_of(at)
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
    unit = unit.replace("^2", "$^2$")
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
    over, above = _exceeded(result, at)
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
        axis.plot(hz, line, color=ORANGE if over[s] else COLOURS[0], lw=1.1 if over[s] else 0.8, zorder=2 * number + 2)
        loud = above[shown, s]
        tops = rpm[s] + _STEPS_HIGH * step * height[loud]
        axis.plot(middle[loud], tops + 0.5 * step, "v", color=ORANGE, ms=4, mec="white", mew=0.4, zorder=2 * number + 2)
    if over.any():
        axis.plot([], [], color=ORANGE, lw=1.1, label="spectra of speeds at which all orders together exceed the limit")
    if above.any():
        axis.plot([], [], "v", color=ORANGE, ms=4, label="orders above their limits")
    if over.any() or above.any():
        legend_below(axis, 2, fontsize=8)
    axis.set_xlim(0.0, widest)
    axis.set_ylim(rpm[0] - step, rpm[-1] + (_STEPS_HIGH + 3.0) * step)
    axis.set_yticks(
        [tick for tick in axis.get_yticks() if rpm[0] - step <= tick <= rpm[-1] + step]
    )  # above are heights alone
    name_axes(axis, label(result, "frequency_hz"), label(result, "speeds"))
    plain_axis(axis)
    return axis


# Levels of an order map reach so far below the highest, dB.
_DEEP = 60.0


def order_map(result: ResponseResult, fig: Any = None, *, at: str | None = None) -> np.ndarray:
    """Draw the levels of one quantity over speed: all together, by frequency (an order a ray), and by order (a level line).

    A level is 20 log10 of the effective value, amplitude over the root of two, over the reference that the bar names; the overall
    level is that of all orders together. Limits are dotted in the overall level; what exceeds them is filled, or edged in orange.

    Args:
        result: a run-up.
        fig: figure to draw on; a new one for None.
        at: as in `waterfall`.

    Returns:
        Three axes: the overall level, the map by frequency, and that by order.

    Raises:
        AnalysisError: no such mesh, bearing or point, or a single speed. MissingExtraError: matplotlib is not installed.
    """
    if len(result.speeds) < 2:
        raise AnalysisError("an order map needs more than one speed")
    title, unit, size = result.amplitudes_of(at)
    reference, words = reference_of(unit)
    words = words.replace("^2", "$^2$")
    rms = size / np.sqrt(2.0)
    levels = _decibel(rms, reference)
    overall = _decibel(np.sqrt(np.sum(rms**2, axis=0)), reference)
    top = float(levels.max())
    rpm = np.abs(result.speed_rpm)
    figure = figure_for(fig, (10.0, 10.2), f"{result.model.title}\n{title}")
    above, axis, by_order = figure.subplots(3, 1, sharex=True, height_ratios=(1.1, 4, 3))
    above.plot(rpm, overall, color=COLOURS[0], lw=1.4)
    above.set_ylabel("overall, dB")
    plain_axis(above)
    line = _limit_of(result, at, "")
    if line is not None:
        limit = _decibel(line.over(rpm) / np.sqrt(2.0), reference)
        above.plot(rpm, limit, color=GREY, lw=1.6, ls=(0, (1, 1)), label="limit")
        above.fill_between(rpm, limit, overall, where=overall > limit, color=ORANGE, alpha=0.6, lw=0, label="above it")
        above.legend(frameon=False, fontsize=8, ncols=2, loc="best")
    shown = np.flatnonzero(levels.max(axis=1) > top - _DEEP)
    exceeded = _exceeded(result, at)[1]
    turns = rpm / 60.0  # of the input shaft, Hz
    lines = None
    for one, heights in ((axis, result.frequency_hz), (by_order, result.frequency_hz / np.maximum(turns, 1e-12))):
        lines = _levels(one, rpm, heights, levels, top, exceeded)
        one.set_ylim(0.0, 1.03 * float(heights[shown].max()))
        ends = heights[shown, -1] / one.get_ylim()[1]
        edge = -np.inf
        for order, height in sorted(zip(shown.tolist(), ends.tolist(), strict=True), key=lambda pair: pair[1]):
            if height - edge >= _LABELS_APART:
                edge = height
                beside(one, result.orders[order], (rpm[-1], heights[order, -1]), (4, -2))
    axis.set_xlim(float(rpm.min()), float(rpm.max()))
    operating = result.model.operating_speed
    for one, colour in ((above, GREY), (axis, "white"), (by_order, "white")):
        if operating and rpm.min() <= abs(operating) * RPM_PER_RAD_S <= rpm.max():
            one.axvline(abs(operating) * RPM_PER_RAD_S, color=colour, lw=0.9, ls="--")
    name_axes(axis, y="frequency, Hz")
    name_axes(by_order, label(result, "speeds"), f"order of shaft '{result.model.reference_shaft}'")
    edged = "; edged in orange: above the limit of the order" if exceeded.any() else ""
    bar = f"level in dB re {words} (effective value){edged}"
    figure.colorbar(lines, ax=[above, axis, by_order], label=bar, pad=0.02, fraction=0.04)
    return np.array([above, axis, by_order])


def _levels(
    axis: Any, rpm: np.ndarray, heights: np.ndarray, levels: np.ndarray, top: float, exceeded: np.ndarray
) -> Any:
    """Draw levels (o, s) along the lines of orders at some heights (o, s), the strongest above the others."""
    from matplotlib import colormaps
    from matplotlib.collections import LineCollection

    points = np.stack([np.broadcast_to(rpm, heights.shape), heights], axis=-1)
    segments = np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 2)
    middle = (0.5 * (levels[:, :-1] + levels[:, 1:])).ravel()
    loudest = np.argsort(middle)
    edged = (exceeded[:, :-1] & exceeded[:, 1:]).ravel()
    axis.add_collection(LineCollection(list(segments[edged]), color=ORANGE, lw=5.5, capstyle="butt"))
    lines = LineCollection(list(segments[loudest]), array=middle[loudest], cmap="viridis", lw=2.6, capstyle="round")
    lines.set_clim(top - _DEEP, top)
    axis.set_facecolor(colormaps["viridis"](0.0))
    axis.add_collection(lines)
    return lines


def _limit_of(result: ResponseResult, at: str | None, order: str) -> LimitLine | None:
    """The limit of a quantity of `amplitudes_of`, of an order or, "", of all together; None without one."""
    name = result.name_at(at)
    return next((line for line in result.limits if (line.at, line.order) == (name, order)), None)


def _exceeded(result: ResponseResult, at: str | None) -> tuple[np.ndarray, np.ndarray]:
    """Whether a quantity exceeds its limit with all orders together (s,), and order by order (o, s)."""
    found = []
    for order in ("", *result.orders):
        line = _limit_of(result, at, order)
        nowhere = np.zeros(len(result.speeds), bool)
        found.append(
            nowhere if line is None else result.amplitude_over_speed(line.at, order) > line.over(result.speed_rpm)
        )
    return found[0], np.array(found[1:])


def _decibel(values: np.ndarray, reference: float) -> np.ndarray:
    return np.asarray(20.0 * np.log10(np.maximum(values, 1e-30) / reference))
