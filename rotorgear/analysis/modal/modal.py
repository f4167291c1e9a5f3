"""Natural frequencies and mode shapes: undamped at standstill, or damped and gyroscopic at a speed of the input shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rotorgear.analysis.common.casings import NOTICED, casing_warnings, reduction_errors, with_casing_modes
from rotorgear.analysis.common.discretise import pieces
from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.common.notes import gathering, mode_warnings
from rotorgear.analysis.common.planet_notes import class_notes
from rotorgear.analysis.common.points import point_amplitudes
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_request, speed_in_si
from rotorgear.analysis.common.stations import shapes_at_stations
from rotorgear.analysis.modal import refine
from rotorgear.analysis.modal.conditioning import conditioning_warnings, too_far_apart
from rotorgear.analysis.modal.describe import describe
from rotorgear.analysis.modal.energies import mode_energies
from rotorgear.analysis.modal.mode_count import MOST_MODES, check_count
from rotorgear.analysis.modal.planet_classes import classes_of, separated
from rotorgear.analysis.modal.reach import Reach
from rotorgear.analysis.modal.refine import DEFAULT_ACCURACY, START, errors_of, total_error
from rotorgear.analysis.modal.solve import Modes, Wanted, solve
from rotorgear.analysis.modal.whirl import whirl_of, whirl_words
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import MOTIONS
from rotorgear.progress import Progress, silent
from rotorgear.results.laws import about_state, law_rows
from rotorgear.results.modal import ModalResult, NodeTable
from rotorgear.solvers.sparse.entries import stretches
from rotorgear.system.plan import Plan
from rotorgear.system.planets import turning_carriers
from rotorgear.system.system import System

DEFAULT_MODES = 24
# Each round raises orders or halves elements where the error is: a model that needs more rounds than this does not converge.
_ROUNDS = 30
# How far beyond the limit modes are looked for where the mesh is known.
_NEAR = 1.05


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
    shapes: bool = True,
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
        shapes: False gives the same frequencies, damping and errors without shapes, energies, whirl and descriptions, in less
            time: for many values of a number.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: nothing to solve, a dof with neither inertia nor stiffness, a speed outside a bearing's table.
        ConvergenceError: a guard of the solver was not met, or the accuracy can't be reached; never a silent loss.
    """
    asked = ModalRequest(
        speed_in_si(speed),
        modes,
        fmax,
        elements,
        accuracy,
        tuple(only),
        pruning,
        error_estimate,
        shapes,
        from_carrier=True,
    )
    return modes_about(model, asked, progress=progress)


@dataclass(frozen=True)
class ModalRequest:
    """What is asked of modes; fields as the arguments of `modal`, the speed in rad/s.

    `from_carrier`: planets whose coefficients change with the angle of their carrier may be told as they are seen from it.
    """

    speed: float | None = None
    modes: int | None = None
    fmax: float | None = None
    elements: int | None = None
    accuracy: float | None = None
    only: tuple[str, ...] = ()
    pruning: bool = True
    error_estimate: bool = True
    shapes: bool = True
    from_carrier: bool = False


def modes_about(
    model: Model | System, asked: ModalRequest, state: State | None = None, progress: Progress = silent
) -> ModalResult:
    """The modes of a model about a state, for analyses that know it; None: about its equilibrium. Errors are those of `modal`."""
    speed = asked.speed
    check_request(modes=asked.modes, fmax=asked.fmax, elements=asked.elements, accuracy=asked.accuracy)
    unknown = set(asked.only) - set(MOTIONS)
    if unknown:
        raise AnalysisError(f"only: got {', '.join(sorted(unknown))}, expected motions among {', '.join(MOTIONS)}")
    if asked.modes is None and asked.fmax is None:
        asked = replace(asked, modes=DEFAULT_MODES)
    clock = Clock()
    taken, short = (model, ()) if isinstance(model, System) else with_casing_modes(model, asked.fmax)
    while True:
        system, found, estimate = _on_fine_mesh(taken, asked, state, clock, progress)
        reduction = reduction_errors(system, found.eigenvalues, found.vectors)
        if isinstance(taken, System) or asked.fmax is not None or not np.any(reduction > NOTICED):
            break
        # How far a number of modes reaches is known now.
        further, _ = with_casing_modes(taken, float(np.max(np.abs(found.eigenvalues))) / (2.0 * np.pi))
        if further is taken:
            break
        taken = further
    progress(0.9, "energies")
    found = separated(system, found)
    s = found.eigenvalues
    seen = _seen(system, speed or 0.0, found) if asked.shapes else _unseen(len(s))
    clock.lap("energies")
    progress(1.0, "done")
    return ModalResult(
        model=model.model if isinstance(model, System) else model,
        speed=speed,
        eigenvalues=s,
        rigid=found.rigid,
        error_estimate=estimate + reduction,
        backward_error=found.backward_error,
        dofs=system.n,
        discretisation=pieces(system),
        seconds=clock.total(),
        laws=law_rows(system.state.operating),
        left_out=(*left_out(system, "modes", speed), *class_notes(system), *found.groups),
        warnings=(
            *mode_warnings(system, asked.modes, s, asked.fmax),
            *conditioning_warnings(system, speed, s, found.rigid, seen["strain_energy"]),
            *short,
            *casing_warnings(reduction, s),
        ),
        method=found.method + about_state(system.state),
        **seen,
    )


