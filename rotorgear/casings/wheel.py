"""A reduced gear body: its elastic coordinates beside the rigid motion of its bore, in axes that do not turn.

    u = R x + E p,    x: six motions of the gear's place on its shaft,   p: elastic coordinates, all with the bore at rest

The coordinates are modes of the body on its bore, of modal mass 1: K = diag(ω²) acts on p alone. Each belongs to a number n of
nodal diameters, those of n > 0 in pairs like cos nθ and sin nθ, so that a pair seen from the ground is a pair again, turned by
n times the angle of the body: with the matrices of `casings/wheel_reduction.py` the system does not depend on time. In the
axes of the gear: z along its shaft, the origin at its place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.casings.reduced_body import Surface


@dataclass(frozen=True)
class ReducedWheel:
    """A gear body in k elastic coordinates.

    Attributes:
        mass: (6 + k, 6 + k) of x and p, in kg, kg m, kg m^2.
        gyroscopic: (6 + k, 6 + k) for 1 rad/s, skew.
        frequency: (k,) of the coordinates at standstill in Hz, the bore at rest.
        diameters: (k,) nodal diameters n; pairs stand side by side.
        spin_stiffness: (k, k) S - H for 1 rad/s: centrifugal stiffening less what the rotating mass takes.
        turning: (k, k) L: turned with the body by a small angle dα, a field changes by -L p dα.
        damping_ratio: of every coordinate.
        body_mass: kg; polar_inertia, diametral_inertia: about the centre, kg m^2; centre: z of it in m.
        rim_motion: (6, k) mean motion of the rim about the origin for unit coordinates; x moves it rigidly.
        rim_cosine, rim_sine: (2, 3, k) displacement of the rim along radius, circumference and axis, by its cos nθ and sin nθ
            parts: at z = 0, and per m of z.
        rim_radius: m.
        modes: how many coordinates are modes of the mesh itself; the others answer statically to rim and acceleration.
        left_frequency: Hz, the least frequency of the mesh on its bore that is not kept.
        averaged: largest relative change of the kept modes' frequencies because the body is taken for one of revolution.
        notes: sentences on what was done with the mesh.
        mesh_error: largest estimated relative error, by the mesh, of the frequencies of its modes.
        surface: in the axes of the gear, with the displacements for unit coordinates p.
    """

    mass: np.ndarray
    gyroscopic: np.ndarray
    frequency: np.ndarray
    diameters: np.ndarray
    spin_stiffness: np.ndarray
    turning: np.ndarray
    damping_ratio: float
    body_mass: float
    polar_inertia: float
    diametral_inertia: float
    centre: float
    rim_motion: np.ndarray
    rim_cosine: np.ndarray
    rim_sine: np.ndarray
    rim_radius: float
    modes: int
    left_frequency: float
    averaged: float
    notes: tuple[str, ...] = ()
    mesh_error: float = 0.0
    surface: Surface | None = None

    @property
    def size(self) -> int:
        """Number k of elastic coordinates."""
        return len(self.frequency)

    @property
    def stiffness(self) -> np.ndarray:
        """ω² (k,) in (rad/s)^2."""
        return np.asarray((2.0 * np.pi * self.frequency) ** 2)

    @property
    def rim_flexibility(self) -> np.ndarray:
        """Static flexibility (6, 6) of the rim's mean motion against the bore, for forces and moments on the rim."""
        return np.asarray((self.rim_motion / self.stiffness) @ self.rim_motion.T)

    def foot(self, angle: float, radius: float, z: float) -> np.ndarray:
        """Motion (6, k) that teeth at a place of the rim share, as that of a rigid body about the origin, for unit coordinates.

        The rim turns and shifts as a whole by its mean motion. What it deforms beside moves the teeth that are at the angle along
        with their foot: in the middle of the face, and tilted as the foot tilts along z.

        Args:
            angle: rad from x, that does not turn with the body.
            radius, z: of the contact in m.
        """
        wave = self.diameters * angle
        local = self.rim_cosine * np.cos(wave) + self.rim_sine * np.sin(wave)
        c, s = np.cos(angle), np.sin(angle)
        axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        at, slope = axes @ local
        shift = self.rim_motion[:3]
        turn = self.rim_motion[3:]
        at = at - shift - np.cross(turn, self.rim_radius * axes[:, 0], axisa=0).T
        slope = slope - np.array([turn[1], -turn[0], np.zeros(self.size)])
        foot = self.rim_motion.copy()
        foot[3] -= slope[1]
        foot[4] += slope[0]
        foot[:2] += at[:2]
        # The tilt would lift the contact, which lies off the axis, along z: its own displacement there is that of the foot.
        foot[2] += at[2] + z * slope[2] + radius * (s * slope[1] + c * slope[0])
        return foot
