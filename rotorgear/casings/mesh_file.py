"""Reads a mesh file, by meshio or by the readers beside this one, and turns every way of failing into a sentence.

meshio ends the process on a file that it can't read, loses the sets of some formats and stumbles over usual Abaqus and Nastran
decks: nothing else in rotorgear calls it, and decks have their own readers (`abaqus`, `nastran`).
"""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.casings.abaqus import read_abaqus
from rotorgear.casings.file_mesh import FileMesh, NamedSet, gathered, set_of
from rotorgear.casings.nastran import read_nastran
from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.files.bounds import MESH
from rotorgear.files.hdf5 import opened_hdf5
from rotorgear.files.read import UnreadableError, named_file
from rotorgear.memory import at_most

# Data that name groups by numbers: their names stand elsewhere in the file.
_TAGS = ("point_tags", "cell_tags")
# Formats that meshio reads from the named file alone. Those of XDMF, TetGen and others name or fetch further files.
_BY_MESHIO = (".msh", ".vtu", ".vtk", ".med", ".mesh", ".meshb", ".su2", ".avs", ".f3grid", ".vol", ".ugrid")
# Of the data in MED, how many times the file they may be when they are unpacked.
_PACKED = 50
# Memory that meshio may take, times the file and besides: its own modules and the arrays of a small mesh.
_TIMES = 30.0
_ANYWAY = 150e6
_DECKS = {".inp": read_abaqus, ".bdf": read_nastran, ".nas": read_nastran, ".fem": read_nastran, ".dat": read_nastran}


def read_mesh(path: Path, address: str) -> FileMesh:
    """Read a mesh file.

    Args:
        path: of the file; its ending names the format.
        address: in the model file, for errors.

    Raises:
        AnalysisError: no such file, or one that can't be read.
        MissingExtraError: meshio is not installed.
    """
    kinds = (*_DECKS, *_BY_MESHIO)
    if path.is_dir():
        raise AnalysisError(f"{address}: '{path}' is a folder, not the file of a mesh.")
    try:
        named_file(path, MESH.most_bytes)
    except UnreadableError as error:
        if not error.missing:
            raise AnalysisError(f"{address}: '{path.name}' can't be read as a mesh: {error.reason}.") from None
        there = sorted(item.name for item in path.parent.iterdir() if item.is_file()) if path.parent.is_dir() else []
        from rotorgear.quantity import nearest

        guess = nearest(path.name, there)
        hint = f" Did you mean '{guess}'?" if guess else " The path is taken from the folder of the model file."
        raise AnalysisError(f"{address}: there is no file '{path}'.{hint}") from None
    if path.suffix.lower() not in kinds:
        raise AnalysisError(
            f"{address}: '{path.name}' can't be read as a mesh: its ending is none of {', '.join(kinds)}. Export it "
            "as Gmsh .msh 4.1, Abaqus .inp or .vtu, with its solids and its named sets."
        )
    reader = _DECKS.get(path.suffix.lower())
    try:
        mesh = reader(path) if reader else _by_meshio(path)
    except (MissingExtraError, AnalysisError):
        raise
    except UnreadableError as error:
        raise AnalysisError(f"{address}: '{path.name}' can't be read as a mesh: {error.reason}.") from None
    except Exception as error:
        words = " ".join(str(error).split())[:200]
        # A ValueError is a sentence of the readers beside this one, or Python's on what is no number.
        kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
        raise AnalysisError(
            f"{address}: '{path.name}' can't be read as a mesh ({kind}{words}). Export it as Gmsh .msh 4.1, "
            "Abaqus .inp or .vtu, with its solids and its named sets."
        ) from None
    if mesh.points.ndim != 2 or mesh.points.shape[1] != 3 or not np.all(np.isfinite(mesh.points)):
        raise AnalysisError(f"{address}: the points of '{path.name}' are not three finite coordinates each.")
    for kind, cells in mesh.cells.items():
        if not np.issubdtype(cells.dtype, np.integer) or cells.min() < 0 or cells.max() >= len(mesh.points):
            raise AnalysisError(
                f"{address}: {kind} cells of '{path.name}' have nodes that the file does not give; it has "
                f"{len(mesh.points)}. Export the mesh anew."
            )
    return mesh


