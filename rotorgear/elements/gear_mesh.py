"""A mesh of one helix as a spring along the flank normal. The only place where hand, helix and torque sense become a sign.

    e = (cos psi, sin psi, 0)      t = (-sin psi, cos psi, 0)      n_t = s cos a t + sin a e
    n = cos b n_t - s h sin b k                                     (direction of the force on the gear)
    v_p = [ n ; ( r_w1 e + xi n_t + z_cp k) x n ]      v_g = [ -n ; -(-r_w2 e + xi n_t + z_cg k) x n ]
    K = k v v^T

Along the face, a place z from the contact's plane approaches by v . q + z (v_t . q), with the tilt of the gears about the
normal of the plane of action,

    v_t = [ 0 ; cos b k x n_t ; 0 ; -cos b k x n_t ].

A mesh that carries over the width of its face resists it too. With the centre of its stiffness at a place e from the middle,

    v_e = v + e v_t,      K = k v_e v_e^T + k_t v_t v_t^T,

k_t = k b^2/12 for a stiffness that is uniform over a width b. A gear that is cut on its shaft bends and twists with it: its
part of v_t is then the difference of v at the nodes of both ends of the face over their distance.

One contact point serves both bodies: that makes all six rigid motions of the pair free of strain. (The widespread form with
each gear's arm to its own base tangent point fails a rigid tilt by up to a_w sin a sin b per rad.) Conventions:
docs/conventions.md.

Bevel gears (gears/geometry/bevel.py) push in the same way at the mean point of their pitch cones. The pitch line, away from the
apex, stands in the place of k, and e leaves the pinion's cone at right angles to it: with the radial direction e_r of the pitch
point and a = +-k away from the apex,

    k -> sin d_1 e_r + cos d_1 a      e -> cos d_1 e_r - sin d_1 a      -e (gear's arm) -> -cos S e_r + sin S a

All this is told in the frame of the pinion's shaft. Where the gear's shaft has other directions, its entries are turned into
them by Q = R_g' R_p, with the axes of both shafts in the columns of R:

    v = [ n ; (P - O_p) x n ; -Q n ; -Q ((P - O_g) x n) ].
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np

from rotorgear.elements.matrices import ElementMatrices


@dataclass(frozen=True)
class Cone:
    """What a contact of bevel gears has beside that of cylindrical ones.

    Attributes:
        pitch_angle: d_1 of the pinion in rad.
        shaft_angle: S in rad, between the axes away from the apex.
        sides: for pinion and gear +1 where z of the shaft leads away from the apex, -1 where it leads to it.
    """

    pitch_angle: float
    shaft_angle: float
    sides: tuple[int, int]


@dataclass(frozen=True)
class ContactGeometry:
    """Geometry of one contact line (m, rad).

    Attributes:
        psi: direction from pinion to gear from +x.
        pressure_angle: working transverse pressure angle a.
        base_helix_angle: b.
        hand: h, +1/-1 for a right/left hand of the pinion's helix, 0 for spur.
        torque_sense: s, sense about +z of the torque that the pinion's shaft puts into the pinion.
        pinion_base_radius: r_b1.
        gear_base_radius: r_b2.
        pinion_offset: z of the contact's plane minus z of the pinion's node.
        gear_offset: z of the contact's plane minus z of the gear's node.
        contact_position: xi, from the pitch point along the line of action.
        turn: Q, rows of (3, 3), directions of the pinion's shaft in those of the gear's; None where both are the same.
        gear_node: (x, y, z) of the gear's node from that of the pinion, beside a turn and where both are known.
        cone: of bevel gears.
    """

    psi: float
    pressure_angle: float
    base_helix_angle: float
    hand: int
    torque_sense: int
    pinion_base_radius: float
    gear_base_radius: float
    pinion_offset: float = 0.0
    gear_offset: float = 0.0
    contact_position: float = 0.0
    turn: tuple[tuple[float, ...], ...] | None = None
    gear_node: tuple[float, ...] | None = None
    cone: Cone | None = None


@dataclass(frozen=True)
class Face:
    """How a mesh carries along its face.

    Attributes:
        place: e (m), centre of its stiffness from the plane of the contact.
        tilt_stiffness: k_t (N m), moment about the place for a tilt in m/m.
        length: distance (m) of the ends of the face, for gears that are cut on their shafts.
        integral: whether pinion and gear are cut on their shafts.
    """

    place: float
    tilt_stiffness: float
    length: float = 0.0
    integral: tuple[bool, bool] = (False, False)


def flank_normal(geometry: ContactGeometry) -> np.ndarray:
    """Direction of the force on the gear, a unit vector (3,)."""
    g = geometry
    side = g.cone.sides[0] if g.cone else 1
    axial = -side * g.torque_sense * g.hand * sin(g.base_helix_angle) * _frame(g)[2]
    return cos(g.base_helix_angle) * _transverse_normal(g) + axial


def contact_vector(geometry: ContactGeometry) -> np.ndarray:
    """The 12 entries (v_p, v_g) that give the approach of the flanks from the dofs of pinion and gear, shape (12,)."""
    return _relative(geometry, flank_normal(geometry), geometry.contact_position * _transverse_normal(geometry))


def tilt_vector(geometry: ContactGeometry) -> np.ndarray:
    """The 12 entries v_t that give the tilt of the flanks along the face, approach per metre of z, from the dofs, shape (12,)."""
    # n . (theta x z k) = z theta . (k x n); the axial part of n drops out.
    turned = cos(geometry.base_helix_angle) * np.cross(_frame(geometry)[2], _transverse_normal(geometry))
    return _turned(geometry, np.concatenate([np.zeros(3), turned, np.zeros(3), -turned]))


def sliding_vectors(geometry: ContactGeometry) -> np.ndarray:
    """What the dofs of pinion and gear add to the sliding of the flanks.

    Returns:
        Shape (2, 12). First row: displacement across the line of action (along k x n_t) of the pinion relative to the gear,
        at the pitch point. Second row: what a contact at xi adds to it for each metre of xi.
    """
    k = _frame(geometry)[2]
    across = np.cross(k, _transverse_normal(geometry))
    # A rotation theta_z carries a point that lies xi along n_t by xi theta_z across it; theta_x and theta_y do not.
    turned = _turned(geometry, np.concatenate([np.zeros(3), k, np.zeros(3), -k]))
    return np.array([_relative(geometry, across, np.zeros(3)), turned])


def _transverse_normal(geometry: ContactGeometry) -> np.ndarray:
    """n_t, the flank normal of the transverse plane, (3,)."""
    e, t, _ = _frame(geometry)
    return geometry.torque_sense * cos(geometry.pressure_angle) * t + sin(geometry.pressure_angle) * e


def _relative(geometry: ContactGeometry, direction: np.ndarray, beside: np.ndarray) -> np.ndarray:
    """Displacement of the pinion relative to the gear along a direction (3,), from their dofs, (12,).

    It is that of one point of both bodies, which lies `beside` (3,) the pitch point in the plane of the contact.
    """
    g = geometry
    radial = np.array([cos(g.psi), sin(g.psi), 0.0])
    k = np.array([0.0, 0.0, 1.0])
    back = -radial
    gear_k = k
    if g.cone is not None:
        away = g.cone.sides[0] * k
        S = g.cone.shaft_angle
        back = sin(S) * away - cos(S) * radial
        gear_k = g.cone.sides[1] * (cos(S) * away + sin(S) * radial)
    # Arms from both nodes to the same point: working radius r_w = r_b / cos a, then along the line of action.
    pinion = g.pinion_base_radius / cos(g.pressure_angle) * radial + beside + g.pinion_offset * k
    gear = g.gear_base_radius / cos(g.pressure_angle) * back + beside + g.gear_offset * gear_k
    if g.gear_node is not None:
        gear = pinion - np.array(g.gear_node)
    return _turned(g, np.concatenate([direction, np.cross(pinion, direction), -direction, -np.cross(gear, direction)]))


def _turned(geometry: ContactGeometry, vector: np.ndarray) -> np.ndarray:
    """Entries (12,) in the directions of the pinion's shaft, those of the gear in the directions of its own."""
    if geometry.turn is not None:
        vector[6:] = (vector[6:].reshape(2, 3) @ np.transpose(geometry.turn)).ravel()
    return vector


