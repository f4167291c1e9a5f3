"""Timoshenko shaft element with two nodes, cylindrical or conical: bending in two planes, axial, torsion.

The shape functions are the exact static ones of the element (Przemieniecki, Theory of Matrix Structural Analysis, 1968, for the
uniform element; here from the flexibility of the variable section, so a cone is exact as well). In one plane, with the slope
theta, the mid moment m and the shear force V, M(s) = m + V (L/2 - s):

    [ theta_2 - theta_1                         ]       [ int 1/EI          int (L/2-s)/EI                  ] [ m ]
    [ w_2 - w_1 - L (theta_1 + theta_2)/2       ]   =   [ int (L/2-s)/EI    int (L/2-s)^2/EI + 1/(kappa G A) ] [ V ]

The inverse of that flexibility is the constitutive matrix D of the two bending strains on the left. Inertia is consistent:
rho A for displacements, rho I for theta_x and theta_y, 2 rho I for theta_z and gyroscopic terms (Nelson and McVaugh, ASME J.
Eng. Ind. 98, 1976).
"""

from __future__ import annotations

import numpy as np

from rotorgear.elements.matrices import ElementMatrices, kept_by_content
from rotorgear.elements.shaft_bubbles import bubble_motions, shaft_bubbles
from rotorgear.elements.shaft_section import ShaftElements, gauss, is_uniform, point_count, section

_NODAL_STRAINS = ("axial", "torsion", "bending", "bending", "bending", "bending")


def shaft_elements(
    data: ShaftElements, *, order: int = 1, lumped: bool = False, internal_damping: float = 0.0
) -> ElementMatrices:
    """Return the matrices of all elements in the order x1 y1 z1 theta_x1 theta_y1 theta_z1 x2 ... theta_z2, then the bubbles.

    Args:
        data: sizes and material of e elements.
        order: 1 for the basic element; p >= 2 adds the bubbles of `shaft_bubbles`.
        lumped: half of the mass and inertia at each node instead of consistent inertia; of order 1 only.
        internal_damping: eta in s of the rotating damping C = eta K.
    """
    # Shafts are made of many equal elements: compute each kind once.
    kinds, which = data.unique()
    one = distinct_elements(kinds, order=order, lumped=lumped, internal_damping=internal_damping)
    terms = {name: getattr(one, name) for name in one.__dataclass_fields__}
    return ElementMatrices(**{name: None if term is None else term[which] for name, term in terms.items()})


@kept_by_content(rows=32, results=128)
def distinct_elements(
    kinds: ShaftElements, *, order: int = 1, lumped: bool = False, internal_damping: float = 0.0
) -> ElementMatrices:
    """The same as `shaft_elements`, computed for every element as if no two were equal; known kinds are not computed again."""
    points = point_count(kinds, order)
    strain, modulus, fields, weights = _statics(kinds, points)

    # A quarter turn R about z in terms of strains, B R = P B: the strains of the two planes of bending change places.
    turn = np.zeros((6, 6))
    turn[2:4, 4:6] = -np.eye(2)
    turn[4:6, 2:4] = np.eye(2)
    if order > 1 and not lumped:
        of_bubbles, R, turn_of_bubbles = shaft_bubbles(kinds, order, points)
        fields = np.concatenate([fields, of_bubbles], axis=3)
        strain = _block(strain, R)
        modulus = _block(modulus, np.eye(R.shape[1])[None])  # their stiffness is R^T R already
        turn = _block(turn[None], turn_of_bubbles[None])[0]
    mass, gyroscopic = _lumped(kinds, points) if lumped else _consistent(kinds, fields, weights)

    # Damping in the rotating material, eta d(strain)/dt there: seen from rest, C = eta K and a circulation -W eta B^T D P B.
    viscosity = circulation = None
    if internal_damping > 0.0:
        viscosity = internal_damping * modulus
        circulation = -internal_damping * modulus @ turn
    return ElementMatrices(
        strain=strain,
        modulus=modulus,
        mass=mass,
        viscosity=viscosity,
        gyroscopic=gyroscopic,
        circulation_per_speed=circulation,
    )


def inner_fields(data: ShaftElements, order: int) -> tuple[np.ndarray, np.ndarray]:
    """Places between the nodes (g,) from 0 to 1, and the displacements x ... theta_z there from the dofs, (6, e, g, d)."""
    points = point_count(data, order)
    fields = _statics(data, points)[2]
    if order > 1:
        fields = np.concatenate([fields, shaft_bubbles(data, order, points)[0]], axis=3)
    return gauss(points)[0], fields


def strain_motions(order: int, shear: bool = True) -> tuple[str, ...]:
    """Motion that each strain of an element belongs to."""
    return _NODAL_STRAINS + bubble_motions(order, shear)


