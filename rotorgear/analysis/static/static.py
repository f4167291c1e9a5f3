"""Static deflections, forces and load sharing of a gearbox under torques, weight and index errors."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.common.points import point_amplitudes
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_request, direction_of, missed, speed_or_operating
from rotorgear.analysis.common.stations import displacement_places, shapes_at_stations
from rotorgear.analysis.static.along_faces import decided_by_loads, equilibrate_along_faces, misalignments
from rotorgear.analysis.static.axial_travel import soft_along_shaft
from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.forces import (
    bearing_forces,
    casing_forces,
    forces_on_gears,
    ground_forces,
    imbalance,
    rigid_forces,
    seat_forces,
    support_forces,
)
from rotorgear.analysis.static.internal_loads import load_rows_of
from rotorgear.analysis.static.sensitivity import sensitivities
from rotorgear.analysis.static.shares import helix_shares, share_rows
from rotorgear.analysis.static.solve import Equilibrated, equilibrate, is_loaded
from rotorgear.errors import AnalysisError
from rotorgear.gears.stiffness.face_load import uniform_line
from rotorgear.model.layout.layout import MOST_MISSED
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.laws import law_rows
from rotorgear.results.static import LoopAssembly, MeshFace, StaticResult
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# Enough for a smooth line of deflection; the forces do not depend on it.
DEFAULT_ELEMENTS = 4
# Teeth that don't feel their shafts: a face load factor above this, by a line of springs, is worth a warning.
_NOTICED = 1.1
_HALVINGS = 4


@recorded
def static(
    model: Model,
    *,
    speed: float | str | None = None,
    elements: int | None = None,
    accuracy: float | None = None,
    tilt: bool = False,
    progress: Progress = silent,
) -> StaticResult:
    """Return deflections, forces, load sharing and its sensitivities.

    Args:
        model: a model with torques, forces or moments, gravity or index errors.
        speed: speed of the input shaft in rad/s or with its unit; its sign chooses the working flanks, and bearings with tables
            take their values at it (default: the operating speed).
        elements: number of basic elements in each shaft segment, which are exact in statics (default: 4).
        accuracy: halve the elements until the forces are estimated to be within this relative error of the largest.
        tilt: all meshes between gears with a width feel the tilt of their shafts, whatever the model says.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: nothing loads the model, it is a mechanism that the loads push, or no set of flanks carries them.
        ConvergenceError: shafts and loads along the faces don't come to agree.
    """
    given = speed_or_operating(speed, model)
    check_request(elements=elements, accuracy=accuracy)
    if tilt:
        wide = [name for name in model.meshes if all(gear.part.width for gear in model.layout.mesh(name).gears)]
        if not wide:
            raise AnalysisError("no mesh has a face that could feel a tilt: give the widths of its gears")
        model = model.with_({f"meshes.{name}.tilt": True for name in wide})
    count = elements or DEFAULT_ELEMENTS
    for _ in range(_HALVINGS):
        found = solved(model, Plan(count), given, progress)
        progress(0.5, "error estimate")
        # Change of all forces when every element is halved, relative to the largest.
        finer = equilibrate(found.system.with_plan(Plan(2 * count)), given or 0.0)
        there = forces_of(finer)
        size = float(np.max(np.abs(there), initial=0.0))
        change = float(np.max(np.abs(forces_of(found) - there), initial=0.0))
        estimate = change / size if size else 0.0
        if accuracy is None or estimate <= accuracy:
            break
        count = 2 * count
    short = missed(
        accuracy, estimate, "the forces no longer change with the elements, what is left is rounding; ask for less"
    )
    progress(0.8, "sensitivities")
    result = replace(_result(found, given, estimate), model=model, internal_loads=load_rows_of(found, finer))
    if short:
        result = replace(result, status=short, warnings=(*result.warnings, short))
    progress(1.0, "done")
    return result


def solved(
    model: Model,
    plan: Plan,
    speed: float | None,
    progress: Progress,
    beside: State | None = None,
    kind: type[System] = System,
) -> Equilibrated:
    """The equilibrium on a mesh, with loaded teeth over the mesh cycle where they need it; errors are those of `static`.

    `beside` is a state of a model next to this one, whose face maps serve, as in `state_at`. `kind` says how the shafts of the
    system are made.
    """
    system = kind(model, plan=plan, state=model.torque_flow(direction_of(speed)).of_kind("static"))
    if beside is not None:
        system = system.with_state(replace(system.state, mapped_at=beside.shared_maps))
    system.require_freedom()
    if not is_loaded(system):
        raise AnalysisError(
            "nothing loads the model in statics: give [operation] a power or torque with its output_shaft, [loads], or gravity"
        )
    progress(0.1, f"solving {system.n} dofs")
    found = equilibrate_along_faces(system, speed or 0.0, part_of(progress, 0.1, 0.4))
    if found.passes and decided_by_loads(found):
        return found
    progress(0.4, "loaded teeth over the mesh cycle")
    equilibrium, _ = over_cycle(found, speed or 0.0)
    return replace(equilibrium, faces=found.faces, passes=found.passes)


def forces_of(equilibrium: Equilibrated) -> np.ndarray:
    """Forces of contacts, bearings and supports in one row, (f,)."""
    held = (*bearing_forces(equilibrium).values(), *support_forces(equilibrium).values())
    return np.concatenate([equilibrium.force, *held])


def _result(equilibrium: Equilibrated, speed: float | None, estimate: float) -> StaticResult:
    system = equilibrium.system
    faces = _face_rows(equilibrium)
    states = equilibrium.lines.states
    q = system.dofs.expand(equilibrium.q)
    nodes, moved = shapes_at_stations(system, q[:, None])
    parameters, units, derivatives, underivable = sensitivities(equilibrium)
    shares, share_change = share_rows(equilibrium, parameters, derivatives)
    approach = equilibrium.lines.vectors.T @ equilibrium.q - equilibrium.lines.gap
    together = system.layout.assembly
    clocking_gap = {state.contact.mesh: state.clocking_gap(system.layout) for state in states}
    # A free motion is no mistake in statics: where the loads do not push it, forces are the same whatever its size.
    count = equilibrium.motions.shape[1]
    free = f"{count} free motion{'s'[: count != 1]} handled exactly, on a determinate support"
    what = "misalignment over the face by the shafts"
    why = "the teeth do not feel it; set tilt = true"
    unfelt = [
        Note(f"meshes.{r.mesh}", what, why, f"{1e6 * r.shaft_misalignment_m:+.3g} um") for r in faces if not r.fed_back
    ]
    doubts = (note for law in equilibrium.laws for note in law.doubts(speed or 0.0))
    return StaticResult(
        model=system.model,
        speed=speed,
        nodes=nodes,
        displacement=moved[:, :, 0],
        contact_mesh=equilibrium.lines.names,
        contact_helix=np.array([state.contact.helix for state in states], dtype=int),
        driver=tuple(state.contact.pinion if state.pinion_drives else state.contact.gear for state in states),
        carries=equilibrium.presses,
        mesh_force=equilibrium.force,
        mesh_force_on_gear=forces_on_gears(equilibrium),
        rigid_mesh=rigid_meshes(system),
        rigid_mesh_force=rigid_forces(equilibrium),
        mesh_stiffness=equilibrium.lines.stiffness,
        mesh_deflection=np.where(equilibrium.closed, approach, 0.0),
        bearing_force=bearing_forces(equilibrium),
        support_force=support_forces(equilibrium),
        casing_force=casing_forces(equilibrium),
        casing_ground_force=ground_forces(equilibrium),
        casing_seat_force=seat_forces(equilibrium),
        shares=shares,
        helix_share=helix_shares(equilibrium),
        parameter=parameters,
        parameter_unit=units,
        force_derivative=derivatives,
        share_derivative=share_change,
        mesh_phase=phases_in_pitches(system.state),
        assembly=tuple(
            LoopAssembly(
                mesh, closing, math.degrees(together.clocking.get(closing, 0.0)), rest, clocking_gap.get(mesh) or 0.0
            )
            for mesh, closing, rest in together.loops
            # That planets can be put in has been checked.
            if closing or system.layout.mesh(mesh).carrier is None
        ),
        torque={item.name: item.torque for item in system.state.applied},
        load_force={load.address: load.constant for load in system.layout.external_loads},
        point_displacement={n: float(v[0]) for n, v in point_amplitudes(system, nodes, moved).items()},
        imbalance=imbalance(equilibrium),
        error_estimate=estimate,
        dofs=system.n,
        faces=faces,
        laws=law_rows(law.at(speed or 0.0) for law in equilibrium.laws),
        passes=equilibrium.passes,
        left_out=(*left_out(system, "static", speed), *equilibrium.notes, *doubts, *unfelt, *underivable),
        warnings=(*system.nodes.merged, *_warnings(equilibrium, faces)),
        method=f"direct, sparse LU; {free if count else 'all motions held'}",
        place_displacement=displacement_places(system, moved[:, :, 0]),
    )


def _face_rows(equilibrium: Equilibrated) -> tuple[MeshFace, ...]:
    """The load along each face that feels the tilt of its shafts, or that has teeth which could."""
    rows = []
    for k, (state, whole) in enumerate(zip(equilibrium.lines.states, misalignments(equilibrium), strict=True)):
        contact = state.contact
        mesh = equilibrium.system.layout.mesh(contact.mesh).part
        face = equilibrium.faces[k]
        if face is None and (mesh.stiffness != "tooth_fe" or not equilibrium.closed[k]):
            continue
        rows.append(
            MeshFace(
                mesh=contact.mesh,
                helix=contact.helix,
                shaft_misalignment_m=float(whole) - mesh.misalignment,
                given_misalignment_m=mesh.misalignment,
                fed_back=face is not None,
                face_load_factor=face.load_factor if face else None,
                load_place_m=face.load_place if face else None,
                peak_place_m=face.peak_place if face else None,
                peak_pressure_pa=face.peak_pressure if face else None,
                tilt_stiffness_n_m=face.static.tilt_stiffness if face else None,
                z_m=face.z if face else np.zeros(0),
                line_load_n_per_m=face.line_load if face else np.zeros(0),
            )
        )
    return tuple(rows)


def rigid_meshes(system: System) -> tuple[str, ...]:
    """The mesh of each contact of rigid ones."""
    return tuple(force.contact.mesh for force in system.state.rigid)


def phases_in_pitches(load: State) -> dict[str, float]:
    """Phase of each mesh in pitches, 0 to 1; NaN where teeth are missing."""
    return {name: math.nan if phi is None else phi / (2.0 * math.pi) for name, phi in load.phases.items()}


def _warnings(equilibrium: Equilibrated, faces: tuple[MeshFace, ...]) -> list[Note]:
    """What statics says of contacts, of loops, and of shafts that misalign teeth which don't feel it."""
    lines = equilibrium.lines
    layout = equilibrium.system.layout
    notes: list[Note] = []
    flow = {
        (force.contact.mesh, force.contact.helix): force.torque_sense
        for force in equilibrium.system.model.torque_flow(equilibrium.system.direction).forces
    }
    for state, closed, presses in zip(lines.states, equilibrium.closed, equilibrium.presses, strict=True):
        contact = state.contact
        two = lines.names.count(contact.mesh) == 2
        which = f"meshes.{contact.mesh}" + (f" helix {contact.helix + 1}" if two else "")
        if not closed:
            notes.append(Note(which, "carries nothing", "its flanks stand apart under these loads and index errors"))
        elif not presses:
            notes.append(Note(which, "carries nothing", "its flanks touch, but no load reaches them"))
        elif state.torque_sense != flow[contact.mesh, contact.helix]:
            notes.append(Note(which, "carries on the other flank than the torque flow in torsion says"))
    what = "carries on the other flank than the torque flow in torsion says, on which a rigid mesh stays"
    rigid = zip(rigid_meshes(equilibrium.system), rigid_forces(equilibrium), strict=True)
    notes += [Note(f"meshes.{mesh}", what, "give it a stiffness") for mesh, force in rigid if force < 0.0]
    what = "closes a loop that can't be put together with the clockings given"
    why = "leave out the clocking of one of its gears and it closes the loop"
    notes += [
        Note(f"meshes.{mesh}", what, why, f"{rest:+.4f} pitches are missing")
        for mesh, closing, rest in layout.assembly.loops
        if not closing and abs(rest) > MOST_MISSED
    ]
    for name, face in zip(lines.names, equilibrium.faces, strict=True):
        notes += [Note(f"meshes.{name}", note) for note in face.warnings] if face is not None else []
    notes += soft_along_shaft(equilibrium)
    force = dict(zip(lines.names, equilibrium.force, strict=True))
    stiffness = dict(zip(lines.names, lines.stiffness, strict=True))
    what = "the shafts misalign the flanks over the face, which the teeth do not feel"
    for row in faces:
        if row.fed_back:
            continue
        width = layout.mesh(row.mesh).width
        factor = uniform_line(stiffness[row.mesh], width, force[row.mesh], row.misalignment_m).load_factor
        if factor > _NOTICED:
            size = f"{1e6 * row.shaft_misalignment_m:+.3g} um, face load factor up to {factor:.2g}"
            notes.append(Note(f"meshes.{row.mesh}", what, "set tilt = true", size))
    return list(dict.fromkeys(notes))
