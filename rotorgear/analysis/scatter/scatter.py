"""Scatter of a model: what its uncertain numbers make of frequencies, margins to excitations and load sharing.

To first order a frequency moves by its energies, d w = phi^H (K' + i w W G' - w^2 M') phi / 2 w, so that
sigma_w^2 = sum_j (s_j dw/dz_j)^2, and each number's term is its share. Beside that are samples: every one solved in a basis
that holds nominal modes and what the numbers add to them, at a small share of the cost of the whole system.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.discretise import cut_of
from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.common.forecast import Forecast
from rotorgear.analysis.common.pool import Pool, in_order
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import (
    check_request,
    check_speed_is_fixed,
    check_whole,
    share_of,
    speed_or_operating,
)
from rotorgear.analysis.common.stream import Stream
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.scatter.family import basis_of, family_of, nominal_modes, whole_modes
from rotorgear.analysis.scatter.gather import gathered
from rotorgear.analysis.scatter.samples import SPARE, Study, groups_of, run_samples
from rotorgear.analysis.sensitivity.forms import Floats, modes_of, with_shapes
from rotorgear.analysis.static.shares import load_shares
from rotorgear.analysis.static.state_at import linear_system, state_at
from rotorgear.analysis.static.static import solved
from rotorgear.cpu import Clock
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
    check_whole("the number of samples", samples)
    check_whole("the number of base points (sobol)", sobol, 0)
    check_whole("the seed", seed, 0)
    if not 2 <= samples <= _MOST_SAMPLES:
        raise AnalysisError(f"samples: got {samples}, expected 2 to {_MOST_SAMPLES}")
    if sampling not in SAMPLINGS:
        raise AnalysisError(f"sampling: got '{sampling}', expected {', '.join(SAMPLINGS)}")
    if not (sobol == 0 or 8 <= sobol <= _MOST_SAMPLES):
        raise AnalysisError(f"sobol: got {sobol}, expected 0 (none) or 8 and more base points")
    at = speed_or_operating(speed, model)
    check_request(modes=modes, elements=elements, accuracy=accuracy)
    least_margin = share_of(margin, "margin")
    share_of(participation, "participation", "0.01")
    spreads = spreads_of(model, _given(model, free, sigma, tolerance, distribution, sharing))
    check_speed_is_fixed(spreads.numbers.addresses, "--speed, and compare runs")
    clock = Clock()
    with single_thread(0):
        plan = Plan(elements or 1)
        if not elements:
            # All these modes are to be within the accuracy, beside all rigid ones where these are more than the spare ones.
            asked = modes + SPARE
            while True:
                found = modal(model, modes=asked, speed=at, accuracy=accuracy)
                if len(found.rigid) < asked or np.count_nonzero(~found.rigid) >= modes:
                    break
                asked = 2 * asked
            plan = Plan(cut=cut_of(found.discretisation))
        count = len(spreads)
        Z = spreads.coordinates(unit_points(sampling, samples, count, seed))
        if sobol:
            # Points of the Sobol indices are from a sequence of their own.
            Z = np.vstack([Z, spreads.coordinates(design(unit_points("sobol", sobol, 2 * count, seed + 1)))])
        study, error, checked, lines_left = _study(
            spreads, at, plan, modes, participation, sharing, Z[:samples], part_of(progress, 0.05, 0.3)
        )
        clock.lap("basis")
        settings = {
            "model": model_hash(model),
            "run": f"{samples} {sampling} {seed} {sobol} {spreads.size} {spreads.numbers.addresses} {modes} {at} {plan} "
            f"{spreads.distribution} {participation} {sharing}",
        }
        # Blocks that an interrupted run kept are taken over.
        blocks = list(stream.begin(settings)) if stream else []
        starts = range(0, len(Z), _BLOCK)
        tasks = ((study, Z[k : k + _BLOCK]) for k in starts[len(blocks) :])
        running = part_of(progress, 0.3, 1.0)
        forecast = Forecast("scatter", clock.worked, len(starts) - len(blocks))
        for block in in_order(run_samples, tasks, workers, executor, spent=forecast.add):
            if stream:
                stream.write(block)
            blocks.append(block)
            running(len(blocks) / len(starts), f"{min(len(blocks) * _BLOCK, len(Z))} of {len(Z)} samples")
        values = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
        clock.lap("samples")
        known = {"sampling": sampling, "checked_samples": checked, "frequency_basis_error": error}
        result = gathered(study, Z, values, samples, seed, least_margin, **known)
    clock.lap("samples")
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
    return replace(result, left_out=notes, seconds=clock.total())


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
        sigma = DEFAULT_SIGMA if sigma is None and tolerance is None else sigma
        entry = Scatter(sigma=sigma, tolerance=tolerance, distribution=distribution)
        found = {part.strip(): entry for part in parts if part.strip()}
    if sharing:
        found = {**graded_errors(model), **found}
    if not found:
        raise AnalysisError(
            "nothing scatters: say what does by --free, such as --free 'bearings.*.stiffness' --sigma '10 %', or by [scatter] "
            "in the model file"
        )
    return found


def _study(
    spreads: Spreads,
    speed: float | None,
    plan: Plan,
    modes: int,
    participation: float,
    sharing: bool,
    Z: Floats,
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
        error = 0.0
        shapes = []
        for z in judges:
            there = modes_of(family.at(z), modes, least, wide)
            omega, whole = whole_modes(family, z, there)
            error = max(error, float(np.max(np.abs(there.omega / omega - 1.0))))
            shapes.append(whole)
        if error <= _REDUCTION_ERROR or round_number == _ROUNDS - 1:
            break
        more = np.hstack(shapes)
        V = with_shapes(system.mass, V, np.hstack([more.real, more.imag]))
    nominal = modes_of(family.nominal, modes + SPARE, least, wide)
    lines: tuple[ExcitationOrder, ...] = excitation_orders(model) if speed else ()
    top = float(nominal.omega[min(modes, len(nominal.omega)) - 1]) / (2.0 * np.pi)
    chosen = tuple(line for line in lines if line.frequency_hz(speed or 0.0) <= top)
    beyond = [line.name for line in lines if line not in chosen]
    notes = (f"excitations above the highest mode ({top:.4g} Hz; --modes): {', '.join(beyond)}",) if beyond else ()
    shared: tuple[tuple[str, str], ...] = ()
    if sharing:
        shared = tuple(load_shares(solved(model, Plan(1), speed, silent)))
        if not shared:
            notes = (*notes, "load sharing: no gear of the model shares its load among meshes")
    study = Study(family, min(modes, len(nominal.omega)), wide, least, nominal, (), chosen, participation, shared)
    return replace(study, groups=groups_of(study, Z[:_PILOTS])), error, len(judges), notes
