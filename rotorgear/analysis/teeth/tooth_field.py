"""Displacement, stress and pressure of loaded teeth at one position, in the place where they mesh.

The pinion's axis is the z axis, the gear's stands on +y. The pinion pushes clockwise, and contact runs ahead at larger z; the
other hand and the other flanks are the mirror image. With roll length xi of pair k in the middle of the face, the tooth is turned
by xi/r_b - (half angle at the base circle) - a_w from +y.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.teeth.request import mesh_request
from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.loaded.contact_points import patch_loads
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, loaded_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem, gear_key, in_space
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.sector import clockwise
from rotorgear.gears.tooth_fe.tooth_solution import TeethSolution, solve_teeth
from rotorgear.model.layout.mesh_layout import mirrored
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.tooth_field import ContactField, ToothField, ToothFields


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
    teeth = request.teeth if request.senses[0] > 0 else mirrored(request.teeth)
    if in_space(teeth)[1]:
        raise AnalysisError(
            "The preview of a pair that changes along the face has no body to show: take --preset default."
        )
    if any(teeth.fe.body_of(body.blank) == "wheel" for body in (teeth.first_body, teeth.second_body)):
        teeth = replace(teeth, fe=replace(teeth.fe, space=True))  # a web carries a part of the face only
    problem, cycle = loaded_cycle(teeth, request.base_force, np.array([at]), part_of(progress, 0.0, 0.4))
    names = tuple(gear.name for gear in request.mesh.gears)
    fields = [
        _gear(names[i], teeth, problem, cycle, at, i, part_of(progress, 0.4 + 0.3 * i, 0.7 + 0.3 * i)) for i in (0, 1)
    ]
    progress(1.0, "done")
    return ToothFields(request.name, at, (fields[0], fields[1]), _contact(problem, cycle, at))


def _gear(
    name: str, teeth: ToothPair, problem: ContactProblem, cycle: MeshCycle, at: float, gear: int, progress: Progress
) -> ToothField:
    gear_body = (teeth.first_body, teeth.second_body)[gear]
    key = gear_key(teeth, gear, space=in_space(teeth)[0])
    solution = solve_teeth(key, _loads(problem, cycle, gear), progress)
    module = problem.module
    # A plane model carries the force of a unit width.
    thickness = module if key.width else teeth.width
    # Compliances are kept for a Young's modulus of 1.
    stretch = 1.0 / (gear_body.youngs_modulus * thickness)
    strength = 1.0 / (thickness * module)
    stress = [solution.pitch.stress(u) for u in solution.displacement]
    mises, largest = (strength * np.concatenate([part[i] for part in stress]) for i in (0, 1))
    fillet = np.concatenate([part[1][solution.pitch.fillet] for part in stress])
    points, moved = _placed(solution, problem, teeth, at, gear)
    cells = _vtk_cells(solution, flipped=gear == 0 and bool(key.width))
    n = len(solution.pitch.points)
    return ToothField(
        name,
        module * points,
        np.concatenate([cells + i * n for i in range(len(solution.teeth))]),
        np.repeat(solution.teeth, n),
        stretch * moved,
        mises,
        largest,
        strength * float(fillet.max()),
    )


def _loads(problem: ContactProblem, cycle: MeshCycle, gear: int) -> dict[int, np.ndarray]:
    """Forces along the outward normals at the flank nodes by tooth, counted clockwise in the gear's own frame (N)."""
    slices = cycle.slices
    place = problem.place(gear, slices.z)
    spread = patch_loads(slices, gear, problem.compliance[gear], problem.module, place, cycle.patch, problem.patch)
    side = 1 if gear == 0 else -1
    loads = {}
    for pair in np.unique(slices.pair[cycle.force > 0.0]):
        of_pair = slices.pair == pair
        loads[side * int(pair)] = -np.asarray(spread.loads[of_pair].T @ cycle.force[of_pair])
    return loads


def _placed(
    solution: TeethSolution, problem: ContactProblem, teeth: ToothPair, at: float, gear: int
) -> tuple[np.ndarray, np.ndarray]:
    """Points in normal modules and displacements, both in space and in the place of the mesh."""
    line = problem.line
    g = (teeth.first, teeth.second)[gear]
    outline = tooth_outline(g)
    pitch = solution.pitch
    first = line.pitch_point + at * line.base_pitch
    roll = first if gear == 0 else line.length - first
    start = roll / g.base_radius - outline.base_half_angle - line.pressure_angle
    points = []
    moved = []
    for tooth, u in zip(solution.teeth, solution.displacement, strict=True):
        R = clockwise(start + 2.0 * np.pi * tooth / g.teeth, pitch.dimension)
        points.append(pitch.points @ R.T)
        moved.append(u @ R.T)
    x = np.concatenate(points)
    u = np.concatenate(moved)
    if gear == 1:  # the gear is the pinion's kind of body, seen through the middle of the face
        x = -x
        u = -u
        x[:, 1] += line.centre_distance / problem.module
    if pitch.dimension == 2:
        x, u = (np.pad(values, ((0, 0), (0, 1))) for values in (x, u))
    return x, u


def _vtk_cells(solution: TeethSolution, *, flipped: bool) -> np.ndarray:
    """Nodes of the elements of one pitch in VTK's order; `flipped`: of the mirror image."""
    places = np.array(solution.pitch.basis.elem.doflocs, float)
    wanted = _VTK_QUAD if places.shape[1] == 2 else _VTK_HEX
    if flipped:
        wanted = wanted * np.array([1, 1, -1]) + np.array([0, 0, 1])
    order = [int(np.argmin(np.abs(places - place).sum(axis=1))) for place in wanted]
    cells = solution.pitch.cells.reshape(-1, len(places))
    return np.asarray(cells[:, order])


def _contact(problem: ContactProblem, cycle: MeshCycle, at: float) -> ContactField:
    """The loaded slices as pieces of contact lines on the plane of action."""
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
    return ContactField(
        np.stack([x, y, z], -1),
        cycle.force[loaded] / length,
        cycle.strip[loaded],
        cycle.pressure[loaded],
        slices.pair[loaded],
    )


_VTK_QUAD = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5], [0.5, 0.5]])
_FACE = [[0, 0], [1, 0], [1, 1], [0, 1]]
_EDGE = [[0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5]]
_VTK_HEX = np.array(
    [[*p, 0] for p in _FACE]
    + [[*p, 1] for p in _FACE]
    + [[*p, 0] for p in _EDGE]
    + [[*p, 1] for p in _EDGE]
    + [[*p, 0.5] for p in _FACE]
    + [[0, 0.5, 0.5], [1, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 1, 0.5], [0.5, 0.5, 0], [0.5, 0.5, 1], [0.5, 0.5, 0.5]],
    float,
)
