"""A basis in which a model and all its neighbours within the scatter have their modes, and what it is off.

Modes of the nominal model; and what scattering numbers add to them: to first order phi' = (K - w^2 M)^-1 (-(K' - w^2 M') phi),
so that for all numbers and modes together the leading directions of K_s^-1 (K_j' - w_i^2 M_j') phi_i s_j are taken, with
K_s = K + w_s^2 M.
The error is not estimated within the basis: samples far out are followed to eigenpairs of the whole system by inverse iteration.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.scatter.family import Family, sampled_system
from rotorgear.analysis.scatter.modes import FormModes
from rotorgear.model.spreads import Spreads
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# A change of one standard deviation is looked at on both sides.
_SIDE = 1.0
# Directions that carry less than this share of the largest are left out, and never more than so many are taken.
_LEAST = 1e-5
_MOST = 80
# What is left of a shape beside the others below this share is rounding.
_SAME = 1e-7
_STEPS = 6
# Free motions of one body.
_OF_A_BODY = 6
_CONVERGED = 1e-11


def nominal_modes(
    system: System, speed: float | None, count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], int]:
    """w^2 (m,), shapes (n, m) of modal mass 1 of the undamped system that does not rotate, and how many are rigid.

    They are `count`, or more where bodies beside each other have more free motions than one.
    """
    strain = system.strain_factor(speed or 0.0)
    asked = count
    found = lowest_modes(system.mass, system.stiffness(speed or 0.0), count=asked, strain=strain)
    while not found.complete and len(found.eigenvalues) - found.rigid_count < count - _OF_A_BODY:
        asked = 2 * asked
        found = lowest_modes(system.mass, system.stiffness(speed or 0.0), count=asked, strain=strain)
    return found.eigenvalues, found.vectors, found.rigid_count


def basis_of(
    spreads: Spreads,
    speed: float | None,
    plan: Plan,
    system: System,
    values: NDArray[np.float64],
    X: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The basis (n, r) with nominal modes w^2 (m,), X (n, m) first, orthonormal in M."""
    pushed = []
    for j in range(len(spreads)):
        z = np.zeros(len(spreads))
        z[j] = _SIDE
        above = sampled_system(spreads, z, speed, plan)
        below = sampled_system(spreads, -z, speed, plan)
        for other, sign in ((above, 1.0), (below, -1.0)):
            if other.n == system.n:
                K = other.stiffness(speed or 0.0) - system.stiffness(speed or 0.0)
                M = other.mass - system.mass
                pushed.append(sign * (K @ X - (M @ X) * values))
    if speed:
        pushed.append(speed * (system.gyroscopic @ X) * np.sqrt(np.maximum(values, 0.0)))
    if not pushed:
        return X
    shift = float(np.median(values[values > 0.0])) if np.any(values > 0.0) else 1.0
    shifted = sp.csc_array(system.stiffness(speed or 0.0) + shift * system.mass)
    from scipy.sparse.linalg import splu

    answers = splu(shifted).solve(np.hstack(pushed) / np.tile(values + shift, len(pushed)))
    whole = np.linalg.norm(answers, axis=0)
    answers -= X @ (X.T @ (system.mass @ answers))
    # In a model of few dofs its modes hold everything: what is left is rounding.
    answers[:, np.linalg.norm(answers, axis=0) <= _SAME * whole] = 0.0
    if not answers.any():
        return X
    # Leading directions in the energy of the shifted system; what is left is the part that a mode hardly takes.
    gram = answers.T @ (shifted @ answers)
    energy, turned = la.eigh(0.5 * (gram + gram.T))
    kept = np.flatnonzero(energy > _LEAST**2 * max(float(energy[-1]), 1e-300))[-_MOST:]
    return with_shapes(system.mass, X, answers @ (turned[:, kept] / np.sqrt(energy[kept])))


def with_shapes(M: sp.csc_array, V: NDArray[np.float64], more: NDArray[np.float64]) -> NDArray[np.float64]:
    """V (n, r) with further shapes, all orthonormal in M; what V has already falls away."""

    def sizes(X: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.sqrt(np.maximum(np.einsum("ij,ij->j", X, M @ X), 0.0))

    before = sizes(more)
    for _ in range(2):
        more = more - V @ (V.T @ (M @ more))
    after = sizes(more)
    fresh = after > _SAME * before
    more = more[:, fresh] / after[fresh]
    if not more.shape[1]:
        return V
    values, turned = la.eigh(more.T @ (M @ more))
    kept = values > 1e-10 * values[-1]
    more = more @ (turned[:, kept] / np.sqrt(values[kept]))
    return np.hstack([V, more - V @ (V.T @ (M @ more))])


def whole_modes(
    family: Family, z: NDArray[np.float64], modes: FormModes
) -> tuple[NDArray[np.float64], NDArray[np.complex128]]:
    """Frequencies (m,) and shapes (n, m) of the whole system at z that the modes of the basis lead to."""
    system = family.system(z)
    speed = family.speed or 0.0
    K = system.stiffness(speed)
    M = system.mass
    W = speed * system.gyroscopic
    X = family.V @ modes.q
    omega = np.array(modes.omega)
    shapes = np.array(X, dtype=complex)
    for i in range(len(omega)):
        omega[i], shapes[:, i] = _inverse_iteration(K, M, W, float(omega[i]), shapes[:, i])
    return omega, shapes


def _inverse_iteration(
    K: sp.csc_array, M: sp.csc_array, W: sp.csc_array, omega: float, q: NDArray[np.complex128]
) -> tuple[float, NDArray[np.complex128]]:
    """The eigenpair of K + s W + s^2 M next to s = i w and q, by Newton's method on both."""
    from scipy.sparse.linalg import splu

    s = 1j * omega
    for _ in range(_STEPS):
        right = W @ q + 2.0 * s * (M @ q)
        try:
            u = splu(sp.csc_array(K + s * W + s**2 * M)).solve(right)
        except RuntimeError:  # exactly singular: s is an eigenvalue
            break
        Mq = M @ q
        change = complex(np.vdot(q, Mq) / np.vdot(Mq, u))
        s = s - change
        q = u / np.sqrt(abs(np.vdot(u, M @ u)))
        if abs(change) <= _CONVERGED * abs(s):
            break
    return float(s.imag), q
