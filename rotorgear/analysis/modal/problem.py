"""The eigenproblem (s^2 M + s D + K) q = 0 of a system, whole or of one independent group of its dofs, and its undamped modes.

Damped modes are built on undamped ones. A Campbell diagram, like every analysis at one speed after another, needs the same
ones each time: where the stiffness does not depend on the speed they are kept as long as the system lives.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from weakref import WeakKeyDictionary

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.solvers.eigen.eigen import UndampedModes, lowest_modes
from rotorgear.solvers.eigen.shift_invert import shifted_operator
from rotorgear.solvers.sparse.entries import column_forms, magnitudes
from rotorgear.solvers.sparse.factor import factor_general
from rotorgear.solvers.sparse.pencil import rounding_noise
from rotorgear.system.assembly import StrainForms
from rotorgear.system.plan import Plan
from rotorgear.system.planets import turning_carriers
from rotorgear.system.rigid_motions import rigid_motions
from rotorgear.system.system import System

# Shares of the usual k_ii / m_ii: how far beside zero free motions are looked for, and below what one is free.
_BESIDE = 1e-14
_AT_ZERO = 1e-11
# Multiple of the rounding of the stiffness within which a motion is free.
_ROUNDED = 4.0
# Share of a motion beyond which a group takes part in it.
_MOVES = 1e-9
_LARGE = 20_000  # dofs above which a look at the coarsest mesh costs nothing beside the rest
# Requests of a system that are kept, the latest ones: as many groups, mostly of one request.
_MOST_KEPT = 16
# Dofs of the group, how many modes, up to which frequency in rad/s, and whether they are counted.
_Request = tuple[bytes, int | None, float | None, bool]
_kept: WeakKeyDictionary[System, dict[_Request, UndampedModes]] = WeakKeyDictionary()


@dataclass(frozen=True)
class Problem:
    """M, D = alpha M + spin G + C and K of n dofs; `strain` (p, n) is S with S^T S the symmetric part of K, None where a spring
    is indefinite.

    `inertial` is the part alpha M + spin G of D, and `make_forms()` what C and K are made of, which keeps what it made.
    `symmetric` says whether K is, `damped` whether anything takes energy out, `guess` where the first elastic eigenvalue may be,
    `dofs` names the dofs of a group, all of them where it is empty. `rigid` (n, r) are the motions that no spring resists, where
    planets go round: what they add to K cancels in the rotation of their train, which no strain tells then.
    """

    system: System
    M: sp.csc_array
    D: sp.csc_array
    K: sp.csc_array
    K_symmetric: sp.csc_array
    inertial: sp.csc_array
    strain: sp.csr_array | None
    make_forms: Callable[[], StrainForms]
    symmetric: bool
    damped: bool
    guess: float | None = None
    dofs: bytes = b""
    rigid: np.ndarray | None = None

    @classmethod
    def at(cls, system: System, speed: float | None, *, damped: bool = True) -> Problem:
        """That of a system at a speed in rad/s; without one, undamped at standstill.

        `damped` False leaves gyroscopic terms and the symmetric K: nothing damps and nothing drives.
        """
        at = speed or 0.0
        nothing = sp.csc_array(system.mass.shape)
        circulatory = system.circulatory(at) if damped else nothing
        K_symmetric = system.stiffness(at)
        K = sp.csc_array(K_symmetric + circulatory) if circulatory.nnz else K_symmetric
        S = system.strain_factor(at)
        turning = bool(at and turning_carriers(system.layout))
        if S is None and circulatory.nnz and not turning:
            # A film at a small load: the symmetric part of its stiffness is no stable spring, while the whole and its damping
            # may well be. Undamped modes serve to find rigid motions and the scale of frequencies only.
            K_symmetric = system.definite_stiffness(at)
        if damped:
            D = system.velocity_terms(speed)
            inertial = nothing if D is None else system.inertial_terms(at)
        else:
            D = inertial = sp.csc_array(at * system.gyroscopic) if at else nothing

        @cache
        def forms() -> StrainForms:
            whole = system.strain_forms(at)
            if D is None or not damped:
                whole = replace(whole, viscosity=0.0 * whole.viscosity)
            return whole if damped else replace(whole, circulation=0.0 * whole.circulation)

        rigid = _free_motions(system, at, K) if turning else None
        guess = None
        if damped and system.n >= _LARGE:
            # The first elastic eigenvalue of the coarsest mesh saves the search for a shift, which costs a factorisation here.
            coarse = system.with_plan(Plan(1))
            guess = shifted_operator(coarse.mass, coarse.stiffness()).elastic if coarse.n else None
        return cls(
            system=system,
            M=system.mass,
            D=nothing if D is None else D,
            K=K,
            K_symmetric=K_symmetric,
            inertial=inertial,
            strain=S,
            make_forms=forms,
            symmetric=not circulatory.nnz,
            damped=damped and speed is not None and bool(system.damping(at).nnz),
            guess=guess,
            rigid=rigid,
        )

    @property
    def forms(self) -> StrainForms:
        """Strains, and what acts on them; made when they are first asked for."""
        return self.make_forms()

    @property
    def is_undamped(self) -> bool:
        """Whether it is s^2 M + K with a symmetric K."""
        return self.symmetric and not self.D.nnz

    def cut(self, group: np.ndarray) -> Problem:
        """The problem of one group of dofs."""
        if len(group) == self.M.shape[0]:
            return self
        place = np.full(self.M.shape[0], -1, dtype=self.M.indices.dtype)
        place[group] = np.arange(len(group))

        def cut_out(A: sp.csc_array) -> sp.csc_array:
            # Only dofs of the group are in the rows of its columns, but for stored zeros.
            columns = A[:, group]
            rows = place[columns.indices]
            if rows.size and rows.min() < 0:
                return sp.csc_array(columns[group])
            return sp.csc_array((columns.data, rows, columns.indptr), shape=(len(group), len(group)))

        D = cut_out(self.D)
        K = cut_out(self.K)
        K_symmetric = K if self.K_symmetric is self.K else cut_out(self.K_symmetric)
        S = self.strain
        if S is not None:
            S = sp.csr_array(sp.csc_array(S)[:, group])
            S = sp.csr_array(S[np.diff(S.indptr) > 0])
        return replace(
            self,
            M=cut_out(self.M),
            D=D,
            K=K,
            K_symmetric=K_symmetric,
            inertial=cut_out(self.inertial),
            strain=S,
            make_forms=cache(lambda: self.forms.cut(group)),
            symmetric=self.symmetric or not (K - K_symmetric).nnz,
            damped=self.damped and bool((D + D.T).nnz),
            dofs=group.tobytes(),
            rigid=None if self.rigid is None else _of_group(self.rigid, group),
        )

    def undamped(self, count: int | None, below: float | None, *, counted: bool = True) -> UndampedModes:
        """The lowest undamped modes: `count` of them, or up to |s| = `below` in rad/s; `counted` by Sturm's sequence."""
        return lowest_modes(
            self.M,
            self.K_symmetric,
            count=count,
            below=below,
            strain=self.strain,
            guess=self.guess,
            counted=counted,
            rigid=0 if self.rigid is None else self.rigid.shape[1],
        )

    def lowest(self, count: int | None, below: float | None, *, counted: bool = True) -> UndampedModes:
        """The same, or what was found when the same was asked of this system before."""
        # The stiffness of indefinite springs is made definite, at some speeds.
        if self.strain is None or self.system.has_tables:
            return self.undamped(count, below, counted=counted)
        known = _kept.setdefault(self.system, {})
        request = (self.dofs, count, below, counted)
        if request not in known:
            known[request] = self.undamped(count, below, counted=counted)
            if len(known) > _MOST_KEPT:
                known.pop(next(iter(known)))
        return known[request]


