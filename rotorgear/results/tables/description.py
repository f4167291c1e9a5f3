"""What a model file describes, as tables for the terminal, 80 columns wide."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rotorgear.results.tables.common import heading, lines

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.description import ModelDescription

_MESH_LEGEND = (
    "[dim]at: direction from pinion to gear from +x; a_wt: working transverse pressure angle; beta_b: base helix angle in deg; "
    "eps: contact ratios, transverse and overlap (of one helix)[/dim]"
)
_GEAR_LEGEND = "[dim]r_b: base radius; z of its nodes; angle of a tooth's middle from the mark of its shaft[/dim]"
_FORCE_LEGEND = (
    "[dim]phase: in pitches, when the mark of the input shaft points to +x; "
    "forces on one helix: normal to the flank, tangential and radial at the working circle, axial; "
    "L and R: helix at the smaller and the larger z[/dim]"
)


def check_table(d: ModelDescription) -> RenderableType:
    """Return shafts, gears, meshes, forces, torques and notes as one rich renderable."""
    from rich.console import Group

    from rotorgear.model.parts.tables import counted

    speed = "no speed given" if d.speed_rpm is None else f"input shaft '{d.reference_shaft}' at {d.speed_rpm:.6g} rpm"
    mass = f"total mass {d.total_mass_kg:.6g} kg; " if d.total_mass_kg else ""
    counts = ", ".join(counted(number, name) for name, number in d.counts.items())
    parts: list[Any] = [heading(d.title or "Model"), *lines(f"{speed}; {counts}"), ""]
    parts.append(_shafts(d))
    if d.gears:
        parts += ["", _gears(d), _GEAR_LEGEND]
    if d.places:
        # A line for each shaft: z of what stands on it beside the gears.
        places = _table(("shaft", "left"), ("z mm of the other parts on it", "left"))
        for shaft in dict.fromkeys(row.shaft for row in d.places):
            places.add_row(
                shaft, ", ".join(f"{row.part} {1e3 * row.z_m:.5g}" for row in d.places if row.shaft == shaft)
            )
        parts += ["", places]
    if d.meshes:
        parts += ["", _meshes(d), _MESH_LEGEND, "", _forces(d), _FORCE_LEGEND]
    if d.torques:
        torques = _table(("load", "left"), ("shaft", "left"), ("torque N m about z", "right"), ("power in kW", "right"))
        for load in d.torques:
            power = "-" if load.power_w is None else f"{1e-3 * load.power_w:.3f}"
            torques.add_row(load.name, load.shaft, f"{load.torque_n_m:.2f}", power)
        parts += ["", torques]
    notes = [
        "",
        f"{mass}{d.nodes} nodes, {d.dofs} dofs with {d.mesh}",
        *(f"left out: {note}" for note in d.left_out),
        *(f"Warning: {note}" for note in d.warnings),
    ]
    return Group(*parts, *lines(*notes), "")


def _table(*columns: tuple[str, str]) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    for name, justify in columns:
        table.add_column(name, justify=justify, overflow="fold")  # type: ignore[arg-type]
    return table


def _shafts(d: ModelDescription) -> Any:
    table = _table(
        ("shaft", "left"),
        ("ratio", "right"),
        ("rpm", "right"),
        ("length mm", "right"),
        ("shaft kg", "right"),
        ("bodies kg", "right"),
        ("Ip kg m2", "right"),
    )
    for row in d.shafts:
        rpm = "-" if row.speed_rpm is None else f"{row.speed_rpm:.2f}"
        table.add_row(
            row.name,
            f"{row.speed_ratio:+.6f}",
            rpm,
            f"{1e3 * row.length_m:.2f}",
            f"{row.shaft_mass_kg:.3f}",
            f"{row.body_mass_kg:.3f}",
            f"{row.polar_inertia_kg_m2:.5g}",
        )
    return table


def _gears(d: ModelDescription) -> Any:
    table = _table(
        ("gear", "left"),
        ("shaft", "left"),
        ("teeth", "right"),
        ("hand", "left"),
        ("r_b mm", "right"),
        ("z mm", "right"),
        ("angle deg", "right"),
        ("kg", "right"),
    )
    for row in d.gears:
        table.add_row(
            row.name,
            row.shaft,
            "-" if row.teeth is None else str(row.teeth),
            row.hand or "-",
            f"{1e3 * row.base_radius_m:.3f}",
            " ".join(f"{1e3 * z:.5g}" for z in row.z_m),
            f"{row.clocking_deg:.3f}",
            f"{row.mass_kg:.3f}",
        )
    return table


def _meshes(d: ModelDescription) -> Any:
    table = _table(
        ("mesh", "left"),
        ("ratio", "right"),
        ("axes mm", "right"),
        ("at deg", "right"),
        ("a_wt deg", "right"),
        ("beta_b", "right"),
        ("eps_a", "right"),
        ("eps_b", "right"),
        ("mesh Hz", "right"),
    )
    for row in d.meshes:
        table.add_row(
            row.name,
            f"{row.ratio:.4f}",
            _number(row.centre_distance_m, 1e3, 3),
            f"{row.centre_line_deg:.2f}",
            f"{row.pressure_angle_deg:.3f}",
            f"{row.base_helix_angle_deg:.3f}",
            _number(row.transverse_contact_ratio, 1.0, 3),
            _number(row.overlap_ratio, 1.0, 3),
            _number(row.mesh_frequency_hz, 1.0, 2),
        )
    return table


def _number(value: float | None, factor: float, digits: int) -> str:
    return "-" if value is None else f"{factor * value:.{digits}f}"


def _forces(d: ModelDescription) -> Any:
    table = _table(
        ("mesh", "left"),
        ("driver", "left"),
        ("phase", "right"),
        ("F_n N", "right"),
        ("F_t N", "right"),
        ("F_r N", "right"),
        ("F_a N", "right"),
        ("k N/m", "right"),
        ("c N s/m", "right"),
    )
    for row in d.meshes:
        helices = len(row.normal_force_n)
        for number, force in enumerate(row.normal_force_n):
            name = row.name if helices == 1 else f"{row.name} {'L' if number == 0 else 'R'}"
            a = math.radians(row.pressure_angle_deg)
            b = math.radians(row.base_helix_angle_deg)
            # F_t = F_n cos(beta_b) cos(alpha_wt), F_r = F_n cos(beta_b) sin(alpha_wt), F_a = F_n sin(beta_b).
            parts = (force, force * math.cos(b) * math.cos(a), force * math.cos(b) * math.sin(a), force * math.sin(b))
            table.add_row(
                name,
                f"{row.driver} (assumed)" if row.flank_assumed else row.driver,
                _number(row.phase_pitches[number], 1.0, 3),
                *(f"{part:.5g}" for part in parts),
                f"{row.stiffness_n_per_m / helices:.4g}",
                f"{row.damping_n_s_per_m / helices:.4g}",
            )
    return table
