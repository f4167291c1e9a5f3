"""Scatter of a model: what its uncertain numbers make of frequencies, margins to excitations and load sharing.

To first order a frequency moves by its energies, d w = phi^H (K' + i w W G' - w^2 M') phi / 2 w, so that
sigma_w^2 = sum_j (s_j dw/dz_j)^2, and each number's term is its share. Beside that stand samples: every one solved in a basis
that holds nominal modes and what the numbers add to them, at a small share of the cost of the whole system.
"""

from __future__ import annotations

import time as clock
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.common.pool import Pool, in_order
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_request, check_speed_is_fixed, check_whole, speed_in_si
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.scatter.family import Family, basis_of, family_of, nominal_modes, whole_modes
from rotorgear.analysis.scatter.gather import Sampled, gathered
from rotorgear.analysis.scatter.samples import SPARE, Study, frequency_slopes, groups_of, run_samples, share_slopes
from rotorgear.analysis.sensitivity.forms import FormNames, modes_of, with_shapes
from rotorgear.analysis.static.shares import load_shares
from rotorgear.analysis.static.state_at import linear_system, state_at
from rotorgear.analysis.static.static import solved
from rotorgear.analysis.transient.histories import Stream
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model, model_hash
from rotorgear.model.parts.operation import Scatter
from rotorgear.model.spreads import DISTRIBUTIONS, Spreads, graded_errors, spreads_of
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.results.scatter import ScatterResult
from rotorgear.solvers.sampling import SAMPLINGS, design, unit_points
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.system.plan import Plan

DEFAULT_SIGMA = "10 %"
_BLOCK = 32
_MOST_SAMPLES = 1_000_000
# Samples that are followed to the whole system, the outermost ones, and what the basis may be off before it grows by them.
_CHECKS = 6
_REDUCTION_ERROR = 1e-4
_ROUNDS = 3
# Samples that show which modes turn into each other, before all are run.
_PILOTS = 64
# Modes of K and M that carry the rotating ones, for each of these.
_WIDE = 2
# An elastic motion lies above this share of the first elastic frequency.
_LEAST = 1e-3


@dataclass(frozen=True)
class Request:
    """How a scatter is sampled: see `scatter`."""

    samples: int
    sampling: str
    seed: int
    sobol: int

    def __post_init__(self) -> None:
        check_whole("the number of samples", self.samples)
        check_whole("the number of base points (sobol)", self.sobol, 0)
        check_whole("the seed", self.seed, 0)
        if not 2 <= self.samples <= _MOST_SAMPLES:
            raise AnalysisError(f"samples: got {self.samples}, expected 2 to {_MOST_SAMPLES}")
        if self.sampling not in SAMPLINGS:
            raise AnalysisError(f"sampling: got '{self.sampling}', expected {', '.join(SAMPLINGS)}")
        if not (self.sobol == 0 or 8 <= self.sobol <= _MOST_SAMPLES):
            raise AnalysisError(f"sobol: got {self.sobol}, expected 0 (none) or 8 and more base points")


