"""Motions of a system that strain nothing, from its geometry: what is left to move in statics.

Between its nodes a shaft is free of strain in its six rigid-body motions only. So the null space of the stiffness lies in the
span of these motions of every shaft (and of single pedestals), where it is small, and it does not depend on how many
decades the stiffnesses span. Bodies are solved by themselves, then parts that something joins: a train of two hundred shafts in
their bearings is one problem of as many torsions, and a thousand loose shafts are a thousand small problems.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from rotorgear.elements.spring import rigid_transfer
from rotorgear.solvers.sparse.nullspace import by_label
from rotorgear.system.groups import ElementGroup
from rotorgear.system.system import System

# Strains below this share of the largest one that a motion of this size could make count as none.
_ZERO = 1e-9


# Elements that can strain: B (e, s, d), which of the strains meet a stiffness (e, s), and their dofs (e, d).
Strained = tuple[np.ndarray, np.ndarray, np.ndarray]


def rigid_motions(system: System, groups: Iterable[ElementGroup]) -> np.ndarray:
    """Return R (n, r), a basis of the motions of the free dofs that strain none of the element groups."""
    bodies, P = _candidates(system)
    T = sp.csc_array(system.dofs.transform)
    selects = system.dofs.selects
    # The elements of which some strain meets a stiffness, each strain relative to the largest that a candidate could give it:
    # what round-off leaves of a direction that the motions of the bodies don't have would else be scaled up to a strain.
    strained: list[Strained] = []
    reach = abs(P).max(axis=1).toarray().ravel()
    for group in groups:
        B = group.matrices.strain
        D = group.matrices.modulus
        if B is None or D is None or group.part.startswith("carriers."):
            continue  # what turning planets bring is no spring: their train turns freely in it
        Z = group.matrices.circulation
        used = np.any(D != 0.0, axis=2) if Z is None else np.any((D != 0.0) | (Z != 0.0), axis=2)
        e = len(group.dofs)
        used = np.broadcast_to(used, (e, used.shape[1]))
        some = used.any(axis=1)
        if some.any():
            own = group.dofs[some]
            B = np.broadcast_to(B, (e, *B.shape[1:]))[some]
            largest = np.einsum("esd,ed->es", np.abs(B), reach[own])
            strained.append((B / np.where(largest > 0.0, largest, 1.0)[:, :, None], used[some], own))

    # Bodies by themselves first: most are held by what is theirs alone, and a long train has few motions left to be solved for.
    body = _labels(P, T, [dofs[None] for dofs in bodies])
    inside = [np.all(body[own] == body[own[:, :1]], axis=1) for _, _, own in strained]
    alone = [(B[at], used[at], own[at]) for (B, used, own), at in zip(strained, inside, strict=True) if at.any()]
    between = [
        (B[~at], used[~at], own[~at]) for (B, used, own), at in zip(strained, inside, strict=True) if not at.all()
    ]
    left = sp.lil_array((P.shape[1], P.shape[1]))
    count = 0
    for part in _parts(P, T, alone, body):
        kept = _unstrained(part.P, part.T, selects, part.strained)
        left[np.ix_(part.moving, count + np.arange(kept.shape[1]))] = kept
        count += kept.shape[1]
    P = sp.csc_array(P @ sp.csc_array(left)[:, :count])
    P.eliminate_zeros()

    found = [np.zeros((system.n, 0))]
    for part in _parts(P, T, between, _labels(P, T, [own for _, _, own in between])):
        R = _free_of_strain(part.P, part.T, selects, part.strained)
        whole = np.zeros((system.n, R.shape[1]))
        whole[part.free] = R
        found.append(whole)
    return np.hstack(found)


def _labels(P: sp.csc_array, T: sp.csc_array, joined: list[np.ndarray]) -> np.ndarray:
    """A number for each of all dofs (a,), the same for those of one candidate, of one free dof or of a row (e, d) of `joined`."""
    dofs = [P.indices, T.indices]
    count = P.shape[1] + T.shape[1]
    joint = [np.repeat(np.arange(count), np.concatenate([np.diff(P.indptr), np.diff(T.indptr)]))]
    for own in joined:
        e, d = own.shape
        dofs.append(own.ravel())
        joint.append(count + np.repeat(np.arange(e), d))
        count += e
    ends = (np.concatenate(dofs), P.shape[0] + np.concatenate(joint))
    size = P.shape[0] + count
    graph = sp.coo_array((np.ones(len(ends[0]), dtype=np.int8), ends), shape=(size, size))
    return np.asarray(connected_components(graph, directed=False)[1][: P.shape[0]])


@dataclass(frozen=True)
class _Part:
    """Dofs that are joined.

    Attributes:
        moving, free: (p,) and (f,) its candidates and free dofs among all.
        P: (a, p) its candidates. T: (a, f) its dofs by its free ones.
        strained: its elements, with its own numbers of dofs.
    """

    moving: np.ndarray
    free: np.ndarray
    P: np.ndarray
    T: sp.csc_array
    strained: list[Strained]


def _parts(P: sp.csc_array, T: sp.csc_array, strained: list[Strained], label: np.ndarray) -> Iterator[_Part]:
    """What dofs of one label (a,) have of candidates P, of T and of the elements, where a candidate moves them."""
    rows = by_label(label)
    columns = by_label(label[P.indices[P.indptr[:-1]]])
    unknowns = by_label(label[T.indices[T.indptr[:-1]]])
    elements: dict[int, list[Strained]] = {}
    place = np.zeros(P.shape[0], dtype=int)
    for here in rows.values():
        place[here] = np.arange(len(here))
    for B, used, own in strained:
        for k, chosen in by_label(label[own[:, 0]]).items():
            elements.setdefault(k, []).append((B[chosen], used[chosen], place[own[chosen]]))
    for k, moving in columns.items():
        here = rows[k]
        free = unknowns.get(k, np.zeros(0, dtype=int))
        yield _Part(moving, free, P[here][:, moving].toarray(), sp.csc_array(T[here][:, free]), elements.get(k, []))


def _followed(T: sp.csc_array, selects: bool, motions: np.ndarray) -> np.ndarray:
    """T+ motions (f, k): the motions of the free dofs that come nearest to those (a, k) of all."""
    # LAPACK refuses a problem without unknowns or right-hand side.
    if selects or not motions.shape[1] or not T.shape[1]:
        return np.asarray(T.T @ motions)
    return np.asarray(la.lstsq(T.toarray(), motions)[0])


def _unstrained(P: np.ndarray, T: sp.csc_array, selects: bool, strained: list[Strained]) -> np.ndarray:
    """Combinations (p, r) of candidates P (a, p) that the free dofs can follow, T (a, f), and that strain nothing."""
    # What of the candidates the free dofs can't follow must vanish: (I - T T+) P, each row scaled to its largest entry.
    off_range = P - T @ _followed(T, selects, P)
    largest = np.abs(off_range).max(axis=1)
    held = largest > 1e-12
    rows = [off_range[held] / largest[held, None]]
    for B, used, dofs in strained:
        rows.append(np.einsum("esd,edp->esp", B, P[dofs])[used])
    A = np.vstack(rows)
    # The triangle of a tall matrix has its null space, without a square of its rows.
    A = np.asarray(np.linalg.qr(A, mode="r")) if A.shape[0] > A.shape[1] else A
    _, size, right = la.svd(A) if A.shape[0] else (None, np.zeros(0), np.eye(P.shape[1]))
    # Rows are scaled to 1: where the largest singular value is far below, nothing holds at all.
    strains_some = int(np.count_nonzero(size > _ZERO * max(float(size.max(initial=0.0)), 1.0)))
    return np.asarray(right[strains_some:].T)


def _free_of_strain(P: np.ndarray, T: sp.csc_array, selects: bool, strained: list[Strained]) -> np.ndarray:
    """A basis (f, r) of the motions of free dofs in the span of candidates P (a, p) that strain nothing; T is (a, f)."""
    free = _followed(T, selects, P @ _unstrained(P, T, selects, strained))
    if not free.size:
        return np.zeros((T.shape[1], 0))
    # Candidates may move held dofs only; what is left of the basis is orthonormal again.
    u, s, _ = la.svd(free, full_matrices=False)
    return np.asarray(u[:, s > _ZERO])


def _candidates(system: System) -> tuple[list[np.ndarray], sp.csc_array]:
    """The dofs (k,) of each body, and all motions (a, p).

    They are six of each shaft about its middle, rotations scaled to its length, three of each pedestal and six of each casing.
    """
    nodes = system.nodes
    # Dofs (k,) that move together, and their motions (k, 6) or (k, 3).
    moving: list[tuple[np.ndarray, np.ndarray]] = []
    carried: dict[str, list[tuple[np.ndarray, float]]] = {name: [] for name in system.model.shafts}
    turning: dict[str, list[int]] = {name: [] for name in system.model.shafts}
    for (gear, _), number in nodes.teeth.items():
        turning[system.layout.gear(gear).shaft].append(6 * len(nodes) + number)
    for (_, gear), number in nodes.feet.items():
        place = system.layout.place(f"gears.{gear}")
        carried[place.shaft].append((6 * len(nodes) + number + np.arange(6), place.z))
    for name, shaft in system.model.shafts.items():
        middle = shaft.start + 0.5 * shaft.length
        of_nodes = [(6 * k + np.arange(6), nodes.z[k]) for k in nodes.on_shaft(name) if not nodes.pedestal[k]]
        block = [(dofs, rigid_transfer(np.array([0.0, 0.0, z - middle]))) for dofs, z in (*of_nodes, *carried[name])]
        block += [(np.array([dof]), np.eye(6)[[5]]) for dof in turning[name]]  # elastic gears turn with their shaft
        whole = np.vstack([motions for _, motions in block])
        whole[:, 3:] /= max(shaft.length, 1e-3)
        moving.append((np.concatenate([dofs for dofs, _ in block]), whole))
    moving += [(6 * k + np.arange(3), np.eye(3)) for k, bearing in enumerate(nodes.pedestal) if bearing]
    moving += [(nodes.of_casing(name), system.layout.casing(name).seat_motions) for name in system.model.casings]
    first = np.cumsum([0, *(motions.shape[1] for _, motions in moving)])
    values = np.concatenate([motions.ravel() for _, motions in moving])
    rows = np.concatenate([np.repeat(dofs, motions.shape[1]) for dofs, motions in moving])
    columns = np.concatenate(
        [np.tile(np.arange(a, b), len(dofs)) for (dofs, _), a, b in zip(moving, first[:-1], first[1:], strict=True)]
    )
    P = sp.csc_array(sp.coo_array((values, (rows, columns)), shape=(system.dofs.transform.shape[0], first[-1])))
    P.eliminate_zeros()
    return [dofs for dofs, _ in moving], P
