"""Newmark, HHT and generalised-alpha integration with one factorisation and contact condensed to m x m.

Average acceleration (beta 1/4, gamma 1/2) by default: second order, no numerical damping. It takes the equations of motion in
the mean over a step, with local forces from their potential, so that energy is kept also where sides meet and part
(kernel_contact.py).
`rho_inf` < 1 damps what the step can't resolve: am = (2 rho - 1)/(rho + 1), af = rho/(rho + 1); these and other beta and gamma
have local forces at a step's end, and may gain energy where stiff sides part. Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67;
Hilber, Hughes and Taylor, Earthquake Eng. Struct. Dyn. 5 (1977) 283; Chung and Hulbert, J. Applied Mechanics 60 (1993) 371.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.solvers.sparse.entries import on_one_pattern
from rotorgear.solvers.sparse.factor import factor_general
from rotorgear.solvers.sparse.pencil import LooseDofError, check_pencil
from rotorgear.solvers.time.arguments import Kept, NewmarkStep, SparseRows, Triangles
from rotorgear.solvers.time.local_system import Integrator, LocalSystem, MotionState, Stepper
from rotorgear.solvers.time.sisters import turning_matrix

# Of contacts over a step, the share that dampers to ground have: a smaller one loses the digits to which forces are found.
_FELT = 1e-5


@dataclass(frozen=True)
class Newmark(Integrator):
    """Method of the generalised-alpha family by its four numbers."""

    beta: float = 0.25
    gamma: float = 0.5
    alpha_m: float = 0.0
    alpha_f: float = 0.0

    def __post_init__(self) -> None:
        if not (self.gamma >= 0.5 and self.beta > 0.0 and self.alpha_m < 1.0 and self.alpha_f < 1.0):
            raise AnalysisError(
                f"beta {self.beta:g}, gamma {self.gamma:g}: expected beta > 0 and gamma >= 1/2; less makes the motion grow"
            )

    @property
    def keeps_energy(self) -> bool:
        """Whether local forces do the work by which their potential changes over a step."""
        return (self.beta, self.gamma, self.alpha_m, self.alpha_f) == (0.25, 0.5, 0.0, 0.0)

    @property
    def name(self) -> str:
        """What it is, in words."""
        if self.alpha_m:
            return f"generalised alpha, rho_inf {(1.0 - self.alpha_f) and self.alpha_f / (1.0 - self.alpha_f):.3g}"
        if self.alpha_f:
            return f"HHT, alpha {self.alpha_f:.3g}"
        if (self.beta, self.gamma) == (0.25, 0.5):
            return "Newmark, average acceleration"
        return f"Newmark, beta {self.beta:.4g}, gamma {self.gamma:.4g}"

    @staticmethod
    def generalised_alpha(rho_inf: float) -> Newmark:
        """Return the method whose highest frequencies shrink by rho_inf each step (0 to 1)."""
        if not 0.0 <= rho_inf <= 1.0:
            raise AnalysisError(f"rho_inf must lie between 0 and 1, got {rho_inf:g}")
        am = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0)
        af = rho_inf / (rho_inf + 1.0)
        return Newmark(0.25 * (1.0 - am + af) ** 2, 0.5 - am + af, am, af)

    @staticmethod
    def hht(alpha: float) -> Newmark:
        """Return Hilber, Hughes and Taylor's method, alpha from 0 to 1/3."""
        if not 0.0 <= alpha <= 1.0 / 3.0:
            raise AnalysisError(f"alpha of HHT must lie between 0 and 1/3, got {alpha:g}")
        return Newmark(0.25 * (1.0 + alpha) ** 2, 0.5 + alpha, 0.0, alpha)

    def prepare(self, system: LocalSystem, h: float, speed: float, tolerance: float = 1e-10) -> NewmarkStepper:
        """Factor the step's matrix and condense it to the contacts."""
        return NewmarkStepper(self, system, h, speed, tolerance)


