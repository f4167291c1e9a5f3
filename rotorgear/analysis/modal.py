"""Natural frequencies and mode shapes: undamped at standstill, or damped and gyroscopic at a speed of the input shaft."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.clock import Clock
from rotorgear.analysis.conditioning import conditioning_warnings
from rotorgear.analysis.describe import describe
from rotorgear.analysis.energies import mode_energies
from rotorgear.analysis.modal_solve import Modes, Wanted, solve
from rotorgear.analysis.notes import left_out, mode_warnings
from rotorgear.analysis.points import point_amplitudes
from rotorgear.analysis.reach import Reach
from rotorgear.analysis.refine import DEFAULT_ACCURACY, START, all_finer, errors_of, refined, total_error
from rotorgear.analysis.stations import shapes_at_stations
from rotorgear.analysis.whirl import whirl_by_shaft, whirl_words
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.fields import MOTIONS
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.quantity import QuantityError, parse_quantity
from rotorgear.results.modal import ModalResult, Piece
from rotorgear.system.plan import PieceKey, Plan
from rotorgear.system.system import System

DEFAULT_MODES = 24
# Finest accuracy that can be asked for: below, rounding and the solvers' own errors take over.
FINEST = 1e-11
_ROUNDS = 30


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
        speed: speed of the input shaft in rad/s, or a text such as "16350 rpm": damped modes with gyroscopic terms.
            None: undamped at standstill.
        modes: how many; 24 where neither `modes` nor `fmax` is given.
        fmax: all modes with a natural frequency |s|/2 pi up to this many Hz.
        elements: so many basic elements in each piece of a section, and no refinement.
        accuracy: refine until every frequency is estimated to be within this relative error; 1e-3 where neither this nor
            `elements` is given.
        only: motions among bending, axial and torsion; groups of dofs that no such motion reaches are left out.
        pruning: False solves all dofs as one group, for comparison.
        error_estimate: False leaves the estimate out, for timing; only with `elements` or a system.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: nothing to solve, a dof with neither inertia nor stiffness, a speed outside a bearing's table.
        ConvergenceError: a guard of the solver was not met, or the accuracy can't be reached; never a silent loss.
    """
    speed = _speed(speed)
    _check_request(speed, modes, fmax, elements, accuracy)
    unknown = set(only) - set(MOTIONS)
    if unknown:
        raise AnalysisError(f"only: got {', '.join(sorted(unknown))}, expected motions among {', '.join(MOTIONS)}")
    clock = Clock()
    if modes is None and fmax is None:
        modes = DEFAULT_MODES
    fixed = isinstance(model, System) or elements is not None
    system = _system(model, speed, Plan(elements) if elements else (Plan() if fixed else START))
    if not (fixed or error_estimate):
        raise AnalysisError(
            "a mesh that is refined to an accuracy needs the error estimate; give elements to do without"
        )
    target = np.inf if fixed else accuracy or DEFAULT_ACCURACY
    reach = Reach(modes, None if fmax is None else 2.0 * np.pi * fmax, *((0, 1.0) if fixed else ()))
    for round_number in range(_ROUNDS):
        progress(min(0.1 + 0.15 * round_number, 0.8), f"solving {system.n} dofs")
        found = solve(system, Wanted(speed, *reach.solver_request(), tuple(only), pruning))
        clock.lap("modes")
        q = system.dofs.expand(found.vectors)
        parts = errors_of(system, speed, found.eigenvalues, q, found.rigid) if error_estimate else {}
        estimate = (
            total_error(parts, len(found.eigenvalues)) if error_estimate else np.full(len(found.eigenvalues), np.nan)
        )
        clock.lap("error estimate")
        if fixed:
            break
        plan = _next_plan(system, reach, found, parts, estimate, target)
        if plan is not None:
            system = _system(system.model, speed, plan)
        elif reach.is_certain(np.abs(found.eigenvalues), estimate, found.is_complete):
            break
        else:
            reach = reach.further()
        clock.lap("refinement")
    else:
        raise ConvergenceError(
            f"the accuracy of {target:g} was not reached within {_ROUNDS} refinements; ask for less, or for fewer modes"
        )
    kept = reach.inside(np.abs(found.eigenvalues))
    progress(0.9, "energies")
    result = _result(system, speed, (modes, fmax), found.first(kept), q[:, :kept], estimate[:kept], clock)
    progress(1.0, "done")
    return result


def _next_plan(
    system: System, reach: Reach, found: Modes, parts: dict[PieceKey, np.ndarray], estimate: np.ndarray, target: float
) -> Plan | None:
    """Return a finer plan while some watched mode is not within the target, or the mesh has fewer modes than asked for."""
    size = np.abs(found.eigenvalues)
    if reach.modes is not None and len(size) < reach.modes and parts:
        return all_finer(system)
    watched = reach.watched(size, estimate)
    return refined(system, {piece: part[watched] for piece, part in parts.items()}, target)


