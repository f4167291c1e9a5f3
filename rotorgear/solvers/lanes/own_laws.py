"""Local forces that the lanes of a sweep take by laws of their own: rolling elements, friction, torques over speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.solvers.lanes.arguments import ActingLaws
from rotorgear.solvers.time.local_forces import LocalForces, gather
from rotorgear.solvers.time.local_system import LocalSystem, evaluated

# Times in a period of the fastest excitation at which tangents are looked at.
_SAMPLES = 64
_FAR = 1e-2  # m or rad, by which a displacement is changed to see whether a law answers


@dataclass(frozen=True)
class OwnLaws:
    """Laws and where they act.

    Attributes:
        forces: the laws. place: (2, l) first of the m local displacements of each, and how many it takes.
        turn: radians of the reference for one of the fastest excitation, with the sign of its speed.
    """

    forces: LocalForces
    place: np.ndarray
    turn: float


def own_laws(forces: LocalForces, own: np.ndarray, turn: float) -> OwnLaws:
    """Pick the laws whose local displacements are marked in `own` (m,)."""
    chosen = [i for i in range(len(forces.laws)) if own[forces.first[i]]]
    place = np.array([[forces.first[i], forces.laws[i].components] for i in chosen], dtype=np.int64)
    return OwnLaws(gather(tuple(forces.laws[i] for i in chosen)), place.reshape(-1, 2).T.copy(), turn)


def acting_laws(own: OwnLaws, parameters: np.ndarray, clock: np.ndarray) -> ActingLaws:
    """The laws as the kernels take them, with the parameters and the clock of one system or of all lanes."""
    of = own.forces
    return ActingLaws(
        of.schedules,
        of.forces,
        of.kind,
        own.place,
        parameters,
        of.parameters_first,
        of.state_first,
        of.block_first,
        clock,
    )


def steepest(local: LocalSystem, q: np.ndarray, own: OwnLaws, period: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """Stiffness and damping (m, m) of the laws at rest beyond their reference, where stiffest and most damped in a period.

    None where there is no such law.
    """
    if not own.forces.laws:
        return []
    found = [_tangents(local, q, own, period * i / _SAMPLES) for i in range(_SAMPLES)]
    most = {max(range(_SAMPLES), key=lambda i: float(np.abs(found[i][part]).sum())) for part in (0, 1)}
    return [found[i] for i in sorted(most)]


def _tangents(local: LocalSystem, q: np.ndarray, own: OwnLaws, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Tangents (m, m) of the laws at a time, without their reference."""
    laws = local.forces
    d = local.B.T @ q
    _, in_d, in_v, _ = evaluated(local, d, np.zeros(local.m), t)
    K = np.zeros((local.m, local.m))
    C = np.zeros((local.m, local.m))
    for a, k in own.place.T:
        at = int(laws.block_first[int(np.searchsorted(laws.first, a))])
        block = slice(a, a + k), slice(a, a + k)
        K[block] = in_d[at : at + k * k].reshape(k, k) - laws.reference_stiffness[block]
        C[block] = in_v[at : at + k * k].reshape(k, k) - laws.reference_damping[block]
    return K, C


def not_held(local: LocalSystem, q: np.ndarray, own: OwnLaws, free: np.ndarray) -> np.ndarray:
    """Of the motions without strain `free` (n, r): those that no law answers with a force, wherever it is; (n, s).

    A support with clearance may have no stiffness at rest, and still holds what it carries.
    """
    if not own.forces.laws or not free.size:
        return free
    d = local.B.T @ q
    still = np.zeros(local.m)
    at_rest = evaluated(local, d, still, 0.0)[0]
    acts = np.zeros(local.m, dtype=bool)
    for j in np.concatenate([np.arange(a, a + k) for a, k in own.place.T]):
        for far in (-_FAR, _FAR):
            moved = d.copy()
            moved[j] += far
            acts[j] |= bool(np.any(evaluated(local, moved, still, 0.0)[0] != at_rest))
    seen = local.B[:, np.flatnonzero(acts)].T @ free
    if not seen.size:
        return free
    _, sizes, right = np.linalg.svd(seen)
    held = int(np.count_nonzero(sizes > 1e-9 * max(1e-300, float(np.linalg.norm(free)))))
    return np.asarray(free @ right[held:].T)
