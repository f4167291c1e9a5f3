"""Reads the mesh of an Abaqus or CalculiX deck (.inp): nodes, solid elements, node sets, element sets and surfaces.

meshio ends the process at elements that it does not know (a mesher writes CPS6 on every named face), reads one block of nodes
only, and takes no sets from headings. Here any number of blocks is read; elements that are no solids give sets of faces.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rotorgear.casings.elements import element
from rotorgear.casings.file_mesh import FACES, SOLIDS, FileMesh, NamedSet, gathered, not_read, set_of

# Elements by how their names begin: kind and number of nodes; the longest beginning counts.
_ELEMENTS = {
    "C3D4": ("tetra", 4),
    "C3D10": ("tetra10", 10),
    "C3D8": ("hexahedron", 8),
    "C3D20": ("hexahedron20", 20),
    "C3D27": ("hexahedron27", 27),
    "C3D6": ("wedge", 6),
    "C3D15": ("wedge15", 15),
    "C3D5": ("pyramid", 5),
    **dict.fromkeys(("CPS3", "CPE3", "CAX3", "S3", "STRI3", "M3D3", "R3D3", "SFM3D3", "DC2D3"), ("triangle", 3)),
    **dict.fromkeys(("CPS6", "CPE6", "CAX6", "S6", "STRI65", "M3D6", "SFM3D6", "DC2D6"), ("triangle6", 6)),
    **dict.fromkeys(("CPS4", "CPE4", "CAX4", "S4", "M3D4", "R3D4", "SFM3D4"), ("quad", 4)),
    **dict.fromkeys(("CPS8", "CPE8", "CAX8", "S8", "M3D8", "SFM3D8"), ("quad8", 8)),
    **dict.fromkeys(("T2D2", "T3D2", "B21", "B31"), ("line", 2)),
    **dict.fromkeys(("T2D3", "T3D3", "B22", "B32"), ("line3", 3)),
}
_SHELL_SIDES = ("SPOS", "SNEG")
# What decks put on a body beside its elements; it is not read, and that is said.
_BESIDE = (
    "COUPLING",
    "DISTRIBUTING COUPLING",
    "KINEMATIC COUPLING",
    "RIGID BODY",
    "MPC",
    "EQUATION",
    "TIE",
    "CONTACT PAIR",
)
# Corners of the faces S1, S2, ... of solids.
_TET_FACES = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))
_HEX_FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))


def read_abaqus(path: Path) -> FileMesh:
    """Read a deck; ValueError says what in it can't be read."""
    coordinates: dict[int, list[float]] = {}
    blocks: list[tuple[str, list[list[int]], list[int]]] = []
    node_sets: dict[str, list[int]] = {}
    cell_sets: dict[str, list[int]] = {}
    surfaces: dict[str, list[tuple[str, str]]] = {}
    nodes_of_elements: dict[str, str] = {}
    instances = 0
    beside: list[str] = []
    for keyword, options, lines in _keywords(path):
        if keyword == "SYSTEM" or (keyword == "NODE" and options.get("SYSTEM", "R").upper() != "R"):
            raise ValueError("its nodes stand in a coordinate system of their own: export global coordinates x, y, z")
        if keyword in _BESIDE:
            if keyword not in beside:
                beside.append(keyword)
        elif keyword == "NODE":
            for line in lines:
                number, *xyz = line.rstrip(",").split(",")
                if len(xyz) < 3:
                    raise ValueError(f"node {number.strip()} has {len(xyz)} coordinates, not three")
                place = [float(x) for x in xyz[:3]]
                if coordinates.setdefault(int(number), place) != place:
                    raise ValueError(f"node {number.strip()} is given twice, at two places")
            if "NSET" in options:
                node_sets.setdefault(options["NSET"], []).extend(int(line.split(",")[0]) for line in lines)
        elif keyword == "ELEMENT":
            kind, count = _element(options.get("TYPE", "").upper())
            numbers = [int(item) for line in lines for item in line.split(",") if item.strip()]
            if len(numbers) % (count + 1):
                raise ValueError(f"elements {options.get('TYPE')} with another number of nodes than {count}")
            rows = [numbers[i : i + count + 1] for i in range(0, len(numbers), count + 1)]
            blocks.append((kind, [row[1:] for row in rows], [row[0] for row in rows]))
            if "ELSET" in options:
                cell_sets.setdefault(options["ELSET"], []).extend(row[0] for row in rows)
        elif keyword == "NSET" and "ELSET" in options:
            nodes_of_elements[options.get("NSET", "")] = options["ELSET"]
        elif keyword in ("NSET", "ELSET"):
            sets = node_sets if keyword == "NSET" else cell_sets
            sets.setdefault(options.get(keyword, ""), []).extend(_members(options, lines, sets))
        elif keyword == "SURFACE":
            items = [[item.strip().strip('"') for item in line.split(",")] for line in lines]
            surfaces.setdefault(options.get("NAME", ""), []).extend(
                (row[0], row[1] if len(row) > 1 else "") for row in items
            )
        elif keyword == "INCLUDE":
            raise ValueError(f"it includes another file, {options.get('INPUT', '')}: put both into one")
        elif keyword == "INSTANCE":
            instances += 1
            if instances > 1 or any(line.strip() for line in lines):
                raise ValueError("it has several instances or a moved one: export a flat deck without parts")
    if not coordinates:
        raise ValueError("it has no *NODE")
    order = {number: place for place, number in enumerate(coordinates)}
    try:
        cells = [(kind, np.array([[order[node] for node in row] for row in rows])) for kind, rows, _ in blocks]
        named = {
            name: NamedSet(np.unique([order[node] for node in nodes]))
            for name, nodes in node_sets.items()
            if nodes and name
        }
    except KeyError as error:
        raise ValueError(f"node {error.args[0]} is named but not given") from None
    for name, numbers in cell_sets.items():
        wanted = np.array(numbers)
        chosen = [
            (kind, rows[np.isin(ids, wanted)])
            for (kind, rows), (_, _, ids) in zip(cells, blocks, strict=True)
            if len(rows)
        ]
        found = set_of(chosen)
        # A deck often has one name for the nodes and for the faces of a place; then the faces say more.
        if name and (name not in named or (found.faces and np.array_equal(found.nodes, named[name].nodes))):
            named[name] = found
    for name, elements in nodes_of_elements.items():
        wanted = np.array(cell_sets.get(elements, []))
        of_blocks = [rows[np.isin(ids, wanted)].ravel() for (_, rows), (_, _, ids) in zip(cells, blocks, strict=True)]
        named.setdefault(name, NamedSet(np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *of_blocks]))))
    for name, places in surfaces.items():
        faces = [rows for place in places for rows in _faces_at(place, cells, blocks, cell_sets)]
        nodes = [node for place, _ in places for node in _members({}, [place], node_sets) if node in order]
        on_nodes = [np.array([order[node] for node in nodes], dtype=np.int64)] if nodes and not faces else []
        if name and name not in named and (faces or on_nodes):
            all_nodes = np.unique(np.concatenate([rows.ravel() for rows in (*faces, *on_nodes)]))
            named[name] = NamedSet(all_nodes, [rows[:, : 4 if rows.shape[1] in (4, 8, 9) else 3] for rows in faces])
    return FileMesh(np.array(list(coordinates.values())), gathered(cells), named, not_read(beside))


