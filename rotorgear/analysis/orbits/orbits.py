"""Periodic motions over a parameter: branches with stable and unstable parts, Floquet multipliers, special points.

The result of a continuation from its branches.

Error of motions along a branch: from twice the harmonics and instants, or from shooting to a tighter tolerance.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

import numpy as np

from rotorgear.analysis.common.casings import time_warnings
from rotorgear.analysis.common.left_out import GIVE_DAMPING
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_whole, missed
from rotorgear.analysis.common.stream import Piece, Stream, pieces, unkept
from rotorgear.analysis.orbits.family import Outputs, SystemFamily, outputs_of, range_of
from rotorgear.analysis.orbits.follow import (
    STRETCH,
    Branch,
    certified,
    doubled_branches,
    main_branches,
    special_curves,
)
from rotorgear.analysis.orbits.kept import AnyOrbits, packed, remembering, unpacked
from rotorgear.analysis.orbits.loads import LOAD_STATISTICS, load_harmonics, load_statistics
from rotorgear.analysis.orbits.verify import first_node, settled, verified
from rotorgear.analysis.transient.notes import damped_at_nodes, left_out_in_time
from rotorgear.cpu import Clock, compiling_seconds, cpu_seconds
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.model import Model, model_hash
from rotorgear.note import Note
from rotorgear.progress import Progress, foretell, silent
from rotorgear.quantity import in_two_digits
from rotorgear.results.orbits import OrbitBranch, OrbitsResult, SpecialCurve, SpecialPoint
from rotorgear.solvers.periodic.arclength import Node, Walk
from rotorgear.solvers.periodic.balance import HarmonicGrid
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits, static_displacements
from rotorgear.solvers.periodic.plant import Plant
from rotorgear.solvers.periodic.samples import MotionCycle, answered
from rotorgear.solvers.periodic.shooting import MOST_COORDINATES, MOST_RATIO, ShootingOrbits
from rotorgear.solvers.periodic.special import Certified
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.solvers.time.statistics import STATISTICS, MotionStatistics, PeriodicCurve, compared, over_period

# Points of a branch whose coefficients are compared.
_POINTS = 3
# Beside a fold both solutions of one value lie next to each other: there the value tells no motion, and no error of one.
_FOLD = 1e-3
# Share of the largest displacement: what moves less has no accuracy of its own.
_STILL = 1e-6


def refined(orbits: AnyOrbits, finer: AnyOrbits, node: Node) -> np.ndarray | None:
    """Unknowns of the finer equations at a node's value, a step of Newton's method from its motion; none beside a fold.

    The step is from a residual that is small by itself: what a second one would change is the square of the error.
    """
    if abs(node.tangent[-1]) <= _FOLD:
        return None
    try:
        finer.prepare_at(node.p)
        y = orbits.lifted(node.y, finer)  # type: ignore[arg-type]
        residual, slope = finer.values(y, node.p)
        better = y - np.linalg.solve(slope, residual)
    except (ConvergenceError, np.linalg.LinAlgError):
        return None
    return np.asarray(better) if np.all(np.isfinite(better)) else None


def largest_error(branch: Branch, columns: np.ndarray) -> float:
    """Largest relative difference of the displacements' coefficients at some points from the finer solution of the same method.

    Args:
        branch: a branch. columns: local displacements that are compared.
    """
    orbits = branch.orbits
    finer = orbits.finer()
    numbers = np.unique(np.linspace(0, len(branch.nodes) - 1, _POINTS + 2).round().astype(int)[1:-1])
    found = []
    for node in (branch.nodes[i].node for i in numbers):
        better = refined(orbits, finer, node)
        if better is not None:
            coarse = orbits.cycle(node.y, node.p).displacement
            found.append(float(change(coarse, finer.cycle(better, node.p).displacement, columns).max()))
    return max(found, default=float("nan"))


def change(coarse: np.ndarray, better: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Largest difference of coefficients (h + 1, m) in each column, over the largest harmonic of the better ones.

    One that hardly moves beside the others is measured by the largest of them.
    """
    both = np.zeros((2, max(len(coarse), len(better)), len(columns)), complex)
    both[0, : len(coarse)] = coarse[:, columns]
    both[1, : len(better)] = better[:, columns]
    size = np.abs(both[1, 1:]).max(axis=0)
    size = np.maximum(size, _STILL * size.max(initial=0.0))
    return np.asarray(np.abs(both[0] - both[1]).max(axis=0) / size)


