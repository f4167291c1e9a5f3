"""Forced responses as tables for the terminal, 80 columns wide."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.results.tables.common import error_words, heading, lines, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.response import ResponseResult


def response_table(result: ResponseResult) -> RenderableType:
    """Return title, tables of the largest values and notes as one rich renderable."""
    from rich.console import Group

    first = result.speed_rpm[0]
    last = result.speed_rpm[-1]
    speeds = f"{first:.6g} rpm" if len(result.speeds) == 1 else f"{first:.6g} to {last:.6g} rpm"
    title = f"{result.model.title or 'Model'}: forced response, {result.model.reference_shaft} at {speeds}"
    orders = table("no", "order", "times input", f"Hz at {abs(last):.6g} rpm", left=2)
    for o, (order, ratio) in enumerate(zip(result.orders, result.ratio, strict=True)):
        orders.add_row(str(o + 1), order, f"{ratio:.6g}", f"{result.frequency_hz[o, -1]:.2f}")
    notes = [
        *(["DTE: dynamic transmission error, r_b1 theta_1 + r_b2 theta_2"] if result.contact_mesh else []),
        "amplitudes are half of peak to peak, each order by itself; forces without their mean",
        f"{len(result.speeds)} speeds, {result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}",
        f"solver error {error_words(result.solver_error)} at {result.checked} points checked; "
        f"on a finer mesh the peaks change by {error_words(result.error_estimate)}",
        f"damping ratio added to every elastic mode: {result.damping_ratio:g}",
        *(f"left out: {note}" for note in result.left_out),
        *(f"Warning: {note}" for note in result.warnings),
    ]
    return Group(heading(title), "", orders, "", _largest(result), "", *lines(*notes), "")


def _largest(result: ResponseResult) -> Any:
    """The largest amplitude of each quantity and the order, speed and frequency of it."""
    out = table("largest of", "", "order no", "rpm", "Hz", "amplitude", left=2)
    for mesh in dict.fromkeys(result.contact_mesh):
        contacts = result.contacts_of(mesh)
        _row(out, result, "mesh force", mesh, np.abs(result.mesh_force[:, :, contacts]).max(axis=2), 1.0, "N")
        error = np.abs(result.transmission_error[:, :, contacts]).max(axis=2)
        _row(out, result, "DTE", mesh, error, 1e6, "um")
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
