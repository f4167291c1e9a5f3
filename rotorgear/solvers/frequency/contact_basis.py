"""A basis of few shapes in which contacts move as in the whole structure: chosen modes, and static shapes of loads and contacts.

Candidates are the lowest modes with all contacts closed and the residual attachment vectors of all columns. Of the modes those
are kept, a few at a time, that change the receptances at the contacts most. By the residual of the present basis a mode j that
is left out changes H by about

    (d_j r_j) / Z_jj,   r = B - Z V y,  d the same for Z^T

which sees couplings by gyroscopic terms and dampers too. The attachment vectors of contacts and loads stay in the basis, so the
static state is exact, whichever contacts touch. Craig and Kurdila, Fundamentals of Structural Dynamics, 2nd ed., section 17.

The receptances of the system at its local displacements are H = B^T Z(s)^-1 B, full or in a basis, contacts closed or apart:

    Z(s) = K + B k B^T + s (D + W G + B c B^T) + s^2 M      closed, with the reference stiffness k and damping c of the laws
    H_apart = H (1 - (k + s c) H)^-1                        all of them apart

Two of them are compared in units of the contacts' own compliance: 1 is the motion that a force makes in a contact itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.solvers.eigen.ritz import ritz_residuals
from rotorgear.solvers.sparse.factor import factor_general, single_thread
from rotorgear.solvers.sparse.nullspace import in_comparable_units, left_null_space, supported_solver
from rotorgear.solvers.time.local_system import LocalSystem

# Of the largest that a column could reach by its own static compliance: responses below are rounding.
_NOTHING = 1e-8


@dataclass(frozen=True)
class Probes:
    """Speeds of the reference in rad/s and complex frequencies s in rad/s, (f,) each."""

    speed: np.ndarray
    s: np.ndarray

    @property
    def count(self) -> int:
        """Number f."""
        return int(self.s.size)


@dataclass(frozen=True)
class Scale:
    """What receptances are measured by.

    Attributes:
        k: reference stiffness (m, m).
        c: reference damping (m, m).
        root: (m,) root of each contact's stiffness, 0 for other columns.
    """

    k: np.ndarray
    c: np.ndarray
    root: np.ndarray

    @property
    def contacts(self) -> np.ndarray:
        """Places of the contacts among the columns."""
        return np.flatnonzero(self.root > 0.0)


def full_receptances(local: LocalSystem, probes: Probes) -> np.ndarray:
    """H (f, m, m) with contacts closed: one sparse factorisation for each of f probes."""
    B = local.B.toarray().astype(complex)
    H = np.zeros((probes.count, local.m, local.m), complex)
    K = local.stiffness_about
    D = local.damping_about
    with single_thread(local.n):
        for i, (speed, s) in enumerate(zip(probes.speed, probes.s, strict=True)):
            damping = D if local.G is None else D + speed * local.G
            H[i] = B.T @ factor_general(sp.csc_array(K + s * damping + s * s * local.M, dtype=complex)).solve(B)
    return H


def around(H: np.ndarray, s: np.ndarray, scale: Scale) -> tuple[np.ndarray, np.ndarray]:
    """(1 - H z)^-1 and (1 - z H)^-1 with z = k + s c, (f, m, m) each: H_apart is H times the second."""
    z = scale.k + s[:, None, None] * scale.c
    one = np.eye(H.shape[1])
    return np.linalg.inv(one - H @ z), np.linalg.inv(one - z @ H)


def sizes(H: np.ndarray, scale: Scale) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What differences are measured by: between contacts (f,); other columns that move a contact (o,), and by how much (o,)."""
    at = scale.contacts
    root = scale.root
    inner = H[:, at][:, :, at] * root[at][:, None] * root[at]
    between = np.maximum(np.linalg.norm(inner, ord=2, axis=(1, 2)), 1.0) if at.size else np.ones(len(H))
    moved = np.linalg.norm(root[at][:, None] * H[:, at], axis=1).max(axis=0, initial=0.0)
    most = np.sqrt(np.abs(np.einsum("fii->fi", H)).max(axis=0, initial=0.0))
    others = np.flatnonzero((root == 0.0) & (moved > _NOTHING * most) & (moved > 0.0))
    return between, others, moved[others]