HARMONICS = 30
# Instants for each harmonic: aliasing, not the cut, sets the error.
INSTANTS = 16
METHODS = ("auto", "harmonic balance", "shooting")
# How often harmonics and instants are doubled to reach an accuracy.
_DOUBLINGS = 2
# Share of the range behind the first solution where it is told what the branch will take.
_NO_LOADS = np.zeros((0, len(LOAD_STATISTICS)))
_SEEN = 0.1
# What special points, both ends and error estimates take beside the points.
_BESIDE = 1.25
_UNLOADED = 1e-6
# Where branches and curves end that have reached what was asked for.
_PLANNED = (
    "the end of the range",
    "the branch closed",
    "the end of the second range",
    "the end of the first range",
    "the curve closed",
)


@recorded
def orbits(
    model: Model,
    over: Mapping[str, str | Sequence[float | str]],
    *,
    harmonics: int | None = None,
    instants: int | None = None,
    method: str = "auto",
    excite: str | None = None,
    from_transient: bool = False,
    switch: bool = False,
    verify: bool = False,
    accuracy: float | None = None,
    step: float = 0.04,
    points: int = 600,
    elements: int | None = None,
    stream: Stream | None = None,
    progress: Progress = silent,
) -> OrbitsResult:
    """Follow the periodic motions of a model over a parameter, through folds, with the stability of each.

    Args:
        model: the model.
        over: address in the model file with both ends of its range, such as 'operation.speed=3000 rpm:6000 rpm'. With a second
            one branches are followed over the first at the beginning of the second, and the folds and period doublings on them
            over both. In Python {"operation.speed": "3000 rpm:6000 rpm"}, or two values.
        harmonics: number of harmonics of the base period (default: 30).
        instants: number of instants in a base period at which the laws are evaluated (default: 16 for each harmonic).
        method: auto, harmonic balance or shooting (for small systems).
        excite: mesh (or another part that varies) whose stage excites alone, with all others at their mean.
        from_transient: begin from the motion that a transient of 400 periods settles on, not from the static state.
        switch: follow the branches of twice the period behind period doublings, too.
        verify: start transients on some of the motions and tell how they leave them.
        accuracy: wanted relative accuracy of the motions; harmonics and instants are doubled until it is reached.
        step: longest step along a branch, as a share of the range.
        points: largest number of points of a branch.
        elements: number of basic elements in each shaft segment (default: one of second order).
        stream: keeps stretches of the branches while they are followed (`rotorgear.stream`), and starts an interrupted run again.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: nothing repeats, or only after too long a time; nothing tells motions apart; laws without periodic
            motions; or a request that makes no sense.
    """
    clock = Clock()
    _check(over, harmonics, instants, method, accuracy, step, points)
    ranges = [range_of(model, address, ends) for address, ends in over.items()]
    plan = Walk(longest=step, most=points)
    asked = (ranges, harmonics, instants, method, excite, from_transient, switch, verify, accuracy, plan, elements)
    piece = pieces(stream, {"model": model_hash(model), "run": repr(asked)})
    curves: tuple[SpecialCurve, ...] = ()
    with single_thread(0):
        progress(0.0, "model")
        family = SystemFamily(model, ranges, excite, elements)
        outputs = outputs_of(family)
        plant = family.plant(0.0)
        scale = scale_of(plant)
        clock.lap("model")
        for doublings in range(_DOUBLINGS + 1):
            H = (harmonics or HARMONICS) * 2**doublings
            N = instants * 2**doublings if instants else INSTANTS * H
            N += N % 2
            problem, why = equations_of(method, family, HarmonicGrid(H, N, family.order), scale)
            # Of small systems transients from rest cost little.
            small = _coordinates(plant) <= MOST_COORDINATES
            from_rest = partial(settled, problem, family, progress=progress) if small else None
            used = cpu_seconds() - compiling_seconds()
            own = remembering(piece, problem)
            measured = partial(_forecast, problem, family, outputs, H, points, clock.worked, [])
            begin = partial(_first_motion, problem, family, from_transient=from_transient, progress=progress)
            branches = main_branches(problem, unpacked(own(begin))[0], plan, progress, from_rest, own, measured)
            if switch:
                branches += [twice for branch in branches for twice in doubled_branches(branch, plan, progress, piece)]
            used = cpu_seconds() - compiling_seconds() - used
            progress(0.95, "error estimate")
            error = own(partial(_error, branches[0], outputs.columns))["error"]
            if accuracy is None or error <= accuracy or isinstance(problem, ShootingOrbits):
                break
        if len(ranges) > 1:
            curves = special_curves(branches, family, outputs, plan, progress, piece)
        clock.lap("branches")
        progress(0.97, "statistics")
        fields = gathered(branches, outputs, family, H, piece)
        clock.lap("statistics")
        checks = verified(branches, family, outputs.columns, piece) if verify else ()
    short = missed(accuracy, error, "ask for more harmonics (--harmonics) or instants (--instants)")
    progress(1.0, "done")
    count = sum(len(branch.nodes) for branch in branches)
    return OrbitsResult(
        model=model,
        address=tuple(one.address for one in ranges),
        unit=tuple(one.unit for one in ranges),
        per_unit=np.array([one.per_unit for one in ranges]),
        excited=family.label,
        order=family.order,
        contact=outputs.contact,
        place=outputs.place,
        place_unit=outputs.place_unit,
        statistic=STATISTICS,
        load_points=tuple(family.loads),
        load_unit=tuple(family.loads.values()),
        **fields,  # type: ignore[arg-type]
        curves=curves,
        verifications=checks,
        harmonics=H,
        instants=N,
        error_estimate=error,
        cpu_per_point=used / max(count, 1),
        dofs=family.local.local.n,
        seconds=clock.total(),
        method=why,
        status=short or "success",
        left_out=(
            *left_out_in_time(family.local, plant.speed, contacts_only=not outputs.place),
            *damped_at_nodes(model),
            *family.notes,
            *_modes_left_out(problem),
        ),
        warnings=(*_warnings(family, branches, curves), *((short,) if short else ())),
    )


