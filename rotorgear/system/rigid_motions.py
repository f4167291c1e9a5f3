"""Motions of a system that strain nothing, from its geometry: what is left to move in statics.

Between its nodes a shaft is free of strain in its six rigid-body motions only. So the null space of the stiffness lies in the
span of these motions of every shaft (and of single pedestals), where it is small, and it does not depend on how many
decades the stiffnesses span.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import scipy.linalg as la

from rotorgear.elements.spring import rigid_transfer
from rotorgear.system.groups import ElementGroup
from rotorgear.system.system import System

# Strains below this share of the largest one that a motion of this size could make count as none.
_ZERO = 1e-9


def rigid_motions(system: System, groups: Iterable[ElementGroup]) -> np.ndarray:
    """Return R (n, r), a basis of the motions of the free dofs that strain none of the element groups."""
    P = _candidates(system)
    T = system.dofs.transform
    # What of the candidates the free dofs can't follow must vanish: (I - T T+) P, each row scaled to its largest entry.
    off_range = P[system.dofs.column < 0] if system.dofs.selects else P - T.toarray() @ la.lstsq(T.toarray(), P)[0]
    largest = np.abs(off_range).max(axis=1)
    held = largest > 1e-12
    rows = [off_range[held] / largest[held, None]]
    for group in groups:
        B = group.matrices.strain
        D = group.matrices.modulus
        if B is None or D is None:
            continue
        Z = group.matrices.circulation
        used = np.any(D != 0.0, axis=2) if Z is None else np.any((D != 0.0) | (Z != 0.0), axis=2)
        strains = np.einsum("esd,edp->esp", B, P[group.dofs])
        sizes = np.einsum("esd,edp->esp", np.abs(B), np.abs(P[group.dofs])).max(axis=2)
        rows.append((strains / np.where(sizes > 0.0, sizes, 1.0)[:, :, None])[used])
    A = np.vstack(rows)
    # The triangle of a tall matrix has its null space, without a square of its rows.
    A = np.asarray(np.linalg.qr(A, mode="r")) if A.shape[0] > A.shape[1] else A
    null = la.null_space(A, rcond=_ZERO) if A.shape[0] else np.eye(P.shape[1])
    motions = P @ null
    if not motions.shape[1]:  # LAPACK refuses a least-squares problem without a right-hand side
        return np.zeros((system.n, 0))
    free = motions[system.dofs.column >= 0] if system.dofs.selects else la.lstsq(T.toarray(), motions)[0]
    # Candidates may move held dofs only; what is left of the basis is orthonormal again.
    u, s, _ = la.svd(free, full_matrices=False) if free.size else (free, np.zeros(0), None)
    return np.asarray(u[:, s > _ZERO])


def _candidates(system: System) -> np.ndarray:
    """Six motions of each shaft about its middle, rotations scaled to its length, three of each pedestal, six of each casing."""
    nodes = system.nodes
    columns = []
    for name, shaft in system.model.shafts.items():
        numbers = [k for k in nodes.on_shaft(name) if not nodes.pedestal[k]]
        block = np.zeros((system.dofs.transform.shape[0], 6))
        middle = shaft.start + 0.5 * shaft.length
        for k in numbers:
            block[6 * k : 6 * k + 6] = rigid_transfer(np.array([0.0, 0.0, nodes.z[k] - middle]))
        for (gear, _), number in nodes.teeth.items():
            if system.layout.gear(gear).shaft == name:
                block[6 * len(nodes) + number, 5] = 1.0  # elastic gears turn with their shaft
        for (_, gear), number in nodes.feet.items():
            place = system.layout.place(f"gears.{gear}")
            if place.shaft == name:
                foot = 6 * len(nodes) + number
                block[foot : foot + 6] = rigid_transfer(np.array([0.0, 0.0, place.z - middle]))
        block[:, 3:] /= max(shaft.length, 1e-3)
        columns.append(block)
    for k, bearing in enumerate(nodes.pedestal):
        if bearing:
            block = np.zeros((system.dofs.transform.shape[0], 3))
            block[[6 * k, 6 * k + 1, 6 * k + 2], [0, 1, 2]] = 1.0
            columns.append(block)
    for name in system.model.casings:
        block = np.zeros((system.dofs.transform.shape[0], 6))
        block[nodes.of_casing(name)] = system.layout.casing(name).seat_motions
        columns.append(block)
    return np.hstack(columns)
