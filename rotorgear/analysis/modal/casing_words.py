"""What a casing does in a mode, in words: it rocks or moves as a whole, or one of its walls bends most."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from rotorgear.casings.reduced_body import ReducedBody


# From this share of its kinetic energy on a casing moves as a whole.
_AS_A_WHOLE = 0.5
_AXES = "xyz"


def casing_words(body: ReducedBody, shape: np.ndarray) -> str:
    """Words for the coordinates (n,) of a body in a mode, real or complex."""
    whole = _whole_motion(body, shape)
    if whole:
        return whole
    if body.surface is None:
        return "bending"
    # The velocity along the normals decides, as it does for the sound: a wall that only slides does not bend.
    normals, areas = body.surface.normals_and_areas()
    corners = body.surface.triangles
    moved = (body.surface.basis @ shape)[corners].mean(axis=1)
    across = areas * np.abs(np.einsum("tx,tx->t", normals, moved)) ** 2
    centres = body.surface.points[corners].mean(axis=1)
    middle = 0.5 * (body.surface.points.min(axis=0) + body.surface.points.max(axis=0))
    axis = np.argmax(np.abs(normals), axis=1)
    # Both faces of a wall belong to the side of the casing where it stands, whichever way they look.
    far = centres[np.arange(len(axis)), axis] > middle[axis]
    sides = np.bincount(2 * axis + far, across, 6)
    side = int(np.argmax(sides))
    return f"wall at {'-+'[side % 2]}{_AXES[side // 2]} bending"


def _whole_motion(body: ReducedBody, shape: np.ndarray) -> str:
    """The rigid-body motion nearest to a shape in kinetic energy, where it has the larger part of it; else ""."""
    M = body.mass
    R = body.seat_motions
    own = R.T @ M @ R
    parts = np.linalg.solve(own, R.T @ (M @ shape))
    total = float(np.real(np.conj(shape) @ M @ shape))
    together = float(np.real(np.conj(parts) @ own @ parts))
    if not together > _AS_A_WHOLE * total:
        return ""
    # Displacement of the point where translation and rotation have no common energy, the centre of mass of what the seats see.
    centre = np.array([own[5, 1] - own[4, 2], own[3, 2] - own[5, 0], own[4, 0] - own[3, 1]]) / (
        2.0 * np.trace(own[:3, :3]) / 3.0
    )
    along = parts[:3] + np.cross(parts[3:], centre)
    inertia = np.diagonal(own)[3:] - np.trace(own[:3, :3]) / 3.0 * (centre @ centre - centre**2)
    energies = np.concatenate([np.diagonal(own)[:3] * np.abs(along) ** 2, inertia * np.abs(parts[3:]) ** 2])
    largest = int(np.argmax(energies))
    return f"moving along {_AXES[largest]}" if largest < 3 else f"rocking about {_AXES[largest - 3]}"
