"""The blank below the teeth as an elastic body of revolution: rim, web and hub, held at the bore, one harmonic at a time.

A body of revolution keeps harmonics round its axis apart. With u_r = U cos n p, u_p = V sin n p, u_z = W cos n p
over the angle p,
    strains = (U_r, (U + n V)/r, W_z, U_z + W_r, V_r - (V + n U)/r, V_z - n W/r) = (B_0 + n B_1) (U, V, W)
are those of a plane problem over the section (r, z): K(n) = K_0 + n K_1 + n^2 K_2, assembled once, for spur and helical gears
alike, from quadratic rectangles. Every K(n) is condensed onto the outer circle, where the teeth stand. Young's modulus 1, lengths
in normal modules. Reference: E. L. Wilson, AIAA Journal 3 (1965) 2269, structural analysis of axisymmetric solids.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import CubicSpline
from scipy.sparse.linalg import splu

from rotorgear.gears.geometry.blank import BlankShape
from rotorgear.gears.tooth_fe import elasticity

# Largest side of an element over the thickness of its part, and in normal modules along the radius and along the axis. Along the
# axis it is no coarser than the layers of the teeth above: what they do between two nodes of the blank would meet no resistance.
_ACROSS_PART = 1.0 / 6.0
_RADIAL_SIDE = 3.0
AXIAL_SIDE = 0.8
# Harmonics up to here are worked out one by one; beyond, K(n) is so smooth that a spline through some of them serves.
_EVERY = 12
_STEP = 1.25

Rectangle = tuple[float, float, float, float]


def parts_of(shape: BlankShape, width: float, outer_radius: float) -> list[Rectangle]:
    """Rectangles (inner radius, outer radius, lowest z, highest z) of the section of a blank inside a circle."""
    half = 0.5 * width
    web = (shape.web_position - 0.5 * shape.web_thickness, shape.web_position + 0.5 * shape.web_thickness)
    found = [
        (shape.rim_radius, outer_radius, -half, half),
        (shape.hub_radius, shape.rim_radius, max(web[0], -half), min(web[1], half)),
        (shape.bore_radius, shape.hub_radius, -0.5 * shape.hub_width, 0.5 * shape.hub_width),
    ]
    # Parts that are not there, or a rim that belongs to the teeth wholly, have no height.
    return [part for part in found if part[1] - part[0] > 1e-9 * outer_radius]


class BlankSection:
    """A blank inside a circle: its stiffness at that circle for every harmonic.

    Args:
        shape: of the blank, in normal modules.
        width: of the rim.
        outer_radius: of the circle.
        poisson_ratio: of the material.
        axial_side: largest side of an element along the axis.
        coarseness: of all other sides over the usual ones.

    Attributes:
        z: (k,) places along the axis of the nodes on the circle, rising.
        weight: (k,) shares of the circle's width of these nodes, of quadratic shape functions.
        points: (p, 2) r and z of all nodes of the section.
        radius: (p,) r of them.
        inertia: (p, p) sparse, integral of N_a N_b r^2 over the volume of one radian.
        unknowns: degrees of freedom of the section.
    """

    def __init__(
        self,
        shape: BlankShape,
        width: float,
        outer_radius: float,
        poisson_ratio: float,
        axial_side: float = AXIAL_SIDE,
        coarseness: float = 1.0,
    ) -> None:
        points, cells = _section_mesh(parts_of(shape, width, outer_radius), axial_side, coarseness)
        self.points = points
        self.radius = points[:, 0]
        on_circle = self.radius > outer_radius * (1.0 - 1e-9)
        held = self.radius < shape.bore_radius * (1.0 + 1e-9)
        circle = np.flatnonzero(on_circle)
        self._circle = circle[np.argsort(points[circle, 1])]
        self._inside = np.flatnonzero(~on_circle & ~held)
        self._free = np.flatnonzero(~held)
        self._stiffness, self.inertia = _matrices(points, cells, poisson_ratio)
        self.z = points[self._circle, 1]
        self.weight = _line_shares(self.z)
        self.unknowns = 3 * len(points)

    def free_stiffness(self, harmonic: int) -> sp.csc_array:
        """K (3 p, 3 p) over one radian of amplitudes (U, V, W) of all nodes, one after the other, before the bore is held."""
        K_0, K_1, K_2 = self._stiffness
        return sp.csc_array(K_0 + harmonic * K_1 + harmonic**2 * K_2)

    def stiffness(self, harmonic: int) -> np.ndarray:
        """K (3 k, 3 k) of the amplitudes of the nodes on the circle: the bore held, all others condensed."""
        return elasticity.condensed(
            self.free_stiffness(harmonic), elasticity.node_dofs(self._inside, 3), elasticity.node_dofs(self._circle, 3)
        )

    def stiffnesses(self, harmonics: int) -> Callable[[int], np.ndarray]:
        """K (3 k, 3 k) by harmonic, 0 to `harmonics`; those beyond the twelfth by a spline through some of them."""
        chosen = list(range(min(_EVERY, harmonics) + 1))
        while chosen[-1] < harmonics:
            chosen.append(min(harmonics, max(chosen[-1] + 1, round(_STEP * chosen[-1]))))
        # A spline passes through what it was made of.
        return CubicSpline(chosen, np.array([self.stiffness(n) for n in chosen]))

    def twist(self) -> np.ndarray:
        """Rotation V/r (p,) of all nodes where a unit torque acts on the circle, spread evenly over its width."""
        K = self._stiffness[0]
        free = self._free
        tangential = 3 * free + 1
        force = np.zeros(len(self.radius))
        force[self._circle] = self.weight / (2.0 * np.pi * self.radius[self._circle])
        moved = np.zeros(len(self.radius))
        moved[free] = splu(sp.csc_matrix(K[tangential][:, tangential])).solve(force[free])
        return moved / self.radius

    def circle_mean(self, values: np.ndarray) -> float:
        """Mean over the width of the circle of a nodal field (p,)."""
        return float(self.weight @ values[self._circle])

    def polar_moment(self, first: np.ndarray, second: np.ndarray) -> float:
        """Integral of first second r^2 over the volume for two nodal fields (p,), such as rotations."""
        return float(2.0 * np.pi * first @ (self.inertia @ second))


@dataclass(frozen=True)
class BlankTorsion:
    """A gear whose teeth turn against their bore.

    Attributes:
        flexibility: rotation of the root circle against the bore over the torque, in rad/(N m) or for a Young's modulus and a
            normal module of 1.
        polar_share: (2, 2) polar moment of inertia about (bore, teeth), over the whole: what lies between turns with both, in the
            shape of the static twist.
    """

    flexibility: float
    polar_share: np.ndarray


def blank_torsion(shape: BlankShape, width: float, radii: tuple[float, float], poisson_ratio: float) -> BlankTorsion:
    """Torsion of a blank; radii: of the root circle and of the reference circle, up to which teeth count as solid."""
    root, outside = radii
    section = BlankSection(shape, width, root, poisson_ratio)
    twist = section.twist()
    flexibility = section.circle_mean(twist)
    teeth = twist / flexibility
    bore = 1.0 - teeth
    cross = section.polar_moment(bore, teeth)
    ring = 0.5 * np.pi * width * (outside**4 - root**4)
    polar = np.array([[section.polar_moment(bore, bore), cross], [cross, section.polar_moment(teeth, teeth) + ring]])
    return BlankTorsion(flexibility, polar / polar.sum())


def torsional_flexibility(shape: BlankShape, width: float, root_radius: float, poisson_ratio: float) -> float:
    """Mean rotation of the root circle against the bore for a unit torque, without the teeth."""
    section = BlankSection(shape, width, root_radius, poisson_ratio)
    return section.circle_mean(section.twist())


def _section_mesh(parts: Sequence[Rectangle], axial_side: float, coarseness: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (p, 2) and cells (9, e) of quadratic rectangles over the parts of a section, on lines that all parts share."""
    across = coarseness * _ACROSS_PART
    r = _lines([part[:2] for part in parts], coarseness * _RADIAL_SIDE, across)
    z = _lines([part[2:] for part in parts], axial_side, across)
    rows, columns = np.meshgrid(np.arange(len(r) - 1), np.arange(len(z) - 1), indexing="ij")
    x = 0.5 * (r[rows] + r[rows + 1])
    y = 0.5 * (z[columns] + z[columns + 1])
    inside = np.zeros(x.shape, bool)
    for inner, outer, low, high in parts:
        inside |= (x > inner) & (x < outer) & (y > low) & (y < high)
    first = np.stack([rows[inside], columns[inside]], -1)

    # Nodes on a lattice twice as fine, three by three in each cell; those of no cell are left out.
    step = np.array([[i, j] for i in range(3) for j in range(3)])
    lattice = 2 * first[:, None, :] + step
    used, cells = np.unique(lattice.reshape(-1, 2), axis=0, return_inverse=True)
    points = np.stack([elasticity.with_middles(r)[used[:, 0]], elasticity.with_middles(z)[used[:, 1]]], -1)
    return points, cells.reshape(-1, 9).T


