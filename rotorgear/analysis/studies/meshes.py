"""Studies over meshes of the shafts: basic elements in each segment, then meshes refined to an accuracy.

Each is a row of the table: the analysis that runs, the quantity that is compared, and the reference that is taken for the truth.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment, root_scalar

from rotorgear.analysis.campbell.campbell import campbell
from rotorgear.analysis.campbell.critical import critical
from rotorgear.analysis.common.casings import with_casing_modes
from rotorgear.analysis.common.points import moving_rows
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import speed_in_si, speed_or_operating
from rotorgear.analysis.common.study import REPEAT, Judged, Setting, Study
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.response.frequency_response import frf, relative_change
from rotorgear.analysis.response.mesh import meshed, strongest_orders
from rotorgear.analysis.response.orders import orders_of
from rotorgear.analysis.response.response import response
from rotorgear.analysis.response.run_up import direct_sweep
from rotorgear.analysis.response.state_space import state_space
from rotorgear.analysis.static.mean_state import about_mean
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.analysis.static.static import forces_of, solved, static
from rotorgear.analysis.studies.continuum import Continuum, ContinuumPlant, ContinuumSystem
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.campbell import CampbellResult
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.results.critical import CriticalResult, CriticalSpeed
from rotorgear.results.frequency_response import FrequencyResponse
from rotorgear.results.modal import ModalResult
from rotorgear.results.response import ResponseResult
from rotorgear.results.state_space import StateSpace
from rotorgear.results.static import StaticResult
from rotorgear.system.internal_loads import read_loads
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
# Share by which Newton's method starts beside the frequencies of the finest mesh.
_ASIDE = 1e-6
# Share above the highest mode up to which modes are counted.
_ABOVE_ALL = 1e-7
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


# What all references have in common with what they judge.
SHARED = "all other parts, and the assembly, are those of the model"


def _exact_eigenvalues(model: Model, s: np.ndarray, speed: float | None) -> tuple[Continuum, np.ndarray]:
    """Continuous shafts at a speed in rad/s, and their eigenvalues next to those of the finest mesh (m,).

    Raises:
        ConvergenceError: one of them is not found.
    """
    highest = float(np.abs(s).max())
    served, _ = with_casing_modes(_as_continuum(model), highest / (2.0 * np.pi))
    # Up to above the highest mode.
    exact = Continuum(linear_system(served, [speed]), speed, highest * (1.0 + _ABOVE_ALL))
    return exact, exact.roots(s)


def _apart(roots: np.ndarray, s: np.ndarray) -> str:
    """How far two methods are apart, in words."""
    return f"{float(np.max(np.abs(np.abs(roots) / np.abs(s) - 1.0))):.0e} from the finest mesh"


def _exact_modes(model: Model, finest: ModalResult) -> tuple[np.ndarray, str, float]:
    """Frequencies in Hz of the elastic modes from the dynamic stiffness of continuous shafts, in words what they are, and their
    rounding."""
    s = finest.eigenvalues[_elastic(finest)]
    try:
        exact, roots = _exact_eigenvalues(model, s, finest.speed)
    except ConvergenceError as error:
        words = f"the same elements, refined to {REFERENCE:g}, {finest.dofs} dofs: {error}"
        return np.abs(s) / (2.0 * np.pi), words, 0.0
    truth = np.abs(roots) / (2.0 * np.pi)
    words = (
        f"the exact dynamic stiffness of Timoshenko's shafts, {exact.system.n} dofs, by Newton's method, {_apart(roots, s)}; "
        f"{SHARED}"
    )
    # The highest mode may be one of a pair.
    limit = float(np.abs(s).max()) * (1.0 + _ABOVE_ALL)
    below, count = (exact.count_below(share * limit) for share in (1.0 - 2.0 * _ABOVE_ALL, 1.0))
    if finest.speed is not None or below is None or count is None:
        return truth, f"{words}; how many modes there are is the finest mesh's word", exact.rounding
    met = "which confirms them" if below < len(finest) <= count else f"not the {len(finest)} found"
    return truth, f"{words}; Wittrick and Williams count {count} modes up to there, {met}", exact.rounding


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
        reference: natural frequencies in Hz of the modes that are not rigid; None for those of continuous shafts (with
            consistent mass where the model's is lumped), next to the modes of the finest mesh.
        repeat: runs of each rung that are timed at least; the median time counts.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: the reference has fewer frequencies than asked for, or the model has no elastic mode.
    """
    finest = modal(_as_continuum(model), speed=speed, modes=modes, accuracy=REFERENCE)
    truth = finest.natural_frequency_hz[_elastic(finest)]
    if truth.size == 0:
        raise AnalysisError("the model has no elastic mode among those asked for, so there is no error to measure")
    rounding = 0.0
    if reference is None:
        progress(0.0, "reference")
        truth, words, rounding = _exact_modes(model, finest)
    else:
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
        resolution=max(RESOLUTION, 10.0 * rounding) if reference is None else 0.0,
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

    The errors are those of |s| of the lowest branches at every speed, against the eigenvalues of continuous shafts at that speed,
    next to those by `modal`: each solved for itself, without the reduced basis and without following branches.

    Args:
        model, stop: as for `campbell`.
        modes: how many branches are compared.
        elements, accuracies, repeat, progress: as for `convergence_study`.
    """

    def run(options: dict[str, Any]) -> CampbellResult:
        return campbell(model, stop=stop, points=_DIAGRAM, modes=modes, **options)

    truth = []
    rounding = 0.0
    words = f"eigenvalues of the exact dynamic stiffness of Timoshenko's shafts at each of {_DIAGRAM} speeds; {SHARED}"
    for k, speed in enumerate(run({"accuracy": 1e-2}).speeds):
        progress(0.4 * k / _DIAGRAM, f"reference, speed {k + 1} of {_DIAGRAM}")
        finest = modal(_as_continuum(model), speed=float(speed), modes=modes + 12, accuracy=REFERENCE)
        s = finest.eigenvalues
        s = s[~finest.rigid & (s.imag > _OSCILLATES * np.abs(s))]
        s = s[np.argsort(np.abs(s), kind="stable")][:modes]
        try:
            exact, s = _exact_eigenvalues(model, s, float(speed))
            rounding = max(rounding, exact.rounding)
        except ConvergenceError as error:
            words = (
                f"modes solved for themselves at each of {_DIAGRAM} speeds, meshes refined to {REFERENCE:g}: {error}"
            )
        truth.append(np.abs(s))
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
        reference=words,
        resolution=max(RESOLUTION, 10.0 * rounding),
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

    The reference are the speeds at which modes of continuous shafts meet the lines, next to those on the finest mesh.
    A speed that one of both has more than the other has an infinite error.

    Args:
        model, stop: as for `critical`.
        elements, accuracies, repeat, progress: as for `convergence_study`.

    Raises:
        AnalysisError: no critical speed in the range.
    """
    progress(0.0, "reference")
    finest = critical(_as_continuum(model), stop=stop, accuracy=REFERENCE)
    truth = {line: speeds for line, (speeds, _) in _by_line(finest).items()}
    if not finest.speeds:
        raise AnalysisError("there is no critical speed in this range, so there is no error to measure; raise --to")
    rounding = 0.0
    for line in truth:
        items = sorted((item for item in finest.speeds if item.line == line), key=lambda item: abs(item.speed))
        exact_speeds, roundings = np.abs([_exact_critical(model, item) for item in items]).T
        truth[line] = exact_speeds
        rounding = max(rounding, float(roundings.max()))
    # Branches that are followed over speed, and their crossings.
    diagram = campbell(model, stop=stop, fmax=1.2 * max(item.frequency_hz for item in finest.speeds))
    crossings = sum(item.line in truth for item in diagram.crossings)

    def judge(result: CriticalResult) -> Judged:
        here = _by_line(result)
        size = sum(max(len(exact), len(here.get(line, ((),))[0])) for line, exact in truth.items())
        error, estimate = np.full((2, size), np.inf)
        at = missed = 0
        for line, exact in truth.items():
            speeds, told = here.get(line, (np.zeros(0), np.zeros(0)))
            # Each goes with the nearest: of two counts, the pairs with the least difference stay together.
            pairs = _paired(exact, speeds)
            for k, (one, other) in enumerate(pairs):
                error[at + k] = abs(speeds[other] / exact[one] - 1.0)
                estimate[at + k] = told[other]
            missed += len(exact) + len(speeds) - 2 * len(pairs)
            at += max(len(exact), len(speeds))
        return Judged(result.dofs, error, estimate, missed)

    return Study(
        _settings(elements, accuracies),
        run=lambda options: critical(model, stop=stop, **options),
        judge=judge,
        compared="critical speeds",
        count=len(finest.speeds),
        reference="modes of the exact dynamic stiffness of Timoshenko's shafts on the lines, by Newton's method and secants; "
        f"{SHARED}; next to the {len(finest.speeds)} speeds of the finest mesh; a Campbell diagram has {crossings} crossings",
        resolution=max(RESOLUTION, 10.0 * rounding),
    ).result("critical", model, repeat, part_of(progress, 0.1, 1.0))


