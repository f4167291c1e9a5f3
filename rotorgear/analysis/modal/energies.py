"""Shares of kinetic and strain energy of modes by part and by motion, element by element."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import Any

import numpy as np

from rotorgear.system.groups import by_motion
from rotorgear.system.nodes import CASING, GEAR_BODY
from rotorgear.system.system import System

# What springs of these tables count as; those of another table count under its name.
_SPRING_KINDS = {"meshes": "mesh", "casings": CASING, "bearings": "supports", "nonlinear_elements": "supports"}


@dataclass(frozen=True)
class Energies:
    """Shares of m modes: part -> (m,), motion -> (m,), and kinetic energy by (shaft, motion), or ("", casing)."""

    kinetic: dict[str, np.ndarray]
    strain: dict[str, np.ndarray]
    kinetic_by_motion: dict[str, np.ndarray]
    strain_by_motion: dict[str, np.ndarray]
    kinetic_by_shaft: dict[tuple[str, str], np.ndarray]


def mode_energies(system: System, speed: float, q: np.ndarray, rigid: np.ndarray) -> Energies:
    """Return the energy shares of the shapes q (a, m) of all dofs, complex or real; `rigid` modes (m,) have no strain energy.

    Twice the kinetic energy of an element is |s|^2 q^H M q, twice its strain energy (B q)^H D (B q); |s|^2 cancels in the shares.
    """
    modes = q.shape[1]
    # |q|^2 = (Re q)^2 + (Im q)^2: with twice as many real columns the matrices stay real.
    halves = np.hstack([q.real, q.imag]) if np.iscomplexobj(q) else q
    kinetic, strain, strain_by_motion, kinetic_by_shaft = (
        defaultdict[Any, np.ndarray](lambda: np.zeros(modes)) for _ in range(4)
    )
    elastic_bodies = {CASING: system.model.casings, GEAR_BODY: system.nodes.bodies}
    motions_of_all = (*system.model.motions, *(name for name, bodies in elastic_bodies.items() if bodies))
    kinetic_by_motion: dict[str, np.ndarray] = {motion: np.zeros(modes) for motion in motions_of_all}

    for group in system.groups_at(speed):
        local = halves[group.dofs]  # (e, d, m or 2 m)
        M = group.matrices.mass
        dofs, same_motion = by_motion(group.dof_motions)
        by_dof = None if M is None else np.einsum("edm,edm->dm", local, (M * same_motion) @ local)
        for motion in motions_of_all:
            if by_dof is None or motion not in dofs:
                continue
            energy = _by_mode(by_dof[dofs[motion]].sum(axis=0), modes)
            kinetic[group.part] += energy
            kinetic_by_shaft[("", group.part) if motion in (CASING, GEAR_BODY) else (group.shaft, motion)] += energy
            kinetic_by_motion[motion] += energy
        B = group.matrices.strain
        D = group.matrices.modulus
        if B is None or D is None:
            continue
        strains = B @ local
        by_strain = np.einsum("esm,esm->sm", strains, D @ strains)
        # Of a shaft by motion, of springs under their kind.
        table = group.part.partition(".")[0]
        labels = group.strain_motions or (_SPRING_KINDS.get(table, table),) * len(by_strain)
        for label in dict.fromkeys(labels):
            energy = by_strain[[k for k, name in enumerate(labels) if name == label]].sum(axis=0)
            elastic = np.where(rigid, 0.0, _by_mode(energy, modes))
            strain[group.part] += elastic
            strain_by_motion[label] += elastic
    kinetic_total = sum(kinetic_by_motion.values(), np.zeros(modes))
    strain_total = sum(strain_by_motion.values(), np.zeros(modes))
    return Energies(
        _shares(kinetic, kinetic_total),
        _shares(strain, strain_total),
        _shares(kinetic_by_motion, kinetic_total),
        _shares(strain_by_motion, strain_total),
        _shares(kinetic_by_shaft, kinetic_total),
    )


def _by_mode(energy: np.ndarray, modes: int) -> np.ndarray:
    """Energies (m,) from those of real columns, or of real and imaginary ones (2 m,)."""
    return energy.reshape(-1, modes).sum(axis=0) if modes else energy


def _shares(table: dict[Any, np.ndarray], total: np.ndarray) -> dict[Any, np.ndarray]:
    safe = np.where(total > 0.0, total, 1.0)
    return {key: np.where(total > 0.0, energy / safe, 0.0) for key, energy in table.items()}