def _seen(system: System, speed: float, found: Modes) -> dict[str, Any]:
    """What a result tells of the shapes of modes: displacements, energies, whirl, and what they are in words."""
    s = found.eigenvalues
    q = system.dofs.expand(found.vectors)
    nodes, displaced = shapes_at_stations(system, q)
    shapes = _turned(displaced)
    energies = mode_energies(system, speed, q, found.rigid)
    whirl = whirl_of(system, shapes[: len(system.nodes)], speed)
    classes = classes_of(system, q, energies.kinetic_by_shaft, speed)
    return {
        "shapes": shapes,
        "nodes": nodes,
        "kinetic_energy": energies.kinetic,
        "strain_energy": energies.strain,
        "kinetic_by_motion": energies.kinetic_by_motion,
        "strain_by_motion": energies.strain_by_motion,
        "whirl": whirl_words(whirl, energies),
        "whirl_by_shaft": whirl.net,
        "description": describe(system, q, energies, found.rigid, (s.imag == 0.0) & ~found.rigid),
        "point_amplitudes": point_amplitudes(system, nodes, shapes),
        "mode_class": classes.words if classes.energy else (),
        "class_energy": classes.energy,
        "carrier_frequency_hz": classes.seen_hz(s) if speed else {},
        "carrier_frequency_share": classes.seen_share if speed else {},
    }


def _unseen(modes: int) -> dict[str, Any]:
    """The same of modes whose shapes nobody asked for: there are no nodes."""
    shares = ("kinetic_energy", "strain_energy", "kinetic_by_motion", "strain_by_motion", "whirl_by_shaft")
    return {
        **{name: {} for name in shares},
        "shapes": np.zeros((0, 6, modes), complex),
        "nodes": NodeTable((), np.zeros((0, 3)), ()),
        "whirl": ("",) * modes,
        "description": ("",) * modes,
    }


