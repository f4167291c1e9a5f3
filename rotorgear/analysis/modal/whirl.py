"""Sense of whirl of modes: forward where the precession has the sense of a shaft's own spin.

An orbit X, Y (or a tilt tx, ty) sweeps -2 Im(conj(X) Y) about +z. Weighted with the inertia of each degree of freedom and
divided by the same sum of |X|^2 + |Y|^2, a circle gives +-1 and a line 0, for shafts that bend and for disks that only tilt.
"""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.modal.energies import Energies
from rotorgear.system.system import System

# Below this share of the inertia-weighted orbit a mode is called planar.
_PLANAR = 0.02
# Nodes that sweep against the rest with more than this share make a mode mixed.
_MIXED = 0.05
# A shaft with less of the kinetic energy in bending does not give the mode its sense.
_LEAST_BENDING = 0.05


def orbits(system: System, inertia: np.ndarray, shapes: np.ndarray, shaft: str) -> tuple[np.ndarray, np.ndarray]:
    """Swept area and size of the orbits of a shaft's nodes, inertia-weighted, each (nodes, m).

    `inertia` (6 p,) is the diagonal of the mass matrix over the nodes, `shapes` (p, 6, m).
    """
    numbers = system.nodes.on_shaft(shaft)
    weight = inertia.reshape(-1, 6)[numbers][:, [0, 3], None]
    first = shapes[numbers][:, [0, 3]]
    second = shapes[numbers][:, [1, 4]]
    swept = -2.0 * np.sum(weight * np.imag(first.conj() * second), axis=1)
    size = np.sum(weight * (np.abs(first) ** 2 + np.abs(second) ** 2), axis=1)
    return swept, size


def diagonal_inertia(system: System) -> np.ndarray:
    """Diagonal of the mass matrix over all dofs of the nodes, (6 p,)."""
    diagonal = np.zeros(system.dofs.transform.shape[0])
    for group in system.groups:
        if group.matrices.mass is not None:
            np.add.at(diagonal, group.dofs, np.diagonal(group.matrices.mass, axis1=1, axis2=2))
    return diagonal[: 6 * len(system.nodes)]


def whirl_by_shaft(system: System, shapes: np.ndarray, speed: float) -> dict[str, np.ndarray]:
    """Net sense of precession of each shaft in the sense of its own spin: shaft -> (m,), -1 to 1; 0 for a shaft at rest."""
    if not speed or not system.model.has("bending"):
        return {name: np.zeros(shapes.shape[2]) for name in system.model.shafts}
    sense = {}
    inertia = diagonal_inertia(system)
    for name in system.model.shafts:
        swept, size = orbits(system, inertia, shapes, name)
        total = size.sum(axis=0)
        spin = np.sign(system.train.ratio(name) * speed)
        # A mode is forward for this shaft when it precesses as the shaft itself turns, not as the input does.
        sense[name] = spin * np.where(total > 0.0, swept.sum(axis=0) / np.where(total > 0.0, total, 1.0), 0.0)
    return sense


def whirl_words(
    system: System, shapes: np.ndarray, by_shaft: dict[str, np.ndarray], energies: Energies
) -> tuple[str, ...]:
    """One word a mode, for the shaft with the most bending: forward, backward, mixed (both on one shaft), planar, or ""."""
    if not system.model.has("bending"):
        return ("",) * shapes.shape[2]
    inertia = diagonal_inertia(system)
    swept_of = {name: orbits(system, inertia, shapes, name) for name in by_shaft}
    words = []
    for mode in range(shapes.shape[2]):
        bending = {name: energies.kinetic_by_shaft.get((name, "bending")) for name in by_shaft}
        shares = {name: float(share[mode]) for name, share in bending.items() if share is not None}
        name = max(shares, key=lambda key: shares[key], default="")
        if not name or shares[name] < _LEAST_BENDING or system.train.ratio(name) == 0.0:
            words.append("")
            continue
        swept = swept_of[name][0][:, mode]
        size = swept_of[name][1][:, mode]
        total = np.sum(np.abs(swept))
        if total < _PLANAR * np.sum(size):
            words.append("planar")
        elif min(np.sum(swept[swept > 0]), -np.sum(swept[swept < 0])) > _MIXED * total:
            words.append("mixed")
        else:
            words.append("forward" if by_shaft[name][mode] > 0 else "backward")
    return tuple(words)
