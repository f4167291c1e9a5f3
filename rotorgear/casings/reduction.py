"""Reduction of a finite-element body to its seats: Craig and Bampton's modes with residual shapes, and their error.

The basis Φ = [Ψ φ v] (Craig and Bampton, AIAA J. 6, 1968):

    Ψ  static answers to unit motions of the seats: mean motions of a patch (RBE3), or the patch as a rigid body (RBE2),
    φ  modes with the seats at rest, up to a frequency,
    v  = A M Ψ without its part in φ: what the modes that are left out add statically to the inertia forces of Ψ.

A is the flexibility with the seats at rest. The residual shapes v make the answer exact to the second power of λ over the first
eigenvalue left out; they are coordinates like the modes, and the internal coordinates are made those of the inside's own pencil.

The error of a mode (λ, q) of whatever structure the body is part of: its residual r in the inside, met by A, raises λ by

    δλ = rᵀ A r = λ² qᵀ E q,   E = Xᵀ K X,   X = A M Φ - Φ_i K_ii⁻¹ Φ_iᵀ M Φ

where Φ_i are the internal shapes: X is what the basis can't follow. E is kept with the body, so that every analysis can state
the error of its own modes.

The whole mesh has modes too, nothing reduced: free, and held as the model file says, its seats free to deform.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.linalg as la

from rotorgear.casings.constrained import Constrained, ElasticBody, lowest_modes, modes_up_to
from rotorgear.casings.fe_body import FiniteElementBody, FreeSpace
from rotorgear.casings.reduced_body import (
    ReducedBody,
    Surface,
    modal_damping,
    node_dofs,
    rigid_coordinates,
    rigid_motions,
)
from rotorgear.casings.split import TRIANGLES
from rotorgear.progress import Progress, part_of, silent


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
    name = f"{fe.settings.address}, free"
    body = body or ElasticBody(fe.stiffness_in(space.shapes), motions[space.dofs], name, progress)
    # Elastic modes have no momentum: the rigid motions, weighted by the mass, are at rest in them.
    still = space.forces(fe.matrices.times_mass(motions))
    return _modes(fe, space, Constrained(body, still / np.linalg.norm(still, axis=0)), count)


def held_modes(
    fe: FiniteElementBody, count: int, body: ElasticBody | None = None, progress: Progress = silent
) -> MeshModes:
    """The lowest modes of the body as it is held and mounted."""
    space = fe.free_space(held=True, rigid_seats=False)
    rigid = rigid_motions(fe.mesh.points)[space.dofs][:, : 0 if len(fe.held) else 6]
    body = body or ElasticBody(fe.stiffness_in(space.shapes), rigid, f"{fe.settings.address}, held", progress)
    springs, flexibility, _ = fe.springs()
    return _modes(fe, space, Constrained(body, space.forces(springs), flexibility), count)


def _modes(fe: FiniteElementBody, space: FreeSpace, system: Constrained, count: int) -> MeshModes:
    values, shapes = lowest_modes(system.solve, partial(fe.mass_times, space=space), len(space.dofs), count)
    return MeshModes(values, np.asarray(space.shapes @ shapes))


def rigid_residual(fe: FiniteElementBody) -> tuple[float, float]:
    """How free of strain rigid motions are: |K R| / (|K| |R|), and the largest of their six frequencies in Hz."""
    R = rigid_motions(fe.mesh.points, fe.mass_properties[1])
    forces = fe.stiffness_times(R)
    largest = float(abs(fe.matrices.stiffness.data).max())
    residual = float((np.linalg.norm(forces, axis=0) / np.linalg.norm(R, axis=0)).max() / largest)
    squares = la.eigh(0.5 * (R.T @ forces + forces.T @ R), fe.rigid_mass(R), eigvals_only=True)
    return residual, float(np.sqrt(np.abs(squares).max()) / (2.0 * np.pi))


# Fixed-interface modes where neither the file nor the analysis says a frequency.
USUAL = 20
# Residual shapes whose mass is less than this share of the largest follow from the others.
_DEPENDENT = 1e-10
# A residual shape smaller than this share of the whole static shape is only rounding of the modes.
_FOLLOWED = 1e-8
# Right-hand sides that are solved at a time: many share the reading of the factor, few need less memory.
_COLUMNS = 16


def reduce(
    fe: FiniteElementBody, modes_to: float | None, progress: Progress = silent
) -> tuple[ReducedBody, ElasticBody, np.ndarray]:
    """Reduce a body.

    Args:
        fe: the body.
        modes_to: Hz, fixed-interface modes are kept up to here; None: the lowest `USUAL`.
        progress: of the steps.

    Returns:
        The reduced body, the factored stiffness that it was found with, and its basis Φ (3p, n).

    Raises:
        AnalysisError: more memory than there is. ConvergenceError: a factorisation or an iteration that failed.
    """
    name = fe.settings.address
    mean = fe.settings.connection == "mean"
    seats = 6 * len(fe.seats)
    space = fe.free_space(held=True, rigid_seats=not mean)
    R = rigid_motions(fe.mesh.points)
    floating = not len(fe.held) and not space.seats.shape[1]
    rigid = R[space.dofs][:, : 6 if floating else 0]
    body = ElasticBody(fe.stiffness_in(space.shapes), rigid, name, part_of(progress, 0.0, 0.3))

    progress(0.3, f"{name}: static shapes of {len(fe.seats)} seats")
    springs, flexibility, _ = fe.springs()
    seat_weights = fe.mean_weights(fe.seats) if mean else np.zeros((fe.dofs, 0))
    compliance = np.concatenate([np.zeros(seat_weights.shape[1]), flexibility])
    system = Constrained(body, space.forces(np.hstack([seat_weights, springs])), compliance)
    static = _static_shapes(fe, space, system, springs)

    progress(0.4, f"{name}: fixed-interface modes")
    of_mass = partial(fe.mass_times, space=space)
    _, fixed, left = modes_up_to(system.solve, of_mass, len(space.dofs), modes_to, USUAL, name)

    progress(0.7, f"{name}: residual shapes and error")
    fixed = space.shapes @ fixed
    kept = fixed.shape[1]
    mass_fixed = fe.matrices.times_mass(fixed)
    mass_static = fe.matrices.times_mass(static)
    whole = space.shapes @ system.solve(space.forces(mass_static))
    residual = whole - fixed @ (mass_fixed.T @ whole)
    residual -= fixed @ (mass_fixed.T @ residual)
    # Where the modes that are kept follow nearly all of a shape, the rest of it is their rounding.
    left_over = np.linalg.norm(residual, axis=0) > _FOLLOWED * np.linalg.norm(whole, axis=0)
    residual = residual[:, left_over]
    residual = independent(residual, fe.matrices.times_mass(residual))
    internal = np.hstack([fixed, residual])

    # Internal coordinates of the inside's own pencil: its stiffness and mass become diagonal.
    K_internal = _stiffness(fe, internal, springs, flexibility)
    squares, turn = la.eigh(K_internal, symmetric(internal.T @ fe.matrices.times_mass(internal)))
    internal = internal @ turn
    # Static shapes and internal shapes share no strain energy, and the internal block is diagonal; rounding is dropped.
    K = la.block_diag(_stiffness(fe, static, springs, flexibility), np.diag(squares))
    basis = np.hstack([static, internal])
    del fixed, residual, mass_fixed, mass_static, static, internal
    mass_basis = fe.matrices.times_mass(basis)
    M = symmetric(basis.T @ mass_basis)
    M[seats:, seats:] = np.eye(len(squares))
    forces = space.forces(mass_basis)
    del mass_basis
    # E: answers to M Φ that the internal shapes can't follow; Xᵀ K X = (M Φ)ᵀ X, because X is such an answer.
    error = np.empty_like(M)
    for some in np.array_split(np.arange(len(M)), max(1, len(M) // _COLUMNS)):
        followed = basis[space.dofs][:, seats:] @ (M[seats:, some] / squares[:, None])
        error[:, some] = forces.T @ (system.solve(forces[:, some]) - followed)
    error = symmetric(error)

    body_mass, centre, inertia = fe.mass_properties
    ground_force, ground_damping, ground_mass, ground_weight = _ground(fe, space, system, basis)
    damping = modal_damping(M, K, fe.settings.damping_ratio) if fe.settings.damping_ratio else np.zeros_like(M)
    ground_damping = ground_damping + ground_mass @ la.solve(M, damping, assume_a="pos")
    # Dampers of the mounts in the coordinates of the basis.
    motions = fe.mean_weights(fe.mounts).T @ basis
    C = np.zeros_like(M)
    for at, mount in enumerate(fe.settings.mounts):
        moved = motions[6 * at : 6 * at + 6]
        C += moved.T @ np.array(mount.damping) @ moved
    progress(1.0, f"{name}: reduced to {len(M)} coordinates")
    seat_points = np.array([patch.point for patch in fe.seats]).reshape(-1, 3)
    held = bool(len(fe.held) or len(flexibility))
    reduced = ReducedBody(
        name=fe.settings.name,
        seats=tuple(seat for seat, _ in fe.settings.seats),
        seat_points=seat_points,
        mass=M,
        stiffness=K,
        damping=damping + C,
        rigid=None if held else rigid_coordinates(len(M), seat_points),
        inertia_force=basis.T @ fe.matrices.times_mass(R),
        body_mass=body_mass,
        centre=centre,
        inertia=inertia,
        fixed_frequency=np.sqrt(squares[:kept]) / (2.0 * np.pi),
        left_frequency=left,
        error=error,
        surface=surface_of(fe, basis),
        ground_sets=(*fe.settings.held, *(mount.set for mount in fe.settings.mounts)),
        ground_force=ground_force,
        ground_damping=ground_damping,
        ground_mass=ground_mass,
        ground_weight=ground_weight,
        held=held,
        notes=fe.mesh.notes,
    )
    return reduced, body, basis


def _static_shapes(fe: FiniteElementBody, space: FreeSpace, system: Constrained, springs: np.ndarray) -> np.ndarray:
    """Ψ (3p, 6 s): displacements for unit motions of the seats, without inertia."""
    seats = 6 * len(fe.seats)
    if not space.seats.shape[1]:
        motions = np.zeros((system.weights.shape[1], seats))
        motions[:seats] = np.eye(seats)
        return np.asarray(space.shapes @ system.solve(motions=motions))
    moved = space.seats.toarray()
    forces = -space.forces(fe.stiffness_times(moved))
    # A seat that moves stretches the springs of mounts that it is part of: Wᵀ (u + u_seat) - C λ = 0.
    return np.asarray(space.shapes @ system.solve(forces, -(springs.T @ moved)) + moved)


def _stiffness(fe: FiniteElementBody, shapes: np.ndarray, springs: np.ndarray, flexibility: np.ndarray) -> np.ndarray:
    """Φᵀ K Φ of shapes Φ, with the springs of mounts."""
    of_mounts = (shapes.T @ springs) @ ((springs.T @ shapes) / flexibility[:, None])
    return symmetric(shapes.T @ fe.stiffness_times(shapes) + of_mounts)


def independent(shapes: np.ndarray, mass_shapes: np.ndarray) -> np.ndarray:
    """Combinations of shapes that are M-orthonormal, without those that follow from the others."""
    gram = symmetric(shapes.T @ mass_shapes)
    scale = np.sqrt(np.diag(gram).clip(min=1e-300))
    values, vectors = la.eigh(gram / np.outer(scale, scale))
    strong = values > _DEPENDENT * values[-1] if len(values) else np.zeros(0, dtype=bool)
    return np.asarray(shapes @ (vectors[:, strong] / np.sqrt(values[strong]) / scale[:, None]))


def symmetric(matrix: np.ndarray) -> np.ndarray:
    return np.asarray(0.5 * (matrix + matrix.T))


def _ground(fe: FiniteElementBody, space: FreeSpace, system: Constrained, basis: np.ndarray) -> list[np.ndarray]:
    """Wrenches of the ground about the origin, at held sets, then at mounts; of damping those of mounts only.

    For unit coordinates, velocities and accelerations (6 g, n), and for gravity (6 g, 3).

    By the principle of virtual work f = Ψᵀ (M a + C v + K u - M g), with the static shapes Ψ of the body for unit motions of the
    ground at one place, the seats at rest. Ψᵀ K Φ has no part of the modes of the inside, so that statics is exact however few
    they are. Damping of modes, C = M Φ Z Φᵀ M, acts like accelerations M⁻¹ C v of the coordinates.
    """
    R = rigid_motions(fe.mesh.points)
    springs, flexibility, mount_of = fe.springs()
    seats = fe.mean_weights(fe.seats) if fe.settings.connection == "mean" else np.zeros((fe.dofs, 0))
    mounts = fe.mean_weights(fe.mounts)
    dampers = la.block_diag(np.zeros((0, 0)), *(np.array(mount.damping) for mount in fe.settings.mounts))
    count = basis.shape[1]
    nothing = np.zeros((0, count))
    found = [(nothing, nothing, nothing, np.zeros((0, 3)))]

    def add(moved: np.ndarray, own: np.ndarray) -> None:
        """Of held nodes that are moved (3p, 6), and of mounts (mounts,) whose far ends are."""
        drawn = own[mount_of][:, None] * (springs.T @ R)
        motions = np.vstack([-seats.T @ moved, drawn - springs.T @ moved])
        shapes = moved + space.shapes @ system.solve(-space.forces(fe.stiffness_times(moved)), motions)
        stretched = (springs.T @ shapes - drawn) / flexibility[:, None]
        mass_shapes = fe.matrices.times_mass(shapes)
        stroke = mounts.T @ shapes - np.repeat(own, 6)[:, None] * (mounts.T @ R)
        found.append(
            (
                (fe.stiffness_times(shapes) + springs @ stretched).T @ basis,
                stroke.T @ dampers @ (mounts.T @ basis),
                mass_shapes.T @ basis,
                -mass_shapes.T @ R[:, :3],
            )
        )

    for nodes in fe.held_sets:
        moved = np.zeros_like(R)
        dofs = node_dofs(nodes)
        moved[dofs] = R[dofs]
        if fe.joined.interpolation is not None:
            moved = np.asarray(fe.joined.interpolation @ moved.reshape(len(fe.mesh.points), -1)).reshape(moved.shape)
        add(moved, np.zeros(len(fe.mounts), dtype=bool))
    for number in range(len(fe.mounts)):
        add(np.zeros_like(R), np.arange(len(fe.mounts)) == number)
    return [np.vstack(parts) for parts in zip(*found, strict=True)]


def surface_of(fe: FiniteElementBody, basis: np.ndarray) -> Surface:
    """The outer faces in flat triangles on all their nodes, so that curved shapes of quadratic elements are seen."""
    faces = fe.mesh.boundary
    of_quad = [(0, 4, 7), (4, 1, 5), (5, 2, 6), (7, 6, 3), (4, 5, 7), (5, 6, 7)]
    split = TRIANGLES if len(fe.mesh.element.faces[0]) == 3 else of_quad
    triangles = faces[:, np.array(split)].reshape(-1, 3)
    nodes, local = np.unique(triangles, return_inverse=True)
    moved = basis.reshape(len(fe.mesh.points), 3, -1)[nodes]
    return Surface(fe.mesh.points[nodes], local.reshape(-1, 3), moved)
