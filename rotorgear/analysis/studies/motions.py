"""Studies of motions: steps, methods and modes of a transient, steps and length of a point of a sweep, and harmonics and instants
of a periodic motion."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import needed_speed
from rotorgear.analysis.common.study import REPEAT, Judged, Setting, Study, keeper
from rotorgear.analysis.orbits.family import SPEED, SystemFamily, outputs_of, range_of
from rotorgear.analysis.orbits.orbits import HARMONICS, INSTANTS, change, equations_of, scale_of, statistics_of
from rotorgear.analysis.orbits.verify import run_periods, settled
from rotorgear.analysis.sweep.classify import period_in
from rotorgear.analysis.sweep.sweep import sweep
from rotorgear.analysis.transient.transient import transient
from rotorgear.cpu import cpu_seconds
from rotorgear.errors import AnalysisError, ConvergenceError, RotorgearError
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.progress import Progress, part_of, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.convergence import ConvergenceStudy, SweepConvergenceStudy, SweepRung
from rotorgear.results.sweep import SweepResult
from rotorgear.results.transient import TransientResult, is_shown
from rotorgear.solvers.periodic.arclength import at_value
from rotorgear.solvers.periodic.balance import HarmonicGrid
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.periodic.shooting import ShootingOrbits
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.solvers.time.statistics import STATISTICS
from rotorgear.system.system import flow_system

_ROUNDING = 1e-9

# Of a transient: methods, shares of all modes, steps of the reference in a period of the fastest mesh.
_METHODS = ("newmark", "generalised-alpha", "exponential")
_SHARES = (0.25, 0.5)
_REFERENCE_STEPS = 5120
_RECORDS = 40
_PERIODS = 8


@recorded
def transient_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    time: float | str | None = None,
    modal_damping: float | None = None,
    steps: Sequence[int] = (40, 80, 160, 320, 640),
    accuracies: Sequence[float] = (1e-2, 1e-3, 1e-4),
    repeat: int = 1,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run a transient from its equilibrium over a series of steps, methods and numbers of modes, and to accuracies.

    Error and estimate are those of the statistics that a transient shows: mean, rms and largest of every contact force, loss and
    coast, transmission error and approach peak to peak, and mean, rms, largest and smallest of channels, each relative to its own
    size. The reference is the exponential method with all modes
    and 5120 steps in a period of the fastest mesh, another method than Newmark's family; it is compared with Newmark's method at
    as many steps, and errors below their difference are not judged.

    Args:
        model: as for `transient`.
        speed: as for `transient`.
        modal_damping: as for `transient`. Damping by modes leaves only the exponential method.
        time: duration in s or as a text; 8 periods of the slowest mesh where not given.
        steps: numbers of steps in a period of the fastest mesh, multiples of 40.
        accuracies: accuracies that the analysis chooses its step for itself.
        repeat: runs of each rung that are timed at least.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a model without meshes, or without excitation.
    """
    if not model.meshes:
        raise AnalysisError("the convergence study of a transient compares contact forces: the model has no mesh")
    system = flow_system(model, plan_in_time())
    fixed: dict[str, Any] = {"speed": speed, "discard": 0.0, "records": _RECORDS, "modal_damping": modal_damping}
    if time is None:
        given = needed_speed(speed, model)
        once = [model.layout.mesh_frequency(name, abs(given)) for name in model.meshes]
        turning = [frequency for frequency in once if frequency]
        if not turning:
            raise AnalysisError("nothing turns that says how long to run: give a time, and a speed")
        time = _PERIODS / min(turning)
    fixed["time"] = time
    fine: dict[str, Any] = {"steps": _REFERENCE_STEPS, "error_estimate": False, **fixed}
    damped = model.damping.modal_ratio if modal_damping is None else modal_damping
    progress(0.0, "reference")
    truth = transient(system, method="exponential", **fine)
    if truth.mesh_force.std(axis=0).max() <= 1e-9 * np.abs(truth.mesh_force).max():
        raise AnalysisError("nothing moves: give a transmission error, a stiffness variation or an unbalance")
    shown = np.array([is_shown(name) for name in truth.quantity])
    known = shown & np.isfinite(truth.quantity_scale) & (truth.quantity_scale > 0.0)

    def errors(found: TransientResult) -> np.ndarray:
        difference = np.abs(found.quantity_value[known] - truth.quantity_value[known])
        return np.asarray(difference / truth.quantity_scale[known])

    words = f"the exponential method with all modes and {_REFERENCE_STEPS} steps in a mesh period"
    resolution = _ROUNDING
    if not damped:
        progress(0.1, "reference by another method")
        other = transient(system, method="newmark", **fine)
        # Newmark's method is the worse of the two by far: their difference is more than the error of the reference.
        resolution = max(0.1 * float(errors(other).max(initial=0.0)), _ROUNDING)
        words += f", {10.0 * resolution:.0e} from Newmark's method with as many"
    plans: list[tuple[str, dict[str, Any]]] = [
        (name, {"method": name}) for name in _METHODS if not damped or name == "exponential"
    ]
    reduced = [int(share * truth.dofs) for share in _SHARES]
    plans += [(f"{n} modes", {"method": "exponential", "modes": n}) for n in reduced if n > 20]
    settings = [
        Setting(f"{name}, {count} steps", name, float(count), {**options, "steps": count})
        for name, options in plans
        for count in steps
    ] + [Setting(f"accuracy {a:g}", "accuracy", a, {"accuracy": a}) for a in accuracies]
    return Study(
        settings,
        run=lambda options: transient(system, **options, **fixed),
        judge=lambda found: Judged(found.dofs, errors(found), np.array([found.error_estimate])),
        compared="statistics",
        count=int(known.sum()),
        reference=words,
        resolution=resolution,
        # With modes missing the error does not fall with the step: there is no order to measure.
        rising=_METHODS,
    ).result("transient", model, repeat, part_of(progress, 0.2, 1.0))


