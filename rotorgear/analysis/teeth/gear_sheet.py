"""The verb behind `rotorgear gear`: geometry, measures, backlash and stiffness of all teeth of a model.

K_v of a mesh of a model: ISO 6336-1 method B where its inputs are given, else the simple form, else the reason why not.
"""

from __future__ import annotations

import math

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.cutter import cutter
from rotorgear.gears.geometry.flank_tolerance import base_pitch_deviation, profile_form_deviation
from rotorgear.gears.geometry.geometry import GearGeometry, check_gear
from rotorgear.gears.geometry.line_of_action import generated_line
from rotorgear.gears.geometry.measure import best_span, normal_thickness, over_balls, span_width, with_allowance
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.geometry.pair import profile_shift_sum, standard_centre_distance
from rotorgear.gears.stiffness.contact_lines import contact_line_length, mean_contact_line_length
from rotorgear.gears.stiffness.dynamic_factor import (
    DynamicFactor,
    iso_dynamic_factor,
    reduced_mass,
    simple_dynamic_factor,
)
from rotorgear.gears.stiffness.iso import pair_iso_stiffness
from rotorgear.gears.stiffness_models import NEEDS_LOAD
from rotorgear.model.checks.gears import ball_diameter
from rotorgear.model.checks.meshes import mesh_findings
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.layout.torque_flow import applied_torques
from rotorgear.model.model import Model
from rotorgear.model.parts.gear import Gear
from rotorgear.results.gear_sheet import GearRow, GearSheet, MeshSheetRow


def mesh_dynamic_factor(model: Model, name: str, base_force: float | None) -> DynamicFactor | str:
    """K_v of one mesh at the operating point, or the sentence that says what is missing.

    Args:
        model: a checked model.
        name: of a mesh between gears with teeth.
        base_force: F_bt (N) of one helix; None where no load is known.
    """
    mesh = model.layout.mesh(name)
    speed = model.operating_speed
    grades = [gear.part.accuracy_grade for gear in mesh.gears if gear.part.accuracy_grade is not None]
    if len(grades) < 2:
        return "K_v: give accuracy_grade of both gears"
    if not speed or not base_force:
        return "K_v: give the speed and the load of the operating point"
    teeth = mesh.teeth
    # The pinion of the standard is the gear with fewer teeth.
    order, geometry = zip(
        *sorted(zip(mesh.gears, (teeth.first, teeth.second), strict=True), key=lambda item: abs(item[1].teeth)),
        strict=True,
    )
    pinion, wheel = geometry
    spin = abs(mesh.turns(order[0]) * speed)
    line_load = mesh.part.application_factor * base_force * math.cos(pinion.transverse_pressure_angle) / teeth.width
    velocity = 0.5 * pinion.reference_diameter * spin
    ratio = abs(wheel.teeth / pinion.teeth)
    inertias = [gear.body.polar_inertia / mesh.helices for gear in order]
    try:
        if min(inertias) <= 0.0:
            worst = max(grades)
            return simple_dynamic_factor(velocity, pinion.teeth, ratio, line_load, teeth.pair.overlap_ratio, worst)
        stiffness = pair_iso_stiffness(teeth, line_load)
        return iso_dynamic_factor(
            pinion_teeth=pinion.teeth,
            ratio=ratio,
            pinion_speed=spin,
            pitch_line_velocity=velocity,
            total_contact_ratio=teeth.pair.total_contact_ratio,
            line_load=line_load,
            single_stiffness=stiffness.single,
            mesh_stiffness=stiffness.mesh_alpha,
            reduced_mass=reduced_mass(inertias, (pinion.base_radius, wheel.base_radius), teeth.width),
            # Deviations are those of the tolerance classes.
            base_pitch_deviation=max(map(base_pitch_deviation, (teeth.first, teeth.second), grades)),
            profile_deviation=max(map(profile_form_deviation, (teeth.first, teeth.second), grades)),
            tip_relief=min(gear.part.tip_relief for gear in order),
        )
    except AnalysisError as error:
        return f"K_v: {error}"


_POSITIONS = 256