def _exact_critical(model: Model, item: CriticalSpeed) -> tuple[float, float]:
    """The speed in rad/s at which a mode of continuous shafts meets the line of a critical speed, Im s = p |W|; its rounding."""
    own = _as_continuum(model)
    w = 2.0 * np.pi * item.frequency_hz
    ratio = w / abs(item.speed)
    s = complex(-item.damping_ratio * w / np.sqrt(1.0 - item.damping_ratio**2), w)

    rounding = 0.0

    def beside(speed: float) -> float:
        nonlocal s, rounding
        exact = Continuum(linear_system(own, [speed]), speed, 1.1 * w)
        s = exact.root(s * (1.0 + _ASIDE))
        rounding = max(rounding, exact.rounding)
        return s.imag - ratio * abs(speed)

    found = root_scalar(
        beside, x0=item.speed * (1.0 + _ASIDE), x1=item.speed * (1.0 - _ASIDE), method="secant", rtol=1e-12
    )
    return float(found.root), rounding


def _paired(first: np.ndarray, second: np.ndarray) -> list[tuple[int, int]]:
    """Numbers of the values of both that go together, each once, with the least sum of relative differences."""
    rows, columns = linear_sum_assignment(np.abs(np.log(first[:, None] / second[None, :])))
    return list(zip(rows.tolist(), columns.tolist(), strict=True))


