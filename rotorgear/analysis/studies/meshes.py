"""Studies over meshes of the shafts: basic elements in each segment, then meshes refined to an accuracy.

Each is a row of the table: the analysis that runs, the quantity that is compared, and the reference that is taken for the truth.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rotorgear.analysis.campbell.campbell import campbell
from rotorgear.analysis.campbell.critical import critical
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import speed_or_operating
from rotorgear.analysis.common.study import REPEAT, Judged, Setting, Study
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.response.frequency_response import frf, relative_change
from rotorgear.analysis.response.mesh import strongest_orders
from rotorgear.analysis.response.response import response
from rotorgear.analysis.static.static import forces_of, solved, static
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.campbell import CampbellResult
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.results.critical import CriticalResult
from rotorgear.results.frequency_response import FrequencyResponse
from rotorgear.results.modal import ModalResult
from rotorgear.results.response import ResponseResult
from rotorgear.results.static import StaticResult
from rotorgear.system.plan import Plan
from rotorgear.system.system import flow_system

# Numbers of basic elements in a shaft segment, and accuracies.
ELEMENTS = (1, 2, 4, 8, 16, 32)
ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-9)
AMPLITUDE_ACCURACIES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6)
# Accuracies of the references of frequencies and of amplitudes.
REFERENCE = 1e-10
AMPLITUDE_REFERENCE = 1e-9
# Ten times the accuracy of the reference: below, the ratio of estimate and error is that of the reference.
RESOLUTION = 1e-9
# Amplitudes at a resonance of 0.1 % damping move 500 times as much as its frequency.
AMPLITUDE_RESOLUTION = 1e-7


def _settings(elements: Sequence[int], accuracies: Sequence[float]) -> list[Setting]:
    by_number = [
        Setting(f"{n} basic element{'s'[: n != 1]} per segment", "elements", float(n), {"elements": n})
        for n in elements
    ]
    return by_number + [Setting(f"accuracy {a:g}", "accuracy", a, {"accuracy": a}) for a in accuracies]


def _as_continuum(model: Model) -> Model:
    """The model with consistent mass on all shafts, whose frequencies at vanishing element length are the same."""
    lumped = [name for name, shaft in model.shafts.items() if shaft.mass_matrix == "lumped"]
    return model.with_({f"shafts.{name}.mass_matrix": "consistent" for name in lumped}) if lumped else model


def _elastic(result: ModalResult) -> np.ndarray:
    """Which modes are neither rigid nor roots at zero, (m,)."""
    return np.asarray(~result.rigid & (np.abs(result.eigenvalues) > 0.0))


@recorded
def convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    modes: int = 24,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    reference: Sequence[float] | None = None,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run the modal analysis of a model over a series of discretisations.

    The errors of the estimates are those of single frequencies: a mode counts with its own estimate.

    Args:
        model: the model.
        speed: as for `modal`.
        modes: how many modes are compared (rigid ones count, but have no error).
        elements: numbers of basic elements in each shaft segment.
        accuracies: relative accuracies to refine to.
        reference: natural frequencies in Hz of the modes that are not rigid; None for the model's own finest (accuracy 1e-10,
            by elements of high order, and with consistent mass where the model's is lumped).
        repeat: runs of each rung that are timed at least; the median time counts.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: the reference has fewer frequencies than asked for, or the model has no elastic mode.
    """
    finest = modal(_as_continuum(model), speed=speed, modes=modes, accuracy=REFERENCE)
    truth = finest.natural_frequency_hz[_elastic(finest)]
    if truth.size == 0:
        raise AnalysisError("the model has no elastic mode among those asked for, so there is no error to measure")
    order = max((part.order for part in finest.discretisation), default=1)
    words = f"elements of order up to {order}, refined to {REFERENCE:g}, {finest.dofs} dofs"
    if reference is not None:
        computed = truth.size
        truth = np.sort(np.asarray(reference, float))
        words = f"{truth.size} given frequencies"
        if truth.size == 0 or not np.all(np.isfinite(truth) & (truth > 0.0)):
            raise AnalysisError("the reference needs positive frequencies in Hz")
        if truth.size > computed:
            raise AnalysisError(
                f"the reference has {truth.size} frequencies, but only {computed} elastic modes are computed; raise modes"
            )

    def judge(result: ModalResult) -> Judged:
        elastic = np.flatnonzero(_elastic(result))[: len(truth)]
        # A discretisation with too few modes has no answer for the last ones.
        error, estimate = np.full((2, len(truth)), np.inf)
        error[: len(elastic)] = np.abs(result.natural_frequency_hz[elastic] / truth[: len(elastic)] - 1.0)
        estimate[: len(elastic)] = result.error_estimate[elastic]
        return Judged(result.dofs, error, estimate)

    # A mesh so coarse that the supports hold everything has nothing to solve.
    able = [n for n in elements if flow_system(model, Plan(n)).n]
    return Study(
        _settings(able, accuracies),
        run=lambda options: modal(model, speed=speed, modes=modes, **options),
        judge=judge,
        compared="frequencies",
        count=len(truth),
        reference=words,
        resolution=RESOLUTION if reference is None else 0.0,
    ).result("modal", model, repeat, progress)