def _system(model: Model | System, speed: float | None, plan: Plan) -> System:
    system = model if isinstance(model, System) else System(model, plan=plan, direction=_direction(speed))
    if system.n == 0:
        raise AnalysisError("the model has no free degree of freedom: its supports and motions hold everything")
    return system


def _direction(speed: float | None) -> int | None:
    return None if not speed else int(np.sign(speed))


def _speed(given: float | str | None) -> float | None:
    """Speed in rad/s from a number or a text with its unit."""
    if given is None:
        return None
    try:
        return parse_quantity(given, "speed")
    except QuantityError as error:
        raise AnalysisError(f"speed: got {given!r}, expected {error}") from None


def _check_request(
    speed: float | None, modes: int | None, fmax: float | None, elements: int | None, accuracy: float | None
) -> None:
    for name, value in (("the number of modes", modes), ("the number of elements", elements)):
        if value is not None and value < 1:
            raise AnalysisError(f"{name} must be at least 1, got {value}")
    if elements is not None and accuracy is not None:
        raise AnalysisError("elements and accuracy: give one of the two; elements fixes the mesh, accuracy refines it")
    if accuracy is not None and not FINEST <= accuracy < 1.0:
        raise AnalysisError(f"the accuracy must lie between {FINEST:g} and 1 (1e-3 is 0.1 %), got {accuracy:g}")
    if fmax is not None and not (np.isfinite(fmax) and fmax > 0.0):
        raise AnalysisError(f"the highest frequency must be positive, got {fmax} Hz")


def _result(
    system: System,
    speed: float | None,
    wanted: tuple[int | None, float | None],
    found: Modes,
    q: np.ndarray,
    estimate: np.ndarray,
    clock: Clock,
) -> ModalResult:
    asked, fmax = wanted
    nodes, displaced = shapes_at_stations(system, q)
    everywhere = _turned(displaced.astype(complex))
    shapes = everywhere[: len(system.nodes)]
    energies = mode_energies(system, speed or 0.0, q, found.rigid)
    whirl = whirl_by_shaft(system, shapes, speed or 0.0)
    words = whirl_words(system, shapes, whirl, energies) if speed else tuple("" for _ in found.eigenvalues)
    real_root = (found.eigenvalues.imag == 0.0) & ~found.rigid
    lines = describe(system, shapes, energies, found.rigid, real_root)
    clock.lap("energies")
    return ModalResult(
        model=system.model,
        speed=speed,
        eigenvalues=found.eigenvalues,
        rigid=found.rigid,
        shapes=everywhere,
        nodes=nodes,
        error_estimate=estimate,
        kinetic_energy=energies.kinetic,
        strain_energy=energies.strain,
        kinetic_by_motion=energies.kinetic_by_motion,
        strain_by_motion=energies.strain_by_motion,
        whirl=words,
        whirl_by_shaft=whirl,
        description=lines,
        backward_error=found.backward_error,
        dofs=system.n,
        discretisation=pieces(system),
        seconds=clock.total(),
        left_out=(*left_out(system, speed), *found.groups),
        warnings=(
            *mode_warnings(system, asked, found.eigenvalues, fmax),
            *conditioning_warnings(system, speed, found.eigenvalues, found.rigid, energies.strain),
        ),
        method=found.method,
        point_amplitudes=point_amplitudes(system, shapes),
    )


def pieces(system: System) -> tuple[Piece, ...]:
    """Say how each piece of shaft was cut."""
    found = []
    for shaft, elements in system.nodes.elements.items():
        for number in sorted({element.piece for element in elements}):
            own = [element for element in elements if element.piece == number]
            start, end = system.nodes.z[own[0].left], system.nodes.z[own[-1].right]
            found.append(Piece(shaft, start, end, len(own), own[0].order))
    return tuple(found)


def _turned(shapes: np.ndarray) -> np.ndarray:
    """Turn each mode's phase so that its largest displacement is real and positive."""
    if shapes.shape[2] == 0:
        return shapes
    size = np.abs(shapes)
    flat = (size[:, :3] if size[:, :3].any() else size).reshape(-1, shapes.shape[2])
    moving = flat.max(axis=0, initial=0.0) > 1e-9 * size.reshape(-1, shapes.shape[2]).max(axis=0, initial=0.0)
    rows = shapes[:, :3].reshape(-1, shapes.shape[2])
    everything = shapes.reshape(-1, shapes.shape[2])
    for mode in range(shapes.shape[2]):
        values = rows[:, mode] if moving[mode] else everything[:, mode]
        peak = values[np.argmax(np.abs(values))]
        if peak != 0.0:
            shapes[:, :, mode] *= np.conj(peak) / np.abs(peak)
    return shapes
