"""The verb behind `rotorgear optimise`: numbers of a model, within bounds, that keep excitations away from the modes they excite.

Which modes count is decided by participation: the share of an exciting mesh in the strain energy of a mode, or of the forward
whirl of a shaft in its kinetic energy. Modes that nobody excites may lie where they like; those that take part by a little less
than the least count as well, with a weight that falls smoothly, so that no search ends just below it.

Sequential quadratic programming (Kraft 1988, A software package for sequential quadratic programming, DFVLR-FB 88-28) with
exact gradients goes down the penalty of `penalty.py` from the file and from points strewn over the bounds; of the layouts that
keep the margin the one with the least change or the least mass is taken, or the one that keeps it by the most standard
deviations of what scatters.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_request, check_speed_is_fixed, check_whole, share_of, speed_in_si
from rotorgear.analysis.layout.modes_at_speed import MARGINS, ModesAtSpeed, kept_deviations, total_mass
from rotorgear.analysis.layout.problem import Problem, bounds_of, last_kept
from rotorgear.analysis.sensitivity.forms import Floats
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.model.numbers import numbers_of
from rotorgear.progress import Progress, silent
from rotorgear.results.optimise import LayoutMargin, LayoutMode, LayoutNumber, OptimiseResult
from rotorgear.solvers.sampling import unit_points
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.system.plan import Plan

OBJECTIVES = ("change", "mass", "scatter")
# Order of the elements where none is asked for; the table's own mesh is one order higher, and its margins are compared.
_ORDER = 4
# The penalty asks for this multiple of the margin, since it is flat at its own edge.
_MORE = 1.01
# Modes that are looked at reach this far beyond the highest line and its margin.
_BEYOND = 1.1
_ITERATIONS = 60
_BISECTIONS = 7
# Weight of the penalty beside the mass over that of the file.
_WEIGHT = 30.0
# Standard deviations by which the margin is to be kept: one more step after each that was reached, up to a limit.
_DEVIATIONS = 0.5
_MOST_DEVIATIONS = 6.0
# A number nearer to a bound than this share of the distance of both bounds is at it.
_AT_BOUND = 1e-4
_ROUNDING = 1e-5
# A margin that changes by more than this share of the one asked for on the finer mesh is said to be unresolved; margins beyond
# this multiple of the one asked for are not compared.
_UNRESOLVED = 0.1
_NEAR = 2.0
# Modes that take part by less than this are in no list.
_NOTHING = 1e-5


# Where a search led: t (p,) and the penalty there, 0 where the margin is kept.
_End = tuple[Floats, float]


@recorded
def optimise(
    model: Model,
    free: str | Iterable[str],
    *,
    margin: float | str = 0.15,
    bounds: Mapping[str, str] | None = None,
    objective: str = "change",
    speeds: Sequence[float | str] | None = None,
    mesh_orders: Sequence[int] = (1,),
    shaft_orders: Sequence[float] = (1,),
    participation: float = 1e-2,
    searches: int = 4,
    seed: int = 1,
    elements: int | None = None,
    progress: Progress = silent,
) -> OptimiseResult:
    """Return numbers of a model so that no excitation has a mode that it excites within a margin.

    Args:
        model: the model.
        free: addresses of the free numbers, with commas between; "*" for all names or places there.
        margin: least distance |f_mode / f_line - 1| of excitations from modes that they excite, such as 0.15 or "15 %".
        bounds: address (or a pattern of addresses) with its LOW:HIGH, shares added to the value (default: "-20 %:20 %") or
            values with units. Places move by a tenth of their shaft unless it is given, and never past gears, disks or
            bearings.
        objective: change (keep the margin with small changes of the numbers), mass (with the least mass) or scatter (by the
            most standard deviations of the frequencies, where the numbers of the model's [scatter] vary).
        speeds: speeds of the input shaft in rad/s or with units (default: the operating speed).
        mesh_orders: orders of every mesh that count.
        shaft_orders: orders of every shaft that count.
        participation: as in `scatter`.
        searches: number of searches: the first from the numbers of the file, the others from points within the bounds.
        seed: seed of those points.
        elements: number of basic elements in each shaft segment (default: one of fourth order).
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a request that makes no sense, no speed, no excitation. ModelError: addresses that lead nowhere.
    """
    asked = share_of(margin, "margin")
    if objective not in OBJECTIVES:
        raise AnalysisError(f"objective: got '{objective}', expected {' or '.join(OBJECTIVES)}")
    if objective == "scatter" and not model.scatter:
        raise AnalysisError(
            "objective 'scatter': nothing scatters; give [scatter] in the model file, such as "
            "\"bearings.*.stiffness\" = { sigma = '10 %' }"
        )
    share_of(participation, "participation", "0.01")
    check_whole("the number of searches", searches)
    check_whole("the seed", seed, 0)
    operating = model.operating_speed
    if speeds is None and not operating:
        raise AnalysisError("no speed: give --speeds, or [operation] speed in the model file")
    wanted = [speed_in_si(speed) for speed in ([operating] if speeds is None else speeds)]
    at = tuple(dict.fromkeys(speed for speed in wanted if speed))
    if not at:
        raise AnalysisError("speeds: expected at least one other than 0")
    check_request(elements=elements)
    lines = excitation_orders(model, shaft_orders, mesh_orders)
    if not lines:
        raise AnalysisError("no excitation: the shafts stand still, or no orders are given")
    numbers = numbers_of(model, free)
    check_speed_is_fixed(numbers.addresses, "--speeds: a layout keeps its margins at several")
    low, high, notes = bounds_of(numbers, bounds or {})
    top = max(line.frequency_hz(speed) for line in lines for speed in at)
    plan = Plan(elements) if elements else Plan(1, _ORDER)
    beyond = 1.0 + MARGINS * asked if objective == "scatter" else (1.0 + asked) * _BEYOND
    problem = Problem(numbers, low, high, at, lines, plan, top * beyond, _MORE * asked, asked, participation)
    with single_thread(0):
        # From the file, then from Sobol points of the bounds.
        points = [problem.start, *unit_points("sobol", max(searches - 1, 1), len(low), seed)][:searches]
        ends = []
        for number, t in enumerate(points):
            progress(0.05 + 0.7 * number / searches, f"start {number + 1} of {searches}")
            ends.append(_descended(problem, t))

        def cost(end: _End) -> float:
            t, penalty = end
            if penalty:
                return penalty
            if objective == "mass":
                return total_mass(problem.states(t)[0].system)
            return float(np.sum((t - problem.start) ** 2))

        best = min(ends, key=lambda end: (end[1] > 0.0, cost(end)))
        if not best[1]:
            improve = {"mass": _lightened, "scatter": _steadied, "change": _nearer}[objective]
            best = (improve(problem, best[0], progress), 0.0)
        result = _result(problem, *best, objective)
    reached = sum(not penalty for _, penalty in ends)
    progress(1.0, "done")
    left = ("damping: frequencies are those of the undamped rotating system", *notes)
    return replace(result, searches=searches, searches_reached=reached, left_out=left)


def _minimised(fun: Callable[[Floats], tuple[float, Floats]], t: Floats, tolerance: float) -> None:
    """Go down a function with its slopes from t, by sequential quadratic programming; the function sees where it leads."""
    from scipy.optimize import minimize

    options = {"maxiter": _ITERATIONS, "ftol": tolerance}
    minimize(fun, t, jac=True, method="SLSQP", bounds=[(0.0, 1.0)] * len(t), options=options)


def _descended(problem: Problem, t: Floats) -> _End:
    """Down the penalty until the margin is kept or nothing gets better."""
    best: _End = (t, np.inf)

    def fun(point: Floats) -> tuple[float, Floats]:
        nonlocal best
        inside = np.clip(point, 0.0, 1.0)
        states = problem.states(inside)
        value = problem.penalty(states)
        if problem.margins_kept(states):
            best = (inside, 0.0)
            raise StopIteration
        if 0.0 < value < best[1]:
            best = (inside, value)
        return value, problem.slopes(inside, states)

    with suppress(StopIteration):
        _minimised(fun, t, 1e-7)
    return best


def _nearer(problem: Problem, end: Floats, progress: Progress) -> Floats:
    """Back towards the file as far as the margin is kept."""
    progress(0.8, "least change")
    start = problem.start

    def kept(share: float) -> bool:
        return problem.margins_kept(problem.states(start + share * (end - start)))

    return start + last_kept(1.0, 0.0, kept, _BISECTIONS) * (end - start)


def _lightened(problem: Problem, end: Floats, progress: Progress) -> Floats:
    """The lightest layout near one that keeps the margin, with the penalty beside the mass."""
    scale, _ = problem.mass(problem.start)
    best = end
    lightest = total_mass(problem.states(end)[0].system)

    def fun(point: Floats) -> tuple[float, Floats]:
        nonlocal best, lightest
        inside = np.clip(point, 0.0, 1.0)
        states = problem.states(inside)
        mass, slope = problem.mass(inside)
        if mass < lightest and problem.margins_kept(states):
            best = inside
            lightest = mass
        total = mass / scale + _WEIGHT * problem.penalty(states)
        return total, slope / scale + _WEIGHT * problem.slopes(inside, states)

    progress(0.8, "mass")
    _minimised(fun, end, 1e-8)
    return best


def _steadied(problem: Problem, end: Floats, progress: Progress) -> Floats:
    """A layout that keeps the margin and as many standard deviations more as can be reached from one that keeps it.

    Slopes of the penalty hold the deviations; whether the margin is kept is asked with those of each layout.
    """
    kept = kept_deviations(_scattering(problem).states(end), problem.asked, problem.least)
    wanted = _DEVIATIONS * (np.floor(max(kept, 0.0) / _DEVIATIONS) + 1.0) if np.isfinite(kept) else np.inf
    while wanted <= _MOST_DEVIATIONS:
        progress(0.8 + 0.15 * wanted / _MOST_DEVIATIONS, f"{wanted:g} standard deviations")
        wider = _scattering(problem, float(wanted))
        t, penalty = _descended(wider, end)
        problem.solutions += wider.solutions
        problem.gradients += wider.gradients
        if penalty:
            break
        end = t
        wanted += _DEVIATIONS
    return end


def _scattering(problem: Problem, deviations: float = 0.0) -> Problem:
    """The problem with modes that know how far they scatter."""
    return replace(problem, deviations=deviations, solutions=0, gradients=0)


def _result(problem: Problem, end: Floats, penalty: float, objective: str) -> OptimiseResult:
    numbers = problem.numbers
    scatters = bool(numbers.model.scatter)
    # The layout is judged on a finer mesh and on maps of its own.
    plan = problem.plan
    plan = Plan(2 * plan.elements, plan.order) if plan.order == 1 else Plan(plan.elements, plan.order + 1)
    finer = replace(_scattering(problem) if scatters else problem, plan=plan, own_maps=True, solutions=0, gradients=0)
    before = finer.states(problem.start)
    after = finer.states(end)
    pull = problem.slopes(end, problem.states(end)) if penalty else np.zeros(len(end))
    # What moved by rounding alone stays as the file has it, word or number.
    t = np.where(np.abs(end - problem.start) < _ROUNDING, problem.start, end)
    values = np.where(t == problem.start, numbers.start, problem.values(t))
    bounds = ["low" if x < _AT_BOUND else "high" if x > 1.0 - _AT_BOUND else "" for x in t]
    columns = (column.tolist() for column in (numbers.start, values, problem.low, problem.high))
    rows = zip(numbers.addresses, numbers.unit, *columns, bounds, pull.tolist(), strict=True)
    names = [line.name for line in problem.lines]
    change, where = _change_of_mesh(problem, ((problem.start, before), (end, after)))
    coarse = (
        f"the margin of {where} changes by {100.0 * change:.2g} % of the excitation on the mesh of the table, one finer than "
        "that of the search: ask for more elements",
    )
    return OptimiseResult(
        model=numbers.model,
        numbers=tuple(LayoutNumber(*row) for row in rows),
        lines=tuple(
            LayoutMargin(name, old.speed, float(old.line_hz[k]), *_nearest(old, k, problem), *_nearest(new, k, problem))
            for old, new in zip(before, after, strict=True)
            for k, name in enumerate(names)
        ),
        modes_before=tuple(_near_rows(problem, before)),
        modes_after=tuple(_near_rows(problem, after)),
        least_margin=problem.asked,
        participation=problem.least,
        objective=objective,
        penalty_before=problem.penalty(before),
        penalty_after=problem.penalty(after),
        deviations_before=kept_deviations(before, problem.asked, problem.least) if scatters else None,
        deviations_after=kept_deviations(after, problem.asked, problem.least) if scatters else None,
        mass_before_kg=total_mass(before[0].system),
        mass_after_kg=total_mass(after[0].system),
        solutions=problem.solutions + finer.solutions,
        gradients=problem.gradients,
        searches_reached=0,
        searches=0,
        dofs=after[0].system.n,
        warnings=coarse if change > _UNRESOLVED * problem.asked else (),
        method="sequential quadratic programming on a penalty with exact gradients",
    )


def _change_of_mesh(problem: Problem, layouts: Iterable[tuple[Floats, list[ModesAtSpeed]]]) -> tuple[float, str]:
    """Largest change of a margin from the mesh of the search to a finer one, on which states are known, and its excitation."""
    largest = (0.0, "")
    for t, states in layouts:
        for coarse, fine in zip(problem.states(t), states, strict=True):
            for k, line in enumerate(problem.lines):
                # Without a mode that counts the margin is as good as the whole excitation.
                sizes = np.abs([_nearest(state, k, problem)[1] for state in (coarse, fine)])
                one, other = np.nan_to_num(sizes, nan=1.0).tolist()
                if min(one, other) < _NEAR * problem.asked:
                    largest = max(largest, (abs(one - other), line.name))
    return largest


def _near_rows(problem: Problem, states: list[ModesAtSpeed]) -> list[LayoutMode]:
    """Modes within three margins of each line that take part at all."""
    rows: list[LayoutMode] = []
    for state in states:
        for line, F, taken in zip(problem.lines, state.line_hz, state.taken, strict=True):
            margins = state.hz / F - 1.0
            near = np.flatnonzero((np.abs(margins) < 3.0 * problem.asked) & (taken > _NOTHING))
            rows += [
                LayoutMode(line.name, state.speed, float(state.hz[k]), float(margins[k]), float(taken[k])) for k in near
            ]
    return rows


def _nearest(state: ModesAtSpeed, line: int, problem: Problem) -> tuple[float, float, float, float]:
    """Frequency, margin and participation of the mode nearest to a line among those that count, NaN without one; and the largest
    participation within the margin of those that don't."""
    margins = state.hz / state.line_hz[line] - 1.0
    taken = state.common[line]
    counts = taken >= problem.least
    inside = float(taken[~counts & (np.abs(margins) < problem.asked)].max(initial=0.0))
    if not counts.any():
        return float("nan"), float("nan"), 0.0, inside
    best = int(np.argmin(np.where(counts, np.abs(margins), np.inf)))
    return float(state.hz[best]), float(margins[best]), float(taken[best]), inside