def _lines(intervals: Sequence[Sequence[float]], largest: float, across: float) -> np.ndarray:
    """Lines through the ends of all intervals, and between them so close that each interval has a few elements."""
    ends = np.unique(np.round(np.concatenate([np.asarray(interval) for interval in intervals]), 9))
    found = [ends[:1]]
    for low, high in pairwise(ends):
        middle = 0.5 * (low + high)
        side = min((across * (b - a) for a, b in intervals if a < middle < b), default=largest)
        count = max(1, int(np.ceil((high - low) / min(side, largest) - 1e-9)))
        found.append(np.linspace(low, high, count + 1)[1:])
    return np.concatenate(found)


def _line_shares(z: np.ndarray) -> np.ndarray:
    """Integrals of the quadratic shape functions along a line of nodes (2 e + 1,), over its length."""
    shares = np.zeros(len(z))
    for i in range(0, len(z) - 1, 2):
        shares[i : i + 3] += (z[i + 2] - z[i]) * np.array([1.0, 4.0, 1.0]) / 6.0
    return shares / (z[-1] - z[0])


def _matrices(
    points: np.ndarray, cells: np.ndarray, poisson_ratio: float
) -> tuple[tuple[sp.csc_array, sp.csc_array, sp.csc_array], sp.csc_array]:
    """K_0, K_1, K_2 over one radian, the three amplitudes of a node after each other, and the matrix of r^2 over a radian."""
    lam, mu = elasticity.lame(poisson_ratio)
    D = np.diag([2.0 * mu] * 3 + [mu] * 3)
    D[:3, :3] += lam

    # Quadratic shape functions in r and z and their products at 4 x 4 Gauss points: 1/r is no polynomial.
    t, weight = np.polynomial.legendre.leggauss(4)
    line = elasticity.quadratic(t).T
    slope = np.stack([t - 0.5, -2.0 * t, t + 0.5])
    N = np.einsum("ap,bq->abpq", line, line).reshape(9, -1)
    by_r = np.einsum("ap,bq->abpq", slope, line).reshape(9, -1)
    by_z = np.einsum("ap,bq->abpq", line, slope).reshape(9, -1)
    size = 0.5 * (points[cells[8]] - points[cells[0]])  # half the sides (e, 2)
    r = points[cells[0], 0][:, None] + size[:, :1] * np.repeat(1.0 + t, 4)
    area = size[:, :1] * size[:, 1:] * np.outer(weight, weight).ravel() * r

    e, q = r.shape
    B_0 = np.zeros((e, q, 6, 9, 3))
    B_1 = np.zeros_like(B_0)
    over_r = N.T / r[:, :, None]
    N_r = by_r.T / size[:, :1, None]
    N_z = by_z.T / size[:, 1:, None]
    B_0[:, :, 0, :, 0] = N_r
    B_0[:, :, 1, :, 0] = over_r
    B_0[:, :, 2, :, 2] = N_z
    B_0[:, :, 3, :, 0] = N_z
    B_0[:, :, 3, :, 2] = N_r
    B_0[:, :, 4, :, 1] = N_r - over_r
    B_0[:, :, 5, :, 1] = N_z
    B_1[:, :, 1, :, 1] = over_r
    B_1[:, :, 4, :, 0] = -over_r
    B_1[:, :, 5, :, 2] = -over_r
    # Points and strains of a cell as one row: each product is one multiplication of matrices a cell.
    stress_0, stress_1 = (
        (np.einsum("ij,eqjac->eqiac", D, B) * area[:, :, None, None, None]).reshape(e, 6 * q, 27) for B in (B_0, B_1)
    )
    strain_0, strain_1 = (B.reshape(e, 6 * q, 27).transpose(0, 2, 1) for B in (B_0, B_1))
    dofs = elasticity.component_dofs(cells, 3)
    mixed = strain_0 @ stress_1
    blocks = (strain_0 @ stress_0, mixed + mixed.transpose(0, 2, 1), strain_1 @ stress_1)
    K_0, K_1, K_2 = (elasticity.assembled(block, dofs, 3 * len(points)) for block in blocks)
    inertia = elasticity.assembled(
        np.einsum("aq,bq,eq->eab", N, N, area * r**2), elasticity.component_dofs(cells, 1), len(points)
    )
    return (K_0, K_1, K_2), inertia