def _free_motions(system: System, speed: float, K: sp.csc_array) -> np.ndarray:
    """Those of the motions that no spring resists which nothing that planets bring resists either, (n, r).

    In the rotation of a train its terms cancel, with planets where their pins give to; planets that nothing keeps upright tilt
    freely at rest, and not on a carrier that turns. Inverse iteration beside zero tells them apart.
    """
    motions = rigid_motions(system, system.groups_at(speed))
    if not motions.shape[1]:
        return motions
    M = system.mass
    m = M.diagonal()
    usual = float(np.median(np.abs(K.diagonal()[m > 0.0]) / m[m > 0.0]))
    factor = factor_general(sp.csc_array(K + _BESIDE * usual * M))
    for _ in range(4):
        motions = np.linalg.qr(factor.solve(M @ motions))[0]
    values, turned = la.eig(motions.T @ (K @ motions), motions.T @ (M @ motions))
    found = motions @ turned.real
    found = found / np.sqrt(np.maximum(column_forms(M, found), np.finfo(float).tiny))
    # Very stiff pins leave more of their rounding than a share of what is usual.
    free = np.abs(values) < np.maximum(_AT_ZERO * usual, _ROUNDED * rounding_noise(magnitudes(K), found))
    return np.asarray(motions @ np.linalg.qr(turned[:, free].real)[0])


def _of_group(motions: np.ndarray, group: np.ndarray) -> np.ndarray:
    """Those of some motions (n, r) that move a group of dofs beyond rounding."""
    mine = motions[group]
    moves = np.abs(mine).max(axis=0, initial=0.0) > _MOVES * np.abs(motions).max(axis=0, initial=0.0)
    return np.asarray(mine[:, moves])
