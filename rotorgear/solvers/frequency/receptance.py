"""Receptances of a local system at its local displacements, H = B^T Z(s)^-1 B, full or in a basis, contacts closed or apart.

    Z(s) = K + B k B^T + s (D + W G + B c B^T) + s^2 M      closed, with the reference stiffness k and damping c of the laws
    H_apart = H (1 - (k + s c) H)^-1                        all of them apart

Two of them are compared in units of the contacts' own compliance: 1 is the motion that a force makes in a contact itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.sparse.factor import factor_general, single_thread
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


def sizes(H: np.ndarray, scale: Scale) -> tuple[np.ndarray, np.ndarray]:
    """What differences are measured by: between contacts (f,), and of other columns (m,), 0 where they move no contact."""
    at = scale.contacts
    root = scale.root
    inner = H[:, at][:, :, at] * root[at][:, None] * root[at]
    between = np.maximum(np.linalg.norm(inner, ord=2, axis=(1, 2)), 1.0) if at.size else np.ones(len(H))
    moved = np.linalg.norm(root[at][:, None] * H[:, at], axis=1).max(axis=0, initial=0.0)
    most = np.sqrt(np.abs(np.einsum("fii->fi", H)).max(axis=0, initial=0.0))
    return between, np.where(moved > _NOTHING * most, moved, 0.0)


def difference(H: np.ndarray, other: np.ndarray, scale: Scale) -> float:
    """Largest relative difference of other receptances (f, m, m) from H.

    Between contacts: relative to |H| or the contacts' own compliance, the larger; of what prescribed forces do at contacts:
    relative to the most that each does over all probes.
    """
    between, moved = sizes(H, scale)
    at = scale.contacts
    root = scale.root
    apart = root[at][:, None] * (other - H)[:, at]
    inner = np.linalg.norm(apart[:, :, at] * root[at], ord=2, axis=(1, 2)) / between if at.size else np.zeros(1)
    others = np.flatnonzero((scale.root == 0.0) & (moved > 0.0))
    outer = np.linalg.norm(apart[:, :, others], axis=1) / moved[others]
    return float(max(inner.max(initial=0.0), outer.max(initial=0.0)))


def differences(H: np.ndarray, other: np.ndarray, s: np.ndarray, scale: Scale) -> tuple[float, float]:
    """`difference` with contacts closed and with all of them apart."""
    closed = difference(H, other, scale)
    return closed, difference(H @ around(H, s, scale)[1], other @ around(other, s, scale)[1], scale)
