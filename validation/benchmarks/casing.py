"""Cost and errors of casings: a box of walls, meshed by more and more quadratic tetrahedra, reduced to four seats.

    python -m validation.benchmarks.casing                 # error against run time over sizes and fixed-interface modes
    python -m validation.benchmarks.casing --large         # one mesh of 140 000 dofs: seconds of CPU and largest memory

The box is 400 x 300 x 500 mm with walls one brick thick and four square seats in two walls; each brick is six tetrahedra.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from rotorgear.casings.assembly import Elastic
from rotorgear.casings.fe_body import finite_element_body
from rotorgear.casings.mesh_error import eigenvalue_errors
from rotorgear.casings.reduction import held_modes, reduce
from rotorgear.casings.settings import CasingSettings
from rotorgear.solvers.sparse.large import best_solver

ALUMINIUM = Elastic(71e9, 0.33, 2700.0)
SIZE = (0.4, 0.3, 0.5)
WALL = 0.02
LARGE = (28, 20, 33)
_TETS = np.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])


def box(path: Path, counts: tuple[int, int, int]) -> Path:
    """Write the deck of a box: walls on a lattice of bricks, linear tetrahedra, which rotorgear raises to quadratic ones."""
    n = np.array(counts)
    i, j, k = np.indices(counts)
    wall = np.zeros(counts, dtype=bool)
    for index, count in zip((i, j, k), counts, strict=True):
        wall |= (index == 0) | (index == count - 1)
    # Lines of the lattice: the walls keep their thickness, the rest is even.
    lines = [
        np.concatenate([[0.0], np.linspace(WALL, size - WALL, count - 1), [size]])
        for size, count in zip(SIZE, counts, strict=True)
    ]
    holes = []
    for centre in (0.3, 0.7):
        inside = (np.abs(i + 0.5 - centre * n[0]) < 0.1 * n[0]) & (np.abs(j + 0.5 - 0.5 * n[1]) < 0.12 * n[1])
        holes.append(inside & ((k == 0) | (k == n[2] - 1)))
        wall &= ~holes[-1]
    corner = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])

    def corners(chosen: np.ndarray) -> np.ndarray:
        return np.asarray((np.argwhere(chosen)[:, None] + corner).reshape(-1, 3))

    places, cells = np.unique(corners(wall), axis=0, return_inverse=True)
    points = np.stack([line[places[:, axis]] for axis, line in enumerate(lines)], axis=1)
    sets = {"feet": places[:, 1] == 0}
    known = {tuple(place): number for number, place in enumerate(places.tolist())}
    for name, hole in zip("ab", holes, strict=True):
        for side, low in (("left", True), ("right", False)):
            chosen = np.zeros(len(places), dtype=bool)
            rim = {tuple(place) for place in corners(hole & ((k == 0) if low else (k > 0))).tolist()}
            chosen[[known[place] for place in rim if place in known]] = True
            sets[f"{side}_{name}"] = chosen
    text = ["*NODE", *(f"{number},{x:.9g},{y:.9g},{z:.9g}" for number, (x, y, z) in enumerate(points, 1))]
    text.append("*ELEMENT, TYPE=C3D4, ELSET=box")
    tets = cells.reshape(-1, 8)[:, _TETS].reshape(-1, 4) + 1
    text += [f"{number},{a},{b},{c},{d}" for number, (a, b, c, d) in enumerate(tets, 1)]
    for name, chosen in sets.items():
        text += [f"*NSET, NSET={name}", *(str(node + 1) for node in np.flatnonzero(chosen))]
    path.write_text("\n".join(text))
    return path


def settings(path: Path, modes_to: float | None = None) -> CasingSettings:
    """The box on its feet, with four seats."""
    seats = tuple((name, name) for name in ("left_a", "left_b", "right_a", "right_b"))
    return CasingSettings("box", (("mesh", path),), 1.0, ALUMINIUM, ("feet",), (), seats, modes_to=modes_to)


def largest_memory() -> float:
    """In GB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024) / 1e9


def large(folder: Path) -> None:
    """Read, assemble and reduce one large mesh."""
    path = box(folder / "box.inp", LARGE)
    start = time.process_time()
    fe = finite_element_body(settings(path))
    assembled = time.process_time()
    body = reduce(fe, None)[0]
    done = time.process_time()
    print(
        f"{fe.dofs} dofs, {best_solver()}: reading and assembly {assembled - start:.1f} CPU s, reduction to {body.size}"
    )
    print(f"coordinates {done - assembled:.1f} CPU s, in all {done - start:.1f} CPU s and {largest_memory():.2f} GB")


def study(folder: Path) -> None:
    """Errors over sizes and over fixed-interface modes."""
    print("dofs      CPU s  first held mode Hz  estimated error of the mesh")
    for counts in ((6, 5, 8), (9, 7, 11), (13, 10, 16), (19, 14, 23)):
        start = time.process_time()
        fe = finite_element_body(settings(box(folder / "box.inp", counts)))
        factor = reduce(fe, None)[1]
        seconds = time.process_time() - start
        modes = held_modes(fe, 1, factor)
        error = 0.5 * eigenvalue_errors(fe, modes.eigenvalues, modes.shapes)[0] / modes.eigenvalues[0]
        print(f"{fe.dofs:<8d} {seconds:6.1f}  {modes.frequency[0]:18.3f}  {error:.1e}")
    fe = finite_element_body(settings(box(folder / "box.inp", (9, 7, 11))))
    reference = held_modes(fe, 8).frequency
    print("\nmodes to  kept  coordinates  CPU s  largest error of 8 held modes  estimated")
    for times in (0.5, 1.0, 1.5, 2.0, 3.0):
        start = time.process_time()
        body = reduce(fe, times * reference[-1])[0]
        seconds = time.process_time() - start
        frequency, shapes = body.modes()
        true = (frequency[:8] / reference - 1.0).max()
        stated = max(
            0.5 * (body.eigenvalue_error((2 * np.pi * f) ** 2, shapes[:, i]) or 0.0)
            for i, f in enumerate(frequency[:8])
        )
        kept = len(body.fixed_frequency)
        print(f"{times:3.1f} f_8   {kept:4d}  {body.size:11d}  {seconds:5.1f}  {true:28.1e}  {stated:.1e}")


def main() -> None:
    """Run the study, or the large case."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true", help="one mesh of 140 000 dofs")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        (large if asked.large else study)(Path(folder))


if __name__ == "__main__":
    main()
