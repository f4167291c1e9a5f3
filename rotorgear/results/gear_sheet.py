"""The gear sheet: what the teeth of a model's gears and meshes measure, as on a drawing. None is what is not known."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rotorgear.gears.stiffness.mesh_stiffness import ToothPair


@dataclass(frozen=True)
class GearRow:
    """One gear with teeth: lengths in m, angles in degrees, factors in normal modules.

    Span and dimension over balls are those of the nominal tooth and of both allowances of its thickness.
    """

    name: str
    kind: str
    hand: str | None
    teeth: int
    normal_module_m: float
    normal_pressure_angle_deg: float
    helix_angle_deg: float
    profile_shift: float
    addendum_factor: float
    dedendum_factor: float
    root_radius_factor: float
    face_width_m: float
    transverse_module_m: float
    transverse_pressure_angle_deg: float
    base_helix_angle_deg: float
    lead_m: float | None
    reference_diameter_m: float
    base_diameter_m: float
    tip_diameter_m: float
    root_diameter_m: float
    form_diameter_m: float
    undercut: bool
    virtual_teeth: float
    normal_thickness_m: float
    tip_thickness_m: float
    upper_thickness_allowance_m: float
    lower_thickness_allowance_m: float
    span_teeth: int
    span_m: float
    span_upper_m: float
    span_lower_m: float
    span_least_width_m: float
    ball_diameter_m: float
    over_balls_m: float
    over_balls_upper_m: float
    over_balls_lower_m: float
    tip_relief_m: float
    tip_relief_diameter_m: float | None
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class MeshSheetRow:
    """One mesh: the pair at its centre distance, its backlash and its stiffness.

    Pairs of numbers are of pinion and gear. `stiffness_n_per_m` is what the rotor model uses, along the flank normal, of all
    helices; the ISO values c'_th, c', c_gamma_alpha and c_gamma_beta are per face width in the transverse plane, in N/m^2
    (1e9 of it are 1 N/(mm um)). Velocity and tangential force F_t are those at the reference circle, forces of one helix.
    """

    name: str
    pinion: str
    gear: str
    ratio: float
    centre_distance_m: float
    reference_centre_distance_m: float
    profile_shift_sum: float
    common_width_m: float
    helices: int
    working_pressure_angle_deg: float
    working_helix_angle_deg: float
    base_helix_angle_deg: float
    transverse_contact_ratio: float
    overlap_ratio: float
    total_contact_ratio: float
    base_pitch_m: float
    approach_length_m: float
    recess_length_m: float
    working_pitch_diameter_m: tuple[float, float]
    active_root_diameter_m: tuple[float, float]
    tip_clearance_m: tuple[float, float]
    transverse_backlash_m: float
    normal_backlash_least_m: float
    normal_backlash_mean_m: float
    normal_backlash_most_m: float
    least_contact_line_m: float
    mean_contact_line_m: float
    largest_contact_line_m: float
    iso_theoretical_stiffness_n_per_m2: float
    iso_single_stiffness_n_per_m2: float
    iso_mesh_stiffness_n_per_m2: float
    iso_lead_stiffness_n_per_m2: float
    stiffness_model: str
    stiffness_n_per_m: float
    stiffness_peak_to_peak_n_per_m: float
    stiffness_definition: str
    stiffness_body: str
    pitch_line_velocity_m_per_s: float | None
    tangential_force_n: float | None
    base_tangential_force_n: float | None
    dynamic_factor: float | None
    dynamic_factor_method: str
    resonance_ratio: float | None
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class GearSheet:
    """All gears and meshes with teeth of a model; `pairs` are the teeth of each mesh, for drawing."""

    title: str
    gears: tuple[GearRow, ...]
    meshes: tuple[MeshSheetRow, ...]
    left_out: tuple[str, ...]
    pairs: dict[str, ToothPair]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are the attributes'."""
        data = asdict(self)
        del data["pairs"]
        return {"analysis": "gear", **data}
