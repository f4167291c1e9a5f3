"""Derivatives of natural frequencies and shapes of a rotating gearbox with respect to free numbers of a model.

With Q(w) = K + i w W G - w^2 M, Q phi = 0 and no damping (Lancaster 1964, On eigenvalues of matrices dependent on a parameter,
Numerische Mathematik 6; Nelson 1976 for the shape):

    dw/dx = phi^H Q' phi / phi^H (2 w M - i W G) phi,    [Q  B; C^H 0] [phi'; .] = [-Q' phi; 0],

with B = (2 w M - i W G) Phi and C = M Phi of all modes at one frequency. What phi' has along them is scale, phase or a turn among
themselves, which no rig sees.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.rig.sensitivity import EQUAL, STEP, beside, energies, group_energies, solved, springs_of
from rotorgear.model.numbers import FreeNumbers
from rotorgear.system.assembly import assemble
from rotorgear.system.plan import Plan
from rotorgear.system.system import System


@dataclass(frozen=True)
class RotatingChanges:
    """What one free number changes at fixed shapes, per unit of x = ln p.

    Attributes:
        form: phi^H Q' phi (m,).
        times: Q' phi (n, m); None where shapes were not asked for.
    """

    form: NDArray[np.float64]
    times: NDArray[np.complex128] | None


def rotating_changes(
    numbers: FreeNumbers,
    x: NDArray[np.float64],
    system: System,
    plan: Plan,
    speed: float,
    omega: NDArray[np.float64],
    X: NDArray[np.complex128],
    *,
    shapes: bool,
) -> list[RotatingChanges]:
    """Return what each number changes about x (p,), at shapes X (n, m) with frequencies `omega` (m,) in rad/s.

    Raises:
        AnalysisError: a number that moves a place away from another one that it coincides with.
    """
    found = []
    springs = springs_of(numbers.model, system, speed)
    for j, address in enumerate(numbers.addresses):
        part, _, name = address.rpartition(".")
        if name == "stiffness" and part in springs:
            groups = springs[part]
            form = sum(group_energies(groups, system.dofs.expand(part_))[0] for part_ in (X.real, X.imag))
            K = assemble(groups, system.dofs, lambda group: group.matrices.stiffness) if shapes else None
            found.append(RotatingChanges(np.asarray(form), None if K is None else K @ X))
            continue
        above, below = beside(numbers, x, j, system, plan, speed)
        found.append(_by_difference(above, below, speed, omega, X, shapes))
    return found


def _by_difference(
    above: System, below: System, speed: float, omega: NDArray[np.float64], X: NDArray[np.complex128], shapes: bool
) -> RotatingChanges:
    real = [a - b for a, b in zip(energies(above, X.real, speed), energies(below, X.real, speed), strict=True)]
    imag = [a - b for a, b in zip(energies(above, X.imag, speed), energies(below, X.imag, speed), strict=True)]
    G = above.gyroscopic - below.gyroscopic
    # i phi^H G phi = -2 a^T G b of phi = a + i b.
    swept = -2.0 * np.sum(X.real * (G @ X.imag), axis=0)
    form = real[0] + imag[0] + omega * speed * swept - omega**2 * (real[1] + imag[1])
    if not shapes:
        return RotatingChanges(form / (2.0 * STEP), None)
    K = above.stiffness(speed) - below.stiffness(speed)
    M = above.mass - below.mass
    times = K @ X + 1j * speed * (G @ X) * omega - (M @ X) * omega**2
    return RotatingChanges(form / (2.0 * STEP), times / (2.0 * STEP))


def rotating_slopes(
    system: System,
    speed: float,
    changes: list[RotatingChanges],
    omega: NDArray[np.float64],
    X: NDArray[np.complex128],
) -> NDArray[np.float64]:
    """Return d ln f / dx (m, p)."""
    size = 2.0 * omega * np.real(np.sum(X.conj() * (system.mass @ X), axis=0))
    size -= speed * np.real(1j * np.sum(X.conj() * (system.gyroscopic @ X), axis=0))
    return np.array([change.form / (size * omega) for change in changes]).T.reshape(len(omega), len(changes))


def rotating_shape_slopes(
    system: System,
    speed: float,
    changes: list[RotatingChanges],
    omega: NDArray[np.float64],
    vectors: NDArray[np.complex128],
    chosen: NDArray[np.intp],
) -> NDArray[np.complex128]:
    """Return d phi / dx (n, k, p), outside their own space, of k chosen ones of the modes `vectors` (n, m), at `omega` (m,)."""
    K = system.stiffness(speed)
    M = system.mass
    G = speed * system.gyroscopic
    n = len(vectors)
    found = np.zeros((n, len(chosen), len(changes)), dtype=complex)
    for i, mode in enumerate(chosen):
        w = omega[mode]
        own = vectors[:, np.abs(omega - w) <= 0.5 * EQUAL * w]
        Q = sp.csc_array(K + 1j * w * G - w**2 * M)
        B = sp.csc_array(2.0 * w * (M @ own) - 1j * (G @ own))
        C = sp.csc_array((M @ own).conj().T)
        right = np.zeros((n + own.shape[1], len(changes)), dtype=complex)
        for j, change in enumerate(changes):
            assert change.times is not None
            right[:n, j] = -change.times[:, i]
        found[:, i] = solved(sp.csc_array(sp.block_array([[Q, B], [C, None]])), right)[:n]
    return found
