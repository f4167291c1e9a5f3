"""The gear sheet: what the teeth of a model's gears and meshes measure, as on a drawing. None is what is not known."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rotorgear.note import NAMED, Note, sentences
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of
from rotorgear.results.table import Block, Column, Line, upright

if TYPE_CHECKING:
    from rotorgear.gears.stiffness.mesh_stiffness import ToothPair


# So many gears or meshes stand side by side in 80 columns.
_ABREAST = 4


def _both(values: tuple[float, ...]) -> str:
    """Numbers of pinion and gear, below each other."""
    return "\n".join(f"{value:.3f}" for value in values)


class GearRow(Record):
    """One gear with teeth: lengths in m, angles in degrees, factors in normal modules.

    Span and dimension over balls are those of the nominal tooth and of both allowances of its thickness.
    """

    name: str = of("name")
    kind: str = of("kind", note=': `"spur"`, `"helical"` or `"herringbone"`')
    hand: str | None = of("hand of the helix", note=': `"right"`, `"left"`, or `null` for a spur gear')
    internal: bool = of("whether it is a ring with its teeth inside")
    teeth: int = of(
        "number of teeth z", note="; of a ring, too, a positive number, and so are its diameters", column="teeth z"
    )
    normal_module_m: float = of("normal module m_n", "m", form=".4f", column="normal module mm")
    normal_pressure_angle_deg: float = of(
        "normal pressure angle α_n", "deg", form=".4f", column="normal pressure angle deg"
    )
    helix_angle_deg: float = of("helix angle β at the reference circle", "deg", form=".4f", column="helix angle deg")
    profile_shift: float = of("profile shift factor x", form=".4f", column="profile shift x")
    addendum_factor: float = of(
        "addendum h_aP of the rack", note=", over m_n", form=".3f", column="rack: addendum h_aP"
    )
    dedendum_factor: float = of("dedendum h_fP of the rack", note=", over m_n", form=".3f", column="  dedendum h_fP")
    root_radius_factor: float = of(
        "root radius ρ_fP in force", note=", over m_n", form=".3f", column="  tip radius rho_fP"
    )
    face_width_m: float = of("face width", "m", note=", of one helix", form=".2f", column="face width mm")
    transverse_module_m: float = of("transverse module m_t", "m", form=".4f", column="transverse module mm")
    transverse_pressure_angle_deg: float = of(
        "transverse pressure angle α_t", "deg", form=".4f", column="transv. pressure angle deg"
    )
    base_helix_angle_deg: float = of("base helix angle β_b", "deg")
    lead_m: float | None = of("lead of the helix", "m", note="; `null` for a spur gear", form=".2f", column="lead mm")
    reference_diameter_m: float = of("reference diameter d", "m", form=".4f", column="reference diameter mm")
    base_diameter_m: float = of("base diameter d_b", "m", form=".4f", column="base diameter mm")
    tip_diameter_m: float = of("tip diameter d_a", "m", form=".4f", column="tip diameter mm")
    root_diameter_m: float = of("root diameter d_f", "m", form=".4f", column="root diameter mm")
    form_diameter_m: float = of(
        "root form diameter d_Ff", "m", note=", where the fillet begins", form=".4f", column="root form diameter mm"
    )
    undercut: bool = of("whether the tool cuts away involute", column="undercut")
    virtual_teeth: float = of("virtual number of teeth z_n", form=".3f", column="virtual teeth z_n")
    normal_thickness_m: float = of(
        "normal tooth thickness s_n at d", "m", note=", without allowance", form=".4f", column="tooth thickness s_n mm"
    )
    tip_thickness_m: float = of("normal tip thickness s_an", "m", form=".4f", column="tip thickness s_an mm")
    upper_thickness_allowance_m: float = of("upper thickness allowance E_sns", "m")
    lower_thickness_allowance_m: float = of("lower thickness allowance E_sni", "m")
    span_teeth: int | None = of(
        "number of teeth k within the base tangent", note="; `null` for a ring", column="span over teeth k"
    )
    span_m: float | None = of(
        "base tangent length W_k", "m", note=", without allowance", form=".4f", column="base tangent W_k mm"
    )
    span_upper_m: float | None = of(
        "base tangent length with the upper allowance", "m", form=".4f", column="  upper mm"
    )
    span_lower_m: float | None = of(
        "base tangent length with the lower allowance", "m", form=".4f", column="  lower mm"
    )
    span_least_width_m: float | None = of("face width that the measurement needs at least", "m")
    ball_diameter_m: float = of("ball diameter D_M", "m", form=".4f", column="ball diameter D_M mm")
    over_balls_m: float = of(
        "dimension over balls or pins M_dK",
        "m",
        note=", without allowance; of a ring between them",
        form=".4f",
        column="over balls M_dK mm",
    )
    over_balls_upper_m: float = of(
        "dimension over balls with the upper allowance", "m", form=".4f", column="  upper mm"
    )
    over_balls_lower_m: float = of(
        "dimension over balls with the lower allowance", "m", form=".4f", column="  lower mm"
    )
    tip_relief_m: float = of("tip relief C_a", "m", form=".1f", column="tip relief C_a um")
    tip_relief_diameter_m: float | None = of(
        "diameter where the relief starts", "m", note=", or `null`", form=".4f", column="  from diameter mm"
    )
    warnings: tuple[str, ...] = of("sentences", "", "warning")


class MeshSheetRow(Record):
    """One mesh: the pair at its centre distance, its backlash and its stiffness.

    Pairs of numbers are of pinion and gear. `stiffness_n_per_m` is what the rotor model uses, along the flank normal, of all
    helices; the ISO values c'_th, c', c_gamma_alpha and c_gamma_beta are per face width in the transverse plane, in N/m^2
    (1e9 of it are 1 N/(mm um)). Velocity and tangential force F_t are those at the reference circle, forces of one helix; the
    pinion drives.
    """

    name: str = of("name")
    pinion: str = of("gear that the file calls the pinion", column="pinion")
    gear: str = of("gear that meshes with the pinion", column="gear")
    ratio: float = of("teeth of the gear over those of the pinion", form=".4f", column="ratio")
    centre_distance_m: float = of("distance of the axes", "m", form=".4f", column="centre distance mm")
    reference_centre_distance_m: float = of(
        "centre distance of gears whose shifts add up to 0", "m", form=".4f", column="at x1 + x2 = 0 mm"
    )
    profile_shift_sum: float = of(
        "x1 + x2 that would mesh without backlash at the centre distance", form=".4f", column="x1 + x2 without backlash"
    )
    common_width_m: float = of(
        "common face width", "m", note=", of one helix", form=".2f", column="common face width mm"
    )
    helices: int = of("number of helices", note=": 1, or 2 for herringbone gears")
    working_pressure_angle_deg: float = of(
        "working transverse pressure angle α_wt", "deg", form=".4f", column="working pressure angle deg"
    )
    working_helix_angle_deg: float = of("working helix angle β_w", "deg", form=".4f", column="working helix angle deg")
    base_helix_angle_deg: float = of("base helix angle β_b", "deg", form=".4f", column="base helix angle deg")
    transverse_contact_ratio: float = of("transverse contact ratio ε_α", form=".4f", column="contact ratio eps_alpha")
    overlap_ratio: float = of("overlap ratio ε_β", note=", of one helix", form=".4f", column="overlap ratio eps_beta")
    total_contact_ratio: float = of("total contact ratio ε_γ", form=".4f", column="total contact ratio")
    involute_contact_ratio: float = of(
        "transverse contact ratio of the involutes that are there",
        note=": less than ε_α, which the tip circles give, where a tip reaches below the involute of its mate",
        form=".4f",
        column="  of the involute left",
    )
    base_pitch_m: float = of("transverse base pitch p_bt", "m", form=".4f", column="base pitch mm")
    approach_length_m: float = of(
        "path of contact before the pitch point", "m", form=".4f", column="length of approach mm"
    )
    recess_length_m: float = of("path of contact after the pitch point", "m", form=".4f", column="length of recess mm")
    working_pitch_diameter_m: tuple[float, float] = of(
        "working pitch diameter d_w", "m", "pinion_and_gear", form=_both, column="working pitch diameters mm"
    )
    active_root_diameter_m: tuple[float, float] = of(
        "active root diameter d_Nf",
        "m",
        "pinion_and_gear",
        note=": where contact with the mate's tip begins",
        form=_both,
        column="active root diameters mm",
    )
    tip_clearance_m: tuple[float, float] = of(
        "clearance from its tip to the root of its mate", "m", "pinion_and_gear", form=_both, column="tip clearances mm"
    )
    transverse_backlash_m: float = of(
        "circumferential backlash j_wt at the working circles", "m", note=", without allowances"
    )
    normal_backlash_least_m: float = of(
        "least normal backlash j_bn",
        "m",
        note=": upper allowances, least distance",
        form=".1f",
        column="normal backlash: least um",
    )
    normal_backlash_mean_m: float = of(
        "mean normal backlash j_bn", "m", note=": in the middle of all allowances", form=".1f", column="  mean um"
    )
    normal_backlash_most_m: float = of(
        "largest normal backlash j_bn", "m", note=": lower allowances, largest distance", form=".1f", column="  most um"
    )
    least_contact_line_m: float = of(
        "least length of all contact lines of one helix", "m", form=".2f", column="contact lines: least mm"
    )
    mean_contact_line_m: float = of(
        "mean length of all contact lines of one helix", "m", form=".2f", column="  mean mm"
    )
    largest_contact_line_m: float = of(
        "largest length of all contact lines of one helix", "m", form=".2f", column="  most mm"
    )
    iso_theoretical_stiffness_n_per_m2: float = of(
        "theoretical single stiffness c'_th of ISO 6336-1 per width", "N/m^2", note=", transverse plane"
    )
    iso_single_stiffness_n_per_m2: float = of(
        "single stiffness c' of ISO 6336-1 per width", "N/m^2", form=".3f", column="ISO c' N/(mm um)"
    )
    iso_mesh_stiffness_n_per_m2: float = of(
        "mesh stiffness c_γα of ISO 6336-1 per width", "N/m^2", form=".3f", column="ISO c_gamma_alpha N/(mm um)"
    )
    iso_lead_stiffness_n_per_m2: float = of("mesh stiffness c_γβ of ISO 6336-1 per width", "N/m^2")
    stiffness_model: str = of(
        "stiffness model", note=' that the file names, or `"given"`', column="stiffness of all helices"
    )
    stiffness_n_per_m: float | None = of(
        "mean stiffness in use",
        "N/m",
        note=", along the flank normal, of all helices; `null` where the model needs a load and there is none",
        form=".4g",
        column="  mean, normal N/m",
    )
    stiffness_peak_to_peak_n_per_m: float | None = of(
        "peak to peak of that stiffness", "N/m", note="; `null` as before", form=".3g", column="  peak to peak N/m"
    )
    stiffness_definition: str | None = of(
        "definition of the stiffness", note=': `"secant"` or `"tangent"`; `null` as before'
    )
    stiffness_body: str | None = of("what the teeth stand on in this stiffness", note="; `null` as before")
    pitch_line_velocity_m_per_s: float | None = of(
        "pitch line velocity v", "m/s", note="; `null` without a speed", form=".2f", column="pitch line velocity m/s"
    )
    tangential_force_n: float | None = of(
        "tangential force F_t", "N", note="; `null` without load", form=".0f", column="tangential F_t, a helix N"
    )
    base_tangential_force_n: float | None = of(
        "tangential base force F_bt", "N", note="; `null` without load", form=".0f", column="base force F_bt a helix N"
    )
    dynamic_factor: float | None = of(
        "dynamic factor", note=" K_v; `null` where its inputs are not given", form=".3f", column="dynamic factor K_v"
    )
    dynamic_factor_method: str = of("method of the dynamic factor", note=", or what is missing")
    resonance_ratio: float | None = of(
        "resonance ratio N of method B", note="; `null` otherwise", form=".4f", column="resonance ratio N"
    )
    warnings: tuple[str, ...] = of("sentences", "", "warning")


class GearSheet(Result, kind="gear"):
    """All gears and meshes with teeth of a model; `pairs` are the teeth of each mesh, for drawing."""

    title: str = of("title of the model")
    gears: tuple[GearRow, ...] = of("gears with teeth", "", "gear", record=GearRow)
    meshes: tuple[MeshSheetRow, ...] = of("meshes", "", "mesh", record=MeshSheetRow)
    pairs: dict[str, ToothPair] = of(
        "teeth of each mesh, for drawing", "", "MESH", json=None, stored=False, default_factory=dict
    )

    def tables(self) -> Iterator[Block]:
        """The sheets of gears and meshes, side by side, and notes."""
        yield Line(self.title or "Gears")
        # The involutes that are left are told where a tip reaches below one of them.
        cut = Column(
            "",
            "involute_contact_ratio",
            where=lambda mesh: mesh.involute_contact_ratio < mesh.transverse_contact_ratio * (1.0 - 1e-9),
        )
        said = [one.name for one in MeshSheetRow.declarations.values() if one.column]
        lines = ["name", *(cut if name == cut.value else name for name in said)]
        for table, kind, shown in (("gears", "gear", list(_gear_lines())), ("meshes", "mesh", lines)):
            for first in range(0, len(getattr(self, table)), _ABREAST):
                yield from ("", upright(self, table, kind, *shown, first=first, count=_ABREAST))
        yield from ("", *self.remarks())
        both = (("gears", self.gears), ("meshes", self.meshes))
        own = [Note(f"{table}.{one.name}", text) for table, members in both for one in members for text in one.warnings]
        yield from (f"Warning: {text}" for text in sentences(own, NAMED))
        for row in self.meshes:
            if row.stiffness_definition is not None:
                yield f"meshes.{row.name}: {row.stiffness_definition} stiffness; body: {row.stiffness_body}"
            yield f"meshes.{row.name}: {'' if row.dynamic_factor is None else 'K_v by '}{row.dynamic_factor_method}"


def _gear_lines() -> Iterator[Column | str]:
    """What the sheet says of a gear, in its order: the name, then each line."""

    def allowances(gear: GearRow) -> str:
        upper = 1e6 * gear.upper_thickness_allowance_m
        lower = 1e6 * gear.lower_thickness_allowance_m
        return f"{upper:g} {lower:g}" if lower else "-"

    allowed = ("span_upper_m", "span_lower_m", "over_balls_upper_m", "over_balls_lower_m")
    yield "name"
    for one in GearRow.declarations.values():
        if one.name == "helix_angle_deg":
            ring = Column("ring, teeth inside", "internal", where=lambda gear: gear.internal)
            yield from (one.name, Column("kind", "kind", left=False), ring, Column("hand", "hand", left=False))
        elif one.name in allowed:
            yield Column("", one.name, where=lambda gear: bool(gear.lower_thickness_allowance_m))
        elif one.name == "tip_relief_m":
            yield Column("thickness allowances um", allowances)
            yield Column("", one.name, where=lambda gear: bool(gear.tip_relief_m))
        elif one.column:
            yield one.name
