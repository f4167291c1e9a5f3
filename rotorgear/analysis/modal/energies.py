"""Shares of kinetic and strain energy of modes by part and by motion, element by element."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rotorgear.system.groups import ElementGroup
from rotorgear.system.system import System

_SPRING_KINDS = {"meshes": "mesh", "bearings": "supports", "supports": "supports", "couplings": "couplings"}


@dataclass(frozen=True)
class Energies:
    """Shares of m modes: part -> (m,), motion -> (m,), and kinetic energy by (shaft, motion)."""

    kinetic: dict[str, np.ndarray]
    strain: dict[str, np.ndarray]
    kinetic_by_motion: dict[str, np.ndarray]
    strain_by_motion: dict[str, np.ndarray]
    kinetic_by_shaft: dict[tuple[str, str], np.ndarray]


def mode_energies(system: System, speed: float, q: np.ndarray, rigid: np.ndarray) -> Energies:
    """Return the energy shares of the shapes q (a, m) of all dofs, complex or real; `rigid` modes (m,) have no strain energy."""
    modes = q.shape[1]
    kinetic: dict[str, np.ndarray] = {}
    strain: dict[str, np.ndarray] = {}
    by_motion: dict[str, np.ndarray] = {motion: np.zeros(modes) for motion in system.model.motions}
    strained: dict[str, np.ndarray] = {}
    by_shaft: dict[tuple[str, str], np.ndarray] = {}
    for group in system.groups_at(speed):
        local = q[group.dofs]  # (e, d, m)
        for motion, energy in _kinetic(group, local, system.model.motions):
            _add(kinetic, group.part, energy)
            _add(by_shaft, (group.shaft, motion), energy)
            by_motion[motion] += energy
        for label, energy in _strain(group, local):
            elastic = np.where(rigid, 0.0, energy)
            _add(strain, group.part, elastic)
            _add(strained, label, elastic)
    nothing = np.zeros(modes)
    total = sum(by_motion.values(), nothing)
    strained_total = sum(strained.values(), nothing)
    return Energies(
        _shares(kinetic, total),
        _shares(strain, strained_total),
        _shares(by_motion, total),
        _shares(strained, strained_total),
        _shares(by_shaft, total),
    )


def _kinetic(group: ElementGroup, local: np.ndarray, motions: Iterable[str]) -> Iterable[tuple[str, np.ndarray]]:
    M = group.matrices.mass
    if M is None:
        return
    kinds = np.array(group.dof_motions)
    for motion in motions:
        own = kinds == motion
        part = local[:, own]
        moved = M[:, own][:, :, own] @ part
        yield motion, np.real(np.einsum("edm,edm->m", part.conj(), moved))


def _strain(group: ElementGroup, local: np.ndarray) -> Iterable[tuple[str, np.ndarray]]:
    B = group.matrices.strain
    D = group.matrices.modulus
    if B is None or D is None:
        return
    strains = B @ local
    density = np.real(np.sum(strains.conj() * (D @ strains), axis=0))  # (s, m)
    if group.strain_motions:
        for motion in dict.fromkeys(group.strain_motions):
            own = [k for k, name in enumerate(group.strain_motions) if name == motion]
            yield motion, density[own].sum(axis=0)
    else:
        yield _SPRING_KINDS[group.part.partition(".")[0]], density.sum(axis=0)


def _add(table: dict[Any, np.ndarray], key: Any, energy: np.ndarray) -> None:
    table[key] = table[key] + energy if key in table else energy


def _shares(table: dict[Any, np.ndarray], total: np.ndarray) -> dict[Any, np.ndarray]:
    safe = np.where(total > 0.0, total, 1.0)
    return {key: np.where(total > 0.0, energy / safe, 0.0) for key, energy in table.items()}
