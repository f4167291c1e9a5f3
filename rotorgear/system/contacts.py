"""The contacts of a system as lines: vectors v with the approach of the flanks v . q, stiffness and damping along them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.elements.gear_mesh import face_strains
from rotorgear.model.layout.carriers import PlanetSet
from rotorgear.model.layout.state import MeshForce, contact_geometry
from rotorgear.model.parts.carrier import MARK, written_name
from rotorgear.solvers.time.sisters import sister_turn
from rotorgear.system.groups import face_of
from rotorgear.system.planets import turning_carriers
from rotorgear.system.system import System


@dataclass(frozen=True)
class ContactLines:
    """c contacts, in the order of the file, helices from left to right.

    Attributes:
        states: mean state of each contact, with its geometry.
        vectors: v over the free dofs, (n, c); turned: dv/dpsi, the change when the centre line turns, (n, c), which says nothing
            of bevel gears.
        tilt: v_t over the free dofs, tilt of the flanks along the face, (n, c).
        tilted: dv_t/dpsi, (n, c).
        rotation: r_b1 tz_1 + r_b2 tz_2 over the free dofs in the sense that presses the teeth, (n, c), in m along the line
            of action of the transverse plane.
        stiffness, damping: N/m and N s/m along the flank normal, (c,); gap: m that must close before a contact carries, (c,).
        tilt_stiffness: N m, (c,), 0 where a contact does not resist the tilt.
        start: N, force of a contact whose flanks have not approached, (c,): F = start + k (v . q - gap).
        couple: N m about the contact's place without tilt, (c,): M - e F = couple + k_t (v_t . q).
        turning: of planets that go round, (c, c): what their contacts s see as a rate beside s' is -W (turning s); else None.
    """

    states: tuple[MeshForce, ...]
    vectors: np.ndarray
    turned: np.ndarray
    tilt: np.ndarray
    tilted: np.ndarray
    rotation: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    gap: np.ndarray
    tilt_stiffness: np.ndarray
    start: np.ndarray
    couple: np.ndarray
    turning: np.ndarray | None = None

    def forces(self, s: np.ndarray, w: np.ndarray, speed: float | np.ndarray) -> np.ndarray:
        """Forces (o, c) of amplitudes s (o, c) of the approach at frequencies w (o,) and reference speeds (o, 1), in rad/s."""
        found = (self.stiffness + 1j * w[:, None] * self.damping) * s
        return found if self.turning is None else found - speed * self.damping * (s @ self.turning.T)

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
    # Fields of `ContactLines` in their order: vectors over all dofs, and numbers of each contact.
    vectors = np.zeros((5, system.dofs.transform.shape[0], len(states)))
    numbers = np.zeros((6, len(states)))
    for k, (state, group) in enumerate(zip(states, groups, strict=True)):
        m = group.matrices
        assert m.strain is not None
        assert m.modulus is not None
        v = m.strain[0, 0]
        v_t = face_strains(contact_geometry(state), face_of(system.layout, state))[1]
        dofs = group.dofs[0]
        vectors[:4, dofs, k] = (v, _quarter_turn(v), v_t, _quarter_turn(v_t))
        vectors[4, dofs[:12], k] = rotation_vector(state)
        numbers[:, k] = (
            m.modulus[0, 0, 0],
            0.0 if m.viscosity is None else m.viscosity[0, 0, 0],
            state.gap(system.layout),
            state.face.tilt_stiffness if state.face else 0.0,
            state.start or 0.0,
            state.face.couple if state.face else 0.0,
        )
    lines = ContactLines(states, *(system.dofs.transform.T @ v for v in vectors), *numbers)
    return replace(lines, turning=_turning(system, states)) if system.layout.planets else lines


def rotation_vector(state: MeshForce) -> np.ndarray:
    """r_b1 tz_1 + r_b2 tz_2 over the dofs of pinion and gear, (12,), in the sense that presses the teeth."""
    found = np.zeros(12)
    found[5], found[11] = (state.torque_sense * lever for lever in state.contact.levers)
    return found


def _quarter_turn(vector: np.ndarray) -> np.ndarray:
    """d/dpsi of a contact vector: displacements and rotations in the plane turn with the centre line."""
    turned = np.zeros_like(vector)
    turned[0::3] = -vector[1::3]
    turned[1::3] = vector[0::3]
    return turned


def sister_contacts(states: Iterable[MeshForce], planets: PlanetSet) -> np.ndarray:
    """Numbers (k, N) of the contacts of planets of one kind, each row the same one of all sisters."""
    own: dict[tuple[str, int], list[int]] = {}
    for number, state in enumerate(states):
        contact = state.contact
        shafts = (contact.pinion_place.shaft, contact.gear_place.shaft)
        # A mesh of two planets of one carrier is counted with its pinion.
        if next((shaft for shaft in shafts if MARK in shaft), "") in planets.planets:
            own.setdefault((written_name(contact.mesh), contact.helix), []).append(number)
    return np.array(list(own.values()), dtype=int).reshape(-1, len(planets.planets))


def _turning(system: System, states: tuple[MeshForce, ...]) -> np.ndarray | None:
    """W T of the contacts of planets that go round for unit reference speed, (c, c); None without any."""
    found = np.zeros((len(states), len(states)))
    for planets in turning_carriers(system.layout):
        for sisters in sister_contacts(states, planets):
            found[np.ix_(sisters, sisters)] = system.train.ratio(planets.shaft) * sister_turn(planets.angles)
    return found if found.any() else None
