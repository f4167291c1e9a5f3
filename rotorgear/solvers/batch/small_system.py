"""A small system with local forces as the kernels of a batch take it: mass one, time in radians of the fastest excitation.

z = L^T q with M = L L^T, ' = d/d(w t):   z'' = f - K z - D z' - B F,   B^T z = B^T q
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.solvers.batch.columns import Columns
from rotorgear.solvers.batch.own_laws import OwnLaws, not_held, steepest, taken_at_rest
from rotorgear.solvers.time.arguments import Sisters
from rotorgear.solvers.time.contact_equilibrium import Equilibrium
from rotorgear.solvers.time.local_system import LocalSystem, Rotation
from rotorgear.solvers.time.sisters import sisters_of

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
class Reads:
    """Loads inside of a structure: `rows` (l, 2 n + m + 1) on z, z', F and 1 of what they differ by from a `base` (l,)."""

    rows: np.ndarray
    base: np.ndarray


@dataclass(frozen=True)
class SmallSystem:
    """n degrees of freedom, m local displacements.

    Attributes:
        K, D: (n, n); load: (n,); B: (n, m); W: (n, p) watched displacements.
        rigid: (r, n) orthonormal motions without strain; rest: z in equilibrium, (n,).
        carried: (c, n) those of them whose speed nothing but the drive keeps, see `_carried`.
        root: L, (n, n). energy: S with S^T S the stiffness with all contacts closed, (n, n).
        columns: of the local forces; own: those that act by laws of their own. loads: what is read beside motions.
        w: rad/s of the fastest excitation; turns: its periods in the common one.
        fastest: largest |eigenvalue| of the linear system, in radians of that excitation; followed: of those that a reduced
        system holds for. shapes: of a system that was reduced.
        sisters, seen_sisters: planets that go round among the columns and the watched displacements, with the ratio of their
        carriers to the fastest excitation.
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
    loads: Reads
    w: float
    turns: int
    fastest: float
    followed: float
    shapes: Shapes | None = None
    sisters: Sisters = field(default_factory=sisters_of)
    seen_sisters: Sisters = field(default_factory=sisters_of)

    @property
    def going_round(self) -> tuple[Sisters | None, Sisters | None]:
        """Both sets of sisters as compiled loops take them, see `LocalSystem.going_round`."""
        return (self.sisters, self.seen_sisters) if self.sisters.planets.size else (None, None)

    @property
    def size(self) -> int:
        """Number of degrees of freedom before any reduction."""
        return self.n if self.shapes is None else len(self.shapes.vectors)

    @property
    def n(self) -> int:
        """Number of degrees of freedom."""
        return int(self.load.size)


class Still:
    """What of a small system is the same at all speeds: L, its inverse, and the system in the coordinates L^T q, in SI units.

    Attributes:
        K: (n, n), load and rest: (n,), clean_B: (n, m) and W: (n, p), all but the load and B without rounding.
        about: (n, n) stiffness with all contacts closed; held: (n, n) damping of the laws at their reference.

    Args:
        local: the system. rest: its equilibrium. shapes: of a system that was reduced.

    Raises:
        AnalysisError: too many dofs, or one without inertia.
    """

    def __init__(self, local: LocalSystem, rest: Equilibrium, shapes: Shapes | None = None) -> None:
        if shapes is None:
            refuse_large(local.n)
        try:
            self.root = L = np.linalg.cholesky(local.M.toarray())
        except np.linalg.LinAlgError:
            raise AnalysisError("a degree of freedom has no inertia: a sweep needs mass on all of them") from None
        self.shapes = shapes
        self.inverse = inverse = np.linalg.inv(L)
        self.B = inverse @ local.B.toarray()
        self.clean_B = _clean(self.B)
        self.K = _clean(inverse @ local.K.toarray() @ inverse.T)
        self.W = _clean(inverse @ local.watched_vectors)
        self.about = inverse @ local.stiffness_about.toarray() @ inverse.T
        self._damping = local.D.toarray(), None if local.G is None else local.G.toarray()
        self._put(local, rest)

    def _put(self, local: LocalSystem, rest: Equilibrium) -> None:
        self.local = local
        self.equilibrium = rest
        self.load = self.inverse @ local.load
        self.held = self.B @ local.forces.reference_damping @ self.B.T
        self.rest = self.root.T @ rest.q

    def under(self, local: LocalSystem, rest: Equilibrium) -> Still:
        """The same matrices under other loads and laws of the same reference stiffness, with their equilibrium."""
        _ = self.standing, self.modes, self.rigid  # what both have is found once
        found = copy(self)
        found._put(local, rest)
        return found

    @cached_property
    def standing(self) -> np.ndarray:
        """Damping (n, n) at standstill."""
        return np.asarray(self.inverse @ self._damping[0] @ self.inverse.T)

    def damping(self, speed: float) -> np.ndarray:
        """Damping and gyroscopic terms (n, n) at a speed of the reference."""
        D, G = self._damping
        return self.standing if G is None else np.asarray(self.inverse @ (D + speed * G) @ self.inverse.T)

    @cached_property
    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Squares (n,) of the frequencies with all contacts closed, and modes (n, n)."""
        return modes_of(self.about)

    @cached_property
    def rigid(self) -> np.ndarray:
        """Motions without strain where no law acts by itself, orthonormal, (r, n)."""
        return self.orthonormal(self.equilibrium.free)

    def orthonormal(self, free: np.ndarray) -> np.ndarray:
        """Motions (n, r) of q as orthonormal rows of L^T q, (r, n)."""
        return np.linalg.qr(self.root.T @ free)[0].T if free.size else np.zeros((0, self.local.n))


