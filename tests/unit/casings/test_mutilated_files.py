"""Mutilated mesh files of every format: each is read, or told in one sentence with its address; nothing else comes out."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rotorgear.casings.assembly import Elastic
from rotorgear.casings.fe_body import finite_element_body
from rotorgear.casings.file_mesh import FileMesh, NamedSet
from rotorgear.casings.patches import Cylinder
from rotorgear.casings.reduction import reduce
from rotorgear.casings.settings import CasingSettings
from rotorgear.errors import RotorgearError
from tests.unit.casings.blocks import block, write_inp, write_msh
from tests.unit.casings.test_mesh_file import low_faces

meshio = pytest.importorskip("meshio")
FORMATS = ("inp", "bdf", "msh22", "msh41", "vtu", "med")
WITH_SETS = ("inp", "msh22", "msh41", "med")
# A face of the block that needs no set: a wide "bore" can't be there, so that formats without sets are held by nothing.
NO_BORE = Cylinder((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.0, 0.2, 0.03)


def write(folder: Path, form: str, found: FileMesh) -> Path:
    """A file of a format, with the face z = 0 as the set "low" where the format has sets."""
    path = folder / f"box.{form[:3]}"
    kind = next(iter(found.cells), "tetra10")
    cells = found.cells.get(kind, np.zeros((0, 10), dtype=int))
    faces = low_faces(found) if kind == "tetra10" and len(cells) else np.zeros((0, 6), dtype=int)
    if form == "inp":
        return write_inp(path, found)
    if form == "bdf":
        lines = [f"GRID,{i + 1},,{x!r},{y!r},{z!r}" for i, (x, y, z) in enumerate(found.points.tolist())]
        for i, cell in enumerate(cells):
            words = [str(n + 1) for n in cell]
            lines += [f"CTETRA,{i + 1},1," + ",".join(words[:6]) + ",+", "+," + ",".join(words[6:])]
        lines += [f"CTRIA6,{900 + i},7," + ",".join(str(n + 1) for n in face) for i, face in enumerate(faces)]
        path.write_text("\n".join([*lines, "ENDDATA"]), encoding="utf-8")
        return path
    if form == "msh22":
        return write_msh(path, found, faces)
    blocks = [("triangle6", faces), (kind, cells)]
    if form == "med":
        tags = [np.full(len(faces), -3), np.full(len(cells), -4)]
        mesh = meshio.Mesh(found.points, blocks, cell_data={"cell_tags": tags})
        mesh.cell_tags = {-3: ["low"], -4: ["body"]}
        meshio.write(path, mesh)
    elif form == "msh41":
        path.write_text(_gmsh(found, faces, cells), encoding="utf-8")
    else:
        meshio.write(path, meshio.Mesh(found.points, blocks[1:]), binary=False)
    return path


def _gmsh(found: FileMesh, faces: np.ndarray, cells: np.ndarray) -> str:
    """A file of version 4.1 of quadratic tetrahedra, whose faces are the physical group "low"."""
    n, f, e = len(found.points), len(faces), len(cells)
    lines = [
        "$MeshFormat",
        "4.1 0 8",
        "$EndMeshFormat",
        "$PhysicalNames",
        "2",
        '2 2 "low"',
        '3 1 "body"',
        "$EndPhysicalNames",
    ]
    lines += ["$Entities", "0 0 1 1", "1 0 0 0 1 1 1 1 2 0", "1 0 0 0 1 1 1 1 1 0", "$EndEntities"]
    lines += ["$Nodes", f"1 {n} 1 {n}", f"3 1 0 {n}", *(str(i + 1) for i in range(n))]
    lines += [" ".join(f"{x:.17g}" for x in point) for point in found.points]
    lines += ["$EndNodes", "$Elements", f"2 {f + e} 1 {f + e}", f"2 1 9 {f}"]
    lines += [f"{i + 1} " + " ".join(str(node + 1) for node in face) for i, face in enumerate(faces)]
    lines.append(f"3 1 11 {e}")
    order = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]  # Gmsh swaps the last two
    lines += [f"{f + i + 1} " + " ".join(str(node + 1) for node in cell[order]) for i, cell in enumerate(cells)]
    return "\n".join([*lines, "$EndElements", ""])


def outcome(path: Path, form: str, unit: float = 1.0, **more: object) -> str:
    """ "read", or the one sentence that came out."""
    sets = form in WITH_SETS or form == "bdf"
    low = "property_7" if form == "bdf" else "low"
    fields: dict[str, object] = {"seats": (("one", low),) if sets else ()}
    fields |= more
    one = CasingSettings("b", (("mesh", path),), unit, Elastic(206e9, 0.3, 7850.0), **fields)  # type: ignore[arg-type]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            body = finite_element_body(one)
            if one.seats:
                reduce(body, None)
        except RotorgearError as error:
            text = str(error)
            assert text.startswith("casings.b"), text
            assert "\n" not in text.strip(), text
            assert "Traceback" not in text
            return text
    return "read"


# What may be wrong with the mesh itself: a name, and the mesh that has it.
def _changed(change: Callable[[FileMesh], None]) -> Callable[[], FileMesh]:
    def made() -> FileMesh:
        found = block()
        change(found)
        return found

    return made


def _cells(change: Callable[[np.ndarray], np.ndarray]) -> Callable[[], FileMesh]:
    def apply(found: FileMesh) -> None:
        found.cells["tetra10"] = change(found.cells["tetra10"].copy())

    return _changed(apply)


def _points(change: Callable[[np.ndarray], object]) -> Callable[[], FileMesh]:
    def apply(found: FileMesh) -> None:
        change(found.points)

    return _changed(apply)


def _set(where: object, value: object) -> Callable[[np.ndarray], np.ndarray]:
    def change(values: np.ndarray) -> np.ndarray:
        values[where] = value  # type: ignore[call-overload]
        return values

    return change


def _two_bodies(found: FileMesh) -> None:
    other = block()
    cells = np.vstack([found.cells["tetra10"], other.cells["tetra10"] + len(found.points)])
    found.points = np.vstack([found.points, other.points + np.array([0.5, 0.0, 0.0])])
    found.cells["tetra10"] = cells


def _folded(found: FileMesh) -> None:
    cell = found.cells["tetra10"][0]
    found.points[cell[4]] = found.points[cell[2]] + 0.2 * (found.points[cell[2]] - found.points[cell[0]])


MESHES: dict[str, tuple[Callable[[], FileMesh], str]] = {
    "whole": (block, "read"),
    "no cells": (_cells(lambda cells: cells[:0]), "no solid cells"),
    "one element": (_cells(lambda cells: cells[:1]), ""),
    "an element twice": (_cells(lambda cells: np.vstack([cells, cells[:1]])), "stand twice in the file"),
    "a node twice in an element": (_cells(_set((0, 1), 0)), ""),
    "all corners the same": (_cells(_set((0, slice(0, 4)), 3)), ""),
    "a corner swapped": (_cells(lambda cells: cells[:, [1, 0, *range(2, 10)]]), ""),
    "edges in another order": (_cells(lambda cells: cells[:, [0, 1, 2, 3, 9, 8, 7, 6, 5, 4]]), ""),
    "a folded element": (_changed(_folded), ""),
    "two bodies": (_changed(_two_bodies), "2 bodies that do not hang together"),
    "a point that is no number": (_points(_set((3, 1), np.nan)), "finite"),
    "a point at infinity": (_points(_set((3, 1), np.inf)), "finite"),
    "a point far away": (_points(_set((0, 0), 1e12)), ""),
    "a point moved into the next element": (_points(_set(0, [0.09, 0.05, 0.19])), "lie in one another"),
    "flat": (_points(_set((slice(None), 2), 0.0)), "no volume"),
    "all points the same": (_points(_set(slice(None), 1.0)), "no volume"),
    "points that no element uses": (
        _changed(lambda found: setattr(found, "points", np.vstack([found.points, [[9.0, 9.0, 9.0]]]))),
        "read",
    ),
    "two points the same": (_points(lambda points: points.__setitem__(1, points[0])), ""),
    "a middle on a corner": (_points(lambda points: points.__setitem__(20, points[0])), ""),
    "mirrored": (_points(lambda points: points.__imul__([-1.0, 1.0, 1.0])), "read"),
}


@pytest.mark.parametrize("form", FORMATS)
def test_a_broken_mesh_is_told_in_a_sentence(tmp_path: Path, form: str) -> None:
    for name, (made, words) in MESHES.items():
        found = made()
        try:
            path = write(tmp_path, form, found)
        except Exception:  # what the format itself can't hold is no file
            continue
        said = outcome(path, form)
        # An empty block of cells may be more than a reader can take.
        assert words in said or "can't be read as a mesh" in said, (name, said)


def cut(share: float) -> Callable[[bytes], bytes]:
    return lambda data: data[: int(share * len(data))]


def replaced(old: bytes, new: bytes, count: int = 1) -> Callable[[bytes], bytes]:
    return lambda data: data.replace(old, new, count)


def without_line(number: int) -> Callable[[bytes], bytes]:
    def apply(data: bytes) -> bytes:
        lines = data.split(b"\n")
        return b"\n".join(lines[: number % len(lines)] + lines[number % len(lines) + 1 :])

    return apply


def twice_line(number: int) -> Callable[[bytes], bytes]:
    def apply(data: bytes) -> bytes:
        lines = data.split(b"\n")
        k = number % len(lines)
        return b"\n".join([*lines[: k + 1], lines[k], *lines[k + 1 :]])

    return apply


TEXTS: dict[str, Callable[[bytes], bytes]] = {
    "empty": cut(0.0),
    "a tenth": cut(0.1),
    "a half": cut(0.5),
    "nine tenths": cut(0.9),
    "all but the end": cut(0.995),
    "zeros": lambda data: bytes(len(data)),
    "noise": lambda data: bytes(range(256)) * 8,
    "noise behind": lambda data: data + bytes(range(256)),
    "commas gone": lambda data: data.replace(b",", b" "),
    "a comma for every point": lambda data: data.replace(b".", b","),
    "lines of Windows": lambda data: data.replace(b"\n", b"\r\n"),
    "lines of old Macs": lambda data: data.replace(b"\n", b"\r"),
    "wide characters": lambda data: data.decode("latin-1").encode("utf-16"),
    "a letter among numbers": lambda data: data.replace(b"0.1", b"0.x", 3),
    "signs turned": lambda data: data.replace(b" 1", b" -1", 40),
    "numbers too large": lambda data: data.replace(b"0.1", b"1e400", 2),
    "numbers grown": lambda data: data.replace(b"2", b"99999999999999999999", 7),
    "capitals": lambda data: data.upper(),
    "small letters": lambda data: data.lower(),
    "a name gone": lambda data: data.replace(b"low", b""),
    **{f"line {n} gone": without_line(n) for n in (0, 1, 2, 3, 5, 8, 13, 30, 50, -2, -3, -8)},
    **{f"line {n} twice": twice_line(n) for n in (0, 1, 2, 4, 6, 12, 31, 45, -2, -4)},
}


@pytest.mark.parametrize("form", FORMATS)
def test_a_broken_file_is_told_in_a_sentence(tmp_path: Path, form: str) -> None:
    path = write(tmp_path, form, block())
    whole = path.read_bytes()
    said = {}
    for name, change in TEXTS.items():
        path.write_bytes(change(whole))
        said[name] = outcome(path, form)
    # A file of nothing, or of noise, is never taken for a mesh.
    assert all(said[name] != "read" for name in ("empty", "a tenth", "zeros", "noise"))


@pytest.mark.parametrize("form", WITH_SETS)
def test_sets_and_units_that_do_not_fit_are_told(tmp_path: Path, form: str) -> None:
    path = write(tmp_path, form, block())
    wrong = {
        "lwo": {"seats": (("one", "lwo"),)},
        "nodes of this seat are held": {"held": ("low",)},
        "casings.b.unit: the mesh measures": {"unit": 1e-6},
        "no face of the mesh lies on this cylinder": {"seats": (("one", NO_BORE),)},
    }
    for words, more in wrong.items():
        assert words in outcome(path, form, **more)  # type: ignore[arg-type]


def test_a_set_without_nodes_is_told(tmp_path: Path) -> None:
    found = block()
    found.sets["low"] = NamedSet(np.zeros(0, dtype=int))
    assert "low" in outcome(write_inp(tmp_path / "box.inp", found), "inp")
