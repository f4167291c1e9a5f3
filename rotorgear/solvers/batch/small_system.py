"""A small system with local forces as the kernels of a batch take it: mass one, time in radians of the fastest excitation.

z = L^T q with M = L L^T, ' = d/d(w t):   z'' = f - K z - D z' - B F,   B^T z = B^T q
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.solvers.batch.columns import Columns
from rotorgear.solvers.batch.own_laws import OwnLaws, not_held, steepest, taken_at_rest
from rotorgear.solvers.time.contact_equilibrium import Equilibrium
from rotorgear.solvers.time.local_system import LocalSystem

# Dense matrices in the kernel: beyond this many, other methods are cheaper.
MOST_DOFS = 80
# The Runge-Kutta method of order 4 is stable along the imaginary axis up to 2.83, along the negative one up to 2.79.
STABLE = 2.5
# Products of a frequency and a step that leave errors of 1e-3 or so in a period.
ACCURATE = 0.35
# The same above the frequencies that a reduced system follows: its stiffest shapes answer as if static.
_STATIC = 1.5
# Of all forces of laws, below which a motion meets none.
_FELT = 1e-9
# Share of its speed by which a motion may be slowed until drag is in balance with what laws take.
_SLOWER = 0.01
# Of the largest stiffness, that every direction gets in the size of a tangent.
_FLOOR = 1e-12


@dataclass(frozen=True)
class Shapes:
    """What n coordinates mean in a larger system: its motions (N, n), M-orthonormal, and these times M."""

    vectors: np.ndarray
    weighed: np.ndarray
    up_to: float

    @staticmethod
    def of(vectors: np.ndarray, M: sp.csc_array, up_to: float) -> Shapes:
        """Shapes of a system with mass M (N, N) that holds up to a frequency in rad/s."""
        return Shapes(vectors, M @ vectors, up_to)


@dataclass(frozen=True)
class SmallSystem:
    """n degrees of freedom, m local displacements.

    Attributes:
        K, D: (n, n); load: (n,); B: (n, m); W: (n, p) watched displacements.
        rigid: (r, n) orthonormal motions without strain; rest: z in equilibrium, (n,).
        carried: (c, n) those of them whose speed nothing but the drive keeps, see `_carried`.
        root: L, (n, n). energy: S with S^T S the stiffness with all contacts closed, (n, n).
        columns: of the local forces; own: those that act by laws of their own.
        w: rad/s of the fastest excitation; turns: its periods in the common one.
        fastest: largest |eigenvalue| of the linear system, in radians of that excitation; followed: of those that a reduced
        system holds for. shapes: of a system that was reduced.
    """

    K: np.ndarray
    D: np.ndarray
    load: np.ndarray
    B: np.ndarray
    W: np.ndarray
    rigid: np.ndarray
    carried: np.ndarray
    rest: np.ndarray
    root: np.ndarray
    energy: np.ndarray
    columns: Columns
    own: OwnLaws
    w: float
    turns: int
    fastest: float
    followed: float
    shapes: Shapes | None = None

    @property
    def size(self) -> int:
        """Number of degrees of freedom before any reduction."""
        return self.n if self.shapes is None else len(self.shapes.vectors)

    @property
    def n(self) -> int:
        """Number of degrees of freedom."""
        return int(self.load.size)


def small_system(
    local: LocalSystem,
    rest: Equilibrium,
    columns: Columns,
    own: OwnLaws,
    w: float,
    turns: int,
    modal_ratio: float = 0.0,
    shapes: Shapes | None = None,
) -> SmallSystem:
    """Return a system at the speed of its rotation in the form of the kernels.

    Args:
        local: the system. rest: its equilibrium. columns: of its local forces, in SI. own: those with laws of their own.
        w: rad/s of the fastest excitation. turns: its periods in the common one.
        modal_ratio: damping ratio added to every mode with strain. shapes: of a system that was reduced.

    Raises:
        AnalysisError: too many dofs, or one without inertia.
    """
    if shapes is None:
        refuse_large(local.n)
    try:
        L = np.linalg.cholesky(local.M.toarray())
    except np.linalg.LinAlgError:
        raise AnalysisError("a degree of freedom has no inertia: a sweep needs mass on all of them") from None
    inverse = np.linalg.inv(L)
    B = inverse @ local.B.toarray()
    K = inverse @ local.K.toarray() @ inverse.T
    D = inverse @ local.velocity_terms(float(local.rotation.speeds[0])).toarray() @ inverse.T
    about = inverse @ local.stiffness_about.toarray() @ inverse.T
    damped = D + B @ local.forces.reference_damping @ B.T
    steep = steepest(local, rest.q, own, 2.0 * np.pi / w)
    linear = [(about, damped), *((about + B @ k @ B.T, damped + B @ c @ B.T) for k, c in steep)]
    squares, modes = np.linalg.eigh(0.5 * (linear[-1][0] + linear[-1][0].T))
    energy = np.sqrt(np.abs(squares) + _FLOOR * np.abs(squares).max())[:, None] * modes.T / w
    if modal_ratio:
        D = D + (modes * (2.0 * modal_ratio * np.sqrt(np.maximum(squares, 0.0)))) @ modes.T
    free = not_held(local, rest.q, own, rest.free)
    rigid = np.linalg.qr(L.T @ free)[0].T if free.size else np.zeros((0, local.n))
    carried = np.zeros((0, local.n))
    if len(rigid) and own.forces.laws:
        carried = _carried(rigid, damped, B, *taken_at_rest(local, rest.q, own, turns * 2.0 * np.pi / w))
    # All |eigenvalues| of z'' = -K z - D z'.
    zero = np.zeros((local.n, local.n))
    matrices = [np.block([[zero, np.eye(local.n)], [-(k / w**2), -(c / w)]]) for k, c in linear]
    rates = np.concatenate([np.abs(np.linalg.eigvals(A)) for A in matrices])
    followed = rates if shapes is None else rates[rates <= shapes.up_to / w]
    return SmallSystem(
        _clean(K) / w**2,
        _clean(D) / w,
        inverse @ local.load / w**2,
        _clean(B),
        _clean(inverse @ local.watched_vectors),
        rigid,
        carried,
        L.T @ rest.q,
        L,
        energy,
        columns.scaled(w),
        own,
        w,
        turns,
        float(rates.max()),
        float(followed.max(initial=0.0)),
        shapes,
    )


def _carried(
    rigid: np.ndarray, D: np.ndarray, B: np.ndarray, power: float, push: np.ndarray, damping: np.ndarray
) -> np.ndarray:
    """Motions without strain (r, n) whose speed the drive keeps; orthonormal, (c, n).

    A law that acts against sliding, such as friction, takes power P from such a motion, which it pushes by f. A drag c on it
    comes into balance with that where the motion is slower by f/c, of P/f that it has. Where that is more than a small share,
    only the drive can hold the speed: without it the system would run down while all that depends on time keeps to its speed,
    and after some thousand periods it would slide as one at another speed does.

    Args:
        rigid: orthonormal motions without strain, (r, n). D: damping, (n, n), and B: directions of the laws, (n, m), about the
        mean state. power, push, damping: of laws of their own, see `taken_at_rest`.
    """
    if not power > 0.0:
        return np.zeros((0, len(D)))
    pushes = B @ push
    drag = 0.5 * (D + D.T) + B @ (0.5 * (damping + damping.T)) @ B.T
    drags, turned = np.linalg.eigh(rigid @ drag @ rigid.T)
    along = turned.T @ rigid
    f = along @ pushes
    felt = np.abs(f) > _FELT * np.linalg.norm(pushes)
    return np.asarray(along[felt & (f**2 > _SLOWER * np.maximum(drags, 0.0) * power)])


def refuse_large(n: int) -> None:
    """AnalysisError where n dofs are too many."""
    if n > MOST_DOFS:
        raise AnalysisError(
            f"{n} dofs are too many for a sweep (at most {MOST_DOFS}): lump the structure (rigid bodies on springs), or run "
            "single points by the transient analysis"
        )


def _clean(A: np.ndarray) -> np.ndarray:
    """A without the rounding that a change of coordinates leaves where nothing was."""
    return np.where(np.abs(A) > 1e-14 * np.abs(A).max(initial=0.0), A, 0.0)


def steps_needed(system: SmallSystem) -> int:
    """Steps in a period of the fastest excitation that follow the frequencies the system holds for, and are stable for all."""
    return max(
        _steps(system.followed, ACCURATE), _steps(system.fastest, ACCURATE if system.shapes is None else _STATIC)
    )


def steps_stable(system: SmallSystem) -> int:
    """Least steps in a period of the fastest excitation that are stable."""
    return _steps(system.fastest, STABLE)


def _steps(fastest: float, share: float) -> int:
    return int(np.ceil(2.0 * np.pi * fastest / share))