# Speeds of the diagrams that are compared, the first and last of them its ends.
_DIAGRAM = 3
# A mode whose damped frequency is below this share of |s| does not oscillate, and is on no branch.
_OSCILLATES = 1e-9


@recorded
def campbell_convergence_study(
    model: Model,
    *,
    stop: float | str | None = None,
    modes: int = 24,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run a Campbell diagram of three speeds over a series of discretisations.

    The errors are those of |s| of the lowest branches at every speed, against the modes at that speed by `modal`: solved for
    themselves, without the reduced basis and without following branches.

    Args:
        model, stop: as for `campbell`.
        modes: how many branches are compared.
        elements, accuracies, repeat, progress: as for `convergence_study`.
    """

    def run(options: dict[str, Any]) -> CampbellResult:
        return campbell(model, stop=stop, points=_DIAGRAM, modes=modes, **options)

    truth = []
    for k, speed in enumerate(run({"accuracy": 1e-2}).speeds):
        progress(0.4 * k / _DIAGRAM, f"reference, speed {k + 1} of {_DIAGRAM}")
        finest = modal(_as_continuum(model), speed=float(speed), modes=modes + 12, accuracy=REFERENCE)
        s = finest.eigenvalues
        truth.append(np.sort(np.abs(s[~finest.rigid & (s.imag > _OSCILLATES * np.abs(s))]))[:modes])
    count = min(len(found) for found in truth)

    def judge(result: CampbellResult) -> Judged:
        error, estimate = np.full((2, _DIAGRAM, count), np.inf)
        for k, exact in enumerate(truth):
            size = np.where(np.isfinite(result.eigenvalues[k]), np.abs(result.eigenvalues[k]), np.inf)
            lowest = np.argsort(size)[:count]
            there = np.isfinite(size[lowest])
            error[k, : len(lowest)][there] = np.abs(size[lowest][there] / exact[: len(lowest)][there] - 1.0)
            estimate[k, : len(lowest)][there] = result.error_estimate[lowest][there]
        # A branch has one estimate, the larger of both ends: it is for the worst of its speeds.
        return Judged(result.dofs, error.max(axis=0), estimate.max(axis=0))

    return Study(
        _settings(elements, accuracies),
        run=run,
        judge=judge,
        compared="branches",
        count=count,
        reference=f"modes solved for themselves at each of {_DIAGRAM} speeds, meshes refined to {REFERENCE:g}",
        resolution=RESOLUTION,
    ).result("campbell", model, repeat, part_of(progress, 0.4, 1.0))


@recorded
def critical_convergence_study(
    model: Model,
    *,
    stop: float | str | None = None,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Find the critical speeds over a series of discretisations.

    The reference are the critical speeds on the finest mesh, each of them confirmed by the modes at that speed.

    Args:
        model, stop: as for `critical`.
        elements, accuracies, repeat, progress: as for `convergence_study`.

    Raises:
        AnalysisError: no critical speed in the range.
    """
    progress(0.0, "reference")
    finest = critical(_as_continuum(model), stop=stop, accuracy=REFERENCE)
    truth = _by_line(finest)
    if not finest.speeds:
        raise AnalysisError("there is no critical speed in this range, so there is no error to measure; raise --to")
    missed = []  # by the nearest mode at each critical speed, relative to its line
    for item in finest.speeds:
        w = 2.0 * np.pi * item.frequency_hz
        fmax = 1.05 * item.frequency_hz / (1.0 - item.damping_ratio**2) ** 0.5
        found = modal(_as_continuum(model), speed=item.speed, fmax=fmax, accuracy=REFERENCE)
        missed.append(float(np.min(np.abs(found.eigenvalues.imag - w)) / w))

    def judge(result: CriticalResult) -> Judged:
        error = []
        estimate = []
        here = _by_line(result)
        for line, (exact, _) in truth.items():
            speeds, told = here.get(line, (np.zeros(0), np.zeros(0)))
            # A critical speed near the end of the range may lie beyond it on a coarse mesh.
            both = min(len(speeds), len(exact))
            error.append(np.abs(speeds[:both] / exact[:both] - 1.0))
            estimate.append(told[:both])
        return Judged(result.dofs, np.concatenate(error), np.concatenate(estimate))

    return Study(
        _settings(elements, accuracies),
        run=lambda options: critical(model, stop=stop, **options),
        judge=judge,
        compared="critical speeds",
        count=len(finest.speeds),
        reference=f"the mesh refined to {REFERENCE:g}, {finest.dofs} dofs; the modes at these speeds, solved for themselves, "
        f"meet the lines to {max(missed):.0e}",
        resolution=RESOLUTION,
    ).result("critical", model, repeat, part_of(progress, 0.1, 1.0))


def _by_line(result: CriticalResult) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Critical speeds of each line by size, and their estimated errors."""
    found: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    for line in dict.fromkeys(item.line for item in result.speeds):
        items = sorted((item for item in result.speeds if item.line == line), key=lambda item: abs(item.speed))
        found[line] = np.array([abs(item.speed) for item in items]), np.array([item.error_estimate for item in items])
    return found


# Internal polynomials up to this order beside the exact static shapes: a mesh that no rung has.
_STATIC_ORDER = 4


@recorded
def static_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    elements: Sequence[int] = (1, 2, 4, 8, 16),
    accuracies: Sequence[float] = (1e-3, 1e-6),
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run the static analysis over numbers of elements.

    The errors are those of the forces of contacts, bearings and supports, relative to the largest. The basic element is exact in
    statics: what remains is rounding, and the study shows that it is no more.

    Args:
        model, speed: as for `static`.
        elements, accuracies, repeat, progress: as for `convergence_study`.
    """
    finest = solved(model, Plan(1, _STATIC_ORDER), speed_or_operating(speed, model), silent)
    truth = forces_of(finest)
    size = max(float(np.abs(truth).max(initial=0.0)), np.finfo(float).tiny)

    def judge(result: StaticResult) -> Judged:
        held = (*result.bearing_force.values(), *result.support_force.values())
        forces = np.concatenate([result.mesh_force, *held])
        return Judged(result.dofs, np.abs(forces - truth) / size, np.array([result.error_estimate]))

    return Study(
        _settings(elements, accuracies),
        run=lambda options: static(model, speed=speed, **options),
        judge=judge,
        compared="forces",
        count=len(truth),
        reference=f"elements with internal polynomials up to order {_STATIC_ORDER}, {finest.system.n} dofs",
        resolution=RESOLUTION,
        below="rounding only",
    ).result("static", model, repeat, progress)


@recorded
def response_convergence_study(
    model: Model,
    *,
    fmax: float | None = None,
    modal_damping: float = 0.0,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = AMPLITUDE_ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run a forced response over speed on a series of meshes.

    The error of an order is the largest difference of its complex forces of contacts and bearings at any speed, relative to the
    largest; the strongest orders are compared. The reference is solved directly at every speed; the rungs may take modes.

    Args:
        model, fmax, modal_damping: as for `response`.
        elements, accuracies, repeat, progress: as for `convergence_study`.
    """

    def run(options: dict[str, Any], of: Model = model) -> ResponseResult:
        return response(of, points=101, fmax=fmax, modal_damping=modal_damping, **options)

    progress(0.0, "reference")
    finest = run({"method": "direct", "accuracy": AMPLITUDE_REFERENCE}, _as_continuum(model))
    truth = _forces(finest)
    size = np.abs(truth).max(axis=2)
    strongest = strongest_orders(size)
    if not size[:, strongest].any():
        raise AnalysisError("nothing moves: the excitations of the model come to nothing")
    largest = size.max(axis=0)[strongest]

    def judge(result: ResponseResult) -> Judged:
        difference = np.abs(_forces(result) - truth).max(axis=(0, 2))[strongest]
        error = difference / np.where(largest > 0.0, largest, 1.0)
        return Judged(result.dofs, error, np.array([result.error_estimate]))

    return Study(
        _settings(elements, accuracies),
        run=run,
        judge=judge,
        compared="orders, each by its largest force over speed",
        count=len(strongest),
        reference=f"direct solutions on a mesh of {finest.dofs} dofs, its own error estimated at {finest.error_estimate:.0e}",
        resolution=AMPLITUDE_RESOLUTION,
    ).result("response", model, repeat, part_of(progress, 0.2, 1.0))


def _forces(result: ResponseResult) -> np.ndarray:
    """All forces over speed, (s, o, f); displacements where the model has neither mesh nor bearing."""
    speeds = len(result.speeds)
    orders = len(result.orders)
    held = result.bearing_force.transpose(1, 0, 2, 3).reshape(speeds, orders, -1)
    forces = np.concatenate([result.mesh_force.transpose(1, 0, 2), held], axis=2)
    if forces.shape[2]:
        return forces
    return result.displacement[..., :3].transpose(1, 0, 2, 3).reshape(speeds, orders, -1)


# A frequency response without a range goes to this many times the frequency of this elastic mode.
_ABOVE = 1.1
_MODES = 6
_FREQUENCIES = 200


@recorded
def frf_convergence_study(
    model: Model,
    *,
    fmax: float | None = None,
    modal_damping: float = 0.0,
    at: str | None = None,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = AMPLITUDE_ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run a driving-point frequency response over a series of meshes.

    The error is the largest difference of the complex receptance at any frequency, relative to the largest receptance.

    Args:
        model, modal_damping: as for `frf`.
        fmax: highest frequency in Hz; above the sixth elastic mode where not given.
        at: where force and response are, as for `frf`; y of the first disk, gear or bearing where not given.
        elements, accuracies, repeat, progress: as for `convergence_study`.

    Raises:
        AnalysisError: no place to take, or no elastic mode that says how far to go.
    """
    if at is None:
        parts = [f"{table}.{name}" for table in ("disks", "gears", "bearings") for name in getattr(model, table)]
        if not parts:
            raise AnalysisError(
                "the model has no disk, gear or bearing to take a frequency response at: give a place (--at)"
            )
        at = f"{parts[0]}:{'y' if model.has('bending') else 'torsion'}"
    if fmax is None:
        modes = modal(model, modes=_MODES + 12)
        found = modes.natural_frequency_hz[_elastic(modes)]
        if not found.size:
            raise AnalysisError("the model has no elastic mode that says how far to go: give --fmax")
        fmax = _ABOVE * float(found[min(_MODES, found.size) - 1])
    asked: dict[str, Any] = {"inputs": [at], "outputs": [at], "fmax": fmax, "modal_damping": modal_damping}

    def run(options: dict[str, Any], of: Model = model) -> FrequencyResponse:
        return frf(of, points=_FREQUENCIES, **asked, **options)

    progress(0.0, "reference")
    finest = run({"accuracy": AMPLITUDE_REFERENCE}, _as_continuum(model))

    def judge(result: FrequencyResponse) -> Judged:
        error = relative_change(finest.receptance, result.receptance)
        return Judged(result.dofs, np.array([error]), np.array([result.error_estimate]))

    return Study(
        _settings(elements, accuracies),
        run=run,
        judge=judge,
        compared="receptance",
        count=1,
        reference=f"elements of high order, {finest.dofs} dofs, its own error estimated at {finest.error_estimate:.0e}; "
        f"force and response at {at}, {_FREQUENCIES} frequencies to {fmax:.5g} Hz",
        resolution=AMPLITUDE_RESOLUTION,
    ).result("frf", model, repeat, part_of(progress, 0.1, 1.0))