def held_by_contacts(system: LocalSystem) -> bool:
    """Whether nothing but contacts holds some dofs without inertia."""
    try:
        check_pencil(system.M, sp.csc_array(0.5 * (system.K + system.K.T)))
    except LooseDofError:
        return True
    return False


class NewmarkStepper(Stepper):
    """The method made ready for one system, step and speed."""

    def __init__(self, method: Newmark, system: LocalSystem, h: float, speed: float, tolerance: float) -> None:
        super().__init__(system, h)
        am = method.alpha_m
        af = method.alpha_f
        beta = method.beta
        gamma = method.gamma
        D = system.velocity_terms(speed)
        if held_by_contacts(system):
            # Dampers to ground hold such dofs where no contact does; where one does, over a step they are too weak to be felt.
            light = np.where(system.M.diagonal() > 0.0, 0.0, _FELT)
            D = D + sp.diags_array(light * (h * system.stiffness_about + system.damping_about).diagonal())
        S = sp.csc_array((1.0 - am) * system.M + (1.0 - af) * (gamma * h * D + beta * h**2 * system.K))
        factor = factor_general(S)
        B = system.B.toarray()
        P = factor.solve(B) if system.m else np.zeros((system.n, 0))
        condensed = (1.0 - af) * (B.T @ P)
        # Over a whole step, one mean acceleration moves both: q1 = q + h v + h^2/2 a, v1 = v + h a.
        whole = method.keeps_energy
        by_q = 0.5 if whole else beta
        by_v = 1.0 if whole else gamma
        Ad = by_q * h**2 * condensed
        Av = by_v * h * condensed
        if system.sisters.planets.size:
            Av = Av - speed * turning_matrix(system.sisters, system.m) @ Ad
        first, column, (K, D_nz, M) = on_one_pattern(system.K, D, system.M)
        lu = factor._lu
        observed = system.observed_rows
        self._step = NewmarkStep(
            h=float(h),
            whole=whole,
            am=float(am),
            af=float(af),
            beta=float(by_q),
            gamma=float(by_v),
            rotation=system.rotation.table,
            tolerance=float(tolerance),
            first=first,
            column=column,
            K=K,
            D=D_nz,
            M=M,
            load=np.ascontiguousarray(system.load, dtype=float),
            S=Triangles(
                L=_compressed(sp.csc_array(sp.tril(lu.L, -1))),
                U=_compressed(sp.csc_array(sp.triu(lu.U, 1))),
                diagonal=1.0 / lu.U.diagonal(),
                row_place=lu.perm_r.astype(np.int32),
                column_place=lu.perm_c.astype(np.int32),
            ),
            Bt=_rows(system.B.T),
            Wt=_rows(system.watched_vectors.T),
            P=np.ascontiguousarray((1.0 - af) * P),
            channels=tuple(_rows(Y) for Y in (observed.q, observed.v, observed.a, observed.F)),
            Ad=np.ascontiguousarray(Ad),
            Av=np.ascontiguousarray(Av),
        )
        self._laws = system.forces.arguments()

    def start(self, state: MotionState) -> None:
        """Any consistent state will do; energies of whole steps have no half step before the first."""
        if self._step.whole and state.step == 0:
            state.sums[:] = 0.0

    def loop(self, state: MotionState, steps: int, every: int, kept: Kept) -> tuple[int, int, int]:
        """Advance a state in place and record; returns steps done, status and linear solutions."""
        from rotorgear.solvers.time.kernel_newmark import newmark_loop

        done, status, solutions = newmark_loop(
            self._step, self._laws, *self.system.going_round, steps, every, state.step, state.carried, kept
        )
        return done, status, solutions


def _rows(A: sp.csc_array | np.ndarray) -> SparseRows:
    return _compressed(sp.csr_array(A))


def _compressed(A: sp.csr_array | sp.csc_array) -> SparseRows:
    return SparseRows(A.indptr.astype(np.int32), A.indices.astype(np.int32), A.data.astype(float))
