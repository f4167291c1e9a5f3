"""The inside of loaded teeth: stress in the fillets while a tooth passes through the mesh, and all fields at one position.

The loaded contact gives the forces on the flanks at each position, the finite elements the stress for them. For the fillets all
teeth are alike: tooth k at position u is where tooth 0 is at u + k, so that one mesh period shows a tooth on its whole way.

Fields are told in the place where the teeth mesh. The pinion's axis is the z axis, the gear's lies on +y. The pinion pushes
clockwise, and contact runs ahead at larger z; the other hand and the other flanks are the mirror image. With roll length xi of
pair k in the middle of the face, the tooth is turned by xi/r_b -+ (half angle at the base circle) - a_w from +y.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.teeth.request import mesh_request, solve_helices
from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.outline import root_section, tooth_outline
from rotorgear.gears.loaded.contact_points import patch_loads
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, loaded_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem, gear_key, in_space
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.sector import clockwise
from rotorgear.gears.tooth_fe.tooth_solution import ToothInside
from rotorgear.model.layout.mesh_layout import mirrored
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.root_stress import GearRootStress, RootStress
from rotorgear.results.tooth_field import ContactField, ToothField, ToothFields

POSITIONS = 24


@recorded
def root_stress(
    model: Model,
    mesh: str | None = None,
    *,
    torque: float | str | None = None,
    preset: str | None = None,
    body: str | None = None,
    positions: int = POSITIONS,
    progress: Progress = silent,
) -> RootStress:
    """Follow the stress in the root fillets of both gears of the first helix over the mesh cycle.

    Args:
        model: a checked model.
        mesh: as in `mesh`.
        torque: as in `mesh`.
        preset: as in `mesh`.
        body: as in `mesh`.
        positions: number of positions in the mesh period, 4 to 256.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mesh or load that can't be, or the preview of a helical pair, whose slices are no body.
        ConvergenceError: the contact does not converge.
        MissingExtraError: scikit-fem is not installed.
    """
    if not 4 <= positions <= 256:
        raise AnalysisError(f"--positions: got {positions}, expected 4 to 256 for root stresses")
    clock = Clock()
    request = mesh_request(model, mesh, "tooth_fe", torque, {"preset": preset, "body": body})
    assert request.teeth is not None
    assert request.load is not None
    flanks = (request.teeth.first_flank, request.teeth.second_flank)
    # All teeth are taken alike: an error of one tooth would show in the fillets of all of them.
    alike = replace(request.teeth, first_flank=flanks[0].of_most_teeth, second_flank=flanks[1].of_most_teeth)
    end = request.senses[0]
    teeth = _with_inside(alike, end, "roots")
    # Positions as for the curves of this helix: where teeth come and go, and where stiffness and pressure need them.
    first = replace(request, senses=request.senses[:1])
    found = solve_helices(first, alike, positions, progress=part_of(progress, 0.0, 0.2))
    problem = found.problem
    cycle = found.cycles[0]
    clock.lap("teeth and contact")
    pinion, gear = (
        _root_stress_of(gear.name, teeth, problem, cycle, i, end, part_of(progress, 0.2 + 0.4 * i, 0.6 + 0.4 * i))
        for i, gear in enumerate(request.mesh.gears)
    )
    clock.lap("inside of the teeth")
    progress(1.0, "done")
    left_out = ["a strength rating: factors of load, size, surface and material"]
    if any(flank.single_teeth for flank in flanks):
        left_out.append("errors of single teeth: all teeth are taken alike")
    if request.mesh.helices > 1:
        left_out.append("the second helix")
    return RootStress(
        title=model.title,
        mesh=request.mesh.name,
        preset=teeth.fe.preset,
        pinion_torque_n_m=request.load.pinion_torque_n_m,
        positions=positions,
        gears=(pinion, gear),
        seconds=clock.total(),
        left_out=tuple(left_out),
        warnings=tuple(dict.fromkeys(problem.warnings + cycle.warnings)),
    )


def _with_inside(teeth: ToothPair, ahead: int, what: str) -> ToothPair:
    """One helix along the path of contact; AnalysisError where its model has no inside, and so not what is asked for."""
    teeth = teeth if ahead > 0 else mirrored(teeth)
    if in_space(teeth)[1]:
        raise AnalysisError(
            f"The preview of a pair that changes along the face has no {what} to show: take --preset default."
        )
    return teeth


def _root_stress_of(
    name: str, teeth: ToothPair, problem: ContactProblem, cycle: MeshCycle, gear: int, end: int, progress: Progress
) -> GearRootStress:
    """Stress in the fillets of the pinion (0) or the gear (1); `end` is -1 where z runs from the other end of the face."""
    key = gear_key(teeth, gear, space=in_space(teeth)[0])
    g = (teeth.first, teeth.second)[gear]
    section = root_section(tooth_outline(g))
    side = 1 if gear == 0 else -1
    loads_at = _tooth_loads(problem, cycle, gear)
    module = problem.module
    # A plane model carries the force of a unit width; compliances are those of lengths in normal modules.
    strength = 1.0 / ((module if key.width else teeth.width) * module)

    inside = ToothInside(key, part_of(progress, 0.0, 0.3))
    pitch = inside.pitch
    progress = part_of(progress, 0.3, 1.0)
    # Fillet nodes plane by plane; their angles about the axis from the middle of the tooth are those of the middle plane.
    fillet = pitch.fillet.reshape(len(pitch.turn), -1)
    middle = pitch.points[fillet[len(fillet) // 2]]
    angle = np.abs(np.arctan2(middle[:, 0], g.sign * middle[:, 1]))
    order = np.argsort(angle)
    fillet = fillet[:, order]
    rows = []
    for number, u in enumerate(cycle.position):
        progress(number / len(cycle.position), f"{name}, position {number + 1} of {len(cycle.position)}")
        for tooth, displacement in zip(*inside.solve(loads_at(number)), strict=True):
            stress = strength * pitch.stress(displacement)[1][fillet]
            plane, node = np.unravel_index(int(np.argmax(stress)), stress.shape)
            x, y, *height = pitch.points[fillet[plane, node]]
            rows.append(
                (
                    u + side * tooth,
                    max(np.interp(section.angle, angle[order], row) for row in stress),
                    stress[plane, node],
                    2.0 * module * np.hypot(x, y),
                    # The gear's own face runs the other way than the pinion's.
                    end * side * (height[0] * module if height else 0.0),
                )
            )
    phase, at_tangent, largest, diameter, z = np.array(rows).T
    # The whole load at the outer point of single contact: the pinion carries alone up to D, one pitch after the start, the gear
    # from B on, one pitch before the end. Helical teeth and high contact ratios have none.
    nominal = None
    line = problem.line
    if not line.base_helix_angle and 1.0 <= line.contact_ratio < 2.0:
        roll = line.start + line.base_pitch if gear == 0 else line.length - (line.end - line.base_pitch)
        nominal = section.nominal_stress(cycle.load / teeth.width, roll)
    by_phase = np.argsort(phase)
    tangent = int(np.argmax(at_tangent))
    worst = int(np.argmax(largest))
    return GearRootStress(
        name=name,
        phase=phase[by_phase],
        at_tangent=at_tangent[by_phase],
        largest=largest[by_phase],
        tangent_diameter=2.0 * section.radius,
        tangent_thickness=section.thickness,
        worst_at_tangent=float(at_tangent[tangent]),
        worst_at_tangent_phase=float(phase[tangent]),
        worst=float(largest[worst]),
        worst_phase=float(phase[worst]),
        worst_diameter=float(diameter[worst]),
        worst_z=float(z[worst]),
        nominal=nominal,
    )


def _tooth_loads(problem: ContactProblem, cycle: MeshCycle, gear: int) -> Callable[[int], dict[int, np.ndarray]]:
    """Forces (N) along the outward normals at the flank nodes at a position of the cycle, by its number.

    They are given for each tooth; teeth are counted clockwise in the gear's own frame.
    """
    slices = cycle.slices
    spread = patch_loads(slices, gear, problem.compliance[gear], problem.module, cycle.patch, problem.patch)
    side = 1 if gear == 0 else -1

    def at(number: int) -> dict[int, np.ndarray]:
        here = (slices.position == number) & (cycle.force > 0.0)
        loads = {}
        for pair in np.unique(slices.pair[here]):
            of_pair = here & (slices.pair == pair)
            loads[side * int(pair)] = -np.asarray(spread.loads[of_pair].T @ cycle.force[of_pair])
        return loads

    return at


@recorded
def tooth_fields(
    model: Model,
    mesh: str | None = None,
    *,
    torque: float | str | None = None,
    preset: str | None = None,
    body: str | None = None,
    at: float = 0.0,
    progress: Progress = silent,
) -> ToothFields:
    """Solve the inside of the teeth of the first helix of a mesh at one position.

    Args:
        model, mesh, torque, preset, body: as for `mesh`.
        at: position in mesh periods.

    Raises:
        AnalysisError: a mesh or load that can't be, or the preview of a helical pair, whose slices are no body.
    """
    request = mesh_request(model, mesh, "tooth_fe", torque, {"preset": preset, "body": body})
    assert request.teeth is not None
    teeth = _with_inside(request.teeth, request.senses[0], "body")
    if teeth.on_wheel:
        teeth = replace(teeth, fe=replace(teeth.fe, space=True))  # a web carries a part of the face only
    problem, cycle = loaded_cycle(teeth, request.base_force, np.array([at]), part_of(progress, 0.0, 0.4))
    pinion, gear = (
        _field(gear.name, teeth, problem, cycle, at, i, part_of(progress, 0.4 + 0.3 * i, 0.7 + 0.3 * i))
        for i, gear in enumerate(request.mesh.gears)
    )
    progress(1.0, "done")
    # The loaded slices as pieces of contact lines on the plane of action.
    line = problem.line
    slices = cycle.slices
    loaded = cycle.force > 0.0
    z = (slices.z @ slices.weight)[loaded, None] + 0.5 * slices.length[loaded, None] * np.array([-1.0, 1.0])
    roll = line.pitch_point + (at + slices.pair[loaded, None]) * line.base_pitch + z * np.tan(line.base_helix_angle)
    c = np.cos(line.pressure_angle)
    s = np.sin(line.pressure_angle)
    x = roll * c - line.base_radius[0] * s
    y = roll * s + line.base_radius[0] * c
    length = slices.length[loaded] / np.cos(line.base_helix_angle)
    contact = ContactField(
        np.stack([x, y, z], -1),
        cycle.force[loaded] / length,
        cycle.strip[loaded],
        cycle.pressure[loaded],
        slices.pair[loaded],
    )
    return ToothFields(request.mesh.name, at, (pinion, gear), contact)


def _field(
    name: str, teeth: ToothPair, problem: ContactProblem, cycle: MeshCycle, at: float, gear: int, progress: Progress
) -> ToothField:
    """Displacements and stresses in the teeth of the pinion (0) or the gear (1), in the place where they mesh."""
    key = gear_key(teeth, gear, space=in_space(teeth)[0])
    inside = ToothInside(key, part_of(progress, 0.0, 0.4))
    numbers, displacement = inside.solve(_tooth_loads(problem, cycle, gear)(0), part_of(progress, 0.4, 1.0))
    pitch = inside.pitch
    module = problem.module
    # A plane model carries the force of a unit width, and compliances are kept for a Young's modulus of 1.
    thickness = module if key.width else teeth.width
    stretch = 1.0 / ((teeth.first_body, teeth.second_body)[gear].youngs_modulus * thickness)
    strength = 1.0 / (thickness * module)
    stress = [pitch.stress(u) for u in displacement]
    mises, largest = (strength * np.concatenate([part[i] for part in stress]) for i in (0, 1))
    fillet = np.concatenate([part[1][pitch.fillet] for part in stress])
    # Nodes of the elements of one pitch in VTK's order.
    places = np.array(pitch.basis.elem.doflocs, float)
    wanted = _VTK_QUAD if places.shape[1] == 2 else _VTK_HEX
    if gear == 0 and key.width:  # the mirror image
        wanted = wanted * np.array([1, 1, -1]) + np.array([0, 0, 1])
    order = [int(np.argmin(np.abs(places - place).sum(axis=1))) for place in wanted]
    cells = pitch.cells.reshape(-1, len(places))[:, order]

    # Points in normal modules and displacements, in the place of the mesh.
    line = problem.line
    g = (teeth.first, teeth.second)[gear]
    first = line.pitch_point + at * line.base_pitch
    roll = first if gear == 0 else line.length - first
    start = roll / g.base_radius - g.sign * tooth_outline(g).base_half_angle - line.pressure_angle
    turn = [clockwise(start + 2.0 * np.pi * tooth / g.teeth, pitch.dimension).T for tooth in numbers]
    x = np.concatenate([pitch.points @ R for R in turn])
    moved = np.concatenate([u @ R for u, R in zip(displacement, turn, strict=True)])
    if gear == 1:  # the gear is the pinion's kind of body, seen through the middle of the face
        x = -x
        moved = -moved
        x[:, 1] += line.centre_distance / module
    if pitch.dimension == 2:
        x, moved = (np.pad(values, ((0, 0), (0, 1))) for values in (x, moved))
    n = len(pitch.points)
    return ToothField(
        name,
        module * x,
        np.concatenate([cells + i * n for i in range(len(numbers))]),
        np.repeat(numbers, n),
        stretch * moved,
        mises,
        largest,
        strength * float(fillet.max()),
    )


_VTK_QUAD = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5], [0.5, 0.5]])
_FACE = _VTK_QUAD[:4].tolist()
_EDGE = _VTK_QUAD[4:8].tolist()
_VTK_HEX = np.array(
    [[*p, 0] for p in _FACE]
    + [[*p, 1] for p in _FACE]
    + [[*p, 0] for p in _EDGE]
    + [[*p, 1] for p in _EDGE]
    + [[*p, 0.5] for p in _FACE]
    + [[0, 0.5, 0.5], [1, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 1, 0.5], [0.5, 0.5, 0], [0.5, 0.5, 1], [0.5, 0.5, 0.5]],
    float,
)