def face_strains(geometry: ContactGeometry, face: Face) -> np.ndarray:
    """Approach at the place of the face and tilt along it from the dofs, shape (2, d).

    The dofs are those of pinion and gear, then those at the smaller and the larger z of the face of each gear that is cut on its
    shaft: d = 12, 24 or 36.
    """
    sides = (slice(0, 6), slice(6, 12))
    tilt = tilt_vector(geometry)
    # At the ends of a face the node stands in the plane of the contact.
    at_ends = contact_vector(replace(geometry, pinion_offset=0.0, gear_offset=0.0, gear_node=None))
    ends = []
    for side, integral in zip(sides, face.integral, strict=True):
        if integral:
            tilt[side] = 0.0
            ends += [-at_ends[side] / face.length, at_ends[side] / face.length]
    along = np.concatenate([tilt, *ends])
    middle = np.pad(contact_vector(geometry), (0, len(along) - 12))
    return np.array([middle + face.place * along, along])


def gear_mesh(
    geometry: ContactGeometry, stiffness: float, damping: float = 0.0, face: Face | None = None
) -> ElementMatrices:
    """Spring (N/m) and damper (N s/m) along the flank normal between pinion and gear.

    Without a face it has 12 dofs and one strain, the approach of the flanks; with a face the dofs of `face_strains` and a second
    strain, their tilt, damped in the same proportion.
    """
    if face is None:
        return ElementMatrices(
            strain=contact_vector(geometry)[None, None],
            modulus=np.array([[[stiffness]]]),
            viscosity=np.array([[[damping]]]) if damping else None,
        )
    modulus = np.diag([stiffness, face.tilt_stiffness])
    return ElementMatrices(
        strain=face_strains(geometry, face)[None],
        modulus=modulus[None],
        viscosity=damping / stiffness * modulus[None] if damping else None,
    )


