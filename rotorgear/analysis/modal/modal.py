"""Natural frequencies and mode shapes: undamped at standstill, or damped and gyroscopic at a speed of the input shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.common.casings import NOTICED, casing_warnings, reduction_errors, serving
from rotorgear.analysis.common.clock import Clock
from rotorgear.analysis.common.notes import gathering
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_request, speed_in_si
from rotorgear.analysis.modal.conditioning import too_far_apart
from rotorgear.analysis.modal.enriched_error import enriched_errors
from rotorgear.analysis.modal.mode_count import MOST_MODES, check_count
from rotorgear.analysis.modal.modes import Modes, Wanted
from rotorgear.analysis.modal.reach import Reach
from rotorgear.analysis.modal.refine import DEFAULT_ACCURACY, START, all_finer, errors_of, refined, total_error
from rotorgear.analysis.modal.result import modal_result
from rotorgear.analysis.modal.solve import solve
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import MOTIONS
from rotorgear.progress import Progress, silent
from rotorgear.results.modal import ModalResult
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

DEFAULT_MODES = 24
# Each round raises orders or halves elements where the error is: a model that needs more rounds than this does not converge.
_ROUNDS = 30


@recorded
def modal(
    model: Model | System,
    *,
    speed: float | str | None = None,
    modes: int | None = None,
    fmax: float | None = None,
    elements: int | None = None,
    accuracy: float | None = None,
    only: Sequence[str] = (),
    pruning: bool = True,
    error_estimate: bool = True,
    progress: Progress = silent,
) -> ModalResult:
    """Return the lowest modes of a model.

    Args:
        model: a model, or its assembled system, which is then taken as it is.
        speed: speed of the input shaft in rad/s or with its unit, such as "16350 rpm": damped modes with gyroscopic terms
            (default: undamped modes at standstill).
        modes: number of modes (default: 24, unless `fmax` is given).
        fmax: all modes with a natural frequency |s|/2 pi up to this many Hz.
        elements: number of basic elements in each shaft segment, without refinement.
        accuracy: refine the mesh until every frequency is estimated to be within this relative error (default: 1e-3, unless
            `elements` is given).
        only: kinds of motion among bending, axial and torsion; groups of degrees of freedom that none of them reaches are left
            out.
        pruning: solve groups of degrees of freedom that nothing couples apart from each other; False is for comparison.
        error_estimate: False leaves the estimate of the discretisation error out, for timing; only with `elements` or a system.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: nothing to solve, a dof with neither inertia nor stiffness, a speed outside a bearing's table.
        ConvergenceError: a guard of the solver was not met, or the accuracy can't be reached; never a silent loss.
    """
    asked = ModalRequest(speed_in_si(speed), modes, fmax, elements, accuracy, tuple(only), pruning, error_estimate)
    return modes_about(model, asked, progress=progress)


@dataclass(frozen=True)
class ModalRequest:
    """What is asked of modes; fields as the arguments of `modal`, the speed in rad/s."""

    speed: float | None = None
    modes: int | None = None
    fmax: float | None = None
    elements: int | None = None
    accuracy: float | None = None
    only: tuple[str, ...] = ()
    pruning: bool = True
    error_estimate: bool = True


def modes_about(
    model: Model | System, asked: ModalRequest, state: State | None = None, progress: Progress = silent
) -> ModalResult:
    """The modes of a model about a state, for analyses that know it; None: about its equilibrium. Errors are those of `modal`."""
    speed = asked.speed
    modes = asked.modes
    fmax = asked.fmax
    only = asked.only
    check_request(speed, modes, fmax, asked.elements, asked.accuracy)
    unknown = set(only) - set(MOTIONS)
    if unknown:
        raise AnalysisError(f"only: got {', '.join(sorted(unknown))}, expected motions among {', '.join(MOTIONS)}")
    clock = Clock()
    if modes is None and fmax is None:
        modes = DEFAULT_MODES
    fixed = isinstance(model, System) or asked.elements is not None
    served, short = (model, ()) if isinstance(model, System) else serving(model, fmax)
    plan = Plan(asked.elements) if asked.elements else (Plan() if fixed else START)
    system = linear_system(served, [speed], plan, state=state)
    if system.n == 0:
        raise AnalysisError("the model has no free degree of freedom: its supports and motions hold everything")
    if not (fixed or asked.error_estimate):
        raise AnalysisError(
            "a mesh that is refined to an accuracy needs the error estimate; give elements to do without"
        )
    target = np.inf if fixed else asked.accuracy or DEFAULT_ACCURACY
    if not fixed and modes is None and fmax is not None:
        check_count(system.model, fmax)
    # Finer elements bring the bound nearer, and the motions no nearer to each other.
    apart = too_far_apart(system, speed)
    reach = Reach(modes, None if fmax is None else 2.0 * np.pi * fmax, *((0, 1.0) if fixed else ()))
    if not fixed and speed is not None and not system.has_tables and not system.circulatory(speed).nnz:
        # Damping and spin hardly change what mesh a mode needs: undamped modes find it at less cost, and it is checked below.
        # Films whose symmetric part alone is no stable spring have no such modes.
        system = _refined_undamped(system, reach, only, target)
        clock.lap("refinement")
    for round_number in range(_ROUNDS):
        progress(min(0.1 + 0.15 * round_number, 0.8), f"solving {system.n} dofs")
        found = _solved(system, Wanted(speed, *reach.solver_request(), only, asked.pruning), apart)
        clock.lap("modes")
        q = system.dofs.expand(found.vectors)
        parts = errors_of(system, speed, found.eigenvalues, found.vectors, found.rigid) if asked.error_estimate else {}
        count = len(found.eigenvalues)
        estimate = total_error(parts, count) if asked.error_estimate else np.full(count, np.nan)
        clock.lap("error estimate")
        if fixed:
            if asked.error_estimate:
                estimate = enriched_errors(system, Wanted(speed, None, None, only, asked.pruning), found, estimate)
            break
        size = np.abs(found.eigenvalues)
        ended = reach.limit is not None and not found.is_complete  # by the highest frequency, not by the mesh
        if reach.modes is not None and len(size) < reach.modes and parts and not ended:
            # The mesh has fewer modes than asked for: every piece must be finer before any error can be estimated.
            if reach.modes > 2 * MOST_MODES:
                raise AnalysisError(
                    f"a flexible shaft has modes without end, and more than {MOST_MODES} are not sought: "
                    "ask for fewer (--modes)"
                )
            finer: Plan | None = all_finer(system)
        else:
            watched = reach.watched(size, estimate)
            finer = refined(system, {piece: part[watched] for piece, part in parts.items()}, target)
        if finer is not None:
            system = system.with_plan(finer)
        elif reach.is_certain(size, estimate, found.is_complete):
            break
        else:
            reach = reach.further()
        clock.lap("refinement")
    else:
        raise ConvergenceError(
            f"the accuracy of {target:g} was not reached within {_ROUNDS} refinements; ask for less, or for fewer modes"
        )
    reduction = reduction_errors(system, found.eigenvalues, found.vectors)
    kept = reach.inside(np.abs(found.eigenvalues))
    given = model.model if isinstance(model, System) else model
    if isinstance(model, Model) and fmax is None and np.any(reduction[:kept] > NOTICED):
        # How far a number of modes reaches is known now.
        further, _ = serving(model, float(np.max(np.abs(found.eigenvalues[:kept]))) / (2.0 * np.pi))
        if further is not model:
            again = modes_about(further, replace(asked, modes=modes), state, progress)
            return replace(again, model=given)
    progress(0.9, "energies")
    result = modal_result(
        system, speed, (modes, fmax), found.first(kept), q[:, :kept], (estimate + reduction)[:kept], clock
    )
    warnings = (*result.warnings, *short, *casing_warnings(reduction[:kept], found.eigenvalues))
    progress(1.0, "done")
    return replace(result, model=given, left_out=(*result.left_out, *system.state.notes), warnings=warnings)


def _refined_undamped(system: System, reach: Reach, only: tuple[str, ...], target: float) -> System:
    """The system on a mesh that is fine enough for its undamped modes at standstill, where these are enough."""
    for _ in range(_ROUNDS):
        found = solve(system, Wanted(None, *reach.solver_request(), only))
        if reach.modes is not None and len(found.eigenvalues) < reach.modes:
            return system
        parts = errors_of(system, None, found.eigenvalues, found.vectors, found.rigid)
        watched = reach.watched(np.abs(found.eigenvalues), total_error(parts, len(found.eigenvalues)))
        finer = refined(system, {piece: part[watched] for piece, part in parts.items()}, target)
        if finer is None:
            return system
        system = system.with_plan(finer)
    return system


def _solved(system: System, wanted: Wanted, apart: str) -> Modes:
    """Solve, and say why where that fails: parts that are too far `apart`, a sentence or "", or overdamped modes without end.

    Damping in proportion to the stiffness b makes such modes gather at 1/b.
    """
    try:
        return solve(system, wanted)
    except ConvergenceError as error:
        if why := apart or too_far_apart(system, wanted.speed):
            raise ConvergenceError(why, error.partial) from error
        gathers = gathering(system)
        if wanted.speed is None or gathers is None:
            raise
        raise ConvergenceError(
            f"{str(error).rstrip('.')}: damping in proportion to the stiffness (internal_damping, rayleigh_beta) "
            f"gathers overdamped modes without end at {gathers / (2.0 * np.pi):.4g} Hz; ask for modes below (--fmax, --modes)",
            error.partial,
        ) from error