def _forecast(
    problem: AnyOrbits,
    family: SystemFamily,
    outputs: Outputs,
    harmonics: int,
    most: int,
    before: float,
    told: list[float],
    nodes: list[Certified],
    seconds: float,
) -> None:
    """Tell once, a part of the range behind the first solution, what the first branch and its statistics will take.

    Args:
        problem, family, outputs, harmonics: of the branch, which has at most so many points. before: CPU seconds until now.
        told: what has been told. nodes: solutions so far. seconds: CPU seconds of one of the last of them.
    """
    p = [one.node.p for one in nodes]
    share = abs(p[-1] - p[0])
    if told or share < _SEEN or p[-1] == p[-2]:
        return
    count = len(p) + (1.0 - share) / abs(p[-1] - p[-2])
    apart = problem.apart()
    branch = Branch(apart, "", 1, [], [], "")
    start = cpu_seconds() - compiling_seconds()
    _columns_of(branch, nodes[-1:], apart.finer(), outputs, family, harmonics)
    of_statistics = cpu_seconds() - compiling_seconds() - start
    each = _BESIDE * (seconds + of_statistics)
    told.append(before + min(count, most) * each)
    foretell(
        "orbits", told[0], f"for the first branch, up to {in_two_digits(before + most * each)} where it turns back"
    )


def _first_motion(
    problem: AnyOrbits, family: SystemFamily, *, from_transient: bool, progress: Progress
) -> dict[str, object]:
    node = first_node(problem, family, from_transient=from_transient, progress=progress)
    return packed([certified(problem, node)])


def _error(branch: Branch, columns: np.ndarray) -> dict[str, object]:
    return {"error": largest_error(branch, columns)}


def _check(
    over: Mapping[str, object],
    harmonics: int | None,
    instants: int | None,
    method: str,
    accuracy: float | None,
    step: float,
    points: int,
) -> None:
    if len(over) not in (1, 2):
        raise AnalysisError(f"over: got {len(over)} parameters, expected one or two")
    for name, count in (("harmonics", harmonics), ("instants", instants), ("points", points)):
        if count is not None:
            check_whole(f"the number of {name}", count)
    if instants is not None and instants < 4 * (harmonics or HARMONICS) + 2:
        raise AnalysisError(
            f"instants: got {instants}, expected at least {4 * (harmonics or HARMONICS) + 2}, four for each harmonic; "
            "16 for each keep aliasing small"
        )
    if method not in METHODS:
        raise AnalysisError(f"method: got '{method}', expected one of {', '.join(METHODS)}")
    if accuracy is not None and not 1e-9 <= accuracy < 1.0:
        raise AnalysisError(f"the accuracy must lie between 1e-9 and 1, got {accuracy:g}")
    if not 1e-4 <= step <= 0.5:
        raise AnalysisError(f"step: got {step:g}, expected a share of the range between 1e-4 and 0.5")