@recorded
def scatter(
    model: Model,
    free: str | Iterable[str] | Mapping[str, Scatter | dict[str, object]] | None = None,
    *,
    sigma: float | str | None = None,
    tolerance: float | str | None = None,
    distribution: str = "normal",
    samples: int = 1024,
    sampling: str = "sobol",
    seed: int = 1,
    sobol: int = 0,
    speed: float | str | None = None,
    modes: int = 20,
    margin: float | str = 0.15,
    participation: float = 1e-2,
    sharing: bool = False,
    accuracy: float | None = None,
    elements: int | None = None,
    workers: int | None = None,
    executor: Pool | None = None,
    stream: Stream | None = None,
    progress: Progress = silent,
) -> ScatterResult:
    """Return bands of frequencies, margins and load shares of a model whose numbers scatter, and what makes them.

    Args:
        model: the model. Its table [scatter] says what scatters, unless `free` does.
        free: addresses of the numbers that scatter, with commas between, "*" for all names or places there (default: the table
            [scatter] of the model); in Python also address -> its scatter.
        sigma: standard deviation of those numbers, a share such as "10 %" (the default) or a size such as "0.1 mm".
        tolerance: half width of a tolerance in place of it: the limits where uniform, else three standard deviations.
        distribution: distribution of those numbers: normal, lognormal or uniform.
        samples: number of samples.
        sampling: how the numbers are sampled: sobol (scrambled), latin (hypercube) or random.
        seed: seed of the samples.
        sobol: base points of Sobol indices, such as 512, each of which costs two samples and one more for each number; 0 for
            none.
        speed: speed of the input shaft in rad/s or with its unit (default: the operating speed, else standstill).
        modes: number of elastic modes, lowest first.
        margin: least distance of modes from excitations, for the share of samples below it.
        participation: least share of the exciting part in the energy of a mode for the mode to count.
        sharing: sample the load shares of meshes, too; index errors of gears with a class of ISO 1328 then scatter.
        accuracy: as in `modal`.
        elements: as in `modal`.
        workers: number of threads, on which the result does not depend (default: all cores).
        executor: takes the blocks in place of threads: `rotorgear.cluster(address)`, or any object with `submit`.
        stream: keeps blocks while samples go on (`rotorgear.stream`), and starts an interrupted run again.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a request that makes no sense; numbers that move a place past another one.
        ModelError: addresses that lead nowhere, sizes that a number can't have.
    """
    request = Request(samples, sampling, seed, sobol)
    at = speed_in_si(speed)
    if at is None and model.operation:
        at = model.operation.speed
    check_request(at, modes, None, elements, accuracy)
    least_margin = _share(margin, "margin")
    if not 0.0 < participation < 1.0:
        raise AnalysisError(f"participation: got {participation:g}, expected a share between 0 and 1, such as 0.01")
    spreads = spreads_of(model, _given(model, free, sigma, tolerance, distribution, sharing))
    check_speed_is_fixed(spreads.numbers.addresses, "--speed, and compare runs")
    begun = clock.perf_counter()
    with single_thread(0):
        plan = Plan(elements) if elements else _plan_of(model, at, modes + SPARE, accuracy)
        Z = np.vstack([_points(spreads, request), _ranking_points(spreads, request)])
        study, error, checked, lines_left = _study(
            spreads, at, plan, modes, participation, sharing, Z[: request.samples], part_of(progress, 0.05, 0.3)
        )
        laps = {"basis": clock.perf_counter() - begun}
        settings = {
            "model": model_hash(model),
            "run": f"{request} {spreads.size} {spreads.numbers.addresses} {modes} {at} {plan} "
            f"{spreads.distribution} {participation} {sharing}",
        }
        values = _run(study, Z, settings, stream, workers, executor, part_of(progress, 0.3, 1.0))
        laps["samples"] = clock.perf_counter() - begun - laps["basis"]
        slopes = frequency_slopes(study)
        sharing_slopes = share_slopes(study)
    sampled = Sampled(Z, values, request.samples, slopes, sharing_slopes, request.seed)
    result = gathered(study, sampled, least_margin, error)
    laps["total"] = clock.perf_counter() - begun
    notes = (
        "damping: natural frequencies are those of the undamped rotating system",
        *lines_left,
        *(() if sharing else ("load sharing of meshes: ask for it (--sharing)",)),
        *(
            f"face maps of {name} for each sample: all keep those of the model"
            for name in state_at(model, [at]).shared_maps
        ),
    )
    progress(1.0, "done")
    return replace(result, sampling=sampling, left_out=notes, seconds=laps, model=model, checked_samples=checked)


def _given(
    model: Model,
    free: str | Iterable[str] | Mapping[str, Scatter | dict[str, object]] | None,
    sigma: float | str | None,
    tolerance: float | str | None,
    distribution: str,
    sharing: bool,
) -> dict[str, Scatter]:
    """What scatters, by address."""
    if distribution not in DISTRIBUTIONS:
        raise AnalysisError(f"distribution: got '{distribution}', expected {', '.join(DISTRIBUTIONS)}")
    if sigma is not None and tolerance is not None:
        raise AnalysisError("give sigma or tolerance of the free numbers, not both")
    if free is None:
        if sigma is not None or tolerance is not None:
            raise AnalysisError("sigma and tolerance belong to --free: say which numbers scatter")
        found = dict(model.scatter)
    elif isinstance(free, Mapping):
        found = {name: entry if isinstance(entry, Scatter) else Scatter(**entry) for name, entry in free.items()}
    else:
        parts = free.split(",") if isinstance(free, str) else free
        size = (
            {"tolerance": tolerance} if tolerance is not None else {"sigma": DEFAULT_SIGMA if sigma is None else sigma}
        )
        entry = Scatter(**size, distribution=distribution)
        found = {part.strip(): entry for part in parts if part.strip()}
    if sharing:
        found = {**graded_errors(model), **found}
    if not found:
        raise AnalysisError(
            "nothing scatters: say what does by --free, such as --free 'bearings.*.stiffness' --sigma '10 %', or by [scatter] "
            "in the model file"
        )
    return found


def _share(value: float | str, what: str) -> float:
    from rotorgear.quantity import QuantityError, parse_quantity

    try:
        share = parse_quantity(value, "ratio")
    except QuantityError:
        share = -1.0
    if not 0.0 < share < 1.0:
        raise AnalysisError(f"{what}: got '{value}', expected a share between 0 and 1, such as '15 %'")
    return share


def _plan_of(model: Model, speed: float | None, modes: int, accuracy: float | None) -> Plan:
    """The mesh on which so many modes are within an accuracy, beside all rigid ones where these are more than the spare ones."""
    found = modal(model, modes=modes, speed=speed, accuracy=accuracy)
    asked = modes
    while len(found.rigid) == asked and np.count_nonzero(~found.rigid) < modes - SPARE:
        asked = 2 * asked
        found = modal(model, modes=asked, speed=speed, accuracy=accuracy)
    cut = {}
    counted: dict[str, int] = {}
    for piece in found.discretisation:
        number = counted.get(piece.shaft, 0)
        counted[piece.shaft] = number + 1
        cut[piece.shaft, number] = (piece.elements, piece.order)
    return Plan(cut=cut)