def _on_fine_mesh(
    model: Model | System, asked: ModalRequest, state: State | None, clock: Clock, progress: Progress
) -> tuple[System, Modes, np.ndarray]:
    """The system on a mesh that is fine enough, its modes that are asked for, and their estimated relative errors (m,)."""
    speed = asked.speed
    limit = None if asked.fmax is None else 2.0 * np.pi * asked.fmax
    fixed = isinstance(model, System) or asked.elements is not None
    plan = Plan(asked.elements) if asked.elements else (Plan() if fixed else START)
    system = linear_system(model, [speed], plan, state=state)
    if speed and asked.from_carrier and system.uneven_planets:
        system = system.seen_from_carrier()
    system.require_freedom()
    if not (fixed or asked.error_estimate):
        raise AnalysisError("refining to an accuracy needs the error estimate; give elements to do without")
    target = np.inf if fixed else asked.accuracy or DEFAULT_ACCURACY
    if not fixed and asked.modes is None and asked.fmax is not None:
        check_count(system.model, asked.fmax)
    # Finer elements bring the bound nearer, and the motions no nearer to each other.
    apart = too_far_apart(system, speed)
    reach = Reach(asked.modes, limit, 0, 1.0) if fixed else Reach(asked.modes, limit)
    # Damping and spin hardly change what mesh a mode needs: undamped modes find it at less cost, and the mesh is checked with
    # the others then. Films whose symmetric part alone is no stable spring have no such modes.
    # What turning planets bring is no spring: modes at standstill find their mesh as well.
    turning = bool(turning_carriers(system.layout))
    varies = system.has_varying_springs or bool(system.layout.elastic_bodies) if turning else system.has_tables
    undamped_first = (
        not fixed and speed is not None and not varies and not system.circulatory(0.0 if turning else speed).nnz
    )
    for _ in range(_ROUNDS if undamped_first else 0):
        found = solve(system, Wanted(None, *reach.solver_request(), asked.only))
        if reach.modes is not None and len(found.eigenvalues) < reach.modes:
            break
        parts = errors_of(system, None, found.eigenvalues, found.vectors, found.rigid)
        watched = reach.watched(np.abs(found.eigenvalues), total_error(parts, len(found.eigenvalues)))
        finer = refine.refined(system, {piece: part[watched] for piece, part in parts.items()}, target)
        if finer is None:
            break
        system = system.with_plan(finer)
    if undamped_first:
        clock.lap("refinement")
        # Modes of planets that go round are dear, and hardly one changes places on a mesh that is known.
        reach = replace(reach, factor=min(reach.factor, _NEAR)) if turning else reach
    for round_number in range(_ROUNDS):
        progress(min(0.1 + 0.15 * round_number, 0.8), f"solving {system.n} dofs")
        wanted = Wanted(speed, *reach.solver_request(), asked.only, asked.pruning)
        found = _solved(system, wanted, apart)
        clock.lap("modes")
        size = np.abs(found.eigenvalues)
        estimate = np.full(len(size), np.nan)
        parts = {}
        if asked.error_estimate:
            parts = errors_of(system, speed, found.eigenvalues, found.vectors, found.rigid)
            estimate = total_error(parts, len(size))
        clock.lap("error estimate")
        kept = reach.inside(size)
        if fixed:
            if asked.error_estimate:
                estimate = refine.enriched_errors(system, wanted, found, estimate)
            return system, found.first(kept), estimate[:kept]
        ended = reach.limit is not None and not found.is_complete  # by the highest frequency, not by the mesh
        if reach.modes is not None and len(size) < reach.modes and parts and not ended:
            # The mesh has fewer modes than asked for: every piece must be finer before any error can be estimated.
            if reach.modes > 2 * MOST_MODES:
                raise AnalysisError(
                    f"a flexible shaft has modes without end, and more than {MOST_MODES} are not sought: ask for fewer (--modes)"
                )
            finer = refine.all_finer(system)
        else:
            watched = reach.watched(size, estimate)
            finer = refine.refined(system, {piece: part[watched] for piece, part in parts.items()}, target)
        if finer is not None:
            system = system.with_plan(finer)
        elif reach.is_certain(size, estimate, found.is_complete):
            return system, found.first(kept), estimate[:kept]
        else:
            reach = reach.further()
        clock.lap("refinement")
    raise ConvergenceError(
        f"the accuracy of {target:g} was not reached within {_ROUNDS} refinements; ask for less, or for fewer modes"
    )


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


def _turned(shapes: np.ndarray) -> np.ndarray:
    """Complex shapes, each mode's phase turned so that its largest displacement is real and positive.

    An eigenvector has no phase of its own; without this choice the same mode would look different from run to run.
    """
    if shapes.shape[2] == 0:
        return shapes.astype(complex)
    peak = _largest(shapes[:, :3])
    rotation = _largest(shapes[:, 3:])
    # A mode that only tilts or twists has no displacement to speak of: its largest rotation is turned then.
    peak = np.where(np.abs(peak) <= 1e-9 * np.abs(rotation), rotation, peak)
    turn = np.where(peak != 0.0, np.conj(peak) / np.where(peak != 0.0, np.abs(peak), 1.0), 1.0)
    if np.iscomplexobj(shapes):
        return np.asarray(shapes * turn)
    turned = np.zeros(shapes.shape, dtype=complex)
    np.multiply(shapes, turn, out=turned.real)
    return turned


def _largest(shapes: np.ndarray) -> np.ndarray:
    """The entry of the largest size, the first of such, in each mode (m,) of shapes (p, d, m)."""
    modes = shapes.shape[2]
    found = np.zeros(modes, dtype=shapes.dtype)
    size = np.full(modes, -1.0)
    for nodes in stretches(len(shapes)):
        part = shapes[nodes].reshape(-1, modes)
        sizes = np.abs(part)
        place = (sizes.argmax(axis=0), np.arange(modes))
        larger = sizes[place] > size
        found = np.where(larger, part[place], found)
        size = np.where(larger, sizes[place], size)
    return found