def modes_of(stiffness: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Squares of frequencies (n,) and modes (n, n) of a stiffness beside mass one."""
    squares, modes = np.linalg.eigh(0.5 * (stiffness + stiffness.T))
    return squares, modes


def small_system(
    still: Still,
    speed: float,
    columns: Columns,
    own: OwnLaws,
    w: float,
    turns: int,
    modal_ratio: float = 0.0,
    inside: Sequence[np.ndarray] = (),
) -> SmallSystem:
    """Return a system at a speed of the reference in rad/s in the form of the kernels.

    Args:
        still: the system as it is at any speed. speed: of the reference. columns: of its local forces, in SI.
        own: those with laws of their own.
        w: rad/s of the fastest excitation. turns: its periods in the common one.
        modal_ratio: damping ratio added to every mode with strain.
        inside: rows (l, n) on q, q' and q'' of loads that are read, and (l,) what is taken off them; nothing where none is.
    """
    shapes = still.shapes
    B = still.B
    n = still.local.n
    D = still.damping(speed)
    damped = D + still.held
    linear = [(still.about, damped)]
    squares, modes = still.modes
    rigid = still.rigid
    carried = np.zeros((0, n))
    if own.forces.laws:
        local = replace(still.local, rotation=Rotation.constant(speed))
        rest = still.equilibrium
        steep = steepest(local, rest.q, own, 2.0 * np.pi / w)
        linear += [(still.about + B @ k @ B.T, damped + B @ c @ B.T) for k, c in steep]
        squares, modes = modes_of(linear[-1][0])
        rigid = still.orthonormal(not_held(local, rest.q, own, rest.free))
        if len(rigid):
            carried = _carried(rigid, damped, B, *taken_at_rest(local, rest.q, own, turns * 2.0 * np.pi / w))
    energy = np.sqrt(np.abs(squares) + _FLOOR * np.abs(squares).max())[:, None] * modes.T / w
    if modal_ratio:
        D = D + (modes * (2.0 * modal_ratio * np.sqrt(np.maximum(squares, 0.0)))) @ modes.T
    rates = np.concatenate([_rates(k / w**2, c / w) for k, c in linear])
    followed = rates if shapes is None else rates[rates <= shapes.up_to / w]
    D = _clean(D)
    return SmallSystem(
        still.K / w**2,
        D / w,
        still.load / w**2,
        still.clean_B,
        still.W,
        rigid,
        carried,
        still.rest,
        still.root,
        energy,
        columns.scaled(w),
        own,
        _reads(still, D, w, inside),
        w,
        turns,
        float(rates.max()),
        float(followed.max(initial=0.0)),
        shapes,
        *(sets._replace(ratio=sets.ratio * own.turn) for sets in (still.local.sisters, still.local.seen_sisters)),
    )


def _reads(still: Still, D: np.ndarray, w: float, inside: Sequence[np.ndarray]) -> Reads:
    """Loads with q'' = f - K q - D q' - B F put in; they are counted from those at rest, beside which vibrations may be small."""
    n = still.local.n
    m = still.clean_B.shape[1]
    if not inside:
        return Reads(np.zeros((0, 2 * n + m + 1)), np.zeros(0))
    of_q, of_v, of_a = (rows @ still.inverse.T for rows in inside[:3])
    base = of_q @ still.rest - inside[3]
    constant = of_a @ still.load - of_q @ still.rest
    rows = (of_q - of_a @ still.K, w * (of_v - of_a @ D), -(w**2) * (of_a @ still.clean_B), constant[:, None])
    return Reads(np.hstack(rows), base)


def _rates(K: np.ndarray, D: np.ndarray) -> np.ndarray:
    """All |eigenvalues| (2 n,) of z'' = -K z - D z'."""
    n = len(K)
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:] = np.eye(n)
    A[n:, :n] = -K
    A[n:, n:] = -D
    return np.abs(np.linalg.eigvals(A))


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