def _points(spreads: Spreads, request: Request) -> NDArray[np.float64]:
    return spreads.coordinates(unit_points(request.sampling, request.samples, len(spreads), request.seed))


def _ranking_points(spreads: Spreads, request: Request) -> NDArray[np.float64]:
    """Points of the Sobol indices, from an own sequence."""
    if not request.sobol:
        return np.zeros((0, len(spreads)))
    return spreads.coordinates(design(unit_points("sobol", request.sobol, 2 * len(spreads), request.seed + 1)))


def _study(
    spreads: Spreads,
    speed: float | None,
    plan: Plan,
    modes: int,
    participation: float,
    sharing: bool,
    Z: NDArray[np.float64],
    progress: Progress,
) -> tuple[Study, float, int, tuple[str, ...]]:
    """What the samples are asked, the error of its basis, at how many samples it was judged, notes on what is out of reach."""
    model = spreads.numbers.model
    system = linear_system(model, [speed], plan)
    values, X, rigid = nominal_modes(system, speed, _WIDE * (modes + SPARE))
    if rigid >= len(values):
        raise AnalysisError("the model has no elastic mode")
    least = _LEAST * float(np.sqrt(values[rigid]))
    wide = len(values) + _WIDE * SPARE
    progress(0.1, "basis")
    V = basis_of(spreads, speed, plan, system, values, X)
    outer = Z[np.argsort(-np.sum(Z**2, axis=1), kind="stable")[:_CHECKS]]
    for round_number in range(_ROUNDS):
        family = family_of(spreads, speed, plan, V, part_of(progress, 0.2, 0.8))
        # What the basis was not made from: halves take turns, so that no sample that it grew by judges it.
        judges = outer[round_number % 2 :: 2]
        error, shapes = _error_of(family, judges, modes, least, wide)
        if error <= _REDUCTION_ERROR or round_number == _ROUNDS - 1:
            break
        V = with_shapes(system.mass, V, np.hstack([shapes.real, shapes.imag]))
    nominal = modes_of(family.nominal, modes + SPARE, least, wide)
    lines: tuple[ExcitationOrder, ...] = excitation_orders(model) if speed else ()
    top = float(nominal.omega[min(modes, len(nominal.omega)) - 1]) / (2.0 * np.pi)
    hz = np.array([line.frequency_hz(speed or 0.0) for line in lines])
    inside = hz <= top if len(lines) else np.zeros(0, dtype=bool)
    beyond = [line.name for line, near in zip(lines, inside, strict=True) if not near]
    notes = (f"excitations above the highest mode ({top:.4g} Hz; --modes): {', '.join(beyond)}",) if beyond else ()
    shared: tuple[tuple[str, str], ...] = ()
    if sharing:
        shared = tuple(load_shares(solved(model, Plan(1), speed, silent).equilibrium))
        if not shared:
            notes = (*notes, "load sharing: no gear of the model shares its load among meshes")
    chosen = tuple(line for line, near in zip(lines, inside, strict=True) if near)
    study = Study(
        family,
        min(modes, len(nominal.omega)),
        wide,
        least,
        nominal,
        (),
        chosen,
        hz[inside],
        participation,
        FormNames.of(family.spreads.numbers.model, speed),
        shared,
    )
    return replace(study, groups=groups_of(study, Z[:_PILOTS])), error, len(judges), notes


def _error_of(
    family: Family, judges: NDArray[np.float64], modes: int, least: float, wide: int
) -> tuple[float, NDArray[np.complex128]]:
    """Largest relative error of a frequency at some samples, and the shapes of the whole system there (n, k)."""
    worst = 0.0
    shapes = []
    for z in judges:
        found = modes_of(family.at(z), modes, least, wide)
        omega, whole = whole_modes(family, z, found)
        worst = max(worst, float(np.max(np.abs(found.omega / omega - 1.0))))
        shapes.append(whole)
    return worst, np.hstack(shapes)


def _run(
    study: Study,
    Z: NDArray[np.float64],
    settings: dict[str, str],
    stream: Stream | None,
    workers: int | None,
    executor: Pool | None,
    progress: Progress,
) -> dict[str, NDArray[np.float64]]:
    """Values of all samples; blocks that an interrupted run kept are taken over."""
    kept = stream.begin(settings) if stream else []
    starts = range(0, len(Z), _BLOCK)
    tasks = ((study, Z[k : k + _BLOCK]) for k in starts[len(kept) :])
    fresh = _kept_as_they_come(in_order(run_samples, tasks, workers, executor), stream)
    blocks = []
    for block in chain(kept, fresh):
        blocks.append(block)
        progress(len(blocks) / len(starts), f"{min(len(blocks) * _BLOCK, len(Z))} of {len(Z)} samples")
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def _kept_as_they_come(
    blocks: Iterator[dict[str, NDArray[np.float64]]], stream: Stream | None
) -> Iterator[dict[str, NDArray[np.float64]]]:
    for block in blocks:
        if stream:
            stream.write(block)
        yield block
