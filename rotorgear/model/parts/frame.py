"""Frames: where a shaft stands in space, and which way its own x, y and z point.

Displacements, rotations, forces and places of a shaft are told in its own frame, R with the columns x, y and z: a point r of it
is at O + R r in the model, and a vector v of the model is R' v to the shaft. A shaft parallel to z has R = 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

# An axis closer than this (rad) to a direction is along it.
_ALONG = 1e-6


@dataclass(frozen=True, eq=False)
class Frame:
    """Coordinates of a shaft.

    Attributes:
        origin: O (3,), place of its z = 0 in m.
        axes: R (3, 3), its own x, y and z in columns.
    """

    origin: np.ndarray
    axes: np.ndarray

    def at(self, z: float | np.ndarray) -> np.ndarray:
        """Places (..., 3) in the model of places z (...) in m on the axis."""
        return np.asarray(self.origin + np.asarray(z)[..., None] * self.axes[:, 2])

    def outside(self, points: np.ndarray) -> np.ndarray:
        """Places (..., 3) in the model of its own points (..., 3)."""
        return np.asarray(self.origin + points @ self.axes.T)

    def inside(self, points: np.ndarray) -> np.ndarray:
        """Its own coordinates (..., 3) of places (..., 3) in the model."""
        return np.asarray((points - self.origin) @ self.axes)

    def sees(self, other: Frame) -> Frame:
        """Another frame in the coordinates of this one."""
        if not self.is_turned:
            return Frame(other.origin - self.origin, other.axes)
        return Frame(self.inside(other.origin), self.axes.T @ other.axes)

    @cached_property
    def is_turned(self) -> bool:
        """Whether its directions are not those of the model."""
        return not np.array_equal(self.axes, np.eye(3))

    @property
    def is_moved(self) -> bool:
        """Whether z of the model is not that of the shaft."""
        return bool(self.is_turned or self.origin[2])

    @cached_property
    def six(self) -> np.ndarray:
        """R for a displacement and a rotation, (6, 6): those in the model from its own."""
        found = np.zeros((6, 6))
        found[:3, :3] = found[3:, 3:] = self.axes
        return found

    def own(self, wrenches: np.ndarray) -> np.ndarray:
        """Vectors and rotations (..., 6) of the model in its own directions."""
        return np.asarray(wrenches @ self.six)


def frame_along(
    origin: tuple[float, ...], axis: tuple[float, float, float], x_axis: tuple[float, float, float] | None
) -> Frame:
    """The frame with z along an axis, and x along another direction made square to it.

    Without a direction it is x of the model, or y for an axis along x.

    Args:
        origin: x and y, or x, y and z, in m.
        axis: any length.
        x_axis: any length.

    Raises:
        ValueError: both directions are the same.
    """
    place = np.zeros(3)
    place[: len(origin)] = origin
    if x_axis is None and axis == (0.0, 0.0, 1.0):
        return Frame(place, np.eye(3))
    z = np.array(axis) / np.linalg.norm(axis)
    if x_axis is None:
        x_axis = (1.0, 0.0, 0.0) if np.hypot(z[1], z[2]) > _ALONG else (0.0, 1.0, 0.0)
    wanted = np.array(x_axis) / np.linalg.norm(x_axis)
    x = wanted - (wanted @ z) * z
    size = np.linalg.norm(x)
    if size <= _ALONG:
        raise ValueError("x_axis lies along the axis")
    x /= size
    return Frame(place, np.column_stack([x, np.cross(z, x), z]))


# Axes that lie apart by more (rad) are not parallel: the rest is rounding of equal directions. Levers of gears fit their teeth.
PARALLEL = 1e-9


def angle_to(seen: Frame) -> float:
    """Angle in rad, 0 to pi, between z and the axis of another frame, as `sees` gives it."""
    x, y, z = seen.axes[:, 2].tolist()
    return math.atan2(math.hypot(x, y), z)
