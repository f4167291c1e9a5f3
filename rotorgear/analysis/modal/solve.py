"""Solves the eigenproblem of a system: each independent group of dofs with the cheapest method that is exact for its terms."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.modal.modes import Modes, Wanted
from rotorgear.analysis.modal.rigid_basis import sorted_rigid
from rotorgear.analysis.modal.undamped import kept_undamped
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.eigen.eigen import UndampedModes, lowest_modes
from rotorgear.solvers.eigen.shift_invert import shifted_operator
from rotorgear.solvers.sparse.pencil import LooseDofError, check_pencil
from rotorgear.system.assembly import StrainForms
from rotorgear.system.components import dof_motions, groups_with_inertia, independent_groups
from rotorgear.system.nodes import CASING, GEAR_BODY
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# Backward error above which a damped mode is refused.
_LARGEST_RESIDUAL = 1e-8
# How far beyond the last mode that is asked for another group is searched, and the share of the largest k_ii / m_ii that the
# square of a frequency must have for a count: rounding lies four decades below.
_BEYOND = 1.0 + 1e-6
_RESOLVED = 1e-12
_LARGE = 20_000  # dofs above which a look at the coarsest mesh costs nothing beside the rest


@dataclass(frozen=True)
class _Problem:
    """M, D (None without such terms) and K of one group of dofs, and its strain factor S (None where a spring is indefinite).

    `inertial` is the part alpha M + spin G of D and `forms()` what the rest of D and K are made of, both None without D and
    circulatory terms. `symmetric` says whether K is, `damped` whether anything takes energy out, `guess` where the first elastic
    eigenvalue may be, `dofs` names the dofs of a group, all of them where it is empty.
    """

    M: sp.csc_array
    D: sp.csc_array | None
    K: sp.csc_array
    K_symmetric: sp.csc_array
    S: sp.csr_array | None
    symmetric: bool
    damped: bool
    inertial: sp.csc_array | None = None
    forms: Callable[[], StrainForms] | None = None
    guess: float | None = None
    dofs: bytes = b""

    def cut(self, group: np.ndarray) -> _Problem:
        """The problem of one group of dofs."""
        if len(group) == self.M.shape[0]:
            return self

        place = np.full(self.M.shape[0], -1, dtype=self.M.indices.dtype)
        place[group] = np.arange(len(group))

        def cut_out(A: sp.csc_array) -> sp.csc_array:
            # Only dofs of the group stand in the rows of its columns, but for stored zeros.
            columns = A[:, group]
            rows = place[columns.indices]
            if rows.size and rows.min() < 0:
                return sp.csc_array(columns[group])
            return sp.csc_array((columns.data, rows, columns.indptr), shape=(len(group), len(group)))

        D = None if self.D is None else cut_out(self.D)
        D = None if D is None or not D.nnz else D
        K = cut_out(self.K)
        K_symmetric = K if self.K_symmetric is self.K else cut_out(self.K_symmetric)
        S = None
        if self.S is not None:
            S = sp.csr_array(sp.csc_array(self.S)[:, group])
            S = sp.csr_array(S[np.diff(S.indptr) > 0])
        symmetric = self.symmetric or not (K - K_symmetric).nnz
        damped = self.damped and D is not None and bool((D + D.T).nnz)
        M = cut_out(self.M)
        if D is None and symmetric:
            return _Problem(M, D, K, K_symmetric, S, symmetric, damped, guess=self.guess, dofs=group.tobytes())
        inertial = None if self.inertial is None else cut_out(self.inertial)
        whole = self.forms
        forms = None if whole is None else cache(lambda: whole().cut(group))
        return _Problem(M, D, K, K_symmetric, S, symmetric, damped, inertial, forms, self.guess, group.tobytes())


def solve(system: System, wanted: Wanted) -> Modes:
    """Return the lowest modes of all groups that are asked for, lowest |s| first, rigid ones at the front.

    Raises:
        AnalysisError: a dof has neither inertia nor stiffness, or no group has a motion that is asked for.
        ConvergenceError: a guard of a solver was not met.
    """
    whole = _problem(system, wanted.speed) if wanted.damped else _conservative(system, wanted.speed or 0.0)
    # Groups of dofs that no entry of M, D or K couples are eigenproblems of their own.
    matrices = [A for A in (whole.K, whole.M, whole.D) if A is not None]
    groups = independent_groups(matrices) if wanted.pruning else [np.arange(system.n)]
    groups, still = groups_with_inertia(system, groups, whole.D)
    motions = dof_motions(system)
    chosen = [group for group in groups if not wanted.only or set(motions[group]) & set(wanted.only)]
    if wanted.dofs is not None:
        chosen = [group for group in chosen if not wanted.dofs.isdisjoint(group.tolist())]
    if not chosen:
        raise AnalysisError(f"no dof of the model moves in {' or '.join(wanted.only)}")
    try:
        solved: list[Modes] = []
        for group in chosen:
            problem = whole.cut(group)
            here = replace(wanted, limit=_reach(problem, solved, wanted))
            solved.append(_solve_group(problem, here, system))
    except LooseDofError as error:
        # The solver knows the number of a dof within its group; the whole pencil tells which dofs of the model they are.
        try:
            check_pencil(whole.M, whole.K_symmetric)
        except LooseDofError as loose:
            names = "; ".join(system.dofs.describe(dof, system.nodes) for dof in loose.dofs[:4])
            more = f" and {len(loose.dofs) - 4} more" if len(loose.dofs) > 4 else ""
            remedy = "give the body there its inertia, or hold the motion with a support"
            raise AnalysisError(f"neither inertia nor stiffness: {names}{more}; {remedy}") from None
        raise AnalysisError(str(error)) from None
    return _merged(system, chosen, solved, wanted.modes, (*group_notes(motions, groups, chosen), *still))


def _reach(problem: _Problem, solved: Sequence[Modes], wanted: Wanted) -> float | None:
    """|s| in rad/s up to which the modes of a next group may be among those asked for; None: there is no such limit.

    The groups before it may have as many modes as were asked for already.
    """
    sizes = np.sort(np.concatenate([np.abs(part.eigenvalues) for part in solved])) if solved else np.zeros(0)
    if wanted.modes is None or len(sizes) < wanted.modes:
        return wanted.limit
    reach = _BEYOND * float(sizes[wanted.modes - 1])
    mass = problem.M.diagonal()
    highest = float((problem.K_symmetric.diagonal()[mass > 0.0] / mass[mass > 0.0]).max(initial=0.0))
    if reach**2 <= _RESOLVED * highest:  # modes can't be counted so near to the rounding of the stiffness
        return wanted.limit
    return reach if wanted.limit is None else min(reach, wanted.limit)


def _problem(system: System, speed: float | None) -> _Problem:
    """M, D, K of a system at a speed in rad/s; without one, undamped at standstill."""
    at = speed or 0.0
    circulatory = system.circulatory(at)
    K_symmetric = system.stiffness(at)
    K = sp.csc_array(K_symmetric + circulatory) if circulatory.nnz else K_symmetric
    S = system.strain_factor(at)
    if S is None and circulatory.nnz:
        # A film at a small load: the symmetric part of its stiffness is no stable spring, while the whole and its damping may
        # well be. Undamped modes serve to find rigid motions and the scale of frequencies only.
        K_symmetric = system.definite_stiffness(at)
    D = system.velocity_terms(speed)
    is_plain = D is None and not circulatory.nnz
    inertial = sp.csc_array(K.shape) if D is None else system.inertial_terms(at)

    @cache
    def forms() -> StrainForms:
        whole = system.strain_forms(at)
        return _without_viscosity(whole) if D is None else whole

    guess = None
    if system.n >= _LARGE:
        # The first elastic eigenvalue of the coarsest mesh saves the search for a shift, which costs a factorisation here.
        coarse = system.with_plan(Plan(1))
        guess = shifted_operator(coarse.mass, coarse.stiffness()).elastic if coarse.n else None
    return _Problem(
        M=system.mass,
        D=D,
        K=K,
        K_symmetric=K_symmetric,
        S=S,
        symmetric=not circulatory.nnz,
        damped=speed is not None and bool(system.damping(at).nnz),
        inertial=None if is_plain else inertial,
        forms=None if is_plain else forms,
        guess=guess,
    )


def _conservative(system: System, speed: float) -> _Problem:
    """M, W G and the symmetric K of a system at a speed in rad/s: nothing damps and nothing drives."""
    K = system.stiffness(speed)
    G = sp.csc_array(speed * system.gyroscopic)
    turns = speed != 0.0 and bool(G.nnz)

    @cache
    def forms() -> StrainForms:
        whole = _without_viscosity(system.strain_forms(speed))
        return replace(whole, circulation=0.0 * whole.circulation)

    return _Problem(
        M=system.mass,
        D=G if turns else None,
        K=K,
        K_symmetric=K,
        S=system.strain_factor(speed),
        symmetric=True,
        damped=False,
        inertial=G if turns else None,
        forms=forms if turns else None,
    )


def _without_viscosity(forms: StrainForms) -> StrainForms:
    """The same strains, and nothing that damps them."""
    return replace(forms, viscosity=0.0 * forms.viscosity)


def _solve_group(problem: _Problem, wanted: Wanted, system: System) -> Modes:
    if problem.D is None and problem.symmetric:
        modes = _lowest(problem, wanted.modes, wanted.limit)
        rigid = np.arange(len(modes.eigenvalues)) < modes.rigid_count
        s = 1j * np.where(rigid, 0.0, np.sqrt(modes.eigenvalues))
        highest = np.sqrt(max(modes.sturm_shift, 0.0)) / (2.0 * np.pi)
        method = f"undamped, {modes.method}, Sturm count {modes.sturm_count} of {modes.sturm_expected} below {highest:.6g} Hz"
        vectors = modes.vectors
        errors = modes.backward_error
        available: int | None = modes.available
    else:
        s, vectors, rigid, errors, available, method = _damped(problem, wanted, system)
    zeta = system.model.damping.modal_ratio
    if zeta and wanted.speed is not None and wanted.damped:
        s = with_modal_damping(s, zeta)
    return Modes(s, vectors, rigid, errors, method, available)


def _lowest(problem: _Problem, modes: int | None, limit: float | None, counted: bool = True) -> UndampedModes:
    return lowest_modes(
        problem.M,
        problem.K_symmetric,
        count=modes,
        below=limit,
        strain=problem.S,
        guess=problem.guess,
        counted=counted,
    )


def _damped(
    problem: _Problem, wanted: Wanted, system: System
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, int | None, str]:
    """Eigenvalues, vectors of modal mass 1, rigid ones, backward errors, number of modes there are, and the method in words."""
    # Most models at standstill need none of these solvers.
    from rotorgear.analysis.modal.damped_problem import DampedProblem
    from rotorgear.analysis.modal.damped_solve import damped_group

    assert problem.forms is not None
    assert problem.inertial is not None

    def lowest(count: int | None, below: float | None, counted: bool = True) -> UndampedModes:
        if problem.S is None:  # the stiffness of other springs is made definite, at some speeds
            return _lowest(problem, count, below, counted)
        request = (problem.dofs, count, below, counted)
        return kept_undamped(system, request, lambda: _lowest(problem, count, below, counted))

    modes, coordinates = damped_group(
        DampedProblem(
            M=problem.M,
            D=sp.csc_array(problem.M.shape) if problem.D is None else problem.D,
            K=problem.K,
            K_symmetric=problem.K_symmetric,
            inertial=problem.inertial,
            strain=problem.S,
            make_forms=problem.forms,
            lowest=lowest,
        ),
        wanted.modes,
        wanted.limit,
    )
    worst = float(modes.backward_error.max(initial=0.0))
    if worst > _LARGEST_RESIDUAL:
        raise ConvergenceError(
            f"a damped mode leaves a residual of {worst:.1e} relative to the matrices, so the modes can't be trusted; ask for "
            "fewer modes, or look for stiffness or damping many decades apart",
            modes,
        )
    s = np.where(modes.rigid, 0.0, modes.eigenvalues)
    if problem.symmetric and not problem.damped:
        s = 1j * np.abs(s)  # gyroscopic terms do no work: without damping every s is imaginary, but for rounding
    norm = np.sqrt(np.real(np.einsum("nm,nm->m", modes.vectors.conj(), problem.M @ modes.vectors)))
    vectors = modes.vectors / np.where(norm > 0.0, norm, 1.0)
    kind = " ".join(word for word, there in (("damped", problem.damped), ("gyroscopic", bool(wanted.speed))) if there)
    method = f"{kind or 'non-symmetric'} problem{coordinates}, {modes.method}"
    return s, vectors, modes.rigid, modes.backward_error, len(s) if modes.complete else None, method


def with_modal_damping(s: np.ndarray, zeta: float) -> np.ndarray:
    """Add a damping ratio to every oscillating mode and keep |s|: what a modal damping ratio states."""
    size = np.abs(s)
    total = np.where(size > 0.0, -s.real / np.where(size > 0.0, size, 1.0), 0.0) + zeta
    oscillates = (s.imag > 0.0) & (total < 1.0)
    turned = size * (-total + 1j * np.sqrt(np.clip(1.0 - total**2, 0.0, None)))
    return np.where(oscillates, turned, s)


def _merged(
    system: System, groups: Sequence[np.ndarray], solved: Sequence[Modes], most: int | None, notes: tuple[str, ...]
) -> Modes:
    """Put the modes of all groups in one order: rigid first, then by |s|, and no more than were asked for."""
    s = np.concatenate([part.eigenvalues for part in solved])
    rigid = np.concatenate([part.rigid for part in solved])
    errors = np.concatenate([part.backward_error for part in solved])
    owner = np.concatenate([np.full(len(part.eigenvalues), k) for k, part in enumerate(solved)])
    column = np.concatenate([np.arange(len(part.eigenvalues)) for part in solved])
    order = np.lexsort((np.abs(s), ~rigid))[:most]
    in_order = np.array_equal(order, np.arange(len(order)))
    if len(solved) == 1 and len(groups[0]) == system.n:
        # Those of large models fill a good part of the memory: no copy without a reason.
        vectors = solved[0].vectors[:, : len(order)] if in_order else solved[0].vectors[:, order]
    else:
        vectors = np.zeros((system.n, len(order)), dtype=np.result_type(*[part.vectors for part in solved]))
        for place, k in enumerate(order):
            vectors[groups[owner[k]], place] = solved[owner[k]].vectors[:, column[k]]
    if np.sum(rigid[order]) > 1:
        # Any combination of rigid motions is one: choose those that a person can read.
        vectors[:, rigid[order]] = sorted_rigid(system, np.real(vectors[:, rigid[order]]))
    counts = [part.available for part in solved]
    available = None if any(count is None for count in counts) else sum(count for count in counts if count is not None)
    methods = list(dict.fromkeys(part.method for part in solved))
    method = methods[0] if len(solved) == 1 else f"{len(solved)} groups of dofs; the largest: {methods[0]}"
    return Modes(s[order], vectors, rigid[order], errors[order], method, available, notes)


def group_notes(motions: np.ndarray, groups: list[np.ndarray], chosen: list[np.ndarray]) -> tuple[str, ...]:
    """Say which groups of dofs were solved apart and which were left out."""
    notes = []
    kept = {int(group[0]) for group in chosen}
    for motion in ("bending", "axial", "torsion", CASING, GEAR_BODY):
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
