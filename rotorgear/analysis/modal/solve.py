"""Solves the eigenproblem of a system: each independent group of dofs with the cheapest method that is exact for its terms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.analysis.modal.problem import Problem
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.sparse.entries import column_forms
from rotorgear.solvers.sparse.pencil import LooseDofError, check_pencil
from rotorgear.system.components import dof_motions, groups_with_inertia, independent_groups
from rotorgear.system.nodes import CASING, GEAR_BODY
from rotorgear.system.system import System

# Real part over the size of an eigenvalue below which it is rounding.
_STILL = 1e-7
# Backward error above which a damped mode is refused.
_LARGEST_RESIDUAL = 1e-8
# How far beyond the last mode that is asked for another group is searched, and the share of the largest k_ii / m_ii that the
# square of a frequency must have for a count: rounding lies four decades below.
_BEYOND = 1.0 + 1e-6
_RESOLVED = 1e-12


@dataclass(frozen=True)
class Wanted:
    """What a modal analysis is asked for.

    Attributes:
        speed: of the reference shaft in rad/s; None is undamped at standstill.
        modes: how many modes; limit: all of them up to this |s| in rad/s. None is no such limit.
        only: motions that a group of dofs must have to be solved; empty for all.
        pruning: False solves all dofs as one group, for comparison.
        damped: False leaves out, at a speed, all that takes energy out or brings it in: what is left is gyroscopic.
        dofs: of which a group must have one to be solved; None: all groups are.
    """

    speed: float | None
    modes: int | None
    limit: float | None
    only: tuple[str, ...] = ()
    pruning: bool = True
    damped: bool = True
    dofs: frozenset[int] | None = None


@dataclass(frozen=True)
class Modes:
    """What the solvers give: eigenvalues s (m,), free shapes (n, m), rigid (m,), backward error (m,), sentences.

    `available` is the number of modes that the model has, None where it was not counted; `groups` says how the dofs fell apart.
    """

    eigenvalues: np.ndarray
    vectors: np.ndarray
    rigid: np.ndarray
    backward_error: np.ndarray
    method: str
    available: int | None
    groups: tuple[str, ...] = ()

    @property
    def is_complete(self) -> bool:
        """Whether these are all the modes that the discretised model has."""
        return self.available is not None and len(self.eigenvalues) >= self.available

    def first(self, count: int) -> Modes:
        """The first modes only."""
        s, rigid, errors = (values[:count] for values in (self.eigenvalues, self.rigid, self.backward_error))
        return replace(self, eigenvalues=s, vectors=self.vectors[:, :count], rigid=rigid, backward_error=errors)


def solve(system: System, wanted: Wanted) -> Modes:
    """Return the lowest modes of all groups that are asked for, lowest |s| first, rigid ones at the front.

    Raises:
        AnalysisError: a dof has neither inertia nor stiffness, or no group has a motion that is asked for.
        ConvergenceError: a guard of a solver was not met.
    """
    whole = Problem.at(system, wanted.speed, damped=wanted.damped)
    # Groups of dofs that no entry of M, D or K couples are eigenproblems of their own.
    groups = independent_groups([whole.K, whole.M, whole.D]) if wanted.pruning else [np.arange(system.n)]
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
            solved.append(_solve_group(problem, replace(wanted, limit=_reach(problem, solved, wanted))))
    except LooseDofError as error:
        # The solver knows the number of a dof within its group; the whole pencil tells which dofs of the model they are.
        try:
            check_pencil(whole.M, whole.K_symmetric)
        except LooseDofError as loose:
            names = system.dofs.describe_some(loose.dofs, system.nodes)
            remedy = "give the body there its inertia, or hold the motion with a support"
            raise AnalysisError(f"neither inertia nor stiffness: {names}; {remedy}") from None
        raise AnalysisError(str(error)) from None
    # Put the modes of all groups in one order: rigid first, then by |s|, and no more than were asked for.
    notes = (*group_notes(motions, groups, chosen), *still)
    s = np.concatenate([part.eigenvalues for part in solved])
    rigid = np.concatenate([part.rigid for part in solved])
    errors = np.concatenate([part.backward_error for part in solved])
    owner = np.concatenate([np.full(len(part.eigenvalues), k) for k, part in enumerate(solved)])
    column = np.concatenate([np.arange(len(part.eigenvalues)) for part in solved])
    order = np.lexsort((np.abs(s), ~rigid))[: wanted.modes]
    if len(solved) == 1 and len(chosen[0]) == system.n:
        # Those of large models fill a good part of the memory: no copy without a reason.
        in_order = np.array_equal(order, np.arange(len(order)))
        vectors = solved[0].vectors[:, slice(len(order)) if in_order else order]
    else:
        vectors = np.zeros((system.n, len(order)), dtype=np.result_type(*[part.vectors for part in solved]))
        for place, k in enumerate(order):
            vectors[chosen[owner[k]], place] = solved[owner[k]].vectors[:, column[k]]
    if np.sum(rigid[order]) > 1:
        # Any combination of rigid motions is one: choose those that a person can read.
        vectors[:, rigid[order]] = _sorted_rigid(system, np.real(vectors[:, rigid[order]]))
    counts = [part.available for part in solved]
    available = None if None in counts else sum(count or 0 for count in counts)
    largest = solved[0].method
    method = largest if len(solved) == 1 else f"{len(solved)} groups of dofs; the largest: {largest}"
    return Modes(s[order], vectors, rigid[order], errors[order], method, available, notes)


def _reach(problem: Problem, solved: Sequence[Modes], wanted: Wanted) -> float | None:
    """|s| in rad/s up to which the modes of a next group may be among those asked for; None: there is no such limit.

    The groups before it may have as many modes as were asked for already.
    """
    sizes = np.sort(np.concatenate([np.zeros(0), *(np.abs(part.eigenvalues) for part in solved)]))
    if wanted.modes is None or len(sizes) < wanted.modes:
        return wanted.limit
    reach = _BEYOND * float(sizes[wanted.modes - 1])
    mass = problem.M.diagonal()
    highest = float((problem.K_symmetric.diagonal()[mass > 0.0] / mass[mass > 0.0]).max(initial=0.0))
    if reach**2 <= _RESOLVED * highest:  # modes can't be counted so near to the rounding of the stiffness
        return wanted.limit
    return reach if wanted.limit is None else min(reach, wanted.limit)


def _solve_group(problem: Problem, wanted: Wanted) -> Modes:
    """The modes of one group, of modal mass 1, with the modal damping ratio of the model."""
    zeta = problem.system.model.damping.modal_ratio
    if problem.is_undamped:
        modes = problem.undamped(wanted.modes, wanted.limit)
        rigid = np.arange(len(modes.eigenvalues)) < modes.rigid_count
        s = 1j * np.where(rigid, 0.0, np.sqrt(modes.eigenvalues))
        highest = np.sqrt(max(modes.sturm_shift, 0.0)) / (2.0 * np.pi)
        method = f"undamped, {modes.method}, Sturm count {modes.sturm_count} of {modes.sturm_expected} below {highest:.6g} Hz"
        found = Modes(s, modes.vectors, rigid, modes.backward_error, method, modes.available)
    else:
        # Most models at standstill need none of these solvers.
        from rotorgear.analysis.modal.damped_solve import damped_group

        damped, coordinates = damped_group(problem, wanted.modes, wanted.limit)
        worst = float(damped.backward_error.max(initial=0.0))
        if worst > _LARGEST_RESIDUAL:
            raise ConvergenceError(
                f"a damped mode leaves a residual of {worst:.1e} relative to the matrices, so the modes can't be trusted; "
                "ask for fewer modes, or look for stiffness or damping many decades apart",
                damped,
            )
        s = np.where(damped.rigid, 0.0, damped.eigenvalues)
        if problem.symmetric and not problem.damped:
            # Gyroscopic terms do no work: without damping every s is imaginary, but for rounding. A carrier that turns faster
            # than its planets vibrate can bring work into them.
            still = problem.rigid is None or np.abs(s.real) < _STILL * np.abs(s)
            s = np.where(still, 1j * np.abs(s), s)
        vectors = _of_modal_mass_1(problem.M, damped.vectors)
        words = {"damped": problem.damped, "gyroscopic": bool(wanted.speed)}
        kind = " ".join(word for word, there in words.items() if there) or "non-symmetric"
        method = f"{kind} problem{coordinates}, {damped.method}"
        available = len(s) if damped.complete else None
        found = Modes(s, vectors, damped.rigid, damped.backward_error, method, available)
    if zeta and wanted.speed is not None and wanted.damped:
        return replace(found, eigenvalues=with_modal_damping(found.eigenvalues, zeta))
    return found


def with_modal_damping(s: np.ndarray, zeta: float) -> np.ndarray:
    """Add a damping ratio to every oscillating mode and keep |s|: what a modal damping ratio states."""
    size = np.abs(s)
    total = np.where(size > 0.0, -s.real / np.where(size > 0.0, size, 1.0), 0.0) + zeta
    oscillates = (s.imag > 0.0) & (total < 1.0)
    return np.where(oscillates, size * (-total + 1j * np.sqrt(np.clip(1.0 - total**2, 0.0, None))), s)


def group_notes(motions: np.ndarray, groups: list[np.ndarray], chosen: list[np.ndarray]) -> tuple[str, ...]:
    """Say which groups of dofs were solved apart and which were left out."""
    notes = []
    kept = {int(group[0]) for group in chosen}
    for motion in ("bending", "axial", "torsion", CASING, GEAR_BODY):
        dropped = sum(len(g) for g in groups if int(g[0]) not in kept and motions[g[0]] == motion)
        if dropped:
            notes.append(f"{motion}: {dropped} dofs decoupled, not among the motions asked for")
    if len(chosen) > 1:
        sizes = ", ".join(f"{len(group)} {'/'.join(sorted(set(motions[group])))}" for group in chosen[:6])
        more = f" and {len(chosen) - 6} more" if len(chosen) > 6 else ""
        notes.append(
            f"coupling between {len(chosen)} groups of dofs that do not act on each other, solved apart: {sizes}{more}"
        )
    return tuple(notes)


def _sorted_rigid(system: System, R: np.ndarray) -> np.ndarray:
    """Turn a basis of the rigid-body motions so that motions and shafts which do not move each other stand apart."""
    nodes = system.nodes
    # A rigid casing is known by its seats, which count as nodes of shafts behind the last one.
    seats = [
        nodes.of_seat(name, k) for name in system.model.casings for k in range(len(system.layout.casing(name).seats))
    ]
    plain = system.dofs.expand(R)[np.concatenate([np.arange(6 * len(nodes)), *seats])]
    shafts = {name: k for k, name in enumerate(system.model.shafts)}
    weight = np.array([1.0 + shafts[name] for name in nodes.shaft] + [1.0 + len(shafts)] * len(seats))
    kinds = np.array([1.0, 1.0, 2.0, 1.0, 1.0, 3.0]) * np.sqrt(2.0)
    scaled = plain * np.sqrt(np.outer(weight, kinds)).reshape(-1, 1)
    try:
        turned = R @ la.eigh(scaled.T @ scaled, plain.T @ plain)[1]
    except la.LinAlgError:
        # Inertias of more than 16 decades: motions that differ in the light parts only are one in all digits. Any basis serves.
        return R
    return _of_modal_mass_1(system.mass, turned)


def _of_modal_mass_1(M: sp.csc_array, V: np.ndarray) -> np.ndarray:
    """Vectors V (n, m) scaled to v^H M v = 1, but for those without inertia."""
    norm = np.sqrt(np.real(column_forms(M, V)))
    return np.asarray(V / np.where(norm > 0.0, norm, 1.0))