def _block(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Block diagonal of (e, a, b) and (e or 1, c, d)."""
    e, a, b = first.shape
    _, c, d = second.shape
    whole = np.zeros((e, a + c, b + d))
    whole[:, :a, :b] = first
    whole[:, a:, b:] = second
    return whole


def _statics(data: ShaftElements, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """What follows from statics of e elements at g Gauss points.

    Returns:
        B (e, 6, 12), D (e, 6, 6), the fields x ... theta_z at the points from the dofs (6, e, g, 12), weights (e, g) in m.
    """
    points, weights, cumulative = gauss(count)
    L = data.length[:, None]
    area, inertia, ratio = section(data.stiffness_diameters, points)
    kappa = data.kappa(ratio)
    E = data.youngs_modulus[:, None]
    G = data.shear_modulus[:, None]

    # Flexibilities per length, and the constitutive matrix as the inverse of their integrals.
    bend = 1.0 / (E * inertia)
    shear = 1.0 / (kappa * G * area)
    stretch = 1.0 / (E * area)
    twist = 1.0 / (2.0 * G * inertia)  # J = 2 I of a circle
    arm = L * (0.5 - points)  # lever of the shear force about the mid-point
    W = L * weights
    D = np.zeros((len(data.length), 6, 6))
    D[:, 0, 0] = 1.0 / np.sum(W * stretch, 1)
    D[:, 1, 1] = 1.0 / np.sum(W * twist, 1)
    a0 = np.sum(W * bend, 1)
    a1 = np.sum(W * bend * arm, 1)
    a2 = np.sum(W * (bend * arm**2 + shear), 1)
    if is_uniform(data):
        a1 = np.zeros_like(a1)  # odd integrand: rounding must not couple moment and shear
    plane = np.stack([np.stack([a2, -a1], -1), np.stack([-a1, a0], -1)], -2) / (a0 * a2 - a1**2)[:, None, None]
    D[:, 2:4, 2:4] = D[:, 4:6, 4:6] = plane

    # Strains: stretch, twist, then change of slope and mean shear in the plane xz, where w = x and slope = theta_y, and in the
    # plane yz, where w = y and slope = -theta_x.
    B = np.zeros((len(data.length), 6, 12))
    B[:, 0, [2, 8]] = (-1.0, 1.0)
    B[:, 1, [5, 11]] = (-1.0, 1.0)
    for row, w, t, sense in ((2, 0, 4, 1.0), (4, 1, 3, -1.0)):
        B[:, row, t] = -sense
        B[:, row, t + 6] = sense
        B[:, row + 1, w] = -1.0
        B[:, row + 1, w + 6] = 1.0
        B[:, row + 1, t] = B[:, row + 1, t + 6] = -sense * 0.5 * data.length

    # Bending shapes of one plane from (w1, theta1, w2, theta2), each (e, g, 4). Its strains make m and V, those bend and shear
    # the element from its left end on; the motion of that end itself is rigid.
    force = plane @ B[:, 2:4, [0, 4, 6, 10]]
    slope = np.stack([L * (bend @ cumulative.T), L * ((bend * arm) @ cumulative.T)], -1) @ force
    deflection = L[:, :, None] * (cumulative @ slope) + (L * (shear @ cumulative.T))[:, :, None] * force[:, 1:2]
    rigid = np.zeros((len(data.length), len(points), 4))
    rigid[:, :, 0] = 1.0
    rigid[:, :, 1] = L * points
    deflection += rigid
    slope[:, :, 1] += 1.0

    # Shares of the axial displacement and of the twist that come from the right node.
    axial = L * (stretch @ cumulative.T) * D[:, :1, 0]
    torsion = L * (twist @ cumulative.T) * D[:, 1:2, 1]

    # Plane xz: slope = theta_y. Plane yz: slope = -theta_x, so its rotations enter and leave with the other sign.
    fields = np.zeros((6, len(data.length), len(points), 12))
    xz = [0, 4, 6, 10]
    yz = [1, 3, 7, 9]
    sign = np.array([1.0, -1.0, 1.0, -1.0])
    fields[0][:, :, xz] = deflection
    fields[4][:, :, xz] = slope
    fields[1][:, :, yz] = deflection * sign
    fields[3][:, :, yz] = -slope * sign
    fields[2][:, :, 2] = 1.0 - axial
    fields[2][:, :, 8] = axial
    fields[5][:, :, 5] = 1.0 - torsion
    fields[5][:, :, 11] = torsion
    return B, D, fields, W


def _consistent(data: ShaftElements, fields: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Consistent mass and gyroscopic matrices, each (e, d, d)."""
    points, _, _ = gauss(fields.shape[2])
    area, inertia, _ = section(data.mass_diameters, points)  # a shrunk-on sleeve may add mass but no stiffness
    translation = weights * data.density[:, None] * area
    tilt = weights * data.density[:, None] * inertia
    M = np.zeros((len(data.length), fields.shape[3], fields.shape[3]))
    for number, weight in enumerate([translation, translation, translation, tilt, tilt, 2.0 * tilt]):
        N = fields[number]
        M += np.swapaxes(N, 1, 2) @ (weight[:, :, None] * N)
    # G of a slice is 2 rho I (theta_x theta_y' - theta_y theta_x'): one product, less its transpose.
    half = np.swapaxes(fields[3], 1, 2) @ (2.0 * tilt[:, :, None] * fields[4])
    return 0.5 * (M + np.swapaxes(M, 1, 2)), half - np.swapaxes(half, 1, 2)


def _lumped(data: ShaftElements, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Half of the element's mass and inertia at each node."""
    points, weights, _ = gauss(count)
    area, inertia, _ = section(data.mass_diameters, points)
    rho = (data.length * data.density)[:, None] * weights
    m = 0.5 * np.sum(rho * area, 1)
    tilt = 0.5 * np.sum(rho * inertia, 1)
    diagonal = np.stack([m, m, m, tilt, tilt, 2.0 * tilt] * 2, -1)
    M = diagonal[:, :, None] * np.eye(12)
    G = np.zeros_like(M)
    for k in (3, 9):
        G[:, k, k + 1] = 2.0 * tilt
        G[:, k + 1, k] = -2.0 * tilt
    return M, G
