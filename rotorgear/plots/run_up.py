"""Draws a run-up over speed: mesh forces, transmission errors, bearing forces and accelerations, whole and by order."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.colours import COLOURS
from rotorgear.plots.figure import figure_for
from rotorgear.plots.static import plain_axis
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.response import ResponseResult

_MOST_LINES = len(COLOURS)
_WIDTH = 5.6
_HEIGHT = 2.9
_HEADROOM = 0.45  # for the legend, as a share of the height of the curves


def response(result: ResponseResult, fig: Any = None) -> np.ndarray:
    """Draw amplitudes over speed: mesh forces, transmission errors, bearing forces and accelerations.

    Left: each mesh, bearing or point with all its orders together (root of the sum of squares); right: the strongest of them
    by order. The eight strongest lines are drawn. The dashed line is the operating speed.

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
    for (left, right), (title, names, size, unit) in zip(axes, rows, strict=False):
        total = np.sqrt((size**2).sum(axis=0))  # (s, lines)
        _lines(left, result, names, total.T, f"{title}, {unit}")
        strongest = int(np.argmax(total.max(axis=0)))
        _lines(right, result, list(result.orders), size[:, :, strongest], f"{names[strongest]} by order, {unit}")
    for axis in axes[-1]:
        axis.set_xlabel(f"speed of {result.model.reference_shaft}, rpm")
    return axes


def _quantities(result: ResponseResult) -> list[tuple[str, list[str], np.ndarray, str]]:
    """(title, names of the lines, amplitudes (o, s, lines), unit)."""
    meshes = list(dict.fromkeys(result.contact_mesh))

    def by_mesh(values: np.ndarray) -> np.ndarray:
        largest = [np.abs(values[:, :, result.contacts_of(mesh)]).max(axis=2) for mesh in meshes]
        return np.stack(largest, axis=2) if largest else np.zeros((len(result.orders), len(result.speeds), 0))

    bearings = np.linalg.norm(np.abs(result.bearing_force), axis=3)
    turning = ("tilt_x", "tilt_y", "torsion")
    linear = [k for k, name in enumerate(result.points) if result.model.points[name].direction not in turning]
    angular = [k for k, name in enumerate(result.points) if result.model.points[name].direction in turning]
    quantities = [
        ("Dynamic mesh force of a helix", meshes, by_mesh(result.mesh_force), "N"),
        ("Transmission error", meshes, 1e6 * by_mesh(result.transmission_error), "um"),
        ("Bearing force", list(result.bearings), bearings, "N"),
        *(
            ("Acceleration", [result.points[k] for k in points], np.abs(result.acceleration[:, :, points]), unit)
            for points, unit in ((linear, "m/s$^2$"), (angular, "rad/s$^2$"))
        ),
    ]
    casings = list(result.casings)
    if casings:  # the power of orders adds up, as the squares of amplitudes do
        power = np.sqrt(result.radiated_power)
        quantities.append(("Root of the equivalent radiated power", casings, power, "W$^{1/2}$"))
    if not meshes and not result.bearings:
        orbit = 1e6 * np.abs(result.displacement[:, :, :, :2]).max(axis=3)
        quantities.append(("Displacement", list(result.places), orbit, "um"))
    return quantities


def _lines(axis: Any, result: ResponseResult, names: list[str], sizes: np.ndarray, label: str) -> None:
    """Draw the strongest lines (lines, s) on a logarithmic scale of four decades at most."""
    ranked = [int(k) for k in np.argsort(-sizes.max(axis=1), kind="stable") if sizes[k].any()]
    for k in sorted(ranked[:_MOST_LINES]):
        marker = "o" if len(result.speeds) == 1 else ""
        colour = COLOURS[sorted(ranked[:_MOST_LINES]).index(k)]
        axis.semilogy(result.speed_rpm, sizes[k], color=colour, lw=1.3, marker=marker, label=names[k])
    more = len(ranked) - _MOST_LINES
    top = float(sizes.max(initial=0.0))
    if top > 0.0:
        low = max(1e-4 * top, 0.5 * float(sizes[sizes > 0.0].min()))
        axis.set_ylim(low, top * (top / low) ** _HEADROOM)
    operating = result.model.operation.speed if result.model.operation else None
    first, last = sorted((float(result.speeds[0]), float(result.speeds[-1])))
    if operating and first <= operating <= last:
        axis.axvline(operating * RPM_PER_RAD_S, color="#777777", lw=0.9, ls="--")
    axis.set_title(label + (f" ({more} weaker left out)" if more > 0 else ""), fontsize=9.5)
    axis.legend(frameon=False, fontsize=7, ncols=2 if len(ranked) > 2 else 1, loc="upper left")
    plain_axis(axis)
