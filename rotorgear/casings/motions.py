"""Rigid motions of points."""

from __future__ import annotations

import numpy as np


def rigid_motions(points: np.ndarray, about: np.ndarray | None = None) -> np.ndarray:
    """Displacements (3p, 6) of points in unit displacements along x y z and unit rotations about the axes through a point."""
    x, y, z = (points - (np.zeros(3) if about is None else about)).T
    zero = np.zeros(len(points))
    one = np.ones(len(points))
    motions = np.array(
        [
            [one, zero, zero, zero, z, -y],
            [zero, one, zero, -z, zero, x],
            [zero, zero, one, y, -x, zero],
        ]
    )
    return np.asarray(motions.transpose(2, 0, 1).reshape(-1, 6))