def difference(H: np.ndarray, other: np.ndarray, scale: Scale) -> float:
    """Largest relative difference of other receptances (f, m, m) from H.

    Between contacts: relative to |H| or the contacts' own compliance, the larger; of what prescribed forces do at contacts:
    relative to the most that each does over all probes.
    """
    between, others, moved = sizes(H, scale)
    at = scale.contacts
    root = scale.root[at]
    apart = root[:, None] * (other - H)[:, at]
    inner = np.linalg.norm(apart[:, :, at] * root, ord=2, axis=(1, 2)) / between if at.size else np.zeros(1)
    outer = np.linalg.norm(apart[:, :, others], axis=1) / moved
    return float(max(inner.max(initial=0.0), outer.max(initial=0.0)))


def differences(H: np.ndarray, other: np.ndarray, s: np.ndarray, scale: Scale) -> tuple[float, float]:
    """`difference` with contacts closed and with all of them apart."""
    closed = difference(H, other, scale)
    return closed, difference(H @ around(H, s, scale)[1], other @ around(other, s, scale)[1], scale)


# Shapes of which modes leave over less than this are in them.
_IN_MODES = 1e-8
# Share of the modes that are kept so far by which they grow at a time.
_GROWTH = 0.06
_NOISE = 1e3 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Candidates:
    """p M-orthonormal shapes of n dofs, and the system in them; contacts closed in K and D.

    Attributes:
        vectors: (n, p), rigid-body motions first, then modes, then attachment vectors.
        rigid: how many rigid-body motions.
        modes: how many modes.
        w: (p,) rad/s.
        K: (p, p) stiffness.
        D: (p, p) damping.
        G: (p, p) gyroscopic, for unit speed.
        B: (p, m) of the contacts.
        statics: (p, a) static shapes under contact forces and loads.
    """

    vectors: np.ndarray
    rigid: int
    modes: int
    w: np.ndarray
    K: np.ndarray
    D: np.ndarray
    G: np.ndarray
    B: np.ndarray
    statics: np.ndarray


@dataclass(frozen=True)
class Choice:
    """A basis and how far its receptances are off.

    Attributes:
        modes: numbers among the candidates of the modes that are kept.
        basis: Q (p, r) in the candidates.
        closed: largest relative difference with contacts closed, see solvers/frequency/contact_basis.py.
        apart: the same with contacts apart.
    """

    modes: np.ndarray
    basis: np.ndarray
    closed: float
    apart: float

    @property
    def error(self) -> float:
        """The larger of both."""
        return max(self.closed, self.apart)


