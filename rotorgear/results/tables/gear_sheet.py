"""The gear sheet as tables: a column a gear or a mesh, a row a quantity."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from rotorgear.note import NAMED, Note, sentences
from rotorgear.results.gear_sheet import GearRow, GearSheet, MeshSheetRow
from rotorgear.results.tables.common import heading, lines, notes_of

if TYPE_CHECKING:
    from rich.console import RenderableType

# So many gears or meshes stand side by side in 80 columns.
_COLUMNS = 4
Row = tuple[str, Callable[[Any], str]]


def _mm(key: str, digits: int = 4) -> Callable[[Any], str]:
    return lambda row: _text(getattr(row, key), 1e3, digits)


def _um(key: str) -> Callable[[Any], str]:
    return lambda row: _text(getattr(row, key), 1e6, 1)


def _plain(key: str, digits: int = 4) -> Callable[[Any], str]:
    return lambda row: _text(getattr(row, key), 1.0, digits)


def _significant(key: str, digits: int) -> Callable[[Any], str]:
    return lambda row: "-" if getattr(row, key) is None else f"{getattr(row, key):.{digits}g}"


def _text(value: float | None, factor: float, digits: int) -> str:
    if value is None:
        return "-"
    text = f"{factor * value:.{digits}f}"
    return text.removeprefix("-") if float(text) == 0.0 else text


def _both(key: str, digits: int = 3) -> Callable[[Any], str]:
    return lambda row: "\n".join(f"{1e3 * value:.{digits}f}" for value in getattr(row, key))


def _allowed(key: str) -> Callable[[Any], str]:
    return lambda row: _text(getattr(row, key), 1e3, 4) if row.lower_thickness_allowance_m else "-"


def _allowances(row: GearRow) -> str:
    upper = 1e6 * row.upper_thickness_allowance_m
    lower = 1e6 * row.lower_thickness_allowance_m
    return f"{upper:g} {lower:g}" if lower else "-"


def _involute_left(row: MeshSheetRow) -> str:
    """Contact ratio of the involutes that are there, where a tip reaches below one of them."""
    cut = row.involute_contact_ratio < row.transverse_contact_ratio * (1.0 - 1e-9)
    return f"{row.involute_contact_ratio:.4f}" if cut else "-"


GEAR_ROWS: Sequence[Row] = (
    ("teeth z", lambda row: str(row.teeth)),
    ("normal module mm", _mm("normal_module_m")),
    ("normal pressure angle deg", _plain("normal_pressure_angle_deg")),
    ("helix angle deg", _plain("helix_angle_deg")),
    ("kind", lambda row: row.kind),
    ("hand", lambda row: row.hand or "-"),
    ("profile shift x", _plain("profile_shift")),
    ("rack: addendum h_aP", _plain("addendum_factor", 3)),
    ("  dedendum h_fP", _plain("dedendum_factor", 3)),
    ("  tip radius rho_fP", _plain("root_radius_factor", 3)),
    ("face width mm", _mm("face_width_m", 2)),
    ("transverse module mm", _mm("transverse_module_m")),
    ("transv. pressure angle deg", _plain("transverse_pressure_angle_deg")),
    ("lead mm", _mm("lead_m", 2)),
    ("reference diameter mm", _mm("reference_diameter_m")),
    ("base diameter mm", _mm("base_diameter_m")),
    ("tip diameter mm", _mm("tip_diameter_m")),
    ("root diameter mm", _mm("root_diameter_m")),
    ("root form diameter mm", _mm("form_diameter_m")),
    ("undercut", lambda row: "yes" if row.undercut else "no"),
    ("virtual teeth z_n", _plain("virtual_teeth", 3)),
    ("tooth thickness s_n mm", _mm("normal_thickness_m")),
    ("tip thickness s_an mm", _mm("tip_thickness_m")),
    ("thickness allowances um", _allowances),
    ("tip relief C_a um", lambda row: _text(row.tip_relief_m or None, 1e6, 1)),
    ("  from diameter mm", _mm("tip_relief_diameter_m")),
    ("span over teeth k", lambda row: str(row.span_teeth)),
    ("base tangent W_k mm", _mm("span_m")),
    ("  upper mm", _allowed("span_upper_m")),
    ("  lower mm", _allowed("span_lower_m")),
    ("ball diameter D_M mm", _mm("ball_diameter_m")),
    ("over balls M_dK mm", _mm("over_balls_m")),
    ("  upper mm", _allowed("over_balls_upper_m")),
    ("  lower mm", _allowed("over_balls_lower_m")),
)

MESH_ROWS: Sequence[Row] = (
    ("pinion", lambda row: row.pinion),
    ("gear", lambda row: row.gear),
    ("ratio", _plain("ratio")),
    ("centre distance mm", _mm("centre_distance_m")),
    ("at x1 + x2 = 0 mm", _mm("reference_centre_distance_m")),
    ("x1 + x2 without backlash", _plain("profile_shift_sum")),
    ("common face width mm", _mm("common_width_m", 2)),
    ("working pressure angle deg", _plain("working_pressure_angle_deg")),
    ("working helix angle deg", _plain("working_helix_angle_deg")),
    ("base helix angle deg", _plain("base_helix_angle_deg")),
    ("contact ratio eps_alpha", _plain("transverse_contact_ratio")),
    ("  of the involute left", _involute_left),
    ("overlap ratio eps_beta", _plain("overlap_ratio")),
    ("total contact ratio", _plain("total_contact_ratio")),
    ("base pitch mm", _mm("base_pitch_m")),
    ("length of approach mm", _mm("approach_length_m")),
    ("length of recess mm", _mm("recess_length_m")),
    ("working pitch diameters mm", _both("working_pitch_diameter_m")),
    ("active root diameters mm", _both("active_root_diameter_m")),
    ("tip clearances mm", _both("tip_clearance_m")),
    ("normal backlash: least um", _um("normal_backlash_least_m")),
    ("  mean um", _um("normal_backlash_mean_m")),
    ("  most um", _um("normal_backlash_most_m")),
    ("contact lines: least mm", _mm("least_contact_line_m", 2)),
    ("  mean mm", _mm("mean_contact_line_m", 2)),
    ("  most mm", _mm("largest_contact_line_m", 2)),
    ("ISO c' N/(mm um)", lambda row: f"{1e-9 * row.iso_single_stiffness_n_per_m2:.3f}"),
    ("ISO c_gamma_alpha N/(mm um)", lambda row: f"{1e-9 * row.iso_mesh_stiffness_n_per_m2:.3f}"),
    ("stiffness of all helices", lambda row: row.stiffness_model),
    ("  mean, normal N/m", _significant("stiffness_n_per_m", 4)),
    ("  peak to peak N/m", _significant("stiffness_peak_to_peak_n_per_m", 3)),
    ("pitch line velocity m/s", _plain("pitch_line_velocity_m_per_s", 2)),
    ("tangential F_t, a helix N", _plain("tangential_force_n", 0)),
    ("base force F_bt a helix N", _plain("base_tangential_force_n", 0)),
    ("dynamic factor K_v", _plain("dynamic_factor", 3)),
    ("resonance ratio N", _plain("resonance_ratio", 4)),
)


def gear_table(sheet: GearSheet) -> RenderableType:
    """Return the sheet as one rich renderable."""
    from rich.console import Group

    parts: list[Any] = [heading(sheet.title or "Gears")]
    for rows, columns, head in ((GEAR_ROWS, sheet.gears, "gear"), (MESH_ROWS, sheet.meshes, "mesh")):
        for first in range(0, len(columns), _COLUMNS):
            parts += ["", _table(head, rows, columns[first : first + _COLUMNS])]
    both = (("gears", sheet.gears), ("meshes", sheet.meshes))
    own = [Note(f"{table}.{one.name}", text) for table, members in both for one in members for text in one.warnings]
    notes = [*notes_of(sheet), *(f"Warning: {text}" for text in sentences(own, NAMED))]
    for row in sheet.meshes:
        method = f"{'' if row.dynamic_factor is None else 'K_v by '}{row.dynamic_factor_method}"
        if row.stiffness_definition is not None:
            notes.append(f"meshes.{row.name}: {row.stiffness_definition} stiffness; body: {row.stiffness_body}")
        notes.append(f"meshes.{row.name}: {method}")
    return Group(*parts, "", *lines(*notes))


def _table(head: str, rows: Sequence[Row], columns: Sequence[GearRow | MeshSheetRow]) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column(head, no_wrap=True)
    for column in columns:
        table.add_column(column.name, justify="right", overflow="fold")
    for label, cell in rows:
        cells = [cell(column) for column in columns]
        if any(text != "-" for text in cells):  # a quantity that none of them has gets no row
            table.add_row(label, *cells)
    return table