def scale_of(plant: Plant) -> np.ndarray:
    """Sizes of the local displacements: their static ones, at least a micrometre's share where there are none."""
    d = np.abs(static_displacements(plant) if plant.m else np.zeros(0))
    stiff = np.diag(plant.forces.reference_stiffness) > 0.0
    largest = max(float(d[stiff].max(initial=0.0)), _UNLOADED)
    return np.where(stiff, np.maximum(d, _UNLOADED), largest)


def equations_of(method: str, family: SystemFamily, grid: HarmonicGrid, scale: np.ndarray) -> tuple[AnyOrbits, str]:
    """The equations and what they are, in words.

    Raises:
        AnalysisError: shooting was asked for, and the system is too large for it.
    """
    plant = family.plant(0.0)
    # Steps of shooting would end at each kink.
    kinked = method == "auto" and any(part.law.many_kinks for part in family.parts)
    if method != "harmonic balance" and _coordinates(plant) <= MOST_COORDINATES and not kinked:
        trial = HarmonicOrbits(family.plant, grid, scale)
        if trial.modes(0.0).highest / grid.frequency(plant.speed) <= MOST_RATIO:
            own = ShootingOrbits(family.plant, grid.order, scale, grid.harmonics, grid.instants)
            return own, f"shooting with steps to the switches of the laws, {own.size} states"
    if method == "shooting":
        raise AnalysisError(
            f"method: shooting takes up to {MOST_COORDINATES} coordinates that are not stiff, this model has "
            f"{_coordinates(plant)}; take harmonic balance"
        )
    cut = f"{grid.harmonics} harmonics at {grid.instants} instants"
    why = f"harmonic balance of {plant.m} local displacements, {cut}, arc length"
    return HarmonicOrbits(family.plant, grid, scale), why


def _coordinates(plant: Plant) -> int:
    return int(plant.M.shape[0] - plant.free.shape[1])


def _modes_left_out(problem: AnyOrbits) -> Iterator[Note]:
    if isinstance(problem, ShootingOrbits) or (basis := problem.modes(0.0)).complete:
        return
    modes = f"modes beyond the lowest {basis.count} (to {basis.highest / 2.0 / np.pi:.4g} Hz)"
    why = f"{modes} but for the static shapes of the contacts; the motions themselves hold all"
    yield Note("", "of Floquet multipliers", why)


def _warnings(family: SystemFamily, branches: list[Branch], curves: tuple[SpecialCurve, ...]) -> Iterator[str]:
    plant = family.plant(0.0)
    rates = plant.D + plant.D.T
    if not any(law.uses_velocity for law in plant.forces.laws) and not (rates.nnz and abs(rates).max() > 0.0):
        why = "at a resonance its motions have no bound, and no branch comes past one"
        yield Note("", "nothing damps the model", f"{why}; {GIVE_DAMPING}")
    ends = [(f"branch {branch.name}", len(branch.nodes), branch.ended) for branch in branches]
    ends += [(f"curve of the {curve.kind}", len(curve.value), curve.ended) for curve in curves]
    for what, count, why in ends:
        if why not in _PLANNED:
            yield Note("", f"{what} ended early, at {count} points", why)
    if not any(one.stable for branch in branches for one in branch.nodes):
        yield Note("", "no motion of the range is stable", "a transient settles on none of them")
    # Modes of a casing may end too low for the faster end of the range.
    local = family.local
    fastest = max(abs(family.plant(share).speed) for share in (0.0, 1.0))
    yield from time_warnings(local.system.model, local.local.forces.laws, fastest)


# Multipliers of a point that are kept.
_MULTIPLIERS = 12
# The finer solution is better by far, and its difference is the error; where that passes through zero, a share of the others'.
_LUCK = 0.1


