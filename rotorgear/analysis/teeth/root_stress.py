"""The verb behind `rotorgear root-stress`: stress in the fillets while a tooth passes through the mesh.

The loaded contact gives the forces on the flanks at each position, the inside of the teeth the stress for them. All teeth are
alike: tooth k at position u stands where tooth 0 is at u + k, so that one mesh period shows a tooth on its whole way.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.recorded import Clock, recorded
from rotorgear.analysis.teeth.request import Cycle, mesh_request, solve_helices
from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.outline import root_section, tooth_outline
from rotorgear.gears.loaded.contact_points import patch_loads
from rotorgear.gears.loaded.mesh_cycle import MeshCycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem, gear_key, in_space
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.tooth_solution import solve_teeth, tooth_inside
from rotorgear.model.layout.mesh_layout import mirrored
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.root_stress import GearRootStress, RootStress

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
        ConvergenceError: contact that does not come to rest.
        MissingExtraError: scikit-fem is not installed.
    """
    if not 4 <= positions <= 256:
        raise AnalysisError(f"--positions: got {positions}, expected 4 to 256 for root stresses")
    clock = Clock()
    request = mesh_request(model, mesh, "tooth_fe", torque, {"preset": preset, "body": body})
    assert request.teeth is not None
    assert request.load is not None
    # All teeth are taken alike: one odd tooth would stand in the fillets of all of them.
    single = request.teeth.first_flank.single_teeth or request.teeth.second_flank.single_teeth
    alike = replace(
        request.teeth,
        first_flank=request.teeth.first_flank.of_most_teeth,
        second_flank=request.teeth.second_flank.of_most_teeth,
    )
    teeth = alike if request.senses[0] > 0 else mirrored(alike)
    if in_space(teeth)[1]:
        raise AnalysisError(
            "The preview of a pair that changes along the face has no roots to show: take --preset default."
        )
    # Positions as for the curves of this helix: where teeth come and go, and where stiffness and pressure need them.
    first = replace(request, senses=request.senses[:1])
    found = solve_helices(first, alike, request.base_force, Cycle(positions), part_of(progress, 0.0, 0.2))
    problem = found.problem
    cycle = found.cycles[0]
    clock.lap("teeth and contact")
    names = tuple(gear.name for gear in request.mesh.gears)
    # Seen from the other end of the face, z runs the other way.
    end = request.senses[0]
    gears = [
        _gear(names[i], teeth, problem, cycle, i, end, part_of(progress, 0.2 + 0.4 * i, 0.6 + 0.4 * i)) for i in (0, 1)
    ]
    clock.lap("inside of the teeth")
    progress(1.0, "done")
    return RootStress(
        title=model.title,
        mesh=request.name,
        preset=teeth.fe.preset,
        pinion_torque_n_m=request.load.pinion_torque_n_m,
        positions=positions,
        gears=(gears[0], gears[1]),
        seconds=clock.total(),
        left_out=(
            "a strength rating: factors of load, size, surface and material",
            *(("errors of single teeth: all teeth are taken alike",) if single else ()),
            *(("the second helix",) if request.helices > 1 else ()),
        ),
        warnings=tuple(dict.fromkeys(problem.warnings + cycle.warnings)),
    )


def _gear(
    name: str, teeth: ToothPair, problem: ContactProblem, cycle: MeshCycle, gear: int, end: int, progress: Progress
) -> GearRootStress:
    g = (teeth.first, teeth.second)[gear]
    key = gear_key(teeth, gear, space=in_space(teeth)[0])
    section = root_section(tooth_outline(g))
    slices = cycle.slices
    place = problem.place(gear, slices.z)
    spread = patch_loads(slices, gear, problem.compliance[gear], problem.module, place, cycle.patch, problem.patch)
    side = 1 if gear == 0 else -1
    # A plane model carries the force of a unit width; compliances are those of lengths in normal modules.
    strength = 1.0 / ((problem.module if key.width else teeth.width) * problem.module)

    inside = tooth_inside(key, part_of(progress, 0.0, 0.3))
    progress = part_of(progress, 0.3, 1.0)

    phase: list[float] = []
    at_tangent: list[float] = []
    largest: list[float] = []
    places: list[tuple[float, float]] = []
    for number, u in enumerate(cycle.position):
        progress(number / len(cycle.position), f"{name}, position {number + 1} of {len(cycle.position)}")
        here = (slices.position == number) & (cycle.force > 0.0)
        loads = {
            side * int(pair): -np.asarray(
                spread.loads[here & (slices.pair == pair)].T @ cycle.force[here & (slices.pair == pair)]
            )
            for pair in np.unique(slices.pair[here])
        }
        solution = solve_teeth(key, loads, inside=inside)
        pitch = solution.pitch
        # Fillet nodes plane by plane; their angles about the axis from the middle of the tooth are those of the middle plane.
        fillet = pitch.fillet.reshape(len(pitch.turn), -1)
        middle = pitch.points[fillet[len(fillet) // 2]]
        order = np.argsort(np.abs(np.arctan2(middle[:, 0], middle[:, 1])))
        fillet = fillet[:, order]
        angle = np.abs(np.arctan2(middle[order, 0], middle[order, 1]))
        for tooth, displacement in zip(solution.teeth, solution.displacement, strict=True):
            stress = strength * pitch.stress(displacement)[1][fillet]
            phase.append(float(u) + side * int(tooth))
            at_tangent.append(max(float(np.interp(section.angle, angle, row)) for row in stress))
            plane, node = np.unravel_index(int(np.argmax(stress)), stress.shape)
            point = pitch.points[fillet[plane, node]]
            largest.append(float(stress[plane, node]))
            z = float(point[2]) * problem.module if pitch.dimension == 3 else 0.0
            # The gear's own face runs the other way than the pinion's.
            places.append((2.0 * problem.module * float(np.hypot(point[0], point[1])), end * side * z))
    order = np.argsort(phase)
    tangent = int(np.argmax(at_tangent))
    worst = int(np.argmax(largest))
    return GearRootStress(
        name=name,
        phase=np.array(phase)[order],
        at_tangent=np.array(at_tangent)[order],
        largest=np.array(largest)[order],
        tangent_diameter=2.0 * section.radius,
        tangent_thickness=section.thickness,
        worst_at_tangent=at_tangent[tangent],
        worst_at_tangent_phase=phase[tangent],
        worst=largest[worst],
        worst_phase=phase[worst],
        worst_diameter=places[worst][0],
        worst_z=places[worst][1],
        nominal=_nominal(teeth, problem, cycle, gear),
    )


def _nominal(teeth: ToothPair, problem: ContactProblem, cycle: MeshCycle, gear: int) -> float | None:
    """Nominal stress (Pa) with the whole load at the outer point of single contact; None for helical and high contact ratios."""
    line = problem.line
    if line.base_helix_angle or not 1.0 <= line.contact_ratio < 2.0:
        return None
    # The pinion carries alone up to D, one pitch after the start; the gear from B on, one pitch before the end.
    roll = line.start + line.base_pitch if gear == 0 else line.length - (line.end - line.base_pitch)
    section = root_section(tooth_outline((teeth.first, teeth.second)[gear]))
    return section.nominal_stress(cycle.load / teeth.width, roll)
