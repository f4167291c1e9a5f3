"""The verb behind `rotorgear mesh`: stiffness, transmission error and load distribution of one mesh of a model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.teeth.errors import ErrorParts, error_parts
from rotorgear.analysis.teeth.request import MeshRequest, SolvedHelices, mesh_request, solve_helices
from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.tooth_contact import in_space
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair
from rotorgear.gears.tooth_fe.settings import PRESETS
from rotorgear.memory import largest_memory
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.mesh import HelixContact, LoadPoint, MeshResult

POSITIONS = 64
# More positions or periods than these are taken for a typing error.
_MOST_POSITIONS = 4096
_MOST_PERIODS = 256
# An accuracy that is asked for takes no more positions than this by itself.
_DENSEST = 512


@recorded
def mesh(
    model: Model,
    mesh: str | None = None,
    *,
    stiffness: str | None = None,
    torque: float | str | None = None,
    preset: str | None = None,
    body: str | None = None,
    accuracy: float | None = None,
    positions: int = POSITIONS,
    periods: int | None = None,
    load_factors: Sequence[float] = (),
    estimate: bool = True,
    progress: Progress = silent,
) -> MeshResult:
    """Solve one mesh over its mesh cycle at the mean load of the torque flow.

    Args:
        model: a checked model.
        mesh: name of the mesh; it may be left out where there is only one.
        stiffness: stiffness model: tooth_fe, iso, contact_line, potential_energy, or given for the numbers of the file
            (default: the model that the file names, else tooth_fe).
        torque: torque on the pinion in N m or with its unit, such as "2000 N m" (default: that of the torque flow).
        preset: preset of the finite elements: preview, default or fine (default: that of the file).
        body: body under the teeth: rim, ring or wheel (default: that of the file).
        accuracy: take the cheapest preset whose estimated relative errors are within it, and more positions where they decide.
        positions: number of positions in one mesh period, placed where teeth come and go and where the curves need them.
        periods: number of mesh periods (default: 1, or enough for all teeth with pitch errors).
        load_factors: also solve at these multiples of the load.
        estimate: solve other meshes and more positions, too, for the error estimates.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mesh, load or setting that can't be; an accuracy that no preset reaches.
        ConvergenceError: the contact does not converge.
        MissingExtraError: scikit-fem is not installed.
    """
    require_positions(positions)
    if accuracy is not None and (preset is not None or not 0.0 < accuracy < 1.0):
        raise AnalysisError("Give an accuracy between 0 and 1, or a preset, not both.")
    if any(not factor > 0.0 for factor in load_factors):
        raise AnalysisError("Load factors must be positive.")
    clock = Clock()
    request = mesh_request(model, mesh, stiffness, torque, {"preset": preset, "body": body})
    if request.model != "tooth_fe":
        return _other(model, request, positions, clock)
    assert request.teeth is not None
    if periods is None:
        wrong = (*request.teeth.first_flank.single_teeth, *request.teeth.second_flank.single_teeth)
        periods = min(max(wrong) + 2, _MOST_PERIODS) if wrong else 1
    if not 1 <= periods <= _MOST_PERIODS:
        raise AnalysisError(f"--periods: got {periods}, expected 1 to {_MOST_PERIODS}")
    if accuracy is None:
        teeth = request.teeth
        found, errors = _with_errors(request, teeth, positions, periods, estimate, progress)
    else:
        teeth, found, errors = _refined(request, positions, periods, accuracy, progress)
    clock.lap("teeth and contact")
    loads = []
    for factor in load_factors:
        at = solve_helices(request, teeth, positions, periods, base_force=factor * request.base_force)
        loads.append(
            LoadPoint(
                factor=factor,
                mean_stiffness_n_per_m=float(at.curve.mean()[1]),
                peak_to_peak_stiffness_n_per_m=float(np.ptp(at.stiffness)),
                ste_peak_to_peak_m=float(np.ptp(at.error)),
                contact_ratio=float(np.mean([helix.contact_ratio for helix in at.cycles])),
                ste_harmonics_m=tuple(np.abs(at.curve.harmonics(3)[:, 0]).tolist()),
                largest_pressure_pa=float(at.curve.values[:, 3].max()),
                position=at.curve.position,
                ste_m=at.error,
            )
        )
    if loads:
        clock.lap("other loads")
    return _result(model, request, teeth, found, errors, tuple(loads), clock)


def require_positions(positions: int) -> None:
    """AnalysisError unless that number of positions in a mesh period is allowed."""
    if not 8 <= positions <= _MOST_POSITIONS:
        raise AnalysisError(f"--positions: got {positions}, expected 8 to {_MOST_POSITIONS} in a mesh period")


def _with_errors(
    request: MeshRequest, teeth: ToothPair, positions: int, periods: int, estimate: bool, progress: Progress
) -> tuple[SolvedHelices, ErrorParts | None]:
    told = part_of(progress, 0.0, 0.7 if estimate else 1.0)
    found = solve_helices(request, teeth, positions, periods, judged=estimate, progress=told)
    return found, error_parts(request, teeth, found, part_of(progress, 0.7, 1.0)) if estimate else None


def _refined(
    request: MeshRequest, positions: int, periods: int, accuracy: float, progress: Progress
) -> tuple[ToothPair, SolvedHelices, ErrorParts]:
    """The cheapest preset whose estimates are within an accuracy."""
    assert request.teeth is not None
    said = []
    for preset in PRESETS:
        teeth = replace(request.teeth, fe=replace(request.teeth.fe, preset=preset, size=None))
        if in_space(teeth)[1]:
            continue  # uncoupled slices can't know their error
        count = positions
        while True:
            found, errors = _with_errors(request, teeth, count, periods, True, progress)
            assert errors is not None
            if errors.total.worst <= accuracy:
                return teeth, found, errors
            # Where the positions have most of the error, more of them are cheaper than a finer mesh.
            if 2.0 * errors.sampling.worst <= accuracy or count >= _DENSEST:
                break
            count *= 2
        said.append(f"{preset} {errors.total.worst:.1e}")
    raise AnalysisError(
        f"No preset reaches a relative accuracy of {accuracy:g} of stiffness, its ripple and the transmission error's ripple: "
        f"the estimates are {', '.join(said)}. Ask for less, or take --preset fine with its estimate."
    )


def _common(model: Model, request: MeshRequest, clock: Clock) -> dict[str, Any]:
    """What a result says of the mesh and the run, whatever the stiffness model."""
    return {
        "title": model.title,
        "mesh": request.mesh.name,
        "pinion": request.mesh.pinion.name,
        "gear": request.mesh.gear.name,
        "helices": request.mesh.helices,
        "stagger": request.mesh.part.stagger,
        "stiffness_model": request.model,
        "face_width": request.teeth.width if request.teeth else request.mesh.pinion.part.width or 0.0,
        "base_helix_angle": request.mesh.pinion.base_helix_angle,
        "load": request.load,
        "memory_bytes": largest_memory(),
        "seconds": clock.total(),
    }


def _other(model: Model, request: MeshRequest, positions: int, clock: Clock) -> MeshResult:
    """A mesh with another stiffness model: its curve, and the transmission error that follows from it at the load."""
    normal = request.load.normal_force_n / request.mesh.helices if request.load else None
    name = None if request.model == "given" else request.model
    curve: MeshStiffness = request.mesh.stiffness(normal, positions, name=name, sense=request.sense)
    error = None if request.load is None else request.load.base_force_n / curve.transverse
    clock.lap("stiffness")
    return MeshResult(
        **_common(model, request, clock),
        preset=None,
        definition=curve.definition,
        body=curve.body,
        position=curve.position,
        event=np.zeros(len(curve.position), bool),
        stiffness=curve.transverse,
        tangent=curve.tangent,
        transmission_error=error,
        no_load_error=None if error is None else np.zeros(len(error)),
        helix=(),
        errors=None,
        element_errors=None,
        slice_errors=None,
        sampling_errors=None,
        dofs=0,
        loads=(),
        warnings=curve.warnings,
    )


def _result(
    model: Model,
    request: MeshRequest,
    teeth: ToothPair,
    found: SolvedHelices,
    errors: ErrorParts | None,
    loads: tuple[LoadPoint, ...],
    clock: Clock,
) -> MeshResult:
    notes = [*found.problem.warnings, *(note for cycle in found.cycles for note in cycle.warnings)]
    if found.problem.uncoupled:
        notes.append(
            "preview: slices along the face do not feel each other, which is tens of percent off in the ripple of a helical pair"
        )
    if teeth.tilts:
        notes.append(
            "tilt: the shafts are rigid here; statics finds the misalignment over the face by their deflection"
        )
    line = found.problem.line
    return MeshResult(
        **_common(model, request, clock),
        preset=teeth.fe.preset,
        definition="secant",
        body=found.problem.body,
        position=found.curve.position,
        event=found.curve.event,
        stiffness=found.stiffness,
        tangent=found.curve.values[:, 2],
        transmission_error=found.error,
        no_load_error=found.no_load,
        helix=tuple(
            HelixContact(
                stiffness=cycle.secant,
                tangent=cycle.tangent,
                transmission_error=cycle.deflection,
                no_load_error=cycle.no_load,
                share=cycle.share_by_pair(),
                contact_ratio=cycle.contact_ratio,
                geometric_contact_ratio=line.contact_ratio + teeth.pair.overlap_ratio,
                path_of_contact=(line.start, line.pitch_point, line.end),
                position=cycle.slices.position,
                pair=cycle.slices.pair,
                z=cycle.slices.z @ cycle.slices.weight,
                length=cycle.slices.length / np.cos(teeth.pair.base_helix_angle),
                corner=cycle.slices.corner,
                # Those of a ring are negative inside.
                roll=np.abs(np.stack([roll @ cycle.slices.weight for roll in cycle.slices.roll], axis=-1)),
                force=cycle.force,
                half_width=cycle.strip,
                pressure=cycle.pressure,
            )
            for cycle in found.cycles
        ),
        errors=errors.total if errors else None,
        element_errors=errors.elements if errors else None,
        slice_errors=errors.slices if errors else None,
        sampling_errors=errors.sampling if errors else None,
        dofs=found.problem.unknowns,
        loads=loads,
        warnings=tuple(dict.fromkeys(notes)),
    )
