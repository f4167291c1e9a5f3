"""Solves the eigenproblem of a system: each independent group of dofs with the cheapest method that is exact for its terms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.modal.damped_problem import DampedProblem
from rotorgear.analysis.modal.damped_solve import damped_group
from rotorgear.analysis.modal.modes import Modes, Wanted
from rotorgear.analysis.modal.rigid_basis import sorted_rigid
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.eigen.eigen import UndampedModes, lowest_modes
from rotorgear.solvers.eigen.shift_invert import shifted_operator
from rotorgear.solvers.sparse.pencil import LooseDofError
from rotorgear.system.components import dof_motions, independent_groups
from rotorgear.system.strain_forms import StrainForms
from rotorgear.system.system import System

# Backward error above which a damped mode is refused.
_LARGEST_RESIDUAL = 1e-8
_LARGE = 20_000  # dofs above which a look at the coarsest mesh costs nothing beside the rest


@dataclass(frozen=True)
class _Problem:
    """M, D (None without such terms) and K of one group of dofs, and its strain factor S (None where a spring is indefinite).

    `inertial` is the part alpha M + spin G of D and `forms` what the rest of D and K are made of, both None without D and
    circulatory terms. `symmetric` says whether K is, `damped` whether anything takes energy out, `guess` where the first elastic
    eigenvalue may be.
    """

    M: sp.csc_array
    D: sp.csc_array | None
    K: sp.csc_array
    K_symmetric: sp.csc_array
    S: sp.csr_array | None
    symmetric: bool
    damped: bool
    inertial: sp.csc_array | None = None
    forms: StrainForms | None = None
    guess: float | None = None


def solve(system: System, wanted: Wanted) -> Modes:
    """Return the lowest modes of all groups that are asked for, lowest |s| first, rigid ones at the front.

    Raises:
        AnalysisError: a dof has neither inertia nor stiffness, or no group has a motion that is asked for.
        ConvergenceError: a guard of a solver was not met.
    """
    speed = wanted.speed or 0.0
    whole = _problem(system, wanted.speed)
    used = [A for A in (whole.M, whole.D, whole.K) if A is not None]
    groups = independent_groups(used) if wanted.pruning else [np.arange(system.n)]
    motions = dof_motions(system)
    chosen = [g for g in groups if not wanted.only or set(motions[g]) & set(wanted.only)]
    if not chosen:
        raise AnalysisError(f"no dof of the model moves in {' or '.join(wanted.only)}")
    try:
        found = [_solve_group(_part(whole, g, system.n), wanted, system) for g in chosen]
    except LooseDofError as error:
        raise _loose(system, whole) or AnalysisError(str(error)) from None
    notes = group_notes(motions, groups, chosen)
    return _merged(system, chosen, found, wanted, speed, notes)


def _problem(system: System, speed: float | None) -> _Problem:
    at = speed or 0.0
    skew = system.circulatory(at)
    K = system.stiffness(at)
    D = system.velocity_terms(speed)
    total = sp.csc_array(K + skew) if skew.nnz else K
    damped = speed is not None and bool(system.damping(at).nnz)
    plain = D is None and not skew.nnz
    inertial, forms = (None, None) if plain else (system.inertial_terms(at), system.strain_forms(at))
    return _Problem(
        system.mass, D, total, K, system.strain_factor(at), not skew.nnz, damped, inertial, forms, _guess(system)
    )


def _guess(system: System) -> float | None:
    """The first elastic eigenvalue of the coarsest mesh of a large system, in (rad/s)^2: it saves a factorisation."""
    if system.n < _LARGE:
        return None
    coarse = System(system.model, elements=1, direction=system.direction)
    return shifted_operator(coarse.mass, coarse.stiffness()).elastic if coarse.n else None


def _part(whole: _Problem, group: np.ndarray, n: int) -> _Problem:
    """Cut one group of dofs out of the whole."""
    if len(group) == n:
        return whole

    def cut(A: sp.csc_array) -> sp.csc_array:
        return sp.csc_array(A[:, group][group])

    D = None if whole.D is None else cut(whole.D)
    D = None if D is None or not D.nnz else D
    K = cut(whole.K)
    K_symmetric = cut(whole.K_symmetric)
    S = None
    if whole.S is not None:
        S = sp.csr_array(sp.csc_array(whole.S)[:, group])
        S = sp.csr_array(S[np.diff(S.indptr) > 0])
    symmetric = whole.symmetric or not (K - K_symmetric).nnz
    damped = whole.damped and D is not None and bool((D + D.T).nnz)
    inertial = None if whole.inertial is None else cut(whole.inertial)
    forms = None if whole.forms is None else whole.forms.cut(group)
    return _Problem(cut(whole.M), D, K, K_symmetric, S, symmetric, damped, inertial, forms, whole.guess)


def _solve_group(problem: _Problem, wanted: Wanted, system: System) -> Modes:
    if problem.D is None and problem.symmetric:
        found = _lowest(problem, wanted.modes, wanted.limit)
        rigid = np.arange(len(found.eigenvalues)) < found.rigid_count
        s = 1j * np.where(rigid, 0.0, np.sqrt(found.eigenvalues))
        highest = np.sqrt(max(found.sturm_shift, 0.0)) / (2.0 * np.pi)
        method = f"undamped, {found.method}, Sturm count {found.sturm_count} of {found.sturm_expected} below {highest:.6g} Hz"
        vectors = found.vectors
        errors = found.backward_error
        available: int | None = found.available
    else:
        s, vectors, rigid, errors, available, method = _damped(problem, wanted)
    zeta = system.model.damping.modal_ratio
    if zeta and wanted.speed is not None:
        s = with_modal_damping(s, zeta)
    return Modes(s, vectors, rigid, errors, method, available)


def _lowest(problem: _Problem, modes: int | None, limit: float | None) -> UndampedModes:
    S = problem.S
    strain = None if S is None else (lambda V: S @ V)
    return lowest_modes(problem.M, problem.K_symmetric, count=modes, below=limit, strain=strain, guess=problem.guess)


def _damped(
    problem: _Problem, wanted: Wanted
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, int | None, str]:
    assert problem.forms is not None
    assert problem.inertial is not None
    D = sp.csc_array(problem.M.shape) if problem.D is None else problem.D
    found, coordinates = damped_group(
        DampedProblem(
            problem.M,
            D,
            problem.K,
            problem.K_symmetric,
            problem.inertial,
            problem.S,
            problem.forms,
            lambda count, below: _lowest(problem, count, below),
        ),
        wanted.modes,
        wanted.limit,
    )
    worst = float(found.backward_error.max(initial=0.0))
    if worst > _LARGEST_RESIDUAL:
        raise ConvergenceError(
            f"a damped mode leaves a residual of {worst:.1e} relative to the matrices, so the modes can't be trusted; ask for "
            "fewer modes, or look for stiffness or damping many decades apart",
            found,
        )
    s = np.where(found.rigid, 0.0, found.eigenvalues)
    if problem.symmetric and not problem.damped:
        s = 1j * np.abs(s)  # gyroscopic terms do no work: without damping every s is imaginary, but for rounding
    norm = np.sqrt(np.real(np.einsum("nm,nm->m", found.vectors.conj(), problem.M @ found.vectors)))
    vectors = found.vectors / np.where(norm > 0.0, norm, 1.0)
    kind = " ".join(word for word, there in (("damped", problem.damped), ("gyroscopic", bool(wanted.speed))) if there)
    available = len(s) if found.complete else None
    return (
        s,
        vectors,
        found.rigid,
        found.backward_error,
        available,
        f"{kind or 'non-symmetric'} problem{coordinates}, {found.method}",
    )


def with_modal_damping(s: np.ndarray, zeta: float) -> np.ndarray:
    """Add a damping ratio to every oscillating mode and keep |s|: what a modal damping ratio states."""
    size = np.abs(s)
    total = np.where(size > 0.0, -s.real / np.where(size > 0.0, size, 1.0), 0.0) + zeta
    oscillates = (s.imag > 0.0) & (total < 1.0)
    turned = size * (-total + 1j * np.sqrt(np.clip(1.0 - total**2, 0.0, None)))
    return np.where(oscillates, turned, s)


def _merged(
    system: System,
    groups: Sequence[np.ndarray],
    found: Sequence[Modes],
    wanted: Wanted,
    speed: float,
    notes: tuple[str, ...],
) -> Modes:
    """Put the modes of all groups in one order: rigid first, then by |s|, and no more than were asked for."""
    s = np.concatenate([part.eigenvalues for part in found])
    rigid = np.concatenate([part.rigid for part in found])
    errors = np.concatenate([part.backward_error for part in found])
    owner = np.concatenate([np.full(len(part.eigenvalues), k) for k, part in enumerate(found)])
    column = np.concatenate([np.arange(len(part.eigenvalues)) for part in found])
    order = np.lexsort((np.abs(s), ~rigid))[: wanted.modes]
    vectors = np.zeros((system.n, len(order)), dtype=np.result_type(*[part.vectors for part in found]))
    for place, k in enumerate(order):
        vectors[groups[owner[k]], place] = found[owner[k]].vectors[:, column[k]]
    if np.sum(rigid[order]) > 1:
        vectors[:, rigid[order]] = sorted_rigid(system, np.real(vectors[:, rigid[order]]))
    counts = [part.available for part in found]
    available = None if any(count is None for count in counts) else sum(count for count in counts if count is not None)
    methods = list(dict.fromkeys(part.method for part in found))
    method = methods[0] if len(found) == 1 else f"{len(found)} groups of dofs; the largest: {methods[0]}"
    return Modes(s[order], vectors, rigid[order], errors[order], method, available, notes)


def group_notes(motions: np.ndarray, groups: list[np.ndarray], chosen: list[np.ndarray]) -> tuple[str, ...]:
    """Say which groups of dofs were solved apart and which were left out."""
    notes = []
    kept = {int(group[0]) for group in chosen}
    for motion in ("bending", "axial", "torsion"):
        dropped = [g for g in groups if int(g[0]) not in kept and motions[g[0]] == motion]
        if dropped:
            notes.append(f"{motion}: {sum(map(len, dropped))} dofs decoupled, not among the motions asked for")
    if len(chosen) > 1:
        sizes = ", ".join(f"{len(group)} {'/'.join(sorted(set(motions[group])))}" for group in chosen[:6])
        more = f" and {len(chosen) - 6} more" if len(chosen) > 6 else ""
        notes.append(
            f"coupling between {len(chosen)} groups of dofs that do not act on each other, solved apart: {sizes}{more}"
        )
    return tuple(notes)


def _loose(system: System, whole: _Problem) -> AnalysisError | None:
    """Name the dofs with neither inertia nor stiffness."""
    from rotorgear.solvers.sparse.pencil import check_pencil

    try:
        check_pencil(whole.M, whole.K_symmetric)
    except LooseDofError as error:
        names = "; ".join(system.dofs.describe(dof, system.nodes) for dof in error.dofs[:4])
        more = f" and {len(error.dofs) - 4} more" if len(error.dofs) > 4 else ""
        remedy = "give the body there its inertia, or hold the motion with a support"
        return AnalysisError(f"neither inertia nor stiffness: {names}{more}; {remedy}")
    return None