def _faces_at(
    place: tuple[str, str],
    cells: list[tuple[str, np.ndarray]],
    blocks: list[tuple[str, list[list[int]], list[int]]],
    cell_sets: dict[str, list[int]],
) -> Iterator[np.ndarray]:
    """Yield the nodes (f, m) of a line of a surface: an element or a set of them, and a face S1 to S6 of each."""
    which, label = place
    wanted = list(_members({}, [which], cell_sets))
    if label.upper() in _SHELL_SIDES:
        label = ""
    for (kind, rows), (_, _, ids) in zip(cells, blocks, strict=True):
        chosen = rows[np.isin(ids, wanted)]
        if not len(chosen):
            continue
        if kind in FACES:
            yield chosen
        elif label and kind in SOLIDS:
            number = int(label.upper().removeprefix("S")) - 1 if label.upper().removeprefix("S").isdigit() else -1
            corners = (
                (_TET_FACES if kind.startswith("tetra") else _HEX_FACES)[number : number + 1] if number >= 0 else ()
            )
            if not corners:
                raise ValueError(f"a *SURFACE has the face {label} of {kind} elements")
            nodes = list(corners[0])
            if kind not in ("tetra", "hexahedron"):  # nodes on the edges of the face too
                shape = element(kind)
                same = [sorted(face) == sorted(nodes) for face in shape.faces]
                nodes = shape.face_nodes[same.index(True)].tolist()
            yield chosen[:, nodes]


def _keywords(path: Path) -> Iterator[tuple[str, dict[str, str], list[str]]]:
    """Yield keyword, options (names in capitals) and lines of data of every block."""
    keyword = ""
    options: dict[str, str] = {}
    lines: list[str] = []
    pending = ""
    with path.open(encoding="utf-8", errors="replace") as file:
        for raw in file:
            line = raw.strip()
            if not line or line.startswith("**"):
                continue
            if not line.startswith("*") and not pending:
                lines.append(line)
                continue
            pending += line
            if pending.endswith(","):  # a keyword goes on in the next line
                continue
            if keyword:
                yield keyword, options, lines
            head, *items = pending.lstrip("*").split(",")
            keyword = head.strip().upper()
            options = {
                key.strip().upper(): value.strip().strip('"') for key, _, value in (i.partition("=") for i in items)
            }
            lines = []
            pending = ""
    if keyword:
        yield keyword, options, lines


def _element(name: str) -> tuple[str, int]:
    known = [start for start in _ELEMENTS if name.startswith(start)]
    # C3D10M and C3D20R are C3D10 and C3D20; C3D100 would be neither.
    known = [start for start in known if not name[len(start) : len(start) + 1].isdigit()]
    if not known:
        raise ValueError(f"elements of the type {name or 'without a name'}")
    return _ELEMENTS[max(known, key=len)]


def _members(options: dict[str, str], lines: list[str], sets: dict[str, list[int]]) -> Iterator[int]:
    for line in lines:
        items = [item.strip() for item in line.split(",") if item.strip()]
        if "GENERATE" in options:
            first, last = int(items[0]), int(items[1])
            yield from range(first, last + 1, int(items[2]) if len(items) > 2 else 1)
            continue
        for item in items:
            if item.isdigit():
                yield int(item)
            else:
                yield from sets.get(item.strip('"'), [])
