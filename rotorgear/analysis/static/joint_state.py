"""What the joint quasi-static state of all loaded contacts is, and how it shakes a linear model.

Linear analyses are about the mean of this state. With k_i the mean tangent of contact i, what shakes it is

    f_i(u) = F_i(u) - k_i delta_i(u),

because k_i v_i . q + f_i then gives F_i(u) wherever the rest follows without inertia: exactly this state at a crawl. Along a
face, with the mean tangent k at the place e and k_t against a tilt about it, delta_i is the approach at that place, and the
couple m_i(u) = M_i - e F_i - k_t tilt_i shakes it too.
H. N. Ozguven and D. R. Houser, Journal of Sound and Vibration 125 (1988) 71, for one mesh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.model.layout.state import FaceState
from rotorgear.system.local import teeth_law

if TYPE_CHECKING:
    from rotorgear.gears.maps.contact_map import ContactMap
    from rotorgear.gears.maps.face_map import FaceMap


@dataclass(frozen=True)
class Cycle:
    """The joint state over the cycle of the contacts of one mesh frequency.

    Attributes:
        meshes: names of these meshes.
        ratio: mesh frequency in rad/s over the size of the reference speed.
        periods: base pitches after which it repeats.
        position: (p,) in base pitches from the time 0 on, evenly spaced over `periods`.
        approach: (p, c) delta of all contacts along the flank normal in m; in the middle of a face that feels its tilt.
        force: (p, c) along the flank normal in N.
        tilt: (p, c) of the flanks in m/m, 0 of contacts without a face map; moment: (p, c) about the middle of the face in N m.
    """

    meshes: tuple[str, ...]
    ratio: float
    periods: int
    position: np.ndarray
    approach: np.ndarray
    force: np.ndarray
    tilt: np.ndarray
    moment: np.ndarray


@dataclass(frozen=True)
class JointState:
    """The joint quasi-static state of all contacts.

    Attributes:
        cycles: one for each mesh frequency of loaded teeth.
        own: (c,) number of the cycle that a contact runs through; -1 of one without a contact map.
        force, approach: (c,) means over its own cycle, N and m along the flank normal; of a contact without map over the first.
        stiffness: (c,) mean tangent over its own cycle in N/m; of a contact without map its own.
        gap: (c,) index error of each contact in m.
        maps: (c,) contact maps, None without one; face_maps: (c,) of teeth that feel the tilt of their shafts, in place of those.
        faces: (c,) how it carries along its face about its mean, None without a face map.
        compliance: (c, c) approach of the contacts in m under a constant force of each mapped one in N, all being springs of
            these stiffnesses.
        pitch: (c,) base pitches past the pitch point of each contact at time 0; sense: (c,) +1 where it then runs up its map.
    """

    cycles: tuple[Cycle, ...]
    own: np.ndarray
    force: np.ndarray
    approach: np.ndarray
    stiffness: np.ndarray
    gap: np.ndarray
    maps: tuple[ContactMap | None, ...]
    face_maps: tuple[FaceMap | None, ...]
    faces: tuple[FaceState | None, ...]
    compliance: np.ndarray
    pitch: np.ndarray
    sense: np.ndarray

    @property
    def start(self) -> list[float | None]:
        """In N: about its mean a contact with a map is F = start + k (delta - gap)."""
        F_0 = self.force - self.stiffness * (self.approach - self.gap)
        return [float(F) if own >= 0 else None for F, own in zip(F_0, self.own, strict=True)]

    def excitation(self, cycle: Cycle) -> np.ndarray:
        """f_i = F_i - k_i delta_i over a cycle, (p, c) in N, without its mean; 0 for contacts without a map."""
        f = cycle.force - self.stiffness * self.pressed(cycle)
        return np.where(self.own >= 0, f - f.mean(axis=0), 0.0)

    def couple(self, cycle: Cycle) -> np.ndarray:
        """m_i = M_i - e F_i - k_t tilt_i over a cycle, (p, c) in N m, without its mean; 0 for contacts without a face map."""
        against = np.array([face.tilt_stiffness if face else 0.0 for face in self.faces])
        m = cycle.moment - self._places * cycle.force - against * cycle.tilt
        return np.asarray(m - m.mean(axis=0))

    def pressed(self, cycle: Cycle) -> np.ndarray:
        """Approach (p, c) over a cycle at the places of contact, in m; of contacts without a face map that of the cycle."""
        return np.asarray(cycle.approach + self._places * cycle.tilt)

    def pressed_force(self, contact: int, cycle: Cycle, delta: np.ndarray) -> np.ndarray:
        """Force (p,) in N at approaches (p,) at the place of a contact over its cycle, the tilt being that of the cycle."""
        u = self.on_map(contact, cycle.position)
        contact_map = self.maps[contact]
        face_map = self.face_maps[contact]
        if contact_map is not None:
            return contact_map.force(delta - self.gap[contact], u)
        assert face_map is not None
        law = teeth_law(face_map, float(self.stiffness[contact]), float(self.gap[contact]), order=1.0)
        tilt = cycle.tilt[:, contact]
        d = np.stack([delta - self._places[contact] * tilt, tilt], axis=1)
        return law.evaluate_many(d, 0.0 * d, angle=2.0 * math.pi * u).force[:, 0]

    @property
    def _places(self) -> np.ndarray:
        """e (c,) in m; 0 without a face map."""
        return np.array([face.place if face else 0.0 for face in self.faces])

    def no_load(self, cycle: Cycle) -> np.ndarray:
        """Approach (p, c) at first touch of the contacts that run through a cycle, in m without its mean; 0 for the others."""
        found = np.zeros_like(cycle.approach)
        for i, contact_map in enumerate(self.maps):
            face_map = self.face_maps[i]
            if self.own[i] < 0 or self.cycles[self.own[i]] is not cycle:
                continue
            u = self.on_map(i, cycle.position)
            if contact_map is not None:
                found[:, i] = contact_map.no_load(u)
            elif face_map is not None:
                found[:, i] = face_map.no_load(float(cycle.tilt[:, i].mean()), u)
        return np.asarray(found - found.mean(axis=0))

    def on_map(self, contact: int, position: np.ndarray) -> np.ndarray:
        """Place u on its map of a contact at positions of its cycle."""
        return np.asarray(self.sense[contact] * (self.pitch[contact] + position))
