"""K_v of a mesh of a model: ISO 6336-1 method B where its inputs are given, else the simple form, else the reason why not."""

from __future__ import annotations

import math

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.flank_tolerance import base_pitch_deviation, profile_form_deviation
from rotorgear.gears.stiffness.dynamic_factor import (
    DynamicFactor,
    DynamicMesh,
    iso_dynamic_factor,
    reduced_mass,
    simple_dynamic_factor,
)
from rotorgear.gears.stiffness.iso import pair_iso_stiffness
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.model.model import Model


def mesh_dynamic_factor(model: Model, name: str, base_force: float | None) -> DynamicFactor | str:
    """K_v of one mesh at the operating point, or the sentence that says what is missing.

    Args:
        model: a checked model.
        name: of a mesh between gears with teeth.
        base_force: F_bt (N) of one helix; None where no load is known.
    """
    mesh = model.layout.mesh(name)
    speed = model.operation.speed if model.operation else None
    grades = [gear.part.accuracy_grade for gear in mesh.gears]
    if grades[0] is None or grades[1] is None:
        return "K_v: give accuracy_grade of both gears"
    if not speed or not base_force:
        return "K_v: give the speed and the load of the operating point"
    teeth = mesh.teeth
    order = mesh.gears
    if teeth.first.teeth > teeth.second.teeth:
        teeth = teeth.swapped()
        order = order[::-1]
        grades = grades[::-1]
    spin = abs(model.layout.train.ratio(order[0].shaft) * speed)
    line_load = (
        mesh.part.application_factor * base_force * math.cos(teeth.first.transverse_pressure_angle) / teeth.width
    )
    velocity = 0.5 * teeth.first.reference_diameter * spin
    inertias = [gear.body.polar_inertia / mesh.helices for gear in order]
    try:
        if min(inertias) > 0.0:
            relief = min(gear.part.tip_relief for gear in order)
            return iso_dynamic_factor(_method_b(teeth, spin, velocity, line_load, inertias, grades, relief))
        ratio = teeth.second.teeth / teeth.first.teeth
        worst = max(grade for grade in grades if grade is not None)
        return simple_dynamic_factor(velocity, teeth.first.teeth, ratio, line_load, teeth.pair.overlap_ratio, worst)
    except AnalysisError as error:
        return f"K_v: {error}"


def _method_b(
    teeth: ToothPair,
    spin: float,
    velocity: float,
    line_load: float,
    inertias: list[float],
    grades: list[int | None],
    relief: float,
) -> DynamicMesh:
    """Inputs of method B from the pair, pinion first; deviations are those of the tolerance classes."""
    g1 = teeth.first
    g2 = teeth.second
    stiffness = pair_iso_stiffness(teeth, line_load)
    classes = [(gear, grade) for gear, grade in zip((g1, g2), grades, strict=True) if grade is not None]
    return DynamicMesh(
        pinion_teeth=g1.teeth,
        ratio=g2.teeth / g1.teeth,
        pinion_speed=spin,
        pitch_line_velocity=velocity,
        total_contact_ratio=teeth.pair.total_contact_ratio,
        line_load=line_load,
        single_stiffness=stiffness.single,
        mesh_stiffness=stiffness.mesh_alpha,
        reduced_mass=reduced_mass(inertias[0], inertias[1], g1.base_radius, g2.base_radius, teeth.width),
        base_pitch_deviation=max(base_pitch_deviation(*item) for item in classes),
        profile_deviation=max(profile_form_deviation(*item) for item in classes),
        tip_relief=relief,
    )