def candidates(local: LocalSystem, loads: np.ndarray, acting: np.ndarray, count: int) -> Candidates:
    """Return the shapes to choose from.

    Args:
        local: the system.
        loads: (n, l) that attachment vectors are kept of.
        acting: (a,) columns of the contacts that attachment vectors are kept of.
        count: how many modes.
    """
    M = local.M
    K = local.stiffness_about
    lowest = lowest_modes(M, sp.csc_array(0.5 * (K + K.T)), count=min(count, local.n))
    V = lowest.vectors
    R = lowest.rigid
    rigid = lowest.rigid_count

    # Attachment vectors: static shapes under forces whose share on rigid-body motions is carried by inertia (a free structure).
    solve = supported_solver(K, in_comparable_units(R, K, M), left_null_space(K, M, R))
    B = local.B.toarray()
    forces = np.hstack([B, loads])
    X = solve(forces - M @ (R @ (R.T @ forces)))

    # What modes leave over of them, twice for the rounding.
    rest = X
    for _ in range(2):
        rest = rest - V @ (V.T @ (M @ rest))
    whole = np.sqrt(np.einsum("ij,ij->j", X, M @ X))
    rest[:, np.sqrt(np.einsum("ij,ij->j", rest, M @ rest)) <= _IN_MODES * whole] = 0.0
    E = np.hstack([V, ritz_residuals(M, sp.csc_array(0.5 * (K + K.T)), rest)])
    Ke = E.T @ (K @ E)
    Be = E.T @ B

    # Rigid motions strain nothing and move no closed contact: what K and B say there is rounding.
    strained = np.diag(local.forces.reference_stiffness) > 0.0
    Ke[:rigid] = 0.0
    Ke[:, :rigid] = 0.0
    Be[:rigid, strained] = 0.0
    size = E.shape[1]
    statics = np.zeros((size, forces.shape[1]))
    statics[rigid:] = np.linalg.solve(Ke[rigid:, rigid:], (E.T @ forces)[rigid:])
    return Candidates(
        vectors=E,
        rigid=rigid,
        modes=V.shape[1] - rigid,
        w=np.sqrt(np.maximum(np.diag(Ke), 0.0)),
        K=Ke,
        D=E.T @ (local.damping_about @ E),
        G=np.zeros((size, size)) if local.G is None else E.T @ (local.G @ E),
        B=Be,
        statics=statics[:, np.concatenate([acting, B.shape[1] + np.arange(loads.shape[1])])],
    )


def basis_of(among: Candidates, modes: np.ndarray) -> np.ndarray:
    """Orthonormal Q (p, r) of rigid-body motions, some modes and the static shapes."""
    rest = among.statics.copy()
    whole = np.linalg.norm(rest, axis=0)
    taken = np.concatenate([np.arange(among.rigid), modes])
    rest[taken] = 0.0
    rest[:, np.linalg.norm(rest, axis=0) <= _IN_MODES * whole] = 0.0
    K = 0.5 * (among.K + among.K.T)
    return np.hstack([np.eye(len(among.w))[:, taken], ritz_residuals(np.eye(len(among.w)), K, rest)])


