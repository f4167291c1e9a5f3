"""Casings whose answer is known without a mesh: a beam of the package's own elements, seen from its seats."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.linalg as la

from rotorgear.elements.shaft import shaft_elements
from rotorgear.elements.shaft_section import ShaftElements
from rotorgear.elements.spring import rigid_transfer

STEEL = (206e9, 206e9 / 2.6, 0.3, 7850.0)


def bar_matrices(
    z: np.ndarray, diameter: float, seats: list[int], held: list[int] | None = None, stiffer: float = 1.0
) -> dict[str, np.ndarray]:
    """Arrays of a round bar along z with nodes at z (p,), its seats at some of them; `held` nodes are fixed to the ground."""
    E, G, nu, rho = STEEL
    length = np.diff(z)
    full = np.ones(len(length))
    sizes = np.tile([diameter, 0.0, diameter, 0.0], (len(length), 1))
    moduli = E * stiffer * full, G * stiffer * full
    data = ShaftElements(length, sizes, sizes, *moduli, nu * full, rho * full, np.nan * full)
    matrices = shaft_elements(data)
    n = 6 * len(z)
    K = np.zeros((n, n))
    M = np.zeros((n, n))
    stiffness = matrices.stiffness
    assert stiffness is not None
    assert matrices.mass is not None
    for k in range(len(length)):
        dofs = slice(6 * k, 6 * k + 12)
        K[dofs, dofs] += stiffness[k]
        M[dofs, dofs] += matrices.mass[k]
    rigid = np.vstack([rigid_transfer(np.array([0.0, 0.0, place])) for place in z])
    fixed = np.array([6 * k + dof for k in held or [] for dof in range(6)], dtype=int)
    interface = np.concatenate([6 * k + np.arange(6) for k in seats])
    inside = np.setdiff1d(np.arange(n), np.concatenate([fixed, interface]))
    # Craig-Bampton with all fixed-interface modes: a change of coordinates, no approximation.
    shapes = np.zeros((n, len(interface) + len(inside)))
    shapes[interface, : len(interface)] = np.eye(len(interface))
    shapes[inside, : len(interface)] = -la.solve(K[np.ix_(inside, inside)], K[np.ix_(inside, interface)])
    shapes[inside, len(interface) :] = la.eigh(K[np.ix_(inside, inside)], M[np.ix_(inside, inside)])[1]
    return {
        "stiffness": shapes.T @ K @ shapes,
        "mass": shapes.T @ M @ shapes,
        "seats": np.array([f"seat_{k}" for k in seats]),
        "positions": np.column_stack([np.zeros((len(seats), 2)), z[seats]]),
        "weight": shapes.T @ M @ rigid[:, :3],
    }


def write_bar(path: Path, **arguments: object) -> Path:
    """Write the arrays of a bar as a NumPy archive."""
    np.savez(path, **bar_matrices(**arguments))  # type: ignore[arg-type]
    return path


def cube(side: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (8, 3) and triangles (12, 3) of a cube about the origin, counter-clockwise from outside."""
    points = side * (np.array([[k & 1, k >> 1 & 1, k >> 2] for k in range(8)]) - 0.5)
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, np.array([corners for a, b, c, d in sides for corners in ((a, b, c), (a, c, d))])