@recorded
def gear(model: Model, mesh: str | None = None) -> GearSheet:
    """Return the sheet of all gears and meshes with teeth, or of one mesh and its two gears.

    Args:
        model: a checked model.
        mesh: name of a mesh, for it and its two gears alone (default: all).

    Raises:
        AnalysisError: no such mesh, or nothing with teeth.
    """
    if mesh is not None and mesh not in model.meshes:
        raise AnalysisError(f"There is no mesh '{mesh}': the model has {', '.join(model.meshes) or 'none'}.")
    meshes = [item for item in model.layout.meshes if mesh in (None, item.name)]
    wanted = [gear.name for item in meshes for gear in item.gears] if mesh else list(model.gears)
    toothed = [gear for gear in model.layout.gears if gear.name in wanted and gear.geometry]
    if not toothed:
        raise AnalysisError(
            "The model has no gears with teeth: those given by base_radius and bevel gears have no tooth geometry here."
        )
    whole = [item for item in meshes if item.pinion.geometry]
    lumped = [name for name, gear in model.gears.items() if name in wanted and not gear.geometry]
    rows = tuple(_mesh(model, item) for item in whole)
    left_out = [
        f"gears.{name}: {'a bevel gear' if model.layout.gear(name).part.is_bevel else 'given by its base radius, without teeth'}"
        for name in lumped
    ]
    left_out += [
        f"meshes.{row.name}: the stiffness of '{row.stiffness_model}' is that of loaded teeth, and no torque flows: give torque, "
        "power or loads"
        for row in rows
        if row.stiffness_n_per_m is None
    ]
    return GearSheet(
        title=model.title,
        gears=tuple(_gear(gear.name, gear.part) for gear in toothed),
        meshes=rows,
        left_out=tuple(left_out),
        pairs={item.name: item.teeth for item in whole},
    )


def _gear(name: str, gear: Gear) -> GearRow:
    g = gear.geometry
    assert g is not None
    outline = tooth_outline(g)
    allowance = gear.allowance
    ball = ball_diameter(gear, g)
    # A span needs flanks that face away from each other: those of a ring don't.
    k = None if g.is_internal else best_span(g)
    thick = with_allowance(g, allowance.upper)
    thin = with_allowance(g, allowance.lower)
    return GearRow(
        name=name,
        kind=gear.kind,
        hand=gear.hand,
        internal=g.is_internal,
        teeth=abs(g.teeth),
        normal_module_m=g.normal_module,
        normal_pressure_angle_deg=math.degrees(g.normal_pressure_angle),
        helix_angle_deg=math.degrees(g.helix_angle),
        profile_shift=g.profile_shift,
        addendum_factor=g.addendum_factor,
        dedendum_factor=g.dedendum_factor,
        root_radius_factor=cutter(g).tip_rounding / g.normal_module if g.is_internal else g.tool_tip_radius_factor,
        face_width_m=gear.width or 0.0,
        transverse_module_m=g.transverse_module,
        transverse_pressure_angle_deg=math.degrees(g.transverse_pressure_angle),
        base_helix_angle_deg=math.degrees(g.base_helix_angle),
        lead_m=g.lead if g.helix_angle else None,
        reference_diameter_m=abs(g.reference_diameter),
        base_diameter_m=2.0 * abs(g.base_radius),
        tip_diameter_m=abs(g.effective_tip_diameter),
        root_diameter_m=abs(g.root_diameter),
        form_diameter_m=2.0 * outline.form_radius,
        undercut=outline.undercut,
        virtual_teeth=abs(g.virtual_teeth),
        normal_thickness_m=normal_thickness(g),
        tip_thickness_m=g.normal_tip_thickness,
        upper_thickness_allowance_m=allowance.upper,
        lower_thickness_allowance_m=allowance.lower,
        span_teeth=k,
        span_m=k and g.base_tangent_length(k),
        span_upper_m=k and thick.base_tangent_length(k),
        span_lower_m=k and thin.base_tangent_length(k),
        span_least_width_m=k and span_width(g, k),
        ball_diameter_m=ball,
        over_balls_m=over_balls(g, ball),
        over_balls_upper_m=over_balls(thick, ball),
        over_balls_lower_m=over_balls(thin, ball),
        tip_relief_m=gear.tip_relief,
        tip_relief_diameter_m=gear.tip_relief_diameter,
        warnings=tuple(check_gear(g)),
    )


