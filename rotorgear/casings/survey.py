"""Modes of a casing's whole mesh, nothing reduced: free, and held as the model file says, its seats free to deform."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.casings.constrained import Constrained, ElasticBody
from rotorgear.casings.fe_body import FiniteElementBody, FreeSpace
from rotorgear.casings.modes import lowest_modes
from rotorgear.casings.motions import rigid_motions
from rotorgear.progress import Progress, silent


@dataclass(frozen=True)
class MeshModes:
    """Elastic modes of a mesh: λ (k,) in (rad/s)^2 rising, and displacements (3p, k) of modal mass 1."""

    eigenvalues: np.ndarray
    shapes: np.ndarray

    @property
    def frequency(self) -> np.ndarray:
        """In Hz (k,)."""
        return np.asarray(np.sqrt(np.maximum(self.eigenvalues, 0.0)) / (2.0 * np.pi))


def free_modes(
    fe: FiniteElementBody, count: int, body: ElasticBody | None = None, progress: Progress = silent
) -> MeshModes:
    """The lowest elastic modes of the body with nothing held; `body` is its factored stiffness, where there is one."""
    space = fe.free_space(held=False, rigid_seats=False)
    motions = rigid_motions(fe.mesh.points)
    if body is None:
        K = fe.stiffness_in(space.shapes)
        body = ElasticBody(K, motions[space.dofs], f"{fe.settings.address}, free", progress)
    # Elastic modes have no momentum: the rigid motions, weighted by the mass, are at rest in them.
    still = space.forces(fe.matrices.times_mass(motions))
    return _modes(fe, space, Constrained(body, still / np.linalg.norm(still, axis=0)), count)


def held_modes(
    fe: FiniteElementBody, count: int, body: ElasticBody | None = None, progress: Progress = silent
) -> MeshModes:
    """The lowest modes of the body as it is held and mounted."""
    space = fe.free_space(held=True, rigid_seats=False)
    if body is None:
        rigid = rigid_motions(fe.mesh.points)[space.dofs][:, : 0 if len(fe.held) else 6]
        body = ElasticBody(fe.stiffness_in(space.shapes), rigid, f"{fe.settings.address}, held", progress)
    springs, flexibility = fe.springs()
    return _modes(fe, space, Constrained(body, space.forces(springs), flexibility), count)


def _modes(fe: FiniteElementBody, space: FreeSpace, system: Constrained, count: int) -> MeshModes:
    def times_mass(columns: np.ndarray) -> np.ndarray:
        return space.forces(fe.matrices.times_mass(space.shapes @ columns))

    values, shapes = lowest_modes(system.solve, times_mass, len(space.dofs), count)
    return MeshModes(values, np.asarray(space.shapes @ shapes))


def rigid_residual(fe: FiniteElementBody) -> tuple[float, float]:
    """How free of strain rigid motions are: |K R| / (|K| |R|), and the largest of their six frequencies in Hz."""
    R = rigid_motions(fe.mesh.points, fe.mass_properties[1])
    forces = fe.stiffness_times(R)
    largest = float(abs(fe.matrices.stiffness.data).max())
    residual = float((np.linalg.norm(forces, axis=0) / np.linalg.norm(R, axis=0)).max() / largest)
    squares = la.eigh(0.5 * (R.T @ forces + forces.T @ R), fe.rigid_mass(R), eigvals_only=True)
    return residual, float(np.sqrt(np.abs(squares).max()) / (2.0 * np.pi))
