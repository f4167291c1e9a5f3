"""The best flanks of a mesh as tables: what was looked for, what it does, and the lines for the model file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.mesh_optimum import MeshOptimum


def mesh_optimum_table(result: MeshOptimum) -> RenderableType:
    """Return the result as one rich renderable."""
    from rich.console import Group

    title = heading(result.title or "Mesh", f": mesh '{result.mesh}', {result.pinion} and {result.gear}")
    limit = "no limit" if result.pressure_limit is None else f"p_max up to {1e-6 * result.pressure_limit:.4g} MPa"
    setting = lines(f"preset {result.preset}, {result.positions} positions, {limit}, {result.evaluations} flanks tried")
    variables = table("modification", "bounds um", "best um", "tolerance um", no_wrap=True)
    for variable in result.variables:
        variables.add_row(
            variable.name,
            f"{1e6 * variable.low_m:.4g} ... {1e6 * variable.high_m:.4g}",
            f"{1e6 * variable.best_m:.2f}",
            f"+-{1e6 * variable.tolerance_m:.3g}",
        )
    points = table("torque", "misalignment", "weight", "STE pp before", "best", "90 % band", "p_max", no_wrap=True)
    points.add_row("N m", "um", "", "um", "um", "um", "MPa")
    for i, torque in enumerate(result.pinion_torque):
        for j, misalignment in enumerate(result.misalignment):
            band = "-"
            if result.ste_low is not None and result.ste_high is not None:
                band = f"{1e6 * result.ste_low[i, j]:.3f} ... {1e6 * result.ste_high[i, j]:.3f}"
            points.add_row(
                f"{torque:.5g}",
                f"{1e6 * misalignment:.4g}",
                f"{result.weight[i, j]:.3f}",
                f"{1e6 * result.before[i, j]:.3f}",
                f"{1e6 * result.ste[i, j]:.3f}",
                band,
                f"{1e-6 * result.largest_pressure[i, j]:.4g}",
            )
    band = "-"
    if result.mean_band is not None:
        band = f"{1e6 * result.mean_band[0]:.3f} ... {1e6 * result.mean_band[1]:.3f}"
    points.add_row("mean", "", "", f"{1e6 * result.mean_before:.3f}", f"{1e6 * result.mean:.3f}", band, "")
    notes = notes_of(result)
    if result.status != "success":
        notes.append(f"Warning: {result.status}")
    # TOML has brackets, which rich would take for marks.
    file = lines("for the model file:", *result.lines.splitlines())
    return Group(
        title, *setting, "", variables, "", points, "", *lines(*notes), f"{result.seconds['total']:.1f} s", "", *file
    )
