"""A stiffness that is given: one number, or values evenly spaced over the mesh period, along the flank normal."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness


def given_stiffness(
    values: Sequence[float], base_helix_angle: float, helices: int, load: float | None, positions: int
) -> MeshStiffness:
    """A given stiffness as a curve of the whole mesh.

    Args:
        values: N/m along the flank normal, of all helices together; one value is constant over the period.
        base_helix_angle: b_b (rad).
        helices: 1 or 2.
        load: F_bt (N) of all helices, where one is known; the values don't depend on it.
        positions: how many positions to give a single value at; several values keep their own.
    """
    normal = np.full(positions, values[0]) if len(values) == 1 else np.asarray(values, float)
    return MeshStiffness(
        model="given",
        position=np.arange(len(normal)) / len(normal),
        transverse=normal * math.cos(base_helix_angle) ** 2,
        definition="tangent",
        helices=helices,
        load=load,
        body="as whoever gave the stiffness took it",
        base_helix_angle=base_helix_angle,
    )
