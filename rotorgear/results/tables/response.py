"""Forced responses as tables for the terminal, 80 columns wide."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.results.tables.common import error_words, heading, lines, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.response import ResponseResult


# Rows of a run of orders before the rest of it shares one.
_SHOWN = 5
_WORDS = (
    "transmission error: rotation at the base circles, r_b1 theta_1 + r_b2 theta_2; approach: of the flanks, transverse, with "
    "bending and axial motion",
)


def response_table(result: ResponseResult) -> RenderableType:
    """Return title, tables of the largest values and notes as one rich renderable."""
    from rich.console import Group

    first = result.speed_rpm[0]
    last = result.speed_rpm[-1]
    speeds = f"{first:.6g} rpm" if len(result.speeds) == 1 else f"{first:.6g} to {last:.6g} rpm"
    title = f"{result.model.title or 'Model'}: forced response, {result.model.reference_shaft} at {speeds}"
    orders = table("no", "order", "times input", f"Hz at {abs(last):.6g} rpm", left=2)
    for first_one, last_one in _rows_of_orders(result.orders):
        ends = dict.fromkeys((first_one, last_one))
        orders.add_row(
            " to ".join(str(o + 1) for o in ends),
            " to ".join(result.orders[o] if o == first_one else result.orders[o].rpartition(" ")[2] for o in ends),
            " to ".join(f"{result.ratio[o]:.6g}" for o in ends),
            " to ".join(f"{result.frequency_hz[o, -1]:.2f}" for o in ends),
        )
    notes = [
        *(_WORDS if result.contact_mesh else ()),
        "amplitudes are half of peak to peak, each order by itself; forces without their mean",
        f"{len(result.speeds)} speeds, {result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}",
        f"solver error {error_words(result.solver_error)} at {result.checked} points checked; "
        f"on a finer mesh the peaks change by {error_words(result.error_estimate)}",
        f"damping ratio added to every elastic mode: {result.damping_ratio:g}",
        *(f"left out: {note}" for note in result.left_out),
        *(f"Warning: {note}" for note in result.warnings),
    ]
    return Group(heading(title), "", orders, "", _largest(result), "", *lines(*notes), "")


def _rows_of_orders(orders: tuple[str, ...]) -> list[tuple[int, int]]:
    """First and last number of each row of the table of orders: a long run of high orders of one part shares a row."""
    rows: list[tuple[int, int]] = []
    start = 0
    for _, group in groupby(order.rpartition(" ")[0] for order in orders):
        end = start + len(list(group))
        shown = start + _SHOWN if end - start > 2 * _SHOWN else end
        rows += [(o, o) for o in range(start, shown)]
        rows += [(shown, end - 1)] if shown < end else []
        start = end
    return rows


def _largest(result: ResponseResult) -> Any:
    """The largest amplitude of each quantity and the order, speed and frequency of it."""
    out = table("largest of", "", "order no", "rpm", "Hz", "amplitude", left=2)
    for mesh in dict.fromkeys(result.contact_mesh):
        contacts = result.contacts_of(mesh)
        _row(out, result, "mesh force", mesh, np.abs(result.mesh_force[:, :, contacts]).max(axis=2), 1.0, "N")
        error = np.abs(result.transmission_error[:, :, contacts]).max(axis=2)
        _row(out, result, "transm. error", mesh, error, 1e6, "um")
        approach = np.abs(result.approach[:, :, contacts]).max(axis=2)
        _row(out, result, "approach", mesh, approach, 1e6, "um")
    for k, name in enumerate(result.bearings):
        force = np.abs(result.bearing_force[:, :, k]).max(axis=2)
        _row(out, result, "bearing force", name, force, 1.0, "N")
    for k, name in enumerate(result.points):
        turns = result.model.points[name].direction in ("tilt_x", "tilt_y", "torsion")
        size = np.abs(result.acceleration[:, :, k])
        _row(out, result, "acceleration", name, size, 1.0, "rad/s2" if turns else "m/s2")
    if not result.bearings and not result.contact_mesh:
        for k, place in enumerate(result.places):
            size = np.abs(result.displacement[:, :, k, :2]).max(axis=2)
            _row(out, result, "displacement", place, size, 1e6, "um")
    return out


def _row(out: Any, result: ResponseResult, what: str, name: str, size: np.ndarray, factor: float, unit: str) -> None:
    o, s = np.unravel_index(int(np.argmax(size)), size.shape)
    if size[o, s] == 0.0:
        return
    out.add_row(
        what,
        name,
        str(o + 1),
        f"{result.speed_rpm[s]:.1f}",
        f"{result.frequency_hz[o, s]:.1f}",
        f"{factor * size[o, s]:.4g} {unit}",
    )
