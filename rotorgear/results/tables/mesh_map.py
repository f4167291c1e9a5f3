"""The map of a mesh over torque and misalignment as a table of its points."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.mesh_map import MeshMap


def mesh_map_table(result: MeshMap) -> RenderableType:
    """Return the map as one rich renderable: a row a point."""
    from rich.console import Group

    title = heading(result.title or "Mesh", f": mesh '{result.mesh}', {result.pinion} and {result.gear}")
    setting = lines(f"preset {result.preset}, {result.positions} positions", f"body: {result.body}")
    out = table("torque", "misalignment", "STE pp", "order 1", "2", "3", "p_max", "K_Hbeta", "k mean", no_wrap=True)
    units = ("N m", "um", "um", "um", "um", "um", "MPa", "", "N/m")
    out.add_row(*units)
    for i, torque in enumerate(result.pinion_torque):
        for j, misalignment in enumerate(result.misalignment):
            out.add_row(
                f"{torque:.5g}",
                f"{1e6 * misalignment:.4g}",
                f"{1e6 * result.ste_peak_to_peak[i, j]:.3f}",
                *(f"{1e6 * value:.3f}" for value in result.ste_harmonics[i, j]),
                f"{1e-6 * result.largest_pressure[i, j]:.4g}",
                f"{result.face_load_factor[i, j]:.3f}",
                f"{result.mean_stiffness[i, j]:.4g}",
            )
    notes = notes_of(result)
    return Group(title, *setting, "", out, "", *lines(*notes), f"{result.dofs} dofs, {result.seconds['total']:.2f} s")