def equivalent_mass_torsion(
    first_inertia: float, second_inertia: float, first_radius: float, second_radius: float
) -> float:
    """m_e = J1 J2/(J1 r2^2 + J2 r1^2) in kg of two bodies on base radii; 0 where one of them has no inertia."""
    product = first_inertia * second_inertia
    return product / (first_inertia * second_radius**2 + second_inertia * first_radius**2) if product else 0.0


def equivalent_mass_general(geometry: ContactGeometry, first: np.ndarray, second: np.ndarray) -> float:
    """m_e in kg with 1/m_e = v^T M^-1 v over the gears' own inertia; `first`, `second` are (6,) diagonals of M.

    A direction without inertia gives way freely: m_e is then 0.
    """
    v = contact_vector(geometry)
    inertia = np.concatenate([first, second])
    moved = v != 0.0  # a mesh of spur teeth does not move z, and such a direction may be without inertia
    if np.any(inertia[moved] <= 0.0):
        return 0.0
    return float(1.0 / np.sum(v[moved] ** 2 / inertia[moved]))


def _frame(geometry: ContactGeometry) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """e from pinion to gear, t across it, and k along the pitch line, each (3,)."""
    psi = geometry.psi
    radial = np.array([cos(psi), sin(psi), 0.0])
    t = np.array([-sin(psi), cos(psi), 0.0])
    k = np.array([0.0, 0.0, 1.0])
    if geometry.cone is None:
        return radial, t, k
    delta = geometry.cone.pitch_angle
    away = geometry.cone.sides[0] * k
    return cos(delta) * radial - sin(delta) * away, t, sin(delta) * radial + cos(delta) * away
