"""One step of mode tracking between two speeds a < b, from eigenvalues, left and right vectors and their derivatives.

    s' = -y^H (s D' + K') q                                  (y^H (2 s M + D) q = 1)
    c_ij = y_i^H (D_a + (s_i + s_j) M) q_j                   biorthogonal product of mode i at a and mode j at b
    MAC_ij = |c_ij(a, b) c_ji(b, a)|                         1 for the same mode, 0 for another one of the same pencil
    mismatch_ij = |s_j - s_i - (b - a)(s_i' + s_j')/2| / |s| of a cubic through both (Hermite)

Pencils are affine in the speed between a and b. Eigenvalues that coincide have their vectors turned so that the derivative
is diagonal: that is how they part. Two branches whose frequencies change places may cross or veer. To first order the gap between
them is 2 (b - a) |c'_ij c'_ji|^1/2 with the off-diagonal derivative c'; where it is not zero the step has to be halved.
Fox and Kapoor, AIAA J. 6 (1968) 2426; Lancaster, Numer. Math. 6 (1964) 377 (derivatives); MAC with left vectors as in
Bucher and Braun, Mech. Syst. Signal Process. 11 (1997).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.solvers.eigen.one_to_one import least_cost
from rotorgear.solvers.eigen.reduced_pencil import Eigen, Pencil, clusters

AMBIGUOUS = 0.3  # best cost over second best, above which a step is too long
MISMATCH = 5e-3  # relative mismatch of the cubic above which a step is too long
_WORST = 0.7  # cost above which two modes are not the same one
_SAME = 1e-7  # derivatives, relative to |s| over the step, that count as equal


def step(a: Eigen, b: Eigen, length: float, narrowest: float) -> tuple[np.ndarray, np.ndarray]:
    """Link the modes at a to those at b.

    Args:
        a: eigenpairs at the beginning of the step.
        b: eigenpairs at its end, of a pencil in the same coordinates.
        length: b - a in rad/s; it may be negative.
        narrowest: a veering that is narrower in speed than this, in rad/s, is a crossing.

    Returns:
        The number at b of each mode at a, (m_a,), -1 where it has none; and whether its link makes the step too long, (m_a,).
    """
    if not len(a.s) or not len(b.s):
        return np.full(len(a.s), -1), np.zeros(len(a.s), bool)
    slope = Pencil(0.0 * a.pencil.M, (b.pencil.D - a.pencil.D) / length, (b.pencil.K - a.pencil.K) / length)
    a, rate_a = parted(a, slope)
    b, rate_b = parted(b, slope)

    def product(one: Eigen, other: Eigen) -> np.ndarray:
        """c_ij (m_a, m_b)."""
        damping = one.y.conj().T @ (one.pencil.D @ other.q)
        return np.asarray(damping + (one.s[:, None] + other.s) * (one.y.conj().T @ (one.pencil.M @ other.q)))

    # The vectors of twins are arbitrary: the MAC of a mode is summed over its twins, and no twin counts as the second best.
    mac = product(a, b) * product(b, a).T
    twins_a = _twins(a.s, rate_a, length)
    twins_b = _twins(b.s, rate_b, length)
    mac = np.clip(np.abs(twins_a @ mac @ twins_b) / np.maximum(twins_a.sum(1)[:, None], 1.0), 0.0, 1.0)

    # Cost of a link: 1 - MAC, and a tenth of how many times the mismatch is above what makes a step too long.
    size = 0.5 * (np.abs(a.s)[:, None] + np.abs(b.s))
    mismatch = np.abs(b.s - a.s[:, None] - 0.5 * length * (rate_a[:, None] + rate_b)) / size
    cost = (1.0 - mac) + np.minimum(mismatch / MISMATCH, 10.0) * 0.1
    rows, columns = least_cost(cost)
    partner = np.full(len(a.s), -1)
    partner[rows] = columns

    # Doubt where a link is not clearly better than the second best of its mode at either end, or does not follow its derivatives.
    others_b = np.where(twins_b[columns] > 0.0, np.inf, cost[rows])
    others_a = np.where(twins_a[rows] > 0.0, np.inf, cost[:, columns].T)
    second = np.minimum(others_b.min(axis=1), others_a.min(axis=1))
    doubt = np.zeros(len(a.s), bool)
    doubt[rows] = (cost[rows, columns] > AMBIGUOUS * second) | (mismatch[rows, columns] > MISMATCH)
    # Modes change places with others that act on them: too coarse a step to tell a veering from a crossing.
    linked = np.flatnonzero(partner >= 0)
    before = a.s[linked].imag
    after = b.s[partner[linked]].imag
    swapped = (before[:, None] - before) * (after[:, None] - after) < 0.0
    for i, j in linked[np.argwhere(np.triu(swapped))]:
        if max(_width(a, rate_a, slope, i, j), _width(b, rate_b, slope, partner[i], partner[j])) > narrowest:
            doubt[[i, j]] = True
    partner[rows[(1.0 - mac[rows, columns]) > _WORST]] = -1
    return partner, doubt


def parted(at: Eigen, slope: Pencil) -> tuple[Eigen, np.ndarray]:
    """Eigenpairs with the vectors of equal eigenvalues turned to the directions in which they part; derivatives (m,)."""
    q = at.q
    y = at.y
    for equal in clusters(at.s):
        if len(equal) < 2:
            continue
        s = np.mean(at.s[equal])
        W = np.linalg.eig(-(y[:, equal].conj().T @ ((s * slope.D + slope.K) @ q[:, equal])))[1]
        if np.linalg.cond(W) < 1e6:  # a defective derivative has no such directions; the vectors stay as they are
            q = q.copy()
            y = y.copy()
            q[:, equal] = q[:, equal] @ W
            y[:, equal] = y[:, equal] @ np.linalg.inv(W).conj().T
    rate = -np.einsum("ri,ri->i", y.conj(), slope.D @ q * at.s + slope.K @ q)
    return replace(at, q=q, y=y), rate


def _twins(s: np.ndarray, rate: np.ndarray, length: float) -> np.ndarray:
    """(m, m) of 0 and 1: which modes are equal in eigenvalue and derivative, so that any combination of them is a mode."""
    size = np.abs(s)[:, None] + np.abs(s)
    same = np.abs(s[:, None] - s) <= _SAME * size
    return np.asarray((same & (np.abs(rate[:, None] - rate) * abs(length) <= _SAME * size)).astype(float))


def _width(at: Eigen, rate: np.ndarray, slope: Pencil, i: int, j: int) -> float:
    """Speed range in rad/s of the veering of two modes: gap over difference of slopes."""
    s = 0.5 * (at.s[i] + at.s[j])
    Z = s * slope.D + slope.K
    coupling = (at.y[:, i].conj() @ (Z @ at.q[:, j])) * (at.y[:, j].conj() @ (Z @ at.q[:, i]))
    closing = abs(rate[i].imag - rate[j].imag)
    if closing == 0.0:
        return 0.0
    return float(2.0 * (abs(at.s[i].imag - at.s[j].imag) / closing) * np.sqrt(abs(coupling)) / closing)
