"""The gear sheet: what the teeth of a model's gears and meshes measure, as on a drawing. None is what is not known."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of

if TYPE_CHECKING:
    from rotorgear.gears.stiffness.mesh_stiffness import ToothPair


class GearRow(Record):
    """One gear with teeth: lengths in m, angles in degrees, factors in normal modules.

    Span and dimension over balls are those of the nominal tooth and of both allowances of its thickness.
    """

    name: str = of("name")
    kind: str = of("kind", note=': `"spur"`, `"helical"` or `"herringbone"`')
    hand: str | None = of("hand of the helix", note=': `"right"`, `"left"`, or `null` for a spur gear')
    teeth: int = of("number of teeth z")
    normal_module_m: float = of("normal module m_n", "m")
    normal_pressure_angle_deg: float = of("normal pressure angle α_n", "deg")
    helix_angle_deg: float = of("helix angle β at the reference circle", "deg")
    profile_shift: float = of("profile shift factor x")
    addendum_factor: float = of("addendum h_aP of the rack", note=", over m_n")
    dedendum_factor: float = of("dedendum h_fP of the rack", note=", over m_n")
    root_radius_factor: float = of("root radius ρ_fP in force", note=", over m_n")
    face_width_m: float = of("face width", "m", note=", of one helix")
    transverse_module_m: float = of("transverse module m_t", "m")
    transverse_pressure_angle_deg: float = of("transverse pressure angle α_t", "deg")
    base_helix_angle_deg: float = of("base helix angle β_b", "deg")
    lead_m: float | None = of("lead of the helix", "m", note="; `null` for a spur gear")
    reference_diameter_m: float = of("reference diameter d", "m")
    base_diameter_m: float = of("base diameter d_b", "m")
    tip_diameter_m: float = of("tip diameter d_a", "m")
    root_diameter_m: float = of("root diameter d_f", "m")
    form_diameter_m: float = of("root form diameter d_Ff", "m", note=", where involute and fillet meet")
    undercut: bool = of("whether the tool cuts away involute")
    virtual_teeth: float = of("virtual number of teeth z_n")
    normal_thickness_m: float = of(
        "normal tooth thickness s_n at the reference circle", "m", note=", without allowance"
    )
    tip_thickness_m: float = of("normal tip thickness s_an", "m")
    upper_thickness_allowance_m: float = of("upper thickness allowance E_sns", "m")
    lower_thickness_allowance_m: float = of("lower thickness allowance E_sni", "m")
    span_teeth: int = of("number of teeth k within the base tangent")
    span_m: float = of("base tangent length W_k", "m", note=", without allowance")
    span_upper_m: float = of("base tangent length with the upper allowance", "m")
    span_lower_m: float = of("base tangent length with the lower allowance", "m")
    span_least_width_m: float = of("face width that the measurement needs at least", "m")
    ball_diameter_m: float = of("ball diameter D_M", "m")
    over_balls_m: float = of("dimension over balls or pins M_dK", "m", note=", without allowance")
    over_balls_upper_m: float = of("dimension over balls with the upper allowance", "m")
    over_balls_lower_m: float = of("dimension over balls with the lower allowance", "m")
    tip_relief_m: float = of("tip relief C_a", "m")
    tip_relief_diameter_m: float | None = of("diameter where the relief starts", "m", note=", or `null`")
    warnings: tuple[str, ...] = of("sentences", "", "warning")


class MeshSheetRow(Record):
    """One mesh: the pair at its centre distance, its backlash and its stiffness.

    Pairs of numbers are of pinion and gear. `stiffness_n_per_m` is what the rotor model uses, along the flank normal, of all
    helices; the ISO values c'_th, c', c_gamma_alpha and c_gamma_beta are per face width in the transverse plane, in N/m^2
    (1e9 of it are 1 N/(mm um)). Velocity and tangential force F_t are those at the reference circle, forces of one helix.
    """

    name: str = of("name")
    pinion: str = of("gear that the file calls the pinion")
    gear: str = of("gear that meshes with the pinion")
    ratio: float = of("teeth of the gear over those of the pinion")
    centre_distance_m: float = of("distance of the axes", "m")
    reference_centre_distance_m: float = of("centre distance of gears whose shifts add up to 0", "m")
    profile_shift_sum: float = of("x1 + x2 that would mesh without backlash at the centre distance")
    common_width_m: float = of("common face width", "m", note=", of one helix")
    helices: int = of("number of helices", note=": 1, or 2 for herringbone gears")
    working_pressure_angle_deg: float = of("working transverse pressure angle α_wt", "deg")
    working_helix_angle_deg: float = of("working helix angle β_w", "deg")
    base_helix_angle_deg: float = of("base helix angle β_b", "deg")
    transverse_contact_ratio: float = of("transverse contact ratio ε_α")
    overlap_ratio: float = of("overlap ratio ε_β", note=", of one helix")
    total_contact_ratio: float = of("total contact ratio ε_γ")
    involute_contact_ratio: float = of(
        "transverse contact ratio of the involutes that are there",
        note=": less than ε_α, which the tip circles give, where a tip reaches below the involute of its mate",
    )
    base_pitch_m: float = of("transverse base pitch p_bt", "m")
    approach_length_m: float = of("path of contact before the pitch point", "m", note=", pinion driving")
    recess_length_m: float = of("path of contact after the pitch point", "m", note=", pinion driving")
    working_pitch_diameter_m: tuple[float, float] = of(
        "working pitch diameter d_w of pinion and gear", "m", "pinion_and_gear"
    )
    active_root_diameter_m: tuple[float, float] = of(
        "active root diameter d_Nf of pinion and gear",
        "m",
        "pinion_and_gear",
        note=": where contact with the mate's tip begins",
    )
    tip_clearance_m: tuple[float, float] = of(
        "clearance between the tip of pinion or gear and the root of its mate", "m", "pinion_and_gear"
    )
    transverse_backlash_m: float = of(
        "circumferential backlash j_wt at the working circles", "m", note=", without allowances"
    )
    normal_backlash_least_m: float = of(
        "least normal backlash j_bn", "m", note=": with the upper allowances and the least centre distance"
    )
    normal_backlash_mean_m: float = of("mean normal backlash j_bn", "m", note=": in the middle of all allowances")
    normal_backlash_most_m: float = of(
        "largest normal backlash j_bn", "m", note=": with the lower allowances and the largest centre distance"
    )
    least_contact_line_m: float = of("least length of all contact lines of one helix", "m")
    mean_contact_line_m: float = of("mean length of all contact lines of one helix", "m")
    largest_contact_line_m: float = of("largest length of all contact lines of one helix", "m")
    iso_theoretical_stiffness_n_per_m2: float = of(
        "theoretical single stiffness c'_th of ISO 6336-1 per face width", "N/m^2", note=", transverse plane"
    )
    iso_single_stiffness_n_per_m2: float = of("single stiffness c' of ISO 6336-1 per face width", "N/m^2")
    iso_mesh_stiffness_n_per_m2: float = of("mesh stiffness c_γα of ISO 6336-1 per face width", "N/m^2")
    iso_lead_stiffness_n_per_m2: float = of("mesh stiffness c_γβ of ISO 6336-1 per face width", "N/m^2")
    stiffness_model: str = of("stiffness model", note=' that the file names, or `"given"`')
    stiffness_n_per_m: float | None = of(
        "mean stiffness in use",
        "N/m",
        note=", along the flank normal, of all helices; `null` where the model needs a load and there is none",
    )
    stiffness_peak_to_peak_n_per_m: float | None = of(
        "peak to peak of the stiffness in use over a mesh period", "N/m", note="; `null` as before"
    )
    stiffness_definition: str | None = of(
        "definition of the stiffness", note=': `"secant"` or `"tangent"`; `null` as before'
    )
    stiffness_body: str | None = of("what the teeth stand on in this stiffness", note="; `null` as before")
    pitch_line_velocity_m_per_s: float | None = of(
        "pitch line velocity v at the reference circle", "m/s", note="; `null` without a speed"
    )
    tangential_force_n: float | None = of(
        "tangential force F_t at the reference circle", "N", note=", of one helix; `null` without a load"
    )
    base_tangential_force_n: float | None = of(
        "tangential force F_bt at the base circle", "N", note=", of one helix; `null` without a load"
    )
    dynamic_factor: float | None = of("dynamic factor", note=" K_v; `null` where its inputs are not given")
    dynamic_factor_method: str = of("method of the dynamic factor", note=", or what is missing")
    resonance_ratio: float | None = of("resonance ratio N of method B", note="; `null` otherwise")
    warnings: tuple[str, ...] = of("sentences", "", "warning")


class GearSheet(Result, kind="gear"):
    """All gears and meshes with teeth of a model; `pairs` are the teeth of each mesh, for drawing."""

    title: str = of("title of the model")
    gears: tuple[GearRow, ...] = of("gears with teeth", "", "gear", record=GearRow)
    meshes: tuple[MeshSheetRow, ...] = of("meshes", "", "mesh", record=MeshSheetRow)
    pairs: dict[str, ToothPair] = of(
        "teeth of each mesh, for drawing", "", "MESH", json=None, stored=False, default_factory=dict
    )
