"""Small meshes of blocks for the tests of casings, as arrays and as files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import rotorgear as rg
from rotorgear.casings.elements import element
from rotorgear.casings.file_mesh import FileMesh, NamedSet

# Six tetrahedra fill a brick.
_TETS = np.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])


def bricks(size: tuple[float, float, float], counts: tuple[int, int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Points and linear hexahedra of a block from the origin on."""
    axes = [np.linspace(0.0, length, count + 1) for length, count in zip(size, counts, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    number = np.arange(len(points)).reshape([count + 1 for count in counts])
    low = number[:-1, :-1, :-1].ravel()
    dx, dy, dz = number[1, 0, 0], number[0, 1, 0], number[0, 0, 1]
    offsets = np.array([0, dx, dx + dy, dy, dz, dx + dz, dx + dy + dz, dy + dz])
    return points, low[:, None] + offsets


def block(
    size: tuple[float, float, float] = (0.1, 0.06, 0.2),
    counts: tuple[int, int, int] = (1, 1, 2),
    kind: str = "tetra10",
) -> FileMesh:
    """A block; its sets "low" and "high" are the faces across z, "left" and "right" those across x."""
    points, cells = bricks(size, counts)
    linear = "tetra" if kind.startswith("tetra") else "hexahedron"
    if linear == "tetra":
        cells = cells[:, _TETS].reshape(-1, 4)
    if kind != linear:
        shape = element(kind)
        edges = np.sort(cells[:, np.array(shape.edges)], axis=2)
        keys, inverse = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
        cells = np.hstack([cells, len(points) + inverse.reshape(len(cells), -1)])
        points = np.vstack([points, points[keys].mean(axis=1)])
    sets = {}
    for name, axis, place in (("low", 2, 0.0), ("high", 2, size[2]), ("left", 0, 0.0), ("right", 0, size[0])):
        sets[name] = NamedSet(np.flatnonzero(np.abs(points[:, axis] - place) < 1e-9))
    return FileMesh(points, {kind: cells}, sets)


def write_inp(path: Path, mesh: FileMesh, extra: str = "") -> Path:
    """An Abaqus deck of a mesh, with `extra` lines at its end."""
    names = {"tetra": "C3D4", "tetra10": "C3D10", "hexahedron": "C3D8", "hexahedron20": "C3D20", "wedge": "C3D6"}
    lines = ["*HEADING", "block", "*NODE"]
    lines += [f"{i + 1}, " + ", ".join(f"{x:.17g}" for x in point) for i, point in enumerate(mesh.points)]
    number = 0
    for kind, cells in mesh.cells.items():
        lines.append(f"*ELEMENT, TYPE={names[kind]}, ELSET=body")
        for cell in cells:
            number += 1
            words = [str(number), *(str(node + 1) for node in cell)]
            lines += [", ".join(words[:11]) + ("," if len(words) > 11 else "")]
            if len(words) > 11:
                lines.append(", ".join(words[11:]))
    for name, one in mesh.sets.items():
        lines.append(f"*NSET, NSET={name}")
        words = [str(node + 1) for node in one.nodes]
        lines += [", ".join(words[i : i + 10]) for i in range(0, len(words), 10)]
    path.write_text("\n".join(lines) + "\n" + extra, encoding="utf-8")
    return path


def write_msh(path: Path, mesh: FileMesh, low: np.ndarray) -> Path:
    """A Gmsh file of version 2.2 of quadratic tetrahedra, whose faces `low` (f, 6) are the physical group "low"."""
    order = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]  # Gmsh swaps the last two
    cells = [("9 2 7 7", face) for face in low]
    cells += [("11 2 1 1", cell[order]) for cell in mesh.cells["tetra10"]]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
    lines += ["$PhysicalNames", "2", '2 7 "low"', '3 1 "body"', "$EndPhysicalNames", "$Nodes", str(len(mesh.points))]
    lines += [f"{i + 1} " + " ".join(f"{x:.17g}" for x in point) for i, point in enumerate(mesh.points)]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [f"{i + 1} {kind} " + " ".join(str(n + 1) for n in cell) for i, (kind, cell) in enumerate(cells)]
    path.write_text("\n".join([*lines, "$EndElements", ""]), encoding="utf-8")
    return path


_BOX = """
[materials.own]
youngs_modulus = {modulus!r}
poisson_ratio = {nu!r}
density = {density!r}

[casings.box]
mesh = "box.inp"
unit = "m"
material = "own"
held = ["low"]
seats = {{ left = "high" }}

[shafts.rotor]
position = [{x!r}, {y!r}]
start = {z!r}
sections = [{{ length = {x!r}, outer_diameter = {d!r}, rigid = true }}]

[bearings.left]
shaft = "rotor"
at = "start"
stiffness = {{ radial = "5e8 N/m", axial = "5e8 N/m", tilt = "1e6 N m/rad" }}
casing = "box"
"""


def block_model(
    folder: Path,
    scale: float = 1.0,
    modulus: float = 200e9,
    nu: float = 0.3,
    density: float = 7800.0,
    counts: tuple[int, int, int] = (2, 1, 3),
    kind: str = "hexahedron20",
) -> rg.Model:
    """That block with a rotor on its top, its mesh in a folder."""
    size = (0.1 * scale, 0.06 * scale, 0.2 * scale)
    write_inp(folder / "box.inp", block(size, counts, kind))
    places = {"x": 0.5 * size[0], "y": 0.5 * size[1], "z": size[2], "d": 0.02 * scale}
    return rg.loads(_BOX.format(modulus=modulus, nu=nu, density=density, **places), folder=folder)
