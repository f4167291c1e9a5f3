"""What a model file describes, as tables for the terminal, 80 columns wide."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from rotorgear.results.tables.common import Column, heading, lines, notes_of, table_of

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.description import MeshRow, ModelDescription

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


def _number(value: float | None, factor: float, digits: int) -> str:
    return "-" if value is None else f"{factor * value:.{digits}f}"


def _force(part: Callable[[float, float], float]) -> Callable[[tuple[MeshRow, int]], str]:
    """Cell of a part of the normal force of a helix, from alpha_wt and beta_b."""

    def cell(item: tuple[MeshRow, int]) -> str:
        row, number = item
        share = part(math.radians(row.pressure_angle_deg), math.radians(row.base_helix_angle_deg))
        return f"{row.normal_force_n[number] * share:.5g}"

    return cell


def _helix_name(item: tuple[MeshRow, int]) -> str:
    row, number = item
    return row.name if len(row.normal_force_n) == 1 else f"{row.name} {'LR'[number]}"


SHAFT_COLUMNS: Sequence[Column] = (
    ("shaft", "left", lambda row: row.name),
    ("ratio", "right", lambda row: f"{row.speed_ratio:+.6f}"),
    ("rpm", "right", lambda row: _number(row.speed_rpm, 1.0, 2)),
    ("length mm", "right", lambda row: f"{1e3 * row.length_m:.2f}"),
    ("shaft kg", "right", lambda row: f"{row.shaft_mass_kg:.3f}"),
    ("bodies kg", "right", lambda row: f"{row.body_mass_kg:.3f}"),
    ("Ip kg m2", "right", lambda row: f"{row.polar_inertia_kg_m2:.5g}"),
)
GEAR_COLUMNS: Sequence[Column] = (
    ("gear", "left", lambda row: row.name),
    ("shaft", "left", lambda row: row.shaft),
    ("teeth", "right", lambda row: "-" if row.teeth is None else str(row.teeth)),
    ("hand", "left", lambda row: row.hand or "-"),
    ("r_b mm", "right", lambda row: f"{1e3 * row.base_radius_m:.3f}"),
    ("z mm", "right", lambda row: " ".join(f"{1e3 * z:.5g}" for z in row.z_m)),
    ("angle deg", "right", lambda row: f"{row.clocking_deg:.3f}"),
    ("kg", "right", lambda row: f"{row.mass_kg:.3f}"),
)
MESH_COLUMNS: Sequence[Column] = (
    ("mesh", "left", lambda row: row.name),
    ("ratio", "right", lambda row: f"{row.ratio:.4f}"),
    ("axes mm", "right", lambda row: _number(row.centre_distance_m, 1e3, 3)),
    ("at deg", "right", lambda row: f"{row.centre_line_deg:.2f}"),
    ("a_wt deg", "right", lambda row: f"{row.pressure_angle_deg:.3f}"),
    ("beta_b", "right", lambda row: f"{row.base_helix_angle_deg:.3f}"),
    ("eps_a", "right", lambda row: _number(row.transverse_contact_ratio, 1.0, 3)),
    ("eps_b", "right", lambda row: _number(row.overlap_ratio, 1.0, 3)),
    ("mesh Hz", "right", lambda row: _number(row.mesh_frequency_hz, 1.0, 2)),
)
# Of a mesh and the number of its helix: F_t = F_n cos(beta_b) cos(alpha_wt), F_r = F_n cos(beta_b) sin(alpha_wt),
# F_a = F_n sin(beta_b); stiffness and damping of the mesh are shared evenly.
FORCE_COLUMNS: Sequence[Column] = (
    ("mesh", "left", _helix_name),
    ("driver", "left", lambda item: f"{item[0].driver} (assumed)" if item[0].flank_assumed else item[0].driver),
    ("phase", "right", lambda item: _number(item[0].phase_pitches[item[1]], 1.0, 3)),
    ("F_n N", "right", _force(lambda alpha, beta: 1.0)),
    ("F_t N", "right", _force(lambda alpha, beta: math.cos(beta) * math.cos(alpha))),
    ("F_r N", "right", _force(lambda alpha, beta: math.cos(beta) * math.sin(alpha))),
    ("F_a N", "right", _force(lambda alpha, beta: math.sin(beta))),
    ("k N/m", "right", lambda item: f"{item[0].stiffness_n_per_m / len(item[0].normal_force_n):.4g}"),
    ("c N s/m", "right", lambda item: f"{item[0].damping_n_s_per_m / len(item[0].normal_force_n):.4g}"),
)
PLACE_COLUMNS: Sequence[Column] = (
    ("shaft", "left", lambda item: item[0]),
    ("z mm of the other parts on it", "left", lambda item: ", ".join(item[1])),
)
TORQUE_COLUMNS: Sequence[Column] = (
    ("load", "left", lambda load: load.name),
    ("shaft", "left", lambda load: load.shaft),
    ("torque N m about z", "right", lambda load: f"{load.torque_n_m:.2f}"),
    ("power in kW", "right", lambda load: _number(load.power_w, 1e-3, 3)),
)


def check_table(d: ModelDescription) -> RenderableType:
    """Return shafts, gears, meshes, forces, torques and notes as one rich renderable."""
    from rich.console import Group

    from rotorgear.model.parts.tables import counted

    speed = "no speed given" if d.speed_rpm is None else f"input shaft '{d.reference_shaft}' at {d.speed_rpm:.6g} rpm"
    mass = f"total mass {d.total_mass_kg:.6g} kg; " if d.total_mass_kg else ""
    if d.casing_mass_kg:
        casings = ", ".join(f"{name} {kg:.6g} kg" for name, kg in d.casing_mass_kg.items())
        mass = f"mass of shafts and what is on them {d.total_mass_kg:.6g} kg, of casing {casings}; "
    counts = ", ".join(counted(number, name) for name, number in d.counts.items())
    parts: list[Any] = [heading(d.title or "Model"), *lines(f"{speed}; {counts}"), ""]
    parts.append(table_of(d.shafts, *SHAFT_COLUMNS))
    if d.gears:
        parts += ["", table_of(d.gears, *GEAR_COLUMNS), _GEAR_LEGEND]
    if d.places:
        parts_on: dict[str, list[str]] = {}
        for place in d.places:
            parts_on.setdefault(place.shaft, []).append(f"{place.part} {1e3 * place.z_m:.5g}")
        parts += ["", table_of(parts_on.items(), *PLACE_COLUMNS)]
    if d.meshes:
        helices = [(row, number) for row in d.meshes for number in range(len(row.normal_force_n))]
        parts += ["", table_of(d.meshes, *MESH_COLUMNS), _MESH_LEGEND]
        parts += ["", table_of(helices, *FORCE_COLUMNS), _FORCE_LEGEND]
    if d.torques:
        parts += ["", table_of(d.torques, *TORQUE_COLUMNS)]
    notes = [
        "",
        f"{mass}{d.nodes} nodes, {d.dofs} dofs with {d.mesh}",
        *notes_of(d),
    ]
    return Group(*parts, *lines(*notes), "")
