"""Draws the wheel of models/elastic_wheel.toml: rim, web and hub in curved bricks of 20 nodes, as an Abaqus deck.

    python -m validation.studies.elastic_wheel models/elastic_wheel.inp

The mesh reaches up to the reference circle, so that it has the mass of the teeth. Its rim for the contact is the circle three
normal modules below the roots, which the loaded teeth are held on: what lies outside of it is moved with it, and its flexibility
is that of the teeth.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

MODULE = 2.0  # mm
TEETH = 96
ROOT = 0.5 * MODULE * TEETH - 1.25 * MODULE
HELD = ROOT - 3.0 * MODULE
RADII = (15.0, 24.0, 55.0, HELD, 0.5 * MODULE * TEETH)  # bore, hub, web, inside of the rim, reference circle
HEIGHTS = (-10.0, -3.5, 3.5, 10.0)
AROUND = 24
_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))


def write(path: Path, held: float = HELD, radii: tuple[float, ...] = RADII) -> None:
    """Write the deck; the rim for the contact is a circle of nodes at `held` mm, on one of the `radii`."""
    web = (1, 2)
    bricks = [
        (i, j, k)
        for i in range(len(radii) - 1)
        for j in range(AROUND)
        for k in range(len(HEIGHTS) - 1)
        if i not in web or k == 1
    ]
    steps = np.vstack([2 * _CORNERS, *(_CORNERS[a] + _CORNERS[b] for a, b in _EDGES)])  # half steps to the 20 nodes
    places = 2 * np.array(bricks)[:, None] + steps
    places[..., 1] %= 2 * AROUND
    nodes, cells = np.unique(places.reshape(-1, 3), axis=0, return_inverse=True)
    r = np.interp(nodes[:, 0] / 2, range(len(radii)), radii)
    z = np.interp(nodes[:, 2] / 2, range(len(HEIGHTS)), HEIGHTS)
    angle = np.pi * nodes[:, 1] / AROUND
    lines = ["*HEADING", "wheel with rim, web and hub, in mm", "*NODE"]
    points = zip(r * np.cos(angle), r * np.sin(angle), z, strict=True)
    lines += [f"{n}, {x:.7g}, {y:.7g}, {height:.7g}" for n, (x, y, height) in enumerate(points, 1)]
    lines.append("*ELEMENT, TYPE=C3D20, ELSET=wheel")
    for number, cell in enumerate(cells.reshape(-1, 20) + 1, 1):
        lines += [f"{number}, " + ", ".join(map(str, cell[:10])) + ",", ", ".join(map(str, cell[10:]))]
    for name, radius in {"bore": radii[0], "rim": held}.items():
        found = np.flatnonzero(np.abs(r - radius) < 1e-9) + 1
        lines.append(f"*NSET, NSET={name}")
        lines += [", ".join(map(str, found[k : k + 12])) for k in range(0, len(found), 12)]
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")


if __name__ == "__main__":
    write(Path(sys.argv[1]))