def gathered(
    branches: list[Branch], outputs: Outputs, family: SystemFamily, harmonics: int, piece: Piece = unkept
) -> dict[str, object]:
    """The fields of a result that belong to points and special points; `piece` does those of a few points, or takes them over.

    The error of a statistic is its difference from that of the finer solution at the same value of the parameter.
    """
    parts: list[dict[str, np.ndarray]] = []
    special = []
    for number, branch in enumerate(branches):
        finer = branch.orbits.finer()
        own = remembering(piece, branch.orbits, finer)
        for k in range(0, len(branch.nodes), STRETCH):
            stretch = branch.nodes[k : k + STRETCH]
            found = own(partial(_columns_of, branch, stretch, finer, outputs, family, harmonics))
            parts.append({"branch": np.full(len(stretch), number), **found})
        for point in branch.special:
            node = point.at.node
            cycle = branch.orbits.cycle(node.y, node.p)
            mu = point.at.multipliers[:_MULTIPLIERS]
            sizes = (mu.real.copy(), mu.imag.copy(), *outputs.extremes(cycle))
            special.append(SpecialPoint(point.kind, family.ranges[0].at(node.p), number, cycle.period, *sizes))
    return {
        **{name: np.concatenate([part[name] for part in parts]) for name in parts[0]},
        "branches": tuple(OrbitBranch(branch.name, branch.periods, branch.ended) for branch in branches),
        "special_points": tuple(special),
    }


def _columns_of(
    branch: Branch,
    stretch: list[Certified],
    finer: AnyOrbits,
    outputs: Outputs,
    family: SystemFamily,
    harmonics: int,
) -> dict[str, np.ndarray]:
    """The fields that belong to some points of a branch, (points, ...)."""
    orbits = branch.orbits
    points: list[dict[str, object]] = []
    for one in stretch:
        node = one.node
        plant = family.plant(node.p)
        cycle = orbits.cycle(node.y, node.p)
        found = statistics_of(cycle, plant, outputs)
        approach, moved = outputs.extremes(cycle)
        better = refined(orbits, finer, node)
        error = np.full(found.values.shape, np.nan)
        place_error = np.full(len(moved), np.nan)
        rows = family.load_rows(node.p)
        loads = load_statistics(cycle.period, load_harmonics(plant, rows, cycle)) if rows else _NO_LOADS
        load_error = np.full(loads.shape, np.nan)
        if better is not None:
            fine = finer.cycle(better, node.p)
            error = compared(found.values, statistics_of(fine, plant, outputs).values, found.scales, 1.0, _LUCK)
            place_error = np.abs(np.ptp(moved, axis=1) - np.ptp(outputs.extremes(fine)[1], axis=1))
            if rows:
                load_error = np.abs(load_statistics(fine.period, load_harmonics(plant, rows, fine)) - loads)
        # Harmonics of the base period: of a motion of k periods every k-th.
        force = cycle.force[:: branch.periods][: harmonics + 1]
        displacement = cycle.displacement[:: branch.periods][: harmonics + 1]
        mu = one.multipliers[:_MULTIPLIERS]
        points.append(
            {
                "value": family.ranges[0].at(node.p),
                "period": cycle.period,
                "stable": one.stable,
                "multipliers": np.concatenate([mu, np.full(_MULTIPLIERS - len(mu), np.nan + 0j)]),
                "approach_extremes": approach,
                "peak_to_peak_transmission_error": np.ptp(found.transmission_error, axis=1),
                "mean_force": found.force.mean,
                "rms_force": found.force.rms,
                "largest_force": found.force.largest,
                "apart": found.shares[:, 1],
                "back": found.shares[:, 2],
                "statistics_error": error,
                "force_harmonics": force[:, outputs.contact_column],
                "displacement_harmonics": displacement[:, outputs.contact_column],
                "place_extremes": moved,
                "place_error": place_error,
                "place_harmonics": displacement[:, outputs.place_column],
                "load_statistics": loads,
                "load_error": load_error,
            }
        )
    return {name: np.array([point[name] for point in points]) for name in points[0]}


def statistics_of(cycle: MotionCycle, plant: Plant, outputs: Outputs) -> MotionStatistics:
    """Statistics of the contacts over a period, what is between its instants included."""

    def laws(t: np.ndarray, d: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at = answered(t, d, v, plant.forces, plant.speed)
        return at.F[:, outputs.contact_column], at.side[:, outputs.contact_law]

    force, shares = over_period(PeriodicCurve(cycle.period, cycle.at.d, cycle.at.v), laws)
    watched = PeriodicCurve(cycle.period, cycle.watched, cycle.watched_rate).extremes()
    return MotionStatistics(force, shares, watched[: len(outputs.contact)], outputs.extremes(cycle)[0])
