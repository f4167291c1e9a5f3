"""Displacements and stresses inside the teeth for given forces on their flanks: what the condensed pitches leave out.

The motions of the cuts follow from the chain of pitches (`gear_compliance`), tooth by tooth and added up. Inside, every pitch
has the same stiffness: one sparse factorisation serves all. Lengths in normal modules, Young's modulus 1, as in `sector`; the
tooth stands on the +y axis at the middle of the face, and displacements are in its frame.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.tooth_fe.blank_section import BlankSection
from rotorgear.gears.tooth_fe.compliance_model import ComplianceKey, pitch_of, wheel_sector
from rotorgear.gears.tooth_fe.elasticity import factorised, node_dofs
from rotorgear.gears.tooth_fe.gear_compliance import cut_motions
from rotorgear.gears.tooth_fe.pitch import whole_pitch
from rotorgear.gears.tooth_fe.sector import Sector, layered_sector, plane_sector
from rotorgear.gears.tooth_fe.wheel_compliance import wheel_motions
from rotorgear.gears.tooth_fe.wheel_sector import WheelSector, seat_frame
from rotorgear.progress import Progress, part_of, silent

# Pitches to either side of the loaded teeth that are solved too.
_NEIGHBOURS = 2


class ToothInside:
    """The inside of the teeth of one gear, for any loads.

    Attributes:
        key: the gear.
        pitch: a pitch with all its nodes.
    """

    def __init__(self, key: ComplianceKey, progress: Progress = silent) -> None:
        """Superelement and factorisation of a pitch."""
        self.key = key
        self._mesh = pitch_of(key)[1]
        layers = key.size.face if key.width else 0
        self.pitch = whole_pitch(self._mesh, key.poisson_ratio, key.width, layers)
        told = part_of(progress, 0.0, 0.6)
        self._sector: Sector
        if key.blank:
            if not key.width:
                raise AnalysisError("The inside of the teeth of a wheel needs the model in space.")
            self._sector = wheel_sector(key, self._mesh, told)
        elif key.width:
            self._sector = layered_sector(self._mesh, key.poisson_ratio, key.width, layers, told)
        else:
            self._sector = plane_sector(self._mesh, key.poisson_ratio)
        # Cuts and inner circle, whose motions the chain of pitches gives, and all other degrees of freedom.
        pitch = self.pitch
        d = pitch.dimension
        self._moved = node_dofs(np.concatenate([pitch.left, pitch.right, pitch.inner]), d)
        self._rest = np.setdiff1d(np.arange(d * len(pitch.points)), self._moved)
        rows = pitch.stiffness[self._rest]
        self._factor = factorised(rows[:, self._rest])
        self._couple = rows[:, self._moved]
        progress(1.0, "inside of the teeth")

    def solve(self, loads: dict[int, np.ndarray], progress: Progress = silent) -> tuple[np.ndarray, np.ndarray]:
        """Displacements of all pitches near loaded teeth.

        Args:
            loads: forces (f,) along the outward normal at the flank nodes by tooth, in the order of the gear's compliance.
            progress: told how far it is.

        Returns:
            Numbers (t,) of the pitches, and displacements (t, n, d) of the nodes of each, in the frame of its own tooth.
        """
        pitch = self.pitch
        near = min(_NEIGHBOURS, ((self.key.arc or self.key.geometry.teeth) - 1) // 2)
        teeth = np.arange(min(loads) - near, max(loads) + near + 1)
        if self.key.blank:
            at_ends = self._moved_wheel(teeth, loads, part_of(progress, 0.0, 0.5))
        else:
            at_ends = self._moved_pitches(teeth, loads)

        # Inside of each pitch: K_rr u_r = f_r - K_rh u_h, with the cuts and the inner circle moved.
        d = pitch.dimension
        n = len(pitch.points)
        told = part_of(progress, 0.5, 1.0)
        displacement = np.zeros((len(teeth), d * n))
        for i, number in enumerate(teeth.tolist()):
            told(i / len(teeth), f"tooth {number}")
            force = np.zeros(d * n)
            if number in loads:
                force[node_dofs(pitch.flank, d)] = (loads[number][:, None] * pitch.normal).ravel()
            displacement[i, self._moved] = at_ends[i]
            displacement[i, self._rest] = self._factor.solve(force[self._rest] - self._couple @ at_ends[i])
        return teeth, displacement.reshape(len(teeth), n, d)

    def _moved_pitches(self, teeth: np.ndarray, loads: dict[int, np.ndarray]) -> list[np.ndarray]:
        """Displacements at the cuts and on the held circle of each pitch in a rim or a ring."""
        pitch = self.pitch
        count = self.key.arc or self.key.geometry.teeth
        ring = self.key.arc == 0
        # One loaded tooth at a time, its chain of pitches moved to where it stands, all of them added up.
        cuts = np.zeros((len(teeth) + 1, self._sector.cut))
        for tooth, force in loads.items():
            moved = cut_motions(self._sector, force[:, None], count, ring=ring)[:, :, 0]
            place = np.arange(teeth[0], teeth[-1] + 2) - tooth + count // 2
            there = np.ones(len(place), bool) if ring else (place >= 0) & (place < len(moved))
            cuts[there] += moved[place[there] % len(moved)]
        at_rest = np.zeros(pitch.dimension * len(pitch.inner))
        return [
            np.concatenate([pitch.in_tooth(left), pitch.in_tooth(right, 1), at_rest]) for left, right in pairwise(cuts)
        ]

    def _moved_wheel(self, teeth: np.ndarray, loads: dict[int, np.ndarray], progress: Progress) -> list[np.ndarray]:
        """The same on a wheel, whose inner circle moves with the blank."""
        key = self.key
        sector = self._sector
        assert key.blank is not None
        assert isinstance(sector, WheelSector)
        blank = BlankSection(key.blank, key.face, key.inner_radius, key.poisson_ratio)
        moved = np.zeros((len(teeth), 2 * sector.cut + sector.middle))
        for tooth, force in loads.items():
            moved += wheel_motions(sector, blank, key.geometry.teeth, force, teeth - tooth, progress)

        # A cut begins with the seat's end in every plane, in polar components.
        left, right, middle = (
            part.reshape(len(teeth), 2 * key.size.face + 1, -1, 3)
            for part in np.split(moved, [sector.cut, 2 * sector.cut], axis=1)
        )
        seat = np.concatenate([left[:, :, :1], middle, right[:, :, :1]], axis=2)
        shapes, polar = seat_frame(self._mesh)
        inner = np.einsum("is,tpsk,ijk->tpij", shapes, seat, polar)
        in_tooth = self.pitch.in_tooth
        return [
            np.concatenate([in_tooth(left[i, :, 1:]), in_tooth(right[i, :, 1:], 1), in_tooth(inner[i])])
            for i in range(len(teeth))
        ]
