"""Order of convergence of the frequencies of a smooth block, free in space, with quadratic bricks and tetrahedra.

    python -m validation.studies.order                 # up to 43 000 dofs of bricks and 82 000 of tetrahedra, a minute
    python -m validation.studies.order --finest 4      # bricks and tetrahedra up to 11 000 dofs, seconds

A block of steel, 100 x 60 x 200 mm, has 2n x n x 3n bricks, or six tetrahedra in each. With quadratic elements frequencies err by
h⁴. The limit is taken from the two finest meshes of bricks (Richardson). Orders stand between each mesh and the one before it.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np

from rotorgear.casings.assembly import Elastic
from rotorgear.casings.fe_body import finite_element_body
from rotorgear.casings.reduction import free_modes
from rotorgear.casings.settings import CasingSettings

STEEL = Elastic(206e9, 0.3, 7850.0)
SIZE = (0.1, 0.06, 0.2)
SHARE = (2, 1, 3)
FINENESS = (1, 2, 3, 4, 6, 8)
# The first three; the fourth crosses another one where the mesh gets finer.
MODES = 3
_TETS = np.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])


def block(path: Path, n: int, tetrahedra: bool) -> Path:
    """Write a deck of linear elements, which rotorgear raises to quadratic ones."""
    counts = n * np.array(SHARE)
    bricks = np.argwhere(np.ones(counts, dtype=bool))
    corners = bricks[:, None] + [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
    places, cells = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    cells = cells.reshape(-1, 8)
    if tetrahedra:
        cells = cells[:, _TETS].reshape(-1, 4)
    points = places * (np.array(SIZE) / counts)
    text = ["*NODE", *(f"{k},{x!r},{y!r},{z!r}" for k, (x, y, z) in enumerate(points.tolist(), 1))]
    text += [f"*ELEMENT, TYPE=C3D{cells.shape[1]}, ELSET=block"]
    text += [f"{k}," + ",".join(map(str, cell)) for k, cell in enumerate((cells + 1).tolist(), 1)]
    path.write_text("\n".join(text))
    return path


def frequencies(n: int, tetrahedra: bool) -> tuple[int, np.ndarray]:
    """Degrees of freedom, and the lowest elastic frequencies in Hz."""
    with tempfile.TemporaryDirectory() as folder:
        path = block(Path(folder) / "block.inp", n, tetrahedra)
        body = finite_element_body(CasingSettings("block", (("mesh", path),), 1.0, STEEL))
    return body.dofs, free_modes(body, MODES).frequency


def orders(fineness: list[int], found: list[np.ndarray], limit: np.ndarray) -> list[np.ndarray]:
    """Order of the error of each mode between each mesh and the one before it."""
    errors = [frequency - limit for frequency in found]
    return [
        np.log(coarse / fine) / np.log(n_fine / n_coarse)
        for coarse, fine, n_coarse, n_fine in zip(errors, errors[1:], fineness, fineness[1:], strict=False)
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--finest", type=int, default=FINENESS[-1], choices=FINENESS[2:], help="largest n")
    last = parser.parse_args().finest
    fineness = [n for n in FINENESS if n <= last]
    bricks = [frequencies(n, tetrahedra=False) for n in fineness]
    before, finest = bricks[-2][1], bricks[-1][1]
    limit = finest - (before - finest) / ((fineness[-1] / fineness[-2]) ** 4 - 1.0)
    for name, rows in (
        ("hexahedron20", bricks),
        ("tetra10", [frequencies(n, tetrahedra=True) for n in fineness]),
    ):
        found = [frequency for _, frequency in rows]
        print(f"{name:14}{'dofs':>7}   relative errors of {MODES} modes      order of each")
        steps = [None, *orders(fineness, found, limit)]
        # The limit was made with the last two meshes of bricks, which say nothing of their own order.
        steps = steps[:-1] if name == "hexahedron20" else steps
        for n, (dofs, frequency), step in zip(fineness, rows, [*steps, None], strict=False):
            words = "" if step is None else " ".join(f"{order:.2f}" for order in step)
            errors = " ".join(f"{error:.1e}" for error in frequency / limit - 1.0)
            print(f"n = {n:<10}{dofs:7}   {errors}      {words}")


if __name__ == "__main__":
    main()