# Of a sweep: least common periods that are discarded; the spread of the initial states, far enough apart for chaos to forget and
# near enough to stay with one motion; steps of the reference over the most steps.
_DISCARD = 300
_SPREAD = 1e-3
_FINER_STEPS = 4
# Shares of the operating speed that are tried for a point with one motion, periods that show it, and how near all states end.
_SPEED_SHARES = (1.0, 0.9, 1.1, 0.8, 1.2, 0.7, 1.3, 0.6, 0.5)
_TRIED = 30
_ALIKE = 1e-3
# Share by which steps change the size of a motion that repeats, at most; another one is another motion.
_SAME = 0.1


@recorded
def sweep_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    steps: Sequence[int] = (50, 100, 200, 400),
    counts: Sequence[int] = (50, 200, 800),
    starts: int = 32,
    progress: Progress = silent,
) -> SweepConvergenceStudy:
    """Run one point with several steps and lengths, each from many states near the static one, side by side.

    Only states that end on the same motion are compared, with one another and with the reference: that of most states there,
    found by shooting, another method, where it repeats and the model is small; else with four times the steps.
    The scatter of states is a check of the standard error that a single run states. Error and estimate are those of the
    statistics of the worst contact in a run, each relative to its own size: the root mean square over the states, and the
    median of what they state.

    Args:
        model: a small model.
        speed: in rad/s or as a text; where not given the operating speed, or one near it at which a single motion attracts all
            states.
        steps: in a period of the fastest mesh.
        counts: least common periods that count.
        starts: states, at least 2.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: fewer than two states, or a model that sweeps don't take.
    """
    if starts < 2:
        raise AnalysisError(f"starts: got {starts}, expected 2 or more, whose scatter is compared")
    given = needed_speed(speed, model)
    notes: list[Note] = []
    if speed is None:
        progress(0.0, "a point with one motion")
        given, notes = _one_motion(model, given, starts)

    def run(n: int, count: int) -> SweepResult:
        at = {"operation.speed": [given]}
        return sweep(model, at, initial_conditions=starts, throw=_SPREAD, steps=n, discard=_DISCARD, sample=count)

    plans = [(n, max(counts)) for n in steps] + [(max(steps) // 2, count) for count in counts[:-1]]
    progress(0.1, "reference")
    piece = keeper()
    finest = piece(lambda: {"sweep": run(_FINER_STEPS * max(steps), max(counts))})["sweep"]
    worst = int(np.argmax(finest.peak_to_peak[0].mean(axis=0)))
    kept = on_same_motion(finest.motion, finest.peak_to_peak[0, :, worst])
    kind = finest.motion[int(np.argmax(kept))]
    like = kind, float(finest.peak_to_peak[0, kept, worst].mean())
    truth = _statistics(finest, worst)[kept].mean(axis=0)
    finer = f"{_FINER_STEPS * max(steps)} steps of the same method and {max(counts)} periods"
    reference = f"{finer}, the mean over the states on that motion"
    exact = _by_shooting(model, given, kind, finest.contact[worst])
    if exact is not None and abs(exact[-1] - truth[-1]) <= _SAME * exact[-1]:
        truth = exact
        reference = "shooting, another method, whose steps end where flanks meet and part"
    if not kept.all():
        why = f"{kept.sum()} of {starts} states end on the one that is compared, {kind}"
        notes = [*notes, Note("", "several motions coexist at this point", why)]

    def rung_of(n: int, count: int) -> dict[str, SweepRung]:
        begun = cpu_seconds()
        runs = run(n, count)
        seconds = cpu_seconds() - begun
        kept = on_same_motion(runs.motion, runs.peak_to_peak[0, :, worst], like)
        return {"rung": _rung_of(runs, worst, kept, (n, count, seconds / starts), truth)}

    rungs = []
    for number, plan in enumerate(plans):
        progress(0.2 + 0.8 * number / len(plans), f"{plan[0]} steps, {plan[1]} periods")
        rungs.append(piece(partial(rung_of, *plan))["rung"])
    progress(1.0, "done")
    return SweepConvergenceStudy(
        model.title or "model",
        starts,
        tuple(rungs),
        speed=given,
        reference=reference,
        warnings=tuple(notes),
    )


def _rung_of(
    runs: SweepResult, worst: int, kept: np.ndarray, of: tuple[int, int, float], truth: np.ndarray
) -> SweepRung:
    """A row: of steps, periods and CPU seconds of a run, over the states (r,) that are kept of those on the worst contact."""
    many = int(kept.sum())
    peak = runs.peak_to_peak[0, kept, worst]
    factor = runs.dynamic_factor[0, kept, worst]
    exponents = runs.lyapunov[0, kept, 0]

    def mean(values: np.ndarray) -> float:
        return float(values.mean()) if many else float("nan")

    def scatter(values: np.ndarray) -> float:
        return float(values.std(ddof=1)) if many > 1 else float("nan")

    error = estimate = float("nan")
    if many:
        size = np.hypot(truth[0], truth[1])
        # A share is of one, a least value as large as the force.
        scale = np.where(np.isin(STATISTICS, _SHARES_OF_TIME), 1.0, np.maximum(np.abs(truth), 1e-300))
        scale[0] = size
        off = (_statistics(runs, worst)[kept] - truth) / scale
        error = float(np.nanmax(np.sqrt(np.mean(off**2, axis=0))))
        told = runs.statistics_error[0, kept, worst][:, [runs.statistic.index(name) for name in STATISTICS]]
        estimate = float(np.nanmax(np.median(told, axis=0) / scale))
    return SweepRung(
        *of,
        mean(exponents),
        scatter(exponents),
        float(np.median(runs.lyapunov_error[0, kept, 0])) if many else float("nan"),
        mean(peak),
        scatter(peak),
        mean(factor),
        scatter(factor),
        tuple(sorted(set(runs.motion))),
        error=error,
        estimate=estimate,
        effectivity=estimate / error if error > _ROUNDING else None,
    )


_SHARES_OF_TIME = ("contact loss", "coast contact")


def _statistics(runs: SweepResult, contact: int) -> np.ndarray:
    """`STATISTICS` of the runs of a point, (r, 8); a sweep does not tell the smallest force."""
    told = {
        "mean force": runs.mean_force,
        "rms force": runs.rms_force,
        "largest force": runs.largest_force,
        "contact loss": runs.apart,
        "coast contact": runs.back,
        "transmission error": runs.peak_to_peak_transmission_error,
        "approach": runs.peak_to_peak_approach,
    }
    nothing = np.full(runs.mean_force.shape, np.nan)
    return np.stack([told.get(name, nothing)[0, :, contact] for name in STATISTICS], axis=1)


def _by_shooting(model: Model, speed: float, kind: str, contact: str) -> np.ndarray | None:
    """`STATISTICS` (8,) of a contact on the motion that a transient settles on, by shooting; None where that does not serve."""
    periods = period_in(kind)
    if not periods:
        return None
    try:
        family = SystemFamily(model, [range_of(model, SPEED, [speed, _RANGE * speed])], None, None)
        outputs = outputs_of(family)
        plant = family.plant(0.0)
        grid = HarmonicGrid(HARMONICS, INSTANTS * HARMONICS, family.order)
        equations, _ = equations_of("shooting", family, grid, scale_of(plant))
        assert isinstance(equations, ShootingOrbits)
        equations.periods = periods
        node = at_value(equations, settled(equations, family, 0.0, silent), 0.0)
    except RotorgearError:
        return None
    found = statistics_of(equations.cycle(node.y, 0.0), plant, outputs).values[outputs.contact.index(contact)]
    found[STATISTICS.index("smallest force")] = np.nan
    return np.asarray(found)


def on_same_motion(kinds: Sequence[str], sizes: np.ndarray, like: tuple[str, float] | None = None) -> np.ndarray:
    """Which states (s,) end on one motion: that which most of them do, or one that is known.

    Args:
        kinds: response types (s,). sizes: peak to peak (s,), by which motions that repeat are told apart.
        like: response type and size of the known motion.
    """
    if like is None:
        which = [(kind, float(size)) for kind, size in zip(kinds, sizes, strict=True)]
        return max((on_same_motion(kinds, sizes, one) for one in which), key=np.count_nonzero)
    kind, size = like
    near = np.abs(sizes - size) <= _SAME * size if period_in(kind) else np.ones(len(sizes), dtype=bool)
    return np.asarray((np.array(kinds) == kind) & near)


def _one_motion(model: Model, operating: float, starts: int) -> tuple[float, list[Note]]:
    """The speed nearest to the operating one, of a few, at which all states end on one motion, and what to say of that.

    Several motions at one point, each with its own values, show no error of steps or length.
    """
    speeds = [share * operating for share in _SPEED_SHARES]
    at = {"operation.speed": speeds}
    runs = sweep(model, at, initial_conditions=starts, throw=_SPREAD, discard=_DISCARD, sample=_TRIED)
    for k, speed in enumerate(speeds):
        # Contacts that hardly move have a peak to peak of rounding only.
        sizes = runs.peak_to_peak[k]
        kinds = {runs.motion_at(k, r) for r in range(starts)}
        if len(kinds) == 1 and np.ptp(sizes, axis=0).max() <= _ALIKE * sizes.max():
            rpm = [f"{value * RPM_PER_RAD_S:.6g} rpm" for value in (operating, speed)]
            what = f"several motions coexist at {rpm[0]}; this is {rpm[1]}, where all states meet one"
            return speed, [Note("", what)] if k else []
    why = "their values differ more than steps make them; give a speed"
    return operating, [Note("", "several motions coexist at this point", why)]


# Of a periodic motion: the reference has this many times the most harmonics, as long as its equations are no more than the limit.
_FINER_HARMONICS = 3
_MOST_UNKNOWNS = 2500
# A branch needs a range: the motion is the one at its begin.
_RANGE = 1.01
_STEPS = 8000


@recorded
def orbits_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    excite: str | None = None,
    harmonics: Sequence[int] = (5, 10, 20, 40, 80),
    densities: Sequence[int] = (6, 8, 16, 32, 64),
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Solve for one periodic motion with series of harmonics and of instants, by harmonic balance.

    Errors and estimates are those of the displacements of every mesh contact (without meshes, of those across bearings, nonlinear
    elements and at unbalances): the largest difference of their coefficients over the largest harmonic of that displacement; the
    estimate is the change with twice the harmonics and instants, as `orbits` states it.
    Small systems are compared with shooting, another method. Larger ones are compared with harmonic balance of more harmonics; a
    transient that starts on that motion tells how near it comes back after one period.

    All begin at the motion of the reference, as a branch begins each point near the one before. The time is that of the motion
    and its multipliers, without the estimate, which a branch makes at three points.

    Args:
        model: as for `orbits`.
        excite: as for `orbits`.
        speed: of the input shaft, in rad/s or as a text; the operating speed where not given.
        harmonics: numbers of harmonics, each with 16 instants a harmonic.
        densities: instants for each of 30 harmonics, 5 or more.
        repeat: runs of each rung that are timed at least.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no speed, nothing that tells motions apart, fewer than 5 instants a harmonic, or no periodic motions.
        ConvergenceError: neither the static state nor a transient leads to a motion at this speed.
    """
    given = needed_speed(speed, model)
    if min(densities, default=INSTANTS) < 5:
        raise AnalysisError(f"densities: got {min(densities)}, expected 5 instants a harmonic or more")
    if not given:
        raise AnalysisError("the shafts stand still, where nothing repeats: ask for a speed (--speed)")
    family = SystemFamily(model, [range_of(model, SPEED, [given, _RANGE * given])], excite, None)
    order = family.order
    outputs = outputs_of(family)
    columns = outputs.columns
    plant = family.plant(0.0)
    scale = scale_of(plant)

    def solved(n: int, instants: int, begin: np.ndarray | None) -> tuple[HarmonicOrbits, np.ndarray]:
        """The motion of n harmonics, found from that of given coefficients (harmonics + 1, m), else from the static state or the
        end of a transient."""
        equations = HarmonicOrbits(family.plant, HarmonicGrid(n, instants, order), scale)
        if begin is None:
            try:
                return equations, at_value(equations, equations.start(0.0), 0.0).y
            except ConvergenceError:
                return equations, at_value(equations, settled(equations, family, 0.0, progress), 0.0).y
        c = np.pad(begin[: n + 1], ((0, max(0, n + 1 - len(begin))), (0, 0)))
        return equations, at_value(equations, equations.unknowns(c), 0.0).y

    with single_thread(0):
        progress(0.0, "reference")
        finest = min(_FINER_HARMONICS * max(harmonics), (_MOST_UNKNOWNS // plant.m - 1) // 2)
        usual, y = solved(HARMONICS, INSTANTS * HARMONICS, None)
        half, y = solved(finest // 2, INSTANTS * (finest // 2), usual.coefficients(y))
        coarser = half.coefficients(y)
        best, y = solved(finest, INSTANTS * finest, coarser)
        truth = best.coefficients(y)
        motion = best.state(y, 0.0)
        other, method = equations_of("auto", family, best.grid, scale)
        if isinstance(other, ShootingOrbits):
            node = at_value(other, other.from_motion(*motion, plant), 0.0)
            balance = truth
            truth = other.cycle(node.y, 0.0).displacement
            gap = float(change(balance, truth, columns).max())
            # Shooting is the better of the two by far: their difference is more than its own error.
            resolution = max(0.1 * gap, _ROUNDING)
            words = f"{method}, {gap:.0e} from harmonic balance with {finest} harmonics"
        else:
            # From order 2 on the error of the finer one is less than a third of the last change.
            resolution = max(float(change(coarser, truth, columns).max()) / 3.0, _ROUNDING)
            _, d = run_periods(family.system([0.0]), order, 1, *motion, _STEPS)
            seen = d[:, columns]
            missed = np.abs(seen[-1] - (plant.B.T @ motion[0])[columns]) / np.ptp(seen, axis=0)
            words = (
                f"harmonic balance with {finest} harmonics; a transient that starts there comes back to "
                f"{missed.max():.0e} of its peak to peak after a period"
            )

    def run(options: dict[str, Any]) -> tuple[HarmonicOrbits, np.ndarray]:
        equations, y = solved(options["harmonics"], options["instants"], truth)
        equations.multipliers(y, 0.0)
        return equations, y

    def judge(found: tuple[HarmonicOrbits, np.ndarray]) -> Judged:
        equations, y = found
        c = equations.coefficients(y)
        finer = equations.finer()
        better = finer.coefficients(at_value(finer, equations.lifted(y, finer), 0.0).y)
        return Judged(equations.size, change(c, truth, columns), change(c, better, columns))

    plans = [("harmonics", h, h, INSTANTS * h) for h in harmonics if 2 * h <= finest]
    plans += [("instants", n, HARMONICS, HARMONICS * n) for n in densities if finest >= 2 * HARMONICS]
    compared = "contacts" if outputs.contact else "bearings, elements and unbalances"
    return Study(
        [
            Setting(f"{h} harmonics, {instants} instants", knob, value, {"harmonics": h, "instants": instants})
            for knob, value, h, instants in plans
        ],
        run=run,
        judge=judge,
        compared=f"displacements of the {compared}",
        count=columns.size,
        reference=words,
        resolution=resolution,
        rising=("harmonics", "instants"),
    ).result("orbits", model, repeat, part_of(progress, 0.3, 1.0))