def _by_meshio(path: Path) -> FileMesh:
    """Read a file by meshio; its output and its exit of the process are caught."""
    try:
        import meshio
    except ImportError:
        raise MissingExtraError("A casing from a mesh file", "meshio", "casing") from None
    if path.suffix.lower() == ".med":
        with opened_hdf5(path, MESH.most_bytes, packed=_PACKED):
            pass
    size = path.stat().st_size
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), at_most(_TIMES * size + _ANYWAY):
            found = meshio.read(path)
    except MemoryError:
        raise ValueError("it unpacks to more than any mesh of its size") from None
    except SystemExit:
        words = " ".join(said.getvalue().split())[-200:]
        raise RuntimeError(f"meshio gave up: {words}") from None
    blocks = [(block.type, np.asarray(block.data, dtype=np.int64)) for block in found.cells]
    points = np.asarray(found.points, dtype=float)
    if points.ndim == 2 and points.shape[1] == 2:
        raise RuntimeError("the mesh is plane")
    return FileMesh(points, gathered(blocks), _sets(found, blocks))


def _sets(found: Any, blocks: list[tuple[str, np.ndarray]]) -> dict[str, NamedSet]:
    """Named sets of a file, wherever its format keeps them."""

    def of_cells(chosen: Iterable[np.ndarray]) -> NamedSet:
        """The set of the cells that numbers or truths choose in each block."""
        return set_of([(kind, cells[those]) for (kind, cells), those in zip(blocks, chosen, strict=False)])

    sets = {name: NamedSet(np.unique(np.asarray(nodes, dtype=np.int64))) for name, nodes in found.point_sets.items()}
    for name, numbers in found.cell_sets.items():
        if not name.startswith("gmsh:"):
            sets[name] = of_cells(np.asarray(() if those is None else those, dtype=np.int64) for those in numbers)
    # Gmsh 2.2: the name of a physical group stands in the header, its number with every cell.
    tags = found.cell_data.get("gmsh:physical")
    if tags is not None:
        known = {"line": 1, "line3": 1, "vertex": 0}
        dimensions = [known.get(kind, 2 if kind.startswith(("tri", "quad")) else 3) for kind, _ in blocks]
        for name, (number, dimension) in found.field_data.items():
            own = [(np.asarray(tag) == number) & (dim == dimension) for tag, dim in zip(tags, dimensions, strict=True)]
            sets.setdefault(name, of_cells(own))
    # MED: families of points and cells, each with the names of the groups that it belongs to.
    for kind, data in (("point_tags", found.point_data), ("cell_tags", found.cell_data)):
        families: dict[str, list[int]] = {}
        for number, names in getattr(found, kind, {}).items() if kind in data else ():
            for name in names:
                families.setdefault(name.strip("\0 "), []).append(number)
        for name, numbers in families.items():
            if kind == "point_tags":
                sets.setdefault(name, NamedSet(np.flatnonzero(np.isin(data[kind], numbers))))
            else:
                sets.setdefault(name, of_cells(np.isin(tag, numbers) for tag in data[kind]))
    # Sets that a format without sets (VTK) keeps as whole numbers of points or cells. Data of zeros and ones mark the members of
    # one set; data of -1 for none and 0, 1, ... for sets are named after them all, joined by "-", as meshio writes its sets where
    # a format has none.
    marked: dict[str, NamedSet] = {}
    for name, values in found.point_data.items():
        marked |= {one: NamedSet(np.flatnonzero(own[0])) for one, own in _members([np.asarray(values)], name)}
    for name, of_blocks in found.cell_data.items():
        marked |= {one: of_cells(own) for one, own in _members([np.asarray(values) for values in of_blocks], name)}
    for name, one_set in marked.items():
        sets.setdefault(name, one_set)
    return {name: one for name, one in sets.items() if name}


def _members(data: list[np.ndarray], name: str) -> Iterator[tuple[str, list[np.ndarray]]]:
    """Yield each set that whole numbers (by block) mark, and its members in each block."""
    if ":" in name or name in _TAGS or any(values.ndim != 1 or values.dtype.kind not in "iub" for values in data):
        return
    data = [values.astype(np.int64) for values in data]
    there = np.unique(np.concatenate([*data, np.zeros(0, np.int64)]))
    if not there.size:
        return
    if there[0] >= 0 and there[-1] == 1:
        yield name, [values == 1 for values in data]
    names = name.split("-")
    # A name of two parts with zeros and ones may be either: both are there to choose from.
    if there[0] >= -1 and len(names) == there[-1] + 1 and (len(names) > 1 or there[0] < 0):
        for number, one in enumerate(names):
            yield one, [values == number for values in data]
