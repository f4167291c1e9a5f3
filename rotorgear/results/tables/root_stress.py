"""Tooth root stresses as a table: a row a gear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.root_stress import RootStress


def root_stress_table(result: RootStress) -> RenderableType:
    """Return the largest stresses of the cycle as one rich renderable."""
    from rich.console import Group

    title = heading(result.title or "Mesh", f": mesh '{result.mesh}', root stress over the mesh cycle")
    setting = lines(
        f"{result.pinion_torque_n_m:.6g} N m on the pinion, preset {result.preset}, {result.positions} positions"
    )
    out = table("largest principal stress", *(gear.name for gear in result.gears), no_wrap=True)

    def row(label: str, *cells: str) -> None:
        out.add_row(label, *cells)

    row("at the 30 deg tangent, MPa", *(f"{1e-6 * gear.worst_at_tangent:.2f}" for gear in result.gears))
    row("  diameter there, mm", *(f"{1e3 * gear.tangent_diameter:.3f}" for gear in result.gears))
    row("  in mesh periods from C", *(f"{gear.worst_at_tangent_phase:.3f}" for gear in result.gears))
    row("largest, MPa", *(f"{1e-6 * gear.worst:.2f}" for gear in result.gears))
    row("  diameter there, mm", *(f"{1e3 * gear.worst_diameter:.3f}" for gear in result.gears))
    row("  along the face, mm", *(f"{1e3 * gear.worst_z:.2f}" for gear in result.gears))
    row("  in mesh periods from C", *(f"{gear.worst_phase:.3f}" for gear in result.gears))
    if any(gear.nominal is not None for gear in result.gears):
        cells = ("-" if gear.nominal is None else f"{1e-6 * gear.nominal:.2f}" for gear in result.gears)
        row("nominal, ISO 6336-3, MPa", *cells)
    notes = notes_of(result)
    return Group(title, *setting, "", out, "", *lines(*notes), f"{result.seconds['total']:.1f} s")
