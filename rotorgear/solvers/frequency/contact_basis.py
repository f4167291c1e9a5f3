"""A basis of few shapes in which contacts move as in the whole structure: chosen modes, and static shapes of loads and contacts.

Candidates are the lowest modes with all contacts closed and the residual attachment vectors of all columns. Of the modes those
are kept, a few at a time, that change the receptances at the contacts most. By the residual of the present basis a mode j that
is left out changes H by about

    (d_j r_j) / Z_jj,   r = B - Z V y,  d the same for Z^T

which sees couplings by gyroscopic terms and dampers too. The attachment vectors of contacts and loads stay in the basis, so the
static state is exact, whichever contacts touch. Craig and Kurdila, Fundamentals of Structural Dynamics, 2nd ed., section 17.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.solvers.frequency.receptance import Probes, Scale, around, differences, sizes
from rotorgear.solvers.sparse.nullspace import SupportedSolver, left_null_space
from rotorgear.solvers.sparse.residual_vectors import ritz_residuals
from rotorgear.solvers.time.local_system import LocalSystem

# Shapes of which modes leave over less than this are in them.
_IN_MODES = 1e-8
# Share of the modes that are kept so far by which they grow at a time.
_GROWTH = 0.06
_NOISE = 1e3 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Candidates:
    """p M-orthonormal shapes of n dofs, and the system in them; contacts closed in K and D.

    Attributes:
        vectors: (n, p), rigid motions first, then modes, then attachment vectors.
        rigid, modes: how many of each. w: (p,) rad/s.
        K, D, G: (p, p). B: (p, m). statics: (p, a) static shapes under contact forces and loads.
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
    """Modes that are kept (numbers among the candidates), the basis Q (p, r) in the candidates, and how far receptances are off.

    `closed`, `apart`: largest relative differences, see solvers/frequency/receptance.py.
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
        local: the system. loads: (n, l), and acting: columns (a,), that attachment vectors are kept of. count: modes.
    """
    M = local.M
    K = local.stiffness_about
    found = lowest_modes(M, sp.csc_array(0.5 * (K + K.T)), count=min(count, local.n))
    V = found.vectors
    rigid = found.rigid_count
    R = V[:, :rigid]
    solver = SupportedSolver(K, R * np.sqrt(np.maximum(K.diagonal(), 1e-300))[:, None], left_null_space(K, M, R))
    B = local.B.toarray()
    forces = np.hstack([B, loads])
    X = solver.solve(forces - M @ (R @ (R.T @ forces)))
    rest = _without(M, V, X)
    whole = np.sqrt(np.einsum("ij,ij->j", X, M @ X))
    rest[:, np.sqrt(np.einsum("ij,ij->j", rest, M @ rest)) <= _IN_MODES * whole] = 0.0
    E = np.hstack([V, ritz_residuals(M, sp.csc_array(0.5 * (K + K.T)), rest)])
    Ke = E.T @ (K @ E)
    Be = E.T @ B
    strained = np.diag(local.forces.reference_stiffness) > 0.0
    Ke[:rigid] = 0.0
    Ke[:, :rigid] = 0.0
    Be[:rigid, strained] = 0.0
    size = E.shape[1]
    G = np.zeros((size, size)) if local.G is None else E.T @ (local.G @ E)
    statics = np.zeros((size, forces.shape[1]))
    statics[rigid:] = np.linalg.solve(Ke[rigid:, rigid:], (E.T @ forces)[rigid:])
    kept = np.concatenate([acting, B.shape[1] + np.arange(loads.shape[1])])
    return Candidates(
        E,
        rigid,
        V.shape[1] - rigid,
        np.sqrt(np.maximum(np.diag(Ke), 0.0)),
        Ke,
        E.T @ (local.damping_about @ E),
        G,
        Be,
        statics[:, kept],
    )


def _without(M: sp.csc_array, V: np.ndarray, X: np.ndarray) -> np.ndarray:
    """X made M-orthogonal to the M-orthonormal V, twice for the rounding."""
    for _ in range(2):
        X = X - V @ (V.T @ (M @ X))
    return X


def basis_of(among: Candidates, modes: np.ndarray) -> np.ndarray:
    """Orthonormal Q (p, r) of rigid motions, some modes and the static shapes."""
    rest = among.statics.copy()
    whole = np.linalg.norm(rest, axis=0)
    own = np.concatenate([np.arange(among.rigid), modes])
    rest[own] = 0.0
    rest[:, np.linalg.norm(rest, axis=0) <= _IN_MODES * whole] = 0.0
    K = 0.5 * (among.K + among.K.T)
    return np.hstack([np.eye(len(among.w))[:, own], ritz_residuals(np.eye(len(among.w)), K, rest)])


