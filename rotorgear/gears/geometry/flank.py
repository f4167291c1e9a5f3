"""Deviations of a flank from the involute helicoid: profile and lead modifications, and pitch errors of single teeth.

Amounts are depths of removed material along the flank normal (m); places are roll lengths (m) and shares of the face.
With s = (xi - xi_m)/L from the middle of the involute, of length L between form circle and tip, and t = z/b:

    profile slope C_Ha s,  profile crowning C_a (2 s)^2,  helix slope C_Hb t,  lead crowning C_b (2 t)^2,  bias S s t.

Where the tip is rounded or chamfered the involute ends at the tip form circle, and all of this ends there.
Reference: ISO 21771-1, section on flank modifications.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class FlankGrid:
    """Measured depths on a grid of one flank, interpolated linearly; beyond the grid its border goes on.

    Attributes:
        roll: (r,) roll lengths (m), rising.
        z: (c,) places from the middle of the face (m), rising.
        depth: (r, c) removed depth (m), row by row.
    """

    roll: tuple[float, ...]
    z: tuple[float, ...]
    depth: tuple[tuple[float, ...], ...]

    def at(self, roll: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Depth (m) at roll lengths and places along the face (m) of shapes that broadcast."""
        roll, z = np.broadcast_arrays(roll, z)
        i, row_share = _between(np.array(self.roll), roll)
        j, column_share = _between(np.array(self.z), z)
        d = np.array(self.depth)
        next_column = np.minimum(j + 1, d.shape[1] - 1)
        rows = (i, np.minimum(i + 1, d.shape[0] - 1))
        below, above = ((1.0 - column_share) * d[k, j] + column_share * d[k, next_column] for k in rows)
        return np.asarray((1.0 - row_share) * below + row_share * above)

    def mirrored(self) -> FlankGrid:
        """The grid seen from the other end of the face."""
        return FlankGrid(self.roll, tuple(-z for z in self.z[::-1]), tuple(row[::-1] for row in self.depth))

    @property
    def along_face(self) -> bool:
        """Whether some row changes along the face."""
        return any(max(row) > min(row) for row in self.depth)

    @property
    def largest(self) -> float:
        """Largest deviation (m) either way."""
        return max(abs(value) for row in self.depth for value in row)


def _between(grid: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Grid point before each x, and the share of the way to the next one, 0 to 1."""
    if len(grid) == 1:
        return np.zeros(x.shape, int), np.zeros(x.shape)
    i = np.clip(np.searchsorted(grid, x, side="right") - 1, 0, len(grid) - 2)
    return i, np.clip((x - grid[i]) / (grid[i + 1] - grid[i]), 0.0, 1.0)


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
        profile_crowning: depth at form circle and tip, parabolic over the roll length.
        profile_slope: depth at the tip less that at the form circle, linear.
        bias: profile slope at the end of larger z less that at the end of smaller z: the twist of the flank.
        tip_break: roll length that the rounding or chamfer of the tip takes off the involute.
        end_relief: depth of linear relief at both ends of the face.
        end_relief_length: how far it reaches along the face.
        helix_slope: depth at the end of larger z less that at the end of smaller z; negative the other way.
        pitch_error: (tooth, how far its flank stands back along the line of action); the other teeth are exact.
        topography: measured depths of all teeth, or None.
        tooth_topography: ((tooth, measured depths), ...) of single teeth, in place of those of all.
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
    profile_crowning: float = 0.0
    profile_slope: float = 0.0
    bias: float = 0.0
    tip_break: float = 0.0
    topography: FlankGrid | None = None
    tooth_topography: tuple[tuple[int, FlankGrid], ...] = ()

    @property
    def along_face(self) -> bool:
        """Whether the flank changes along the face, so that a plane model can't follow it."""
        return bool(
            self.crowning
            or self.end_relief
            or self.helix_slope
            or self.bias
            or any(grid.along_face for grid in self._grids)
        )

    @property
    def single_teeth(self) -> tuple[int, ...]:
        """Teeth that differ from the others, in rising order."""
        pitch = {tooth for tooth, error in self.pitch_error if error}
        return tuple(sorted(pitch | {tooth for tooth, _ in self.tooth_topography}))

    @property
    def of_most_teeth(self) -> FlankModification:
        """The flank without what single teeth have of their own."""
        return replace(self, pitch_error=(), tooth_topography=())

    @property
    def _grids(self) -> tuple[FlankGrid, ...]:
        own = tuple(grid for _, grid in self.tooth_topography)
        return own if self.topography is None else (self.topography, *own)

    def mirrored(self) -> FlankModification:
        """The flank seen from the other end of the face: what depends on the sign of z changes sides."""
        return replace(
            self,
            helix_slope=-self.helix_slope,
            bias=-self.bias,
            topography=self.topography.mirrored() if self.topography else None,
            tooth_topography=tuple((tooth, grid.mirrored()) for tooth, grid in self.tooth_topography),
        )

    @property
    def largest(self) -> float:
        """Upper bound (m) of the depth at any point: the sum of all deviations, as if their peaks met."""
        pitch = max((abs(error) for _, error in self.pitch_error), default=0.0)
        measured = max((grid.largest for grid in self._grids), default=0.0)
        profile = self.tip_relief + self.root_relief + abs(self.profile_crowning) + abs(self.profile_slope)
        lead = abs(self.crowning) + self.end_relief + abs(self.helix_slope)
        return profile + lead + abs(self.bias) + pitch + measured

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
        # Slopes turn the flank about its middle: half of one is added at one end, half taken off at the other.
        s = (roll - 0.5 * (form + tip)) / (tip - form)
        t = z / width
        depth = depth + self.profile_slope * s + self.profile_crowning * (2.0 * s) ** 2
        return np.asarray(depth + self.helix_slope * t + self.bias * s * t)

    def measured_depth(self, roll: np.ndarray, z: np.ndarray, tooth: np.ndarray, teeth: int) -> np.ndarray:
        """Depth (m) by the measured topographies at roll lengths and places (n, q) on teeth (n,), counted round the gear."""
        depth = np.zeros(np.broadcast_shapes(np.shape(roll), np.shape(z)))
        if self.topography is not None:
            depth = depth + self.topography.at(roll, z)
        for number, grid in self.tooth_topography:
            own = np.asarray(tooth) % teeth == number % teeth
            depth[own] = grid.at(roll, z)[own]
        return depth
