"""Small meshes of wheels for the tests of gear bodies: rings of curved bricks about z."""

from __future__ import annotations

import numpy as np

from rotorgear.casings.elements import element
from rotorgear.casings.file_mesh import FileMesh, NamedSet
from tests.unit.casings.blocks import bricks


def ring(radii: tuple[float, ...], heights: tuple[float, ...], around: int, keep: np.ndarray | None = None) -> FileMesh:
    """Quadratic bricks between radii and heights, `around` of them about z; sets "bore" and "rim" are the inner and outer faces.

    Args:
        radii, heights: rising, of the corners of the bricks in m.
        around: bricks about the axis.
        keep: (len(radii) - 1, around, len(heights) - 1) which bricks there are; default: all.
    """
    counts = (len(radii) - 1, around, len(heights) - 1)
    points, cells = bricks((1.0, 1.0, 1.0), counts)
    if keep is not None:
        cells = cells[keep.ravel()]
    shape = element("hexahedron20")
    edges = np.sort(cells[:, np.array(shape.edges)], axis=2)
    keys, inverse = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
    cells = np.hstack([cells, len(points) + inverse.reshape(len(cells), -1)])
    points = np.vstack([points, points[keys].mean(axis=1)])
    r = np.interp(points[:, 0], np.linspace(0.0, 1.0, len(radii)), radii)
    angle = 2.0 * np.pi * points[:, 1]
    z = np.interp(points[:, 2], np.linspace(0.0, 1.0, len(heights)), heights)
    placed = np.column_stack([r * np.cos(angle), r * np.sin(angle), z])
    # The seam at 0 and 1 of the angle is one.
    _, first, own = np.unique(np.round(placed, 9), axis=0, return_index=True, return_inverse=True)
    placed, cells, r = placed[first], own.reshape(-1)[cells], r[first]
    used = np.isin(np.arange(len(placed)), cells)
    sets = {
        name: NamedSet(np.flatnonzero(used & (np.abs(r - radius) < 1e-9)))
        for name, radius in (("bore", radii[0]), ("rim", radii[-1]))
    }
    return FileMesh(placed, {"hexahedron20": cells}, sets)