def reduced_receptances(among: Candidates, Q: np.ndarray, probes: Probes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """H (f, m, m) in a basis, and the motions (f, r, m) of it and of its transpose."""
    Z = _dynamic(Q.T @ among.K @ Q, Q.T @ among.D @ Q, Q.T @ among.G @ Q, probes)
    B = (Q.T @ among.B).astype(complex)
    y = np.linalg.solve(Z, np.broadcast_to(B, (probes.count, *B.shape)))
    dual = np.linalg.solve(Z.transpose(0, 2, 1), np.broadcast_to(B, (probes.count, *B.shape)))
    return B.T @ y, y, dual


def _dynamic(K: np.ndarray, D: np.ndarray, G: np.ndarray, probes: Probes) -> np.ndarray:
    s = probes.s[:, None, None]
    W = probes.speed[:, None, None]
    return np.asarray(K + s * D + (s * W) * G + (s * s) * np.eye(len(K)))


def choose(
    among: Candidates,
    full: np.ndarray,
    probes: Probes,
    scale: Scale,
    tolerance: float,
    most: int,
    begin: np.ndarray | None = None,
    fixed: int | None = None,
    heard: Callable[[int, float], None] = lambda n, e: None,
) -> Choice:
    """Choose modes until the receptances agree to a tolerance, or the basis has `most` shapes, or no mode is left.

    Args:
        among: the candidates. full: H (f, m, m) of the whole system at the probes. scale: of its contacts.
        tolerance: largest relative difference, contacts closed or apart.
        begin: modes to begin with. fixed: so many modes, whatever the difference.
        heard: is told the size and the error so far.
    """
    chosen = np.zeros(0, dtype=int) if begin is None else begin
    every = among.rigid + np.arange(among.modes)
    while True:
        Q = basis_of(among, chosen)
        H, y, dual = reduced_receptances(among, Q, probes)
        found = Choice(chosen, Q, *differences(full, H, probes.s, scale))
        heard(Q.shape[1], found.error)
        left = np.setdiff1d(every, chosen)
        limit = len(left) if fixed is None else fixed - len(chosen)
        room = min(most - Q.shape[1], len(left), limit)
        if room <= 0 or (fixed is None and found.error <= tolerance):
            return found
        worth = _worth(among, Q, H, y, dual, probes, scale, left)
        more = min(room, max(1, int(_GROWTH * len(chosen))))
        chosen = np.sort(np.concatenate([chosen, left[np.argsort(-worth, kind="stable")[:more]]]))


def _worth(
    among: Candidates,
    Q: np.ndarray,
    H: np.ndarray,
    y: np.ndarray,
    dual: np.ndarray,
    probes: Probes,
    scale: Scale,
    left: np.ndarray,
) -> np.ndarray:
    """About how much each mode that is left out changes the receptances, (j,)."""
    s = probes.s[:, None, None]
    W = probes.speed[:, None, None]
    K = among.K
    D = among.D
    G = among.G
    r = among.B[left] - ((K[left] @ Q) @ y + s * ((D[left] @ Q) @ y) + (s * W) * ((G[left] @ Q) @ y))
    d = among.B[left] - ((K.T[left] @ Q) @ dual + s * ((D.T[left] @ Q) @ dual) + (s * W) * ((G.T[left] @ Q) @ dual))
    own = np.abs(np.diag(K)[left] + probes.s[:, None] * np.diag(D)[left] + probes.s[:, None] ** 2)
    before, after = around(H, probes.s, scale)
    closed = _share(r, d, own, H, scale)
    apart = _share(r @ after, d @ before.transpose(0, 2, 1), own, H @ after, scale)
    return np.maximum(closed, apart)


def _share(r: np.ndarray, d: np.ndarray, own: np.ndarray, H: np.ndarray, scale: Scale) -> np.ndarray:
    """Largest relative change (j,) of receptances H by shapes with residuals r, d (f, j, m) and stiffness `own` (f, j)."""
    size, moved = sizes(H, scale)
    at = scale.contacts
    root = scale.root[scale.contacts]
    dual = np.linalg.norm(d[:, :, at] * root, axis=2) / own
    inner = dual * np.linalg.norm(r[:, :, at] * root, axis=2) / size[:, None]
    others = np.flatnonzero((scale.root == 0.0) & (moved > 0.0))
    outer = dual * (np.abs(r[:, :, others]) / moved[others]).max(axis=2, initial=0.0)
    return np.asarray(np.maximum(inner, outer).max(axis=0))


def reduced(local: LocalSystem, among: Candidates, Q: np.ndarray) -> tuple[LocalSystem, np.ndarray]:
    """Return a system in a basis, mass 1 and stiffness without contacts diagonal, and its shapes (n, r)."""
    inner = local.forces.reference_stiffness
    free = among.rigid
    K = Q.T @ among.K @ Q - (Q.T @ among.B) @ inner @ (Q.T @ among.B).T
    squares = np.zeros(len(K))
    turned = np.eye(len(K))
    squares[free:], turned[free:, free:] = la.eigh(0.5 * (K + K.T)[free:, free:])
    T = Q @ turned
    V = among.vectors @ T
    skew = turned.T @ (0.5 * (K - K.T)) @ turned
    stiff = np.diag(np.where(np.abs(squares) > _NOISE * np.abs(squares).max(initial=0.0), squares, 0.0)) + skew
    B = T.T @ among.B
    D = T.T @ among.D @ T - B @ local.forces.reference_damping @ B.T
    own = LocalSystem(
        M=sp.csc_array(np.eye(V.shape[1])),
        D=sp.csc_array(D),
        K=sp.csc_array(stiff),
        B=sp.csc_array(B),
        forces=local.forces,
        load=V.T @ local.load,
        rotation=local.rotation,
        G=None if local.G is None else sp.csc_array(T.T @ among.G @ T),
    )
    return own, V