def reduced_receptances(among: Candidates, Q: np.ndarray, probes: Probes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """H (f, m, m) in a basis, and the motions (f, r, m) of it and of its transpose."""
    s = probes.s[:, None, None]
    W = probes.speed[:, None, None]
    K = Q.T @ among.K @ Q
    G = Q.T @ among.G @ Q
    D = Q.T @ among.D @ Q
    Z = K + s * D + (s * W) * G + (s * s) * np.eye(len(K))
    B = (Q.T @ among.B).astype(complex)
    try:
        y = np.linalg.solve(Z, np.broadcast_to(B, (probes.count, *B.shape)))
        dual = np.linalg.solve(Z.transpose(0, 2, 1), np.broadcast_to(B, (probes.count, *B.shape)))
    except np.linalg.LinAlgError:
        raise ConvergenceError(
            "no reduction: the dynamic stiffness is singular at a frequency that counts; look for numbers decades apart"
        ) from None
    return B.T @ y, y, dual


def choose(
    among: Candidates,
    full: np.ndarray,
    probes: Probes,
    scale: Scale,
    tolerance: float,
    most: int,
    begin: np.ndarray | None = None,
    fixed: int | None = None,
    report: Callable[[int, float], None] = lambda n, e: None,
) -> Choice:
    """Choose modes until the receptances agree to a tolerance, or the basis has `most` shapes, or no mode is left.

    Args:
        among: the candidates.
        full: H (f, m, m) of the whole system at the probes.
        probes: speeds and frequencies.
        scale: of the contacts.
        tolerance: largest relative difference, contacts closed or apart.
        most: shapes at most.
        begin: modes to begin with.
        fixed: number of modes to choose, whatever the difference.
        report: called with the size of the basis and its error so far.
    """
    chosen = np.zeros(0, dtype=int) if begin is None else begin
    every = among.rigid + np.arange(among.modes)
    s = probes.s[:, None, None]
    W = probes.speed[:, None, None]
    K = among.K
    D = among.D
    G = among.G
    while True:
        Q = basis_of(among, chosen)
        H, y, dual = reduced_receptances(among, Q, probes)
        choice = Choice(chosen, Q, *differences(full, H, probes.s, scale))
        report(Q.shape[1], choice.error)
        left = np.setdiff1d(every, chosen)
        limit = len(left) if fixed is None else fixed - len(chosen)
        room = min(most - Q.shape[1], len(left), limit)
        if room <= 0 or (fixed is None and choice.error <= tolerance):
            return choice

        # What each mode that is left out would change: (d_j r_j) / Z_jj, contacts closed, and apart by H (1 - z H)^-1.
        r = among.B[left] - ((K[left] @ Q) @ y + s * ((D[left] @ Q) @ y) + (s * W) * ((G[left] @ Q) @ y))
        d = among.B[left] - ((K.T[left] @ Q) @ dual + s * ((D.T[left] @ Q) @ dual) + (s * W) * ((G.T[left] @ Q) @ dual))
        Z_jj = np.abs(np.diag(K)[left] + probes.s[:, None] * np.diag(D)[left] + probes.s[:, None] ** 2)
        before, after = around(H, probes.s, scale)
        closed = _share(r, d, Z_jj, H, scale)
        apart = _share(r @ after, d @ before.transpose(0, 2, 1), Z_jj, H @ after, scale)
        worth = np.maximum(closed, apart)

        # A few at a time: each one taken changes what the others are worth.
        more = min(room, max(1, int(_GROWTH * len(chosen))))
        chosen = np.sort(np.concatenate([chosen, left[np.argsort(-worth, kind="stable")[:more]]]))


def _share(r: np.ndarray, d: np.ndarray, Z_jj: np.ndarray, H: np.ndarray, scale: Scale) -> np.ndarray:
    """Largest relative change (j,) of receptances H by shapes with residuals r, d (f, j, m) and stiffness Z_jj (f, j)."""
    size, others, moved = sizes(H, scale)
    at = scale.contacts
    root = scale.root[at]
    dual = np.linalg.norm(d[:, :, at] * root, axis=2) / Z_jj
    inner = dual * np.linalg.norm(r[:, :, at] * root, axis=2) / size[:, None]
    outer = dual * (np.abs(r[:, :, others]) / moved).max(axis=2, initial=0.0)
    return np.asarray(np.maximum(inner, outer).max(axis=0))


def reduced(local: LocalSystem, among: Candidates, Q: np.ndarray) -> tuple[LocalSystem, np.ndarray]:
    """Return a system in a basis, mass 1 and stiffness without contacts diagonal, and its shapes (n, r)."""
    inner = local.forces.reference_stiffness
    free = among.rigid
    K = Q.T @ among.K @ Q - (Q.T @ among.B) @ inner @ (Q.T @ among.B).T

    # Modes of the basis without contacts; rigid-body motions are turned among none, so that they stay rigid to the last bit.
    squares = np.zeros(len(K))
    turned = np.eye(len(K))
    squares[free:], turned[free:, free:] = la.eigh(0.5 * (K + K.T)[free:, free:])
    T = Q @ turned
    V = among.vectors @ T
    skew = turned.T @ (0.5 * (K - K.T)) @ turned
    stiff = np.diag(np.where(np.abs(squares) > _NOISE * np.abs(squares).max(initial=0.0), squares, 0.0)) + skew
    B = T.T @ among.B
    D = T.T @ among.D @ T - B @ local.forces.reference_damping @ B.T
    in_basis = LocalSystem(
        M=sp.csc_array(np.eye(V.shape[1])),
        D=sp.csc_array(D),
        K=sp.csc_array(stiff),
        B=sp.csc_array(B),
        forces=local.forces,
        load=V.T @ local.load,
        rotation=local.rotation,
        G=None if local.G is None else sp.csc_array(T.T @ among.G @ T),
        watched=V.T @ local.watched_vectors,
        sisters=local.sisters,
        seen_sisters=local.seen_sisters,
    )
    return in_basis, V
