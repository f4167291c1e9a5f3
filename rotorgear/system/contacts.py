"""The contacts of a system as lines: vectors v with the approach of the flanks v . q, stiffness and damping along them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.elements.gear_mesh import face_strains
from rotorgear.model.layout.state import MeshForce
from rotorgear.system.groups import contact_geometry, face_of
from rotorgear.system.system import System


@dataclass(frozen=True)
class ContactLines:
    """c contacts, in the order of the file, helices from left to right.

    Attributes:
        states: mean state of each contact, with its geometry.
        vectors: v over the free dofs, (n, c); turned: dv/dpsi, the change when the centre line turns, (n, c).
        rotation: r_b1 tz_1 + r_b2 tz_2 over the free dofs in the sense that presses the teeth, (n, c), in m along the line
            of action of the transverse plane.
        stiffness, damping: N/m and N s/m along the flank normal, (c,); gap: m that must close before a contact carries, (c,).
        tilt: v_t over the free dofs, tilt of the flanks along the face, (n, c).
        tilted: dv_t/dpsi, (n, c).
        tilt_stiffness: N m, (c,), 0 where a contact does not resist the tilt.
        start: N, force of a contact whose flanks have not approached, (c,): F = start + k (v . q - gap).
        couple: N m about the contact's place without tilt, (c,): M - e F = couple + k_t (v_t . q).
    """

    states: tuple[MeshForce, ...]
    vectors: np.ndarray
    turned: np.ndarray
    rotation: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    gap: np.ndarray
    tilt: np.ndarray
    tilted: np.ndarray
    tilt_stiffness: np.ndarray
    start: np.ndarray
    couple: np.ndarray

    def force(self, q: np.ndarray) -> np.ndarray:
        """Force (c,) along the flank normals at the displacements q (n,) of the free dofs, were all contacts closed."""
        return np.asarray(self.start + self.stiffness * (self.vectors.T @ q - self.gap))

    def moment(self, q: np.ndarray) -> np.ndarray:
        """Moment (c,) against the tilt of the flanks about the places of contact, in N m."""
        return np.asarray(self.couple + self.tilt_stiffness * (self.tilt.T @ q))

    @property
    def names(self) -> tuple[str, ...]:
        """Name of the mesh of each contact."""
        return tuple(state.contact.mesh for state in self.states)


def contact_lines(system: System) -> ContactLines:
    """Return the contacts of a system as vectors over its free degrees of freedom."""
    states = system.state.forces
    groups = [group for group in system.groups if group.part.startswith("meshes.")]
    count = len(states)
    size = system.dofs.transform.shape[0]
    v, turned, rotation, tilt, tilted = np.zeros((5, size, count))
    stiffness, damping, gap, tilt_stiffness, start, couple = np.zeros((6, count))
    for k, (state, group) in enumerate(zip(states, groups, strict=True)):
        strain = group.matrices.strain
        D = group.matrices.modulus
        V = group.matrices.viscosity
        assert strain is not None
        assert D is not None
        stiffness[k] = D[0, 0, 0]
        damping[k] = 0.0 if V is None else V[0, 0, 0]
        dofs = group.dofs[0]
        v[dofs, k] = strain[0, 0]
        turned[dofs, k] = _quarter_turn(strain[0, 0])
        rotation[dofs[:12], k] = rotation_vector(state)
        gap[k] = state.gap(system.layout.mesh(state.contact.mesh).part)
        v_t = face_strains(contact_geometry(state), face_of(system.layout, state))[1]
        tilt[dofs, k] = v_t
        tilted[dofs, k] = _quarter_turn(v_t)
        start[k] = state.start or 0.0
        if state.face is not None:
            tilt_stiffness[k] = state.face.tilt_stiffness
            couple[k] = state.face.couple
    T = system.dofs.transform.T
    return ContactLines(
        states=states,
        vectors=T @ v,
        turned=T @ turned,
        rotation=T @ rotation,
        stiffness=stiffness,
        damping=damping,
        gap=gap,
        tilt=T @ tilt,
        tilted=T @ tilted,
        tilt_stiffness=tilt_stiffness,
        start=start,
        couple=couple,
    )


def rotation_vector(state: MeshForce) -> np.ndarray:
    """r_b1 tz_1 + r_b2 tz_2 over the dofs of pinion and gear, (12,), in the sense that presses the teeth."""
    found = np.zeros(12)
    found[5] = state.torque_sense * state.contact.pinion_base_radius
    found[11] = state.torque_sense * state.contact.gear_base_radius
    return found


def _quarter_turn(vector: np.ndarray) -> np.ndarray:
    """d/dpsi of a contact vector: displacements and rotations in the plane turn with the centre line."""
    out = np.zeros_like(vector)
    for first in range(0, len(vector), 3):
        out[first] = -vector[first + 1]
        out[first + 1] = vector[first]
    return out
