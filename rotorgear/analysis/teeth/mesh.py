"""The verb behind `rotorgear mesh`: stiffness, transmission error and load distribution of one mesh of a model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.common.clock import Clock
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.teeth.errors import coarser, estimated
from rotorgear.analysis.teeth.request import MeshRequest, mesh_request
from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.mesh_cycle import MeshCycle
from rotorgear.gears.loaded.stiffness import loaded_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair
from rotorgear.gears.tooth_fe.settings import PRESETS
from rotorgear.model.layout.mesh_layout import mirrored
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.mesh import HelixContact, LoadPoint, MeshErrors, MeshResult, harmonics

POSITIONS = 64
# More positions or periods than these are a slip of the keyboard.
_MOST_POSITIONS = 4096
_MOST_PERIODS = 256


@dataclass(frozen=True)
class SolvedHelices:
    """All helices of one request at one load and setting."""

    problem: ContactProblem
    cycles: tuple[MeshCycle, ...]
    stiffness: np.ndarray
    tangent: np.ndarray
    error: np.ndarray
    no_load: np.ndarray


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
        mesh: name of the mesh; None where there is only one.
        stiffness: a stiffness model in place of the file's, or "given"; a mesh with a number in the file takes "tooth_fe".
        torque: on the pinion, in N m or as a text such as "2000 N m", in place of the torque flow's.
        preset, body: of the finite elements, in place of the file's.
        accuracy: take the cheapest preset whose estimated relative errors are within it.
        positions: in one mesh period; periods: how many (default 1, or enough for all teeth with pitch errors).
        load_factors: also solve at these multiples of the load.
        estimate: whether a coarser mesh is solved too, for the error estimates.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mesh, load or setting that can't be; an accuracy that no preset reaches.
        ConvergenceError: contact that does not come to rest.
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
    u = np.arange(positions * _periods(request.teeth, periods)) / positions
    stagger = request.mesh.lead_on_path(request.sense)
    if accuracy is None:
        teeth = request.teeth
        found, errors = _with_errors(request, teeth, u, stagger, estimate, progress)
    else:
        teeth, found, errors = _refined(request, u, stagger, accuracy, progress)
    clock.lap("teeth and contact")
    loads = tuple(_load_point(request, teeth, factor, u, stagger) for factor in load_factors)
    if loads:
        clock.lap("other loads")
    return _result(model, request, teeth, u, found, errors, loads, clock)


def require_positions(positions: int) -> None:
    """AnalysisError unless so many positions of a mesh period can be asked for."""
    if not 8 <= positions <= _MOST_POSITIONS:
        raise AnalysisError(f"--positions: got {positions}, expected 8 to {_MOST_POSITIONS} in a mesh period")


def _periods(teeth: ToothPair, wanted: int | None) -> int:
    if wanted is not None:
        if not 1 <= wanted <= _MOST_PERIODS:
            raise AnalysisError(f"--periods: got {wanted}, expected 1 to {_MOST_PERIODS}")
        return wanted
    wrong = (*teeth.first_flank.single_teeth, *teeth.second_flank.single_teeth)
    return min(max(wrong) + 2, _MOST_PERIODS) if wrong else 1


def solve_helices(
    request: MeshRequest,
    teeth: ToothPair,
    base_force: float,
    u: np.ndarray,
    stagger: float,
    progress: Progress = silent,
) -> SolvedHelices:
    """All helices at one load; they share it evenly, and the mesh approaches by their mean."""
    cycles: list[MeshCycle] = []
    kinds = [teeth if ahead > 0 else mirrored(teeth) for ahead in request.senses]
    for helix, pair in enumerate(kinds):
        if helix and pair == kinds[0] and stagger == 0.0:
            cycles.append(cycles[0])
            continue
        told = part_of(progress, helix / request.helices, (helix + 1) / request.helices)
        problem, cycle = loaded_cycle(pair, base_force, u + helix * stagger, told)
        cycles.append(cycle)
    error = np.mean([cycle.deflection for cycle in cycles], axis=0)
    no_load = np.mean([cycle.no_load for cycle in cycles], axis=0)
    total = base_force * request.helices
    tangent = request.helices / np.mean([1.0 / cycle.tangent for cycle in cycles], axis=0)
    return SolvedHelices(problem, tuple(cycles), total / (error - no_load), tangent, error, no_load)


def _with_errors(
    request: MeshRequest, teeth: ToothPair, u: np.ndarray, stagger: float, estimate: bool, progress: Progress
) -> tuple[SolvedHelices, MeshErrors | None]:
    rough = coarser(teeth) if estimate else None
    share = 0.25 if rough is not None else 0.0
    found = solve_helices(request, teeth, request.base_force, u, stagger, part_of(progress, share, 1.0))
    if rough is None:
        return found, None
    other = solve_helices(request, rough, request.base_force, u, stagger, part_of(progress, 0.0, share))
    return found, estimated(teeth, found.stiffness, found.error, other.stiffness, other.error)


def _refined(
    request: MeshRequest, u: np.ndarray, stagger: float, accuracy: float, progress: Progress
) -> tuple[ToothPair, SolvedHelices, MeshErrors | None]:
    """The cheapest preset whose estimates are within an accuracy."""
    assert request.teeth is not None
    said = []
    for preset in PRESETS:
        fe = replace(request.teeth.fe, preset=preset, size=None)
        teeth = replace(request.teeth, fe=fe)
        if coarser(teeth) is None:
            continue  # uncoupled slices can't know their error
        found, errors = _with_errors(request, teeth, u, stagger, True, progress)
        assert errors is not None
        if errors.worst <= accuracy:
            return teeth, found, errors
        said.append(f"{preset} {errors.worst:.1e}")
    raise AnalysisError(
        f"No preset reaches a relative accuracy of {accuracy:g} of stiffness, its ripple and the transmission error's ripple: "
        f"the estimates are {', '.join(said)}. Ask for less, or take --preset fine with its estimate."
    )


def _load_point(request: MeshRequest, teeth: ToothPair, factor: float, u: np.ndarray, stagger: float) -> LoadPoint:
    found = solve_helices(request, teeth, factor * request.base_force, u, stagger)
    ratio = float(np.mean([cycle.contact_ratio for cycle in found.cycles]))
    k = found.stiffness
    return LoadPoint(
        factor=factor,
        mean_stiffness_n_per_m=float(k.mean()),
        peak_to_peak_stiffness_n_per_m=float(np.ptp(k)),
        ste_peak_to_peak_m=float(np.ptp(found.error)),
        contact_ratio=ratio,
        ste_harmonics_m=tuple(np.abs(harmonics(u, found.error, 3)).tolist()),
        largest_pressure_pa=max(float(cycle.pressure.max()) for cycle in found.cycles),
        ste_m=found.error,
    )


def _other(model: Model, request: MeshRequest, positions: int, clock: Clock) -> MeshResult:
    """A mesh with another stiffness model: its curve, and the transmission error that follows from it at the load."""
    normal = request.load.normal_force_n / request.helices if request.load else None
    name = None if request.model == "given" else request.model
    curve: MeshStiffness = request.mesh.stiffness(normal, positions, name=name, sense=request.sense)
    error = None if request.load is None else request.load.base_force_n / curve.transverse
    clock.lap("stiffness")
    width = request.teeth.width if request.teeth else request.mesh.pinion.part.width or 0.0
    return MeshResult(
        title=model.title,
        mesh=request.name,
        pinion=request.mesh.pinion.name,
        gear=request.mesh.gear.name,
        stiffness_model=curve.model,
        preset=None,
        definition=curve.definition,
        body=curve.body,
        helices=request.helices,
        face_width=width,
        base_helix_angle=curve.base_helix_angle,
        stagger=request.mesh.part.stagger,
        load=request.load,
        position=curve.position,
        stiffness=curve.transverse,
        tangent=curve.tangent,
        transmission_error=error,
        no_load_error=None if error is None else np.zeros(len(error)),
        helix=(),
        errors=None,
        dofs=0,
        seconds=clock.total(),
        loads=(),
        warnings=curve.warnings,
    )


def _result(
    model: Model,
    request: MeshRequest,
    teeth: ToothPair,
    u: np.ndarray,
    found: SolvedHelices,
    errors: MeshErrors | None,
    loads: tuple[LoadPoint, ...],
    clock: Clock,
) -> MeshResult:
    notes = [*found.problem.warnings]
    for cycle in found.cycles:
        notes += cycle.warnings
    if found.problem.uncoupled:
        notes.append(
            "preview: slices along the face do not feel each other, which is tens of percent off in the ripple of a helical pair"
        )
    if teeth.tilts:
        notes.append(
            "tilt: the shafts are rigid here; statics finds the misalignment over the face by their deflection"
        )
    return MeshResult(
        title=model.title,
        mesh=request.name,
        pinion=request.mesh.pinion.name,
        gear=request.mesh.gear.name,
        stiffness_model="tooth_fe",
        preset=teeth.fe.preset,
        definition="secant",
        body=found.problem.body,
        helices=request.helices,
        face_width=teeth.width,
        base_helix_angle=teeth.pair.base_helix_angle,
        stagger=request.mesh.part.stagger,
        load=request.load,
        position=u,
        stiffness=found.stiffness,
        tangent=found.tangent,
        transmission_error=found.error,
        no_load_error=found.no_load,
        helix=tuple(_helix(cycle, teeth, found.problem) for cycle in found.cycles),
        errors=errors,
        dofs=found.problem.unknowns,
        seconds=clock.total(),
        loads=loads,
        warnings=tuple(dict.fromkeys(notes)),
    )


def _helix(cycle: MeshCycle, teeth: ToothPair, problem: ContactProblem) -> HelixContact:
    s = cycle.slices
    return HelixContact(
        stiffness=cycle.secant,
        tangent=cycle.tangent,
        transmission_error=cycle.deflection,
        no_load_error=cycle.no_load,
        share=cycle.share_by_pair(),
        contact_ratio=cycle.contact_ratio,
        geometric_contact_ratio=problem.line.contact_ratio + teeth.pair.overlap_ratio,
        path_of_contact=(problem.line.start, problem.line.pitch_point, problem.line.end),
        position=s.position,
        pair=s.pair,
        z=s.z @ s.weight,
        length=s.length / np.cos(teeth.pair.base_helix_angle),
        corner=s.corner,
        roll=np.stack([roll @ s.weight for roll in s.roll], axis=-1),
        force=cycle.force,
        half_width=cycle.strip,
        pressure=cycle.pressure,
    )
