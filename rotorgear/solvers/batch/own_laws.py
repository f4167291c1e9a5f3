"""Local forces that a sweep takes by laws of their own: rolling elements, friction, torques over speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.solvers.time.contact_equilibrium import FAR, held_and_unheld
from rotorgear.solvers.time.kernel_time import DISSIPATED, ENERGIES
from rotorgear.solvers.time.local_forces import LocalForces, gather
from rotorgear.solvers.time.local_system import LocalSystem, evaluated

# Times in a period of the fastest excitation at which tangents are looked at.
_SAMPLES = 64
# Times in a common period over which the power of laws is averaged: a prime number, so that they meet all phases of any cycle.
_TIMES = 257
_PRESSED = 1e-6  # m or rad: contacts without a load are looked at as if pressed together, or apart, by this


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


def steepest(local: LocalSystem, q: np.ndarray, own: OwnLaws, period: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """Stiffness and damping (m, m) of the laws at rest beyond their reference, where stiffest and most damped in a period.

    None where there is no such law.
    """
    if not own.forces.laws:
        return []
    laws = local.forces
    d = local.B.T @ q
    still = np.zeros(local.m)
    found = []
    for i in range(_SAMPLES):
        _, in_d, in_v, _ = evaluated(local, d, still, period * i / _SAMPLES)
        stiffness = _of_laws(own, laws.matrix(in_d) - laws.reference_stiffness)
        found.append((stiffness, _of_laws(own, laws.matrix(in_v) - laws.reference_damping)))
    most = {max(range(_SAMPLES), key=lambda i: float(np.abs(found[i][part]).sum())) for part in (0, 1)}
    return [found[i] for i in sorted(most)]


def taken_at_rest(
    local: LocalSystem, q: np.ndarray, own: OwnLaws, period: float
) -> tuple[float, np.ndarray, np.ndarray]:
    """What laws such as friction take of the power of the prescribed motion, on average over the common `period` in s.

    Returns:
        About the displacements q (n,): the power in W, (m,) mean forces of the laws that take some, and (m, m) mean damping of
        all laws beyond their reference.
    """
    laws = local.forces
    d = local.B.T @ q
    still = np.zeros(local.m)
    numbers = np.searchsorted(laws.first, own.place[0])
    for pressed in (0.0, _PRESSED, -_PRESSED):
        power = 0.0
        push = np.zeros(local.m)
        in_v = np.zeros(laws.block_first[-1])
        for i in range(_TIMES):
            F, _, tangent, energy = evaluated(local, d + pressed, still, period * i / _TIMES)
            in_v += tangent / _TIMES
            taken = energy.reshape(-1, ENERGIES)[:, DISSIPATED] / _TIMES
            for number, (a, k) in zip(numbers, own.place.T, strict=True):
                if taken[number] > 0.0:
                    power += taken[number]
                    push[a : a + k] += F[a : a + k] / _TIMES
        if power > 0.0:
            break
    return power, push, _of_laws(own, laws.matrix(in_v) - laws.reference_damping)


def _of_laws(own: OwnLaws, A: np.ndarray) -> np.ndarray:
    """The part of A (m, m) that belongs to own laws."""
    found = np.zeros_like(A)
    for a, k in own.place.T:
        found[a : a + k, a : a + k] = A[a : a + k, a : a + k]
    return found


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
        for far in (-FAR, FAR):
            moved = d.copy()
            moved[j] += far
            acts[j] |= bool(np.any(evaluated(local, moved, still, 0.0)[0] != at_rest))
    seen = local.B[:, np.flatnonzero(acts)].T @ free
    return held_and_unheld(seen, free)[1] if seen.size else free