def _mesh(model: Model, mesh: MeshLayout) -> MeshSheetRow:
    teeth = mesh.teeth
    g1 = teeth.first
    g2 = teeth.second
    pair = teeth.pair
    backlash = mesh.backlash
    lines = contact_line_length(teeth, (np.arange(_POSITIONS) + 0.5) / _POSITIONS)
    line = generated_line(g1, g2, pair, (teeth.first_flank.tip_break, teeth.second_flank.tip_break))
    iso = pair_iso_stiffness(teeth)
    force = 0.0
    sense = 1
    if applied_torques(model.layout)[0]:
        forces = model.torque_flow().of_mesh(mesh.name)
        force = sum(force.normal_force for force in forces) / len(forces)
        sense = forces[0].torque_sense
    given = mesh.part.stiffness
    known = not mesh.is_rigid and (bool(force) or given not in NEEDS_LOAD)
    curve = mesh.stiffness(force or None, sense=sense).about_load if known else None
    base = math.cos(pair.base_helix_angle)
    dynamic = mesh_dynamic_factor(model, mesh.name, force * base or None)
    factor = dynamic if isinstance(dynamic, DynamicFactor) else None
    notes = [*mesh_findings(mesh), *(curve.warnings if curve else ()), *(factor.warnings if factor else ())]
    if factor and factor.resonance_ratio:
        notes += [
            f"K_v: '{gear}' has other mates too; N and K_v are those of this pair by itself"
            for gear in (mesh.part.pinion, mesh.part.gear)
            if sum(gear in (other.pinion, other.gear) for other in model.meshes.values()) > 1
        ]
    speed = model.operating_speed
    cosine = math.cos(pair.working_transverse_pressure_angle)
    active = pair.active_root_diameters(g1, g2)
    return MeshSheetRow(
        name=mesh.name,
        pinion=mesh.pinion.name,
        gear=mesh.gear.name,
        ratio=abs(g2.teeth / g1.teeth),
        centre_distance_m=abs(pair.centre_distance),
        reference_centre_distance_m=abs(standard_centre_distance(g1, g2)),
        profile_shift_sum=profile_shift_sum(g1, g2, pair.centre_distance),
        common_width_m=teeth.width,
        helices=mesh.helices,
        working_pressure_angle_deg=math.degrees(pair.working_transverse_pressure_angle),
        working_helix_angle_deg=math.degrees(pair.working_helix_angle),
        base_helix_angle_deg=math.degrees(pair.base_helix_angle),
        transverse_contact_ratio=pair.transverse_contact_ratio,
        overlap_ratio=pair.overlap_ratio,
        total_contact_ratio=pair.total_contact_ratio,
        involute_contact_ratio=line.contact_ratio,
        base_pitch_m=teeth.first.transverse_base_pitch,
        approach_length_m=-pair.start_of_contact,
        recess_length_m=pair.end_of_contact,
        # d_w = d_b / cos a_wt
        working_pitch_diameter_m=(2.0 * g1.base_radius / cosine, 2.0 * abs(g2.base_radius) / cosine),
        active_root_diameter_m=(active[0], abs(active[1])),
        tip_clearance_m=(_clearance(g1, g2, pair.centre_distance), _clearance(g2, g1, pair.centre_distance)),
        transverse_backlash_m=pair.transverse_backlash,
        normal_backlash_least_m=backlash.least,
        normal_backlash_mean_m=backlash.mean,
        normal_backlash_most_m=backlash.most,
        least_contact_line_m=float(lines.min()),
        mean_contact_line_m=mean_contact_line_length(teeth),
        largest_contact_line_m=float(lines.max()),
        iso_theoretical_stiffness_n_per_m2=iso.theoretical,
        iso_single_stiffness_n_per_m2=iso.single,
        iso_mesh_stiffness_n_per_m2=iso.mesh_alpha,
        iso_lead_stiffness_n_per_m2=iso.mesh_beta,
        stiffness_model=given if isinstance(given, str) else "given",
        stiffness_n_per_m=curve.mean_normal if curve else None,
        stiffness_peak_to_peak_n_per_m=curve.peak_to_peak / base**2 if curve else None,
        stiffness_definition=curve.definition if curve else None,
        stiffness_body=curve.body if curve else None,
        pitch_line_velocity_m_per_s=(
            0.5 * g1.reference_diameter * abs(mesh.turns(mesh.pinion) * speed) if speed else None
        ),
        tangential_force_n=force * base * math.cos(g1.transverse_pressure_angle) if force else None,
        base_tangential_force_n=force * base if force else None,
        dynamic_factor=factor.value if factor else None,
        resonance_ratio=factor.resonance_ratio if factor else None,
        dynamic_factor_method=dynamic if isinstance(dynamic, str) else dynamic.method,
        warnings=tuple(notes),
    )


def _clearance(g: GearGeometry, mate: GearGeometry, distance: float) -> float:
    """c (m) between the tip circle of a gear and the root circle of its mate, signs as of ISO 21771."""
    return distance - 0.5 * (g.effective_tip_diameter + mate.root_diameter)
