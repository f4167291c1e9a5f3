"""Floquet multipliers of a periodic motion in complex modes, from the tangents of the laws along it.

    delta u = [k - K(t), c - C(t)] [delta d; delta d'] moves the modes,   z' = s z + Y_f B delta u

Over each of N steps the tangents are their mean, delta u is linear and the modes are exact: second order in the step, also
where tangents jump within it, because the mean knows the place of the jump. Multipliers are eigenvalues of the map over a period.
Seydel, Practical Bifurcation and Stability Analysis
(Springer 2010), ch. 7; Hochbruck and Ostermann, Acta Numerica 19 (2010) 209.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.solvers.periodic.plant import Plant
from rotorgear.solvers.periodic.samples import Samples, answered
from rotorgear.solvers.periodic.switches import Switches
from rotorgear.solvers.time.contact_equilibrium import FAR, held_and_unheld
from rotorgear.solvers.time.exponential import phi_functions

# Instants whose tangents make the mean of a step.
FINER = 4
# Systems up to this size keep all modes; larger ones those below some multiple of what excites, and static shapes.
_ALL = 60
_LEAST = 24
# Share of a vector left without the motions R that is rounding.
_ROUNDING = 1e-6
# Share of all velocity terms below which those on free motions are rounding.
_BRAKED = 1e-9
_MOST = 120


@dataclass(frozen=True)
class ModalBasis:
    """V (n, r), M-orthonormal: elastic modes and static shapes of the local forces; `complete` where it spans all motions.

    `highest`: frequency of its highest mode in rad/s. `count`: of its elastic modes. `unheld`: of motions without strain that
    stand first, which velocity terms or laws tie to the others, while no force depends on where they are.
    """

    V: np.ndarray
    complete: bool
    highest: float
    count: int
    unheld: int = 0


def basis_of(plant: Plant, up_to: float) -> ModalBasis:
    """The modes of a plant that matter up to a frequency in rad/s."""
    M = plant.M
    K = sp.csc_array(0.5 * (plant.K + plant.K.T))
    R = plant.free
    n = M.shape[0]
    if n <= _ALL:
        w2, V = la.eigh(K.toarray(), M.toarray())
        V = _free_of(V, R, M) if R.shape[1] else V
        count = n - R.shape[1]
    else:
        from rotorgear.solvers.eigen.eigen import lowest_modes

        wanted = min(_LEAST, n)
        while True:
            found = lowest_modes(M, K, count=wanted)
            w2 = np.asarray(found.eigenvalues)
            if found.complete or w2[-1] >= up_to**2 or wanted >= min(_MOST, n):
                break
            wanted = min(2 * wanted, _MOST, n)
        V = np.asarray(found.vectors[:, found.rigid_count :])
        count = V.shape[1]
        V = _free_of(np.hstack([V, plant.static.X]), R, M)
    highest = float(np.sqrt(max(w2[-1], 0.0)))
    complete = n <= _ALL
    if not R.shape[1] or not _tied(plant, R):
        return ModalBasis(V, complete, highest, count)
    # First those of the motions R that no law answers with a force wherever they are, then the others.
    m = plant.m
    moved = np.vstack([np.zeros((1, m)), FAR * np.eye(m), -FAR * np.eye(m)])
    F = answered(np.zeros(len(moved)), moved, np.zeros_like(moved), plant.forces, plant.speed).F
    acts = np.any(F[0] != F, axis=1)[1:].reshape(2, m).any(axis=0)
    held, unheld = held_and_unheld(plant.B.T[acts] @ R, R)
    return ModalBasis(np.hstack([unheld, held, V]), complete, highest, count, unheld.shape[1])


def _free_of(V: np.ndarray, R: np.ndarray, M: sp.csc_array) -> np.ndarray:
    """M-orthonormal vectors that span those given without the motions R."""
    V = V / _sizes(V, M)
    for _ in range(2):
        V = V - R @ (R.T @ (M @ V))
    # A vector of R leaves rounding, whose direction is arbitrary.
    size = _sizes(V, M)
    own = size > _ROUNDING
    V = V[:, own] / size[own]
    w, U = la.eigh(V.T @ (M @ V))
    kept = w > 1e-10 * w[-1]
    return np.asarray(V @ (U[:, kept] / np.sqrt(w[kept]))[:, ::-1])


def _sizes(V: np.ndarray, M: sp.csc_array) -> np.ndarray:
    return np.sqrt(np.maximum(np.einsum("ij,ij->j", V, M @ V), 1e-300))


def _tied(plant: Plant, R: np.ndarray) -> bool:
    """Whether velocity terms or local forces couple motions without strain to the others."""
    D = plant.D @ R
    own = plant.M @ R @ (R.T @ D)
    other = plant.D.T @ R
    own_other = plant.M @ R @ (R.T @ other)
    scale = abs(plant.D).max() if plant.D.nnz else 0.0
    size = np.abs(R).max(initial=0.0)
    loose = max(np.abs(D - own).max(initial=0.0), np.abs(other - own_other).max(initial=0.0)) > 1e-9 * scale * size
    # A torque that does not depend on the motion moves nothing else.
    now = answered(np.zeros(1), np.zeros((1, plant.m)), np.zeros((1, plant.m)), plant.forces, plant.speed)
    a, b = plant.forces.places
    felt = np.zeros(plant.m, bool)
    for tangent, reference in (
        (now.Kd, plant.forces.reference_stiffness),
        (now.Kv, plant.forces.reference_damping),
    ):
        np.logical_or.at(felt, b, (tangent[0] != 0.0) | (reference[a, b] != 0.0))
    seen = np.abs(plant.B.T @ R).max(axis=1, initial=0.0) * felt
    return bool(loose or seen.max(initial=0.0) > 1e-9 * np.abs(plant.B).max(initial=0.0) * size)


def multipliers(plant: Plant, basis: ModalBasis, fine: Samples, switches: Switches) -> np.ndarray:
    """Floquet multipliers, largest first, from the laws at FINER instants a step of one period.

    Those of 1 that motions have which nothing holds in their place are left out.

    Args:
        plant: at the motion's own value. basis: its modes. fine: N FINER instants.
        switches: where laws change sides between these.
    """
    moved = monodromy(plant, basis, fine, switches)[basis.unheld :, basis.unheld :]
    kept = _momenta(plant, basis, _period(fine))
    if len(kept):
        # Deviations without these momenta keep to themselves.
        Z = la.null_space(kept)
        moved = Z.T @ moved @ Z
    return sorted_by_size(la.eigvals(moved))


def _period(fine: Samples) -> float:
    return float((fine.t[1] - fine.t[0]) * len(fine.t))


def _units(K: np.ndarray, period: float) -> np.ndarray:
    """Units of displacements: in w = [unit q, q'], from the diagonal of K, an undamped structure has orthogonal eigenvectors."""
    return np.asarray(np.maximum(np.sqrt(np.maximum(np.diag(K), 0.0)), 0.01 / period))


def _momenta(plant: Plant, basis: ModalBasis, period: float) -> np.ndarray:
    """Rows (k, 2 r - unheld) on deviations: momenta of what nothing holds in its place that nothing brakes, either.

    R' (M q' + D q) never changes, for R' K = 0 and the laws do no work on R. Where R' D R = 0 its value is that of a motion at
    another speed, as of planets that go round, whose Coriolis forces tie the turn of their train to what they do outwards.
    """
    count = basis.unheld
    if not count:
        return np.zeros((0, 0))
    V = basis.V
    R = V[:, :count]
    braked = R.T @ (plant.D @ R)
    if np.abs(braked).max() > _BRAKED * np.linalg.norm(plant.D @ V):
        return np.zeros((0, 0))
    unit = _units(V.T @ (plant.K @ V), period)
    return np.hstack([(R.T @ (plant.D @ V) / unit)[:, count:], R.T @ (plant.M @ V)])


def sorted_by_size(values: np.ndarray) -> np.ndarray:
    """Largest first; of a pair the one above the real axis."""
    return np.asarray(values[np.lexsort((-values.imag, -np.round(np.abs(values), 12)))])


def monodromy(plant: Plant, basis: ModalBasis, fine: Samples, switches: Switches) -> np.ndarray:
    """The map (2 r, 2 r) of small deviations [q, q'/w0] in the basis over one period."""
    V = basis.V
    r = V.shape[1]
    m = plant.m
    K = V.T @ (plant.K @ V)
    D = V.T @ (plant.D @ V)
    B = V.T @ plant.B
    N = len(fine.t) // FINER
    period = _period(fine)
    h = period / N
    unit = _units(K, period)
    A = np.zeros((2 * r, 2 * r))
    A[:r, r:] = np.diag(unit)
    A[r:, :r] = -K / unit
    A[r:, r:] = -D
    forced = np.vstack([np.zeros((r, m)), B])
    s, X = la.eig(A)
    condition = np.linalg.cond(X, 1)
    if condition > 1e9:
        # Where eigenvectors lie too near to each other: the same by exponentials of whole matrices.
        look = np.zeros((2 * m, 2 * r))
        look[:m, :r] = B.T / unit
        look[m:, r:] = B.T
        total = np.eye(2 * r)
        for tangent in _means(plant, fine, switches):
            total = la.expm((A + forced @ (tangent @ look)) * h) @ total
        return total
    Y = np.linalg.inv(X)
    kept = s.imag >= 0.0
    weight = np.where(s[kept].imag > 0.0, 2.0, 1.0)
    s = s[kept]
    Y = Y[kept]
    shapes = X[:, kept] * weight
    e = np.exp(s * h)[:, None]
    first, second = phi_functions(s * h)
    gain = Y @ forced
    Q0 = (h * (first - second))[:, None] * gain
    Q1 = (h * second)[:, None] * gain
    rows = np.vstack([B.T @ (shapes[:r] / unit[:, None]), B.T @ shapes[r:]])
    S = _means(plant, fine, switches)
    lift = np.real(rows @ Q1)
    implicit = np.linalg.solve(np.eye(m) - S @ lift, S)
    # Real parts over imaginary ones: what pushes the modes is real, and so is what the laws see of them.
    push = np.hstack([_parts(e * Q1), _parts(Q0)])
    look = np.hstack([rows.real, -rows.imag])
    half = len(s)
    c = e.real
    d = e.imag
    z = _parts(Y)
    seen = look @ z
    u = np.zeros((m, 2 * r))
    for k in range(N):
        # z is what it was at the end of the step before, but for the rest Q1 u of that step.
        pushed = push @ np.vstack([u, S[k] @ seen])
        pushed[:half] += c * z[:half] - d * z[half:]
        pushed[half:] += d * z[:half] + c * z[half:]
        z = pushed
        free = look @ z
        u = implicit[k] @ free
        seen = free + lift @ u
    return np.asarray(np.real(shapes @ (z[:half] + 1j * z[half:] + Q1 @ u)))


def _parts(z: np.ndarray) -> np.ndarray:
    return np.vstack([z.real, z.imag])


def _means(plant: Plant, fine: Samples, switches: Switches) -> np.ndarray:
    """[k - K, c - C], its mean over each step, (N, m, 2 m): by the trapezoidal rule on its instants.

    Where a tangent jumps at theta between two of them, the rule has half of both sides in place of theta and 1 - theta.
    """
    m = plant.m
    N = len(fine.t) // FINER
    cells = np.floor(switches.phase / switches.spacing).astype(int)
    missed = (0.5 - switches.theta)[:, None]
    a, b = plant.forces.places
    S = np.zeros((N, m, 2 * m))
    for place, reference, tangent, jump in (
        (0, plant.forces.reference_stiffness, fine.Kd, switches.in_d),
        (m, plant.forces.reference_damping, fine.Kv, switches.in_v),
    ):
        values = reference[a, b] - tangent
        ends = 0.5 * (values + np.roll(values, -1, axis=0))
        np.add.at(ends, cells, missed * jump)
        S[:, a, place + b] = ends.reshape(N, FINER, -1).mean(axis=1)
    return S
