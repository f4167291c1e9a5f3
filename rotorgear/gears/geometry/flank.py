"""Deviations of a flank from the involute helicoid: profile and lead modifications, and pitch errors of single teeth.

Amounts are depths of removed material along the flank normal (m); places are roll lengths (m) and shares of the face.
Reference: ISO 21771-1, section on flank modifications.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class FlankModification:
    """What is taken off one flank.

    Attributes:
        tip_relief: depth at the tip.
        tip_relief_length: roll length from the tip over which it falls to 0.
        root_relief: depth at the form circle.
        root_relief_length: roll length from the form circle over which it falls to 0.
        relief_exponent: 1 for linear, 2 for parabolic relief.
        crowning: depth at both ends of the face, parabolic.
        end_relief: depth of linear relief at both ends of the face.
        end_relief_length: how far it reaches along the face.
        helix_slope: depth at the end of larger z less that at the end of smaller z; negative the other way.
        pitch_error: (tooth, how far its flank stands back along the line of action); the other teeth are exact.
    """

    tip_relief: float = 0.0
    tip_relief_length: float = 0.0
    root_relief: float = 0.0
    root_relief_length: float = 0.0
    relief_exponent: float = 1.0
    crowning: float = 0.0
    end_relief: float = 0.0
    end_relief_length: float = 0.0
    helix_slope: float = 0.0
    pitch_error: tuple[tuple[int, float], ...] = ()

    @property
    def along_face(self) -> bool:
        """Whether the flank changes along the face, so that a plane model can't follow it."""
        return bool(self.crowning or self.end_relief or self.helix_slope)

    @property
    def largest(self) -> float:
        """Upper bound (m) of the depth at any point: the sum of all deviations, as if their peaks met."""
        pitch = max((abs(error) for _, error in self.pitch_error), default=0.0)
        return self.tip_relief + self.root_relief + self.crowning + self.end_relief + abs(self.helix_slope) + pitch

    def pitch_depth(self, tooth: np.ndarray, teeth: int) -> np.ndarray:
        """How far the flanks of some teeth stand back (m); `tooth` holds any whole numbers, counted round the gear."""
        table = np.zeros(teeth)
        for number, error in self.pitch_error:
            table[number % teeth] += error
        return np.asarray(table[np.asarray(tooth) % teeth])

    def depth(self, roll: np.ndarray, z: np.ndarray, form: float, tip: float, width: float) -> np.ndarray:
        """Removed depth (m) of flank points.

        Args:
            roll: roll lengths (m).
            z: places from the middle of the face (m), of a shape that broadcasts with `roll`.
            form: roll length at which the involute begins (m).
            tip: roll length at which it ends (m).
            width: face width (m).
        """
        depth = np.zeros(np.broadcast_shapes(np.shape(roll), np.shape(z)))
        if self.tip_relief:
            share = 1.0 - (tip - roll) / self.tip_relief_length
            depth = depth + self.tip_relief * np.clip(share, 0.0, 1.0) ** self.relief_exponent
        if self.root_relief:
            share = 1.0 - (roll - form) / self.root_relief_length
            depth = depth + self.root_relief * np.clip(share, 0.0, 1.0) ** self.relief_exponent
        if self.crowning:
            depth = depth + self.crowning * (2.0 * z / width) ** 2
        if self.end_relief:
            share = 1.0 - (0.5 * width - np.abs(z)) / self.end_relief_length
            depth = depth + self.end_relief * np.clip(share, 0.0, 1.0)
        # The slope turns the flank about the middle of the face: half of it is added at one end, half taken off at the other.
        return depth + self.helix_slope * z / width
