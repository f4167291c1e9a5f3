"""A reduced elastic body: small matrices in the motions of its seats, and the motion of its surface that belongs to them.

    u = Φ q,   q = [motions of the seats; internal coordinates],   M = Φᵀ M_fe Φ,   K = Φᵀ K_fe Φ

The motions of a seat are x y z rx ry rz of its point, in model coordinates: displacement, and rotation about the axes of the
model. The internal coordinates leave all seats at rest: fixed-interface modes and residual shapes (Craig and Bampton, Coupling
of substructures for dynamic analyses, AIAA J. 6, 1968). What holds the body to the ground (held faces, mounts) is in K already.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as la


def rigid_motions(points: np.ndarray, about: np.ndarray | None = None) -> np.ndarray:
    """Displacements (3p, 6) of points in unit displacements along x y z and unit rotations about the axes through a point."""
    x, y, z = (points - (np.zeros(3) if about is None else about)).T
    zero = np.zeros(len(points))
    one = np.ones(len(points))
    along_x = [one, zero, zero, zero, z, -y]
    along_y = [zero, one, zero, -z, zero, x]
    along_z = [zero, zero, one, y, -x, zero]
    return np.array([along_x, along_y, along_z]).transpose(2, 0, 1).reshape(-1, 6)


def node_dofs(nodes: np.ndarray) -> np.ndarray:
    """Numbers (3n,) of the displacements along x y z of nodes (n,)."""
    return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel())


def rigid_coordinates(size: int, seat_points: np.ndarray) -> np.ndarray:
    """Coordinates (n, 6) of rigid motions of the model: those of the seats; the inside follows statically.

    Args:
        size: number n of coordinates, six of each seat first.
        seat_points: (s, 3) in m.
    """
    coordinates = np.zeros((size, 6))
    for number, point in enumerate(seat_points):
        coordinates[6 * number : 6 * number + 3] = rigid_motions(point[None, :])
        coordinates[6 * number + 3 : 6 * number + 6, 3:] = np.eye(3)
    return coordinates


def mass_properties(rigid_mass: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass, centre and inertia about the centre from the mass matrix (6, 6) of rigid motions about the origin."""
    mass = float(rigid_mass[0, 0])
    # Rotation about x moves the centre along y by -z_c, and so on: the coupling block is mass times the cross product with it.
    coupling = rigid_mass[:3, 3:] / mass
    centre = np.array([coupling[1, 2], coupling[2, 0], coupling[0, 1]])
    offset = mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    return mass, centre, rigid_mass[3:, 3:] - offset


@dataclass(frozen=True)
class Surface:
    """The outer faces of a body in triangles, and how they move.

    Attributes:
        points: (p, 3) in m, in model coordinates.
        triangles: (t, 3) numbers of points, counter-clockwise seen from outside.
        basis: (p, 3, n) displacement of the points for unit values of the body's coordinates.
    """

    points: np.ndarray
    triangles: np.ndarray
    basis: np.ndarray

    def normals_and_areas(self) -> tuple[np.ndarray, np.ndarray]:
        """Outward unit normals (t, 3) and areas (t,) in m^2 of the triangles."""
        a, b, c = (self.points[self.triangles[:, corner]] for corner in range(3))
        double = np.cross(b - a, c - a)
        length = np.linalg.norm(double, axis=1)
        return double / length[:, None], 0.5 * length

    def normal_motion(self) -> np.ndarray:
        """W (n, n) with q^H W q = sum of |n.u|^2 A over the triangles, u that of their middles, for coordinates q (n,)."""
        across = self._across()
        return np.asarray(across.T @ across)

    @cached_property
    def motion_of_sides(self) -> np.ndarray:
        """The parts (6, n, n) of W of the walls that stand at -x, +x, -y, +y, -z and +z of the body.

        Both faces of a wall belong to the side where it stands, whichever way they look: by the axis that their normal is
        nearest to, and by the half of the body that they are in.
        """
        normals, _ = self.normals_and_areas()
        centres = self.points[self.triangles].mean(axis=1)
        middle = 0.5 * (self.points.min(axis=0) + self.points.max(axis=0))
        axis = np.argmax(np.abs(normals), axis=1)
        far = centres[np.arange(len(axis)), axis] > middle[axis]
        across = self._across()
        walls = [across[2 * axis + far == side] for side in range(6)]
        return np.array([wall.T @ wall for wall in walls])

    def _across(self) -> np.ndarray:
        """Motion along the normals of the triangles, times the roots of their areas, (t, n)."""
        normals, areas = self.normals_and_areas()
        middle = self.basis[self.triangles].mean(axis=1)
        return np.asarray(np.sqrt(areas)[:, None] * np.einsum("tx,txn->tn", normals, middle))


