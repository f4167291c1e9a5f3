"""Casings as tables: what the mesh is, its modes with their errors, and its seats."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rotorgear.quantity import millimetres
from rotorgear.results.casing import CasingRow, CasingSurvey
from rotorgear.results.tables.common import heading, lines, plain_table, table

if TYPE_CHECKING:
    from rich.console import RenderableType

# Products of inertia below this share of the largest are shown as 0.
_ROUNDING = 1e-9
# |K R| / (|K| |R|) of rigid-body motions that strain nothing.
_STRAINED = 1e-10


def casing_table(survey: CasingSurvey) -> RenderableType:
    """What `rotorgear casing` prints."""
    from rich.console import Group

    parts: list[Any] = [heading(survey.title)] if survey.title else []
    for name, row in survey.casings.items():
        parts += _casing(name, row)
    return Group(*parts)


def _casing(name: str, row: CasingRow) -> list[Any]:
    facts = plain_table(f"casing {name}")
    facts.add_column("")
    facts.add_column("")
    facts.show_header = False
    facts.add_row("mesh", f"{row.elements} {row.element}, {row.nodes} nodes, {row.dofs} dofs")
    facts.add_row("size", " x ".join(millimetres(float(side)) for side in row.size_m))
    facts.add_row("mass", f"{row.mass_kg:.6g} kg")
    facts.add_row("centre", ", ".join(millimetres(float(x)) for x in row.centre_m))
    # Products of inertia of a symmetric body are rounding.
    inertia = row.inertia_kg_m2 * (abs(row.inertia_kg_m2) > _ROUNDING * abs(row.inertia_kg_m2).max())
    facts.add_row("inertia xx yy zz", " ".join(f"{inertia[i, i]:.5g}" for i in range(3)) + " kg m^2")
    facts.add_row("inertia xy yz zx", " ".join(f"{inertia[i, (i + 1) % 3]:.5g}" for i in range(3)) + " kg m^2")
    facts.add_row("least Jacobian", f"{row.jacobian_least:.3g} of the straight element's")
    free_of_strain = row.rigid_residual < _STRAINED and row.rigid_frequency_hz < 1e-3 * row.free_frequency_hz[0]
    words = "strain nothing" if free_of_strain else f"are strained: {row.rigid_frequency_hz:.2g} Hz"
    compared = f"below {_STRAINED:.0e}" if free_of_strain else f"= {row.rigid_residual:.1e}"
    facts.add_row("rigid-body motions", f"{words}: |K R|/|K||R| {compared}")
    fixed = row.fixed_frequency_hz
    reach = f", to {fixed[-1]:.0f} Hz" if len(fixed) else ""
    facts.add_row("reduced to", f"{row.coordinates} coordinates: {len(fixed)} fixed-interface modes{reach}")
    facts.add_row("seats", f"connection {row.connection}")
    if row.memory_bytes:
        facts.add_row("largest memory", f"{row.memory_bytes / 1e9:.2f} GB")
    facts.add_row("seconds", ", ".join(f"{step} {value:.1f}" for step, value in row.seconds.items()))
    out = [facts, *lines(*(f"  {note}" for note in row.notes)), *lines("")]

    modes = table("mode", "free", "mesh err.", "held", "mesh err.", "reduced", "reduction err.", left=0)
    columns = (
        (row.free_frequency_hz, "{:.2f}"),
        (row.free_mesh_error, "{:.1e}"),
        (row.held_frequency_hz, "{:.2f}"),
        (row.held_mesh_error, "{:.1e}"),
        (row.reduced_frequency_hz, "{:.2f}"),
        (row.reduction_error, "{:.1e}"),
    )
    for mode in range(max(len(values) for values, _ in columns)):
        cells = [form.format(values[mode]) if mode < len(values) else "-" for values, form in columns]
        modes.add_row(str(mode + 1), *("-" if cell == "nan" else cell for cell in cells))
    out += [modes, *lines("Frequencies in Hz, without rigid modes; errors are relative estimates of frequencies.", "")]

    seats = table("seat", "x", "y", "z", "k_x", "k_y", "k_z", "k_rx", "k_ry", "k_rz")
    for seat in row.seats:
        stiffness = [f"{1e-6 * seat.stiffness[i, i]:.4g}" for i in range(6)]
        seats.add_row(seat.name, *(f"{1e3 * x:.4g}" for x in seat.point_m), *stiffness)
    others = row.seats[0].others if row.seats else "free"
    out += [seats, *lines(f"Points in mm; stiffness in MN/m and MN m/rad, the other seats {others}.")]
    return out