def _by_line(result: CriticalResult) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Critical speeds of each line by size, and their estimated errors."""
    found: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    for line in dict.fromkeys(item.line for item in result.speeds):
        items = sorted((item for item in result.speeds if item.line == line), key=lambda item: abs(item.speed))
        found[line] = np.array([abs(item.speed) for item in items]), np.array([item.error_estimate for item in items])
    return found


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

    The errors are those of the forces of contacts, bearings and supports, relative to the largest. The reference integrates the
    equations along each piece. The basic element is exact in statics: what remains is rounding, and the study shows that it is no
    more. Loads inside shafts and couplings are compared with those on four times the elements, each relative to its own size.

    Args:
        model, speed: as for `static`.
        elements, accuracies, repeat, progress: as for `convergence_study`.
    """
    finest = solved(model, Plan(), speed_or_operating(speed, model), silent, kind=ContinuumSystem)
    truth = forces_of(finest)
    size = max(float(np.abs(truth).max(initial=0.0)), np.finfo(float).tiny)
    deep = static(model, speed=speed, elements=4 * max(elements)).internal_loads if read_loads(model) else ()

    def judge(result: StaticResult) -> Judged:
        held = (*result.bearing_force.values(), *result.support_force.values())
        forces = np.concatenate([result.mesh_force, *held])
        pairs = zip(result.internal_loads, deep, strict=True)
        inside = [abs(own.load - best.load) / (abs(best.load) or 1.0) for own, best in pairs]
        errors = np.concatenate([np.abs(forces - truth) / size, inside])
        return Judged(result.dofs, errors, np.array([result.error_estimate]))

    return Study(
        _settings(elements, accuracies),
        run=lambda options: static(model, speed=speed, **options),
        judge=judge,
        compared="forces" if not deep else "forces, and loads inside shafts and couplings",
        count=len(truth) + len(deep),
        reference=f"Timoshenko's equations integrated along each piece, {finest.system.n} dofs; {SHARED}, and so "
        "is the search of the equilibrium",
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
    largest; the strongest orders are compared. The reference is solved directly at every speed; the rungs may take modes. Loads
    inside shafts and couplings are compared in these orders, each relative to its own largest.

    Args:
        model, fmax, modal_damping: as for `response`.
        elements, accuracies, repeat, progress: as for `convergence_study`.
    """

    def run(options: dict[str, Any], of: Model = model) -> ResponseResult:
        return response(of, points=101, fmax=fmax, modal_damping=modal_damping, **options)

    progress(0.0, "reference")
    by_elements = any(bearing.rigid_directions for bearing in model.bearings.values()) or bool(read_loads(model))
    inside = np.zeros((0, 0, 0))
    if modal_damping or model.damping.modal_ratio or by_elements:
        by_modes = modal_damping or model.damping.modal_ratio
        deep = {"accuracy": AMPLITUDE_REFERENCE} if by_modes else {"elements": 2 * max(elements)}
        finest = run({"method": "direct", **deep}, _as_continuum(model))
        truth = _forces(finest)
        inside = finest.internal_load
        words = f"direct solutions, {_finer(finest, by_elements=by_elements)}"
    else:
        first = run({"method": "direct", "elements": 1}, _as_continuum(model))
        truth, dofs = _exact_response(_as_continuum(model), first)
        words = f"the exact dynamic stiffness of Timoshenko's shafts at every speed, {dofs} dofs; {SHARED}"
    size = np.abs(truth).max(axis=2)
    strongest = strongest_orders(size)
    if not size[:, strongest].any():
        raise AnalysisError("nothing moves: the excitations of the model come to nothing")
    largest = size.max(axis=0)[strongest]
    loads = inside.shape[2]

    def judge(result: ResponseResult) -> Judged:
        difference = np.abs(_forces(result) - truth).max(axis=(0, 2))[strongest]
        error = difference / np.where(largest > 0.0, largest, 1.0)
        if loads:
            most = np.abs(inside[strongest]).max(axis=(0, 1))
            off = np.abs(result.internal_load - inside)[strongest].max(axis=(0, 1))
            error = np.concatenate([error, off / np.where(most > 0.0, most, 1.0)])
        return Judged(result.dofs, error, np.array([result.error_estimate]))

    words_of_loads = ", and loads inside shafts and couplings in them" if loads else ""
    return Study(
        _settings(elements, accuracies),
        run=run,
        judge=judge,
        compared=f"orders, each by its largest force over speed{words_of_loads}",
        count=len(strongest) + loads,
        reference=words,
        resolution=AMPLITUDE_RESOLUTION,
    ).result("response", model, repeat, part_of(progress, 0.2, 1.0))


# Speeds at which tangents of laws are taken.
_TANGENTS = 8


def _finer(finest: ResponseResult | FrequencyResponse, *, by_elements: bool = False) -> str:
    """What a finest mesh is in words, and why it has to do."""
    why = "damping by modes is that of the modes of a mesh"
    if by_elements:
        why = "elements tell loads inside shafts and forces of rigid bearings"
    own = f"its own error estimated at {finest.error_estimate:.0e}"
    return f"a mesh of {finest.dofs} dofs, {own}; the same elements, because {why}"


def _exact_response(model: Model, first: ResponseResult) -> tuple[np.ndarray, int]:
    """Forces (s, o, f) of all orders with continuous shafts, and their number of unknowns; the loads are those of the model."""
    speeds = first.speeds
    last = float(speeds[-1])
    top = float(np.max(first.ratio * abs(last) / (2.0 * np.pi) + first.fixed_frequency))  # Hz
    about = about_mean(model, [float(value) for value in speeds[:: max(1, len(speeds) // _TANGENTS)]], last)
    system = meshed(with_casing_modes(model, top)[0], about, last, top, 1)
    plant = ContinuumPlant(system)
    orders = orders_of(replace(about[1], system=system, lines=plant.lines))[0]
    kept = [order for order in orders if order.name in first.orders]
    return direct_sweep(plant, kept, speeds, silent)[0].stacked, system.n


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
# Accuracy of the state space that tells where peaks are, damping ratio above which they have a width, and where they are looked
# at, in half widths at half power.
_PEAKS = 1e-5
_WIDTH = 1e-9
_ABOUT_PEAKS = np.array([-1.5, -0.7, 0.0, 0.7, 1.5])


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
    at, fmax = _place_and_range(model, at, fmax)
    asked: dict[str, Any] = {"inputs": [at], "outputs": [at], "modal_damping": modal_damping}
    hz = np.linspace(fmax / _FREQUENCIES, fmax, _FREQUENCIES)
    progress(0.0, "reference")
    truth, words = _reference_receptance(model, asked, hz, 0.0)

    def judge(result: FrequencyResponse) -> Judged:
        error = relative_change(truth, result.receptance)
        return Judged(result.dofs, np.array([error]), np.array([result.error_estimate]))

    return Study(
        _settings(elements, accuracies),
        run=lambda options: frf(model, points=_FREQUENCIES, fmax=fmax, **asked, **options),
        judge=judge,
        compared="receptance",
        count=1,
        reference=f"{words}; force and response at {at}, {_FREQUENCIES} frequencies to {fmax:.5g} Hz",
        resolution=AMPLITUDE_RESOLUTION,
    ).result("frf", model, repeat, part_of(progress, 0.1, 1.0))


@recorded
def state_space_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    fmax: float | None = None,
    modal_damping: float = 0.0,
    at: str | None = None,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = AMPLITUDE_ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Make a state space of one place over a series of meshes, each with its reduction.

    The error is the largest difference of the receptance of the reduced system at any frequency, relative to the largest; the
    estimate is that of the mesh and that of the reduction together.

    Args:
        model, speed, modal_damping: as for `state_space`.
        fmax, at: as for `frf_convergence_study`.
        elements, accuracies, repeat, progress: as for `convergence_study`.

    Raises:
        AnalysisError: no place to take, or no elastic mode that says how far to go.
    """
    at, fmax = _place_and_range(model, at, fmax)
    asked: dict[str, Any] = {"inputs": [at], "outputs": [at], "modal_damping": modal_damping}
    turns = speed_in_si(speed) or 0.0
    progress(0.0, "reference")
    # Errors are relative to the largest response of the range: tops and flanks of its peaks belong to it.
    finest = state_space(model, fmax=fmax, speed=turns, accuracy=_PEAKS, **asked)
    poles = np.linalg.eigvals(finest.first_order()[0]) / (2.0 * np.pi)
    poles = poles[(poles.imag > 0.0) & (poles.real < -_WIDTH * poles.imag)]
    about = (poles.imag[:, None] + np.abs(poles.real[:, None]) * _ABOUT_PEAKS).ravel()
    even = np.linspace(fmax / _FREQUENCIES, fmax, _FREQUENCIES)
    hz = np.unique([*even, *about[(about > even[0]) & (about < fmax)]])
    truth, words = _reference_receptance(model, asked, hz, turns)

    def judge(result: StateSpace) -> Judged:
        error = relative_change(truth, result.receptance(hz))
        return Judged(result.dofs, np.array([error]), np.array([result.error_estimate + result.reduction_error]))

    return Study(
        _settings(elements, accuracies),
        run=lambda options: state_space(model, fmax=fmax, speed=turns, **asked, **options),
        judge=judge,
        compared="receptance of the reduced system",
        count=1,
        reference=f"{words}; input and output at {at}, {len(hz)} frequencies to {fmax:.5g} Hz",
        resolution=AMPLITUDE_RESOLUTION,
    ).result("state-space", model, repeat, part_of(progress, 0.1, 1.0))


def _place_and_range(model: Model, at: str | None, fmax: float | None) -> tuple[str, float]:
    """Where force and response are, and the highest frequency in Hz: as asked for, or chosen."""
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
    return at, fmax


def _reference_receptance(
    model: Model, asked: Mapping[str, Any], hz: np.ndarray, speed: float
) -> tuple[np.ndarray, str]:
    """Receptance (f, 1, 1) at a speed in rad/s that is taken for the truth, and what it is in words."""
    own = _as_continuum(model)
    if asked["modal_damping"] or model.damping.modal_ratio:
        finest = frf(own, hz, speed=speed, accuracy=AMPLITUDE_REFERENCE, **asked)
        return finest.receptance, _finer(finest)
    truth, dofs = _exact_receptance(own, asked["inputs"][0], hz, speed)
    return truth, f"the exact dynamic stiffness of Timoshenko's shafts, {dofs} dofs; {SHARED}"


def _exact_receptance(model: Model, at: str, hz: np.ndarray, speed: float) -> tuple[np.ndarray, int]:
    """Driving-point receptance (f, 1, 1) with continuous shafts at a speed in rad/s, and their number of unknowns."""
    served, _ = with_casing_modes(model, float(hz[-1]))
    about = about_mean(model, [speed or None], speed)
    exact = Continuum(linear_system(served, [speed], state=about[1].with_tangents(about[0])), speed)
    f = moving_rows(exact.system, [at]).T
    found = [f.T @ exact.solve(2.0 * np.pi * float(value), f) for value in hz]
    return np.array(found), exact.system.n