@dataclass(frozen=True)
class ReducedBody:
    """Mass, stiffness and damping of an elastic body in n coordinates, the 6 s motions of its s seats first.

    Attributes:
        name: of the casing in the model file.
        seats: names of the seats, in the order of their motions.
        seat_points: (s, 3) point of each seat about which its rotations are, in m, in model coordinates.
        mass: (n, n) in kg, kg m, kg m^2; symmetric.
        stiffness: (n, n); symmetric, with the springs of mounts in it.
        damping: (n, n); symmetric, of the material and of the mounts.
        rigid: (n, 6) coordinates of the six rigid motions: unit displacements, and rotations about the origin of the model;
            None for a body that is held or mounted.
        inertia_force: (n, 6) Φᵀ M R: forces on the coordinates for unit accelerations along x y z and about the axes through the
            origin, so that gravity g acts by inertia_force[:, :3] @ g.
        body_mass: mass in kg.
        centre: (3,) centre of mass in m.
        inertia: (3, 3) inertia tensor about the centre of mass in kg m^2.
        fixed_frequency: (k,) frequencies in Hz of the fixed-interface modes that are kept.
        left_frequency: Hz, the least fixed-interface frequency that is not kept; inf where it is not known.
        error: (n, n) symmetric: λ² qᵀ error q is what a mode's λ = ω² is too large by reduction, for qᵀ M q = 1 over the whole
            structure; see `eigenvalue_error`. None where it is not known.
        surface: None for a body without a mesh.
        ground_sets: names of held sets and mounts.
        ground_force: (6 g, n) force, and moment about the origin, of the ground on the body at each of them for unit coordinates.
        ground_damping, ground_mass: (6 g, n) the same for unit velocities and accelerations of the coordinates.
        ground_weight: (6 g, 3) what gravity of 1 m/s^2 adds to it.
        held: whether held faces or mounts carry it; else it floats, and K has the six rigid motions.
        notes: sentences on what was done with the mesh, such as an order that was raised.
    """

    name: str
    seats: tuple[str, ...]
    seat_points: np.ndarray
    mass: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    rigid: np.ndarray | None
    inertia_force: np.ndarray
    body_mass: float
    centre: np.ndarray
    inertia: np.ndarray
    fixed_frequency: np.ndarray
    left_frequency: float = float("inf")
    error: np.ndarray | None = None
    surface: Surface | None = None
    ground_sets: tuple[str, ...] = ()
    ground_force: np.ndarray | None = None
    ground_damping: np.ndarray | None = None
    ground_mass: np.ndarray | None = None
    ground_weight: np.ndarray | None = None
    held: bool = False
    notes: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return len(self.mass)

    @property
    def interface(self) -> int:
        """Number 6 s of motions of the seats, which stand first."""
        return 6 * len(self.seats)

    @property
    def seat_motions(self) -> np.ndarray:
        """Coordinates (n, 6) in which all seats move as one rigid body, and the inside follows: `rigid` of a body that floats."""
        if self.rigid is not None:
            return self.rigid
        return rigid_coordinates(self.size, self.seat_points)

    def seat(self, name: str) -> slice:
        """The places of the six motions x y z rx ry rz of a seat among the coordinates."""
        first = 6 * self.seats.index(name)
        return slice(first, first + 6)

    def eigenvalue_error(self, eigenvalue: float, shape: np.ndarray) -> float | None:
        """How much too large a mode's λ = ω² is, relative to λ, because the body is reduced.

        The residual r = (K_fe - λ M_fe) Φ q of a mode in the inside of the body, met by the flexibility A of the body with its
        seats at rest: δλ = rᵀ A r = λ² qᵀ E q with the `error` E. As fixed-interface modes up to `left_frequency` are kept,
        what is left out answers at λ more than statically, by no more than 1 / (1 - λ / λ_left). Frequencies err by half of it.

        Args:
            eigenvalue: λ in (rad/s)^2.
            shape: (n,) coordinates of this body in the mode, real or complex, for a modal mass of 1 of the whole structure.
        """
        if self.error is None:
            return None
        static = eigenvalue * float(np.real(np.conj(shape) @ self.error @ shape))
        left_out = eigenvalue / (2.0 * np.pi * self.left_frequency) ** 2
        return static / (1.0 - left_out) if left_out < 1.0 else float("inf")

    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies (n,) in Hz and shapes (n, n), of modal mass 1, with the seats free; held as the body is."""
        eigenvalues, shapes = la.eigh(self.stiffness, self.mass)
        return np.sqrt(np.maximum(eigenvalues, 0.0)) / (2.0 * np.pi), shapes


def modal_damping(mass: np.ndarray, stiffness: np.ndarray, ratio: float) -> np.ndarray:
    """Damping matrix C (n, n) that gives every mode of (K, M) the same damping ratio ζ: C = M V diag(2 ζ ω) Vᵀ M."""
    eigenvalues, shapes = la.eigh(stiffness, mass)
    weighted = mass @ shapes
    # Rigid motions have eigenvalues of rounding, of either sign; no damping holds them to the ground.
    elastic = np.where(eigenvalues > 1e-9 * eigenvalues[-1], eigenvalues, 0.0)
    return np.asarray((weighted * (2.0 * ratio * np.sqrt(elastic))) @ weighted.T)
