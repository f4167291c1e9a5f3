"""Reads the mesh of an Abaqus or CalculiX deck (.inp): nodes, solid elements, node sets, element sets and surfaces.

meshio ends the process at elements that it does not know (a mesher writes CPS6 on every named face), reads one block of nodes
only, and takes no sets from headings. Here any number of blocks is read; elements that are no solids give sets of faces.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rotorgear.casings.elements import element
from rotorgear.casings.file_mesh import FACES, SOLIDS, FileMesh, Listed, NamedSet, gathered, not_read, places_of, set_of
from rotorgear.files.bounds import MESH
from rotorgear.files.numbers import is_count, number_of, whole_of
from rotorgear.files.read import text_lines

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
# Lines that a keyword may go on over.
_MOST_CONTINUED = 100
_SHELL_SIDES = ("SPOS", "SNEG")
# Keywords of loads and connections that decks hold beside the elements; they are not read, and a note says so.
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
# Corners of the faces S1, S2, ... of solids, by the number of all corners.
_SIDES = {
    4: ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)),
    8: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (1, 2, 5, 6), (2, 3, 6, 7), (0, 3, 4, 7)),
}


def read_abaqus(path: Path) -> FileMesh:
    """Read a deck; ValueError says what in it can't be read."""
    coordinates: dict[int, list[float]] = {}
    blocks: list[tuple[str, np.ndarray, np.ndarray]] = []
    node_sets: dict[str, Listed] = {}
    cell_sets: dict[str, Listed] = {}
    surfaces: dict[str, list[tuple[str, str]]] = {}
    nodes_of_elements: dict[str, str] = {}
    instanced = False
    beside: dict[str, None] = {}
    for keyword, options, lines in _keywords(path):
        if keyword == "SYSTEM" or (keyword == "NODE" and options.get("SYSTEM", "R").upper() != "R"):
            raise ValueError("its nodes stand in a coordinate system of their own: export global coordinates x, y, z")
        if keyword in _BESIDE:
            beside[keyword] = None
        elif keyword == "NODE":
            for line in lines:
                number, *xyz = line.rstrip(",").split(",")
                if len(xyz) < 3:
                    raise ValueError(f"node {number.strip()} has {len(xyz)} coordinates, not three")
                place = [number_of(x) for x in xyz[:3]]
                if coordinates.setdefault(whole_of(number), place) != place:
                    raise ValueError(f"node {number.strip()} is given twice, at two places")
            if "NSET" in options:
                node_sets.setdefault(options["NSET"], Listed()).numbers += [int(line.split(",")[0]) for line in lines]
        elif keyword == "ELEMENT":
            kind, count = _element(options.get("TYPE", "").upper())
            numbers = [whole_of(item) for line in lines for item in line.split(",") if item.strip()]
            if len(numbers) % (count + 1):
                raise ValueError(f"elements {options.get('TYPE')} with another number of nodes than {count}")
            table = np.array(numbers, dtype=np.int64).reshape(-1, count + 1)
            blocks.append((kind, table[:, 1:], table[:, 0]))
            if "ELSET" in options:
                cell_sets.setdefault(options["ELSET"], Listed()).numbers += table[:, 0].tolist()
        elif keyword == "NSET" and "ELSET" in options:
            nodes_of_elements[options.get("NSET", "")] = options["ELSET"]
        elif keyword in ("NSET", "ELSET"):
            sets = node_sets if keyword == "NSET" else cell_sets
            _list(sets.setdefault(options.get(keyword, ""), Listed()), options, lines, sets)
        elif keyword == "SURFACE":
            items = [[item.strip().strip('"') for item in f"{line}, ".split(",")] for line in lines]
            surfaces.setdefault(options.get("NAME", ""), []).extend((row[0], row[1]) for row in items)
        elif keyword == "INCLUDE":
            raise ValueError(f"it includes another file, {options.get('INPUT', '')}: put both into one")
        elif keyword == "INSTANCE":
            if instanced or lines:
                raise ValueError("it has several instances or a moved one: export a flat deck without parts")
            instanced = True
    if not coordinates:
        raise ValueError("it has no *NODE")
    places = places_of(coordinates, "node")
    cells = [(kind, places(rows), ids) for kind, rows, ids in blocks]
    known = np.array(list(coordinates))

    def nodes_of(listed: Listed) -> np.ndarray:
        """Places of listed nodes; single ones must be there, of a range those that are count."""
        places(listed.numbers)
        return np.flatnonzero(listed.among(known))

    named = {name: NamedSet(nodes_of(listed)) for name, listed in node_sets.items() if name}
    named = {name: one for name, one in named.items() if len(one.nodes)}

    def chosen(listed: Listed) -> list[tuple[str, np.ndarray]]:
        return [(kind, nodes[listed.among(ids)]) for kind, nodes, ids in cells]

    for name, listed in cell_sets.items():
        found = set_of(chosen(listed))
        # A deck often has one name for the nodes and for the faces of a place; then the faces say more.
        if name and (name not in named or (found.faces and np.array_equal(found.nodes, named[name].nodes))):
            named[name] = found
    for name, elements in nodes_of_elements.items():
        named.setdefault(name, NamedSet(set_of(chosen(cell_sets.get(elements, Listed()))).nodes))
    for name, sides in surfaces.items():
        # Sides of one list and face belong together: a surface may name each element by itself.
        lists: dict[str, tuple[Listed, Listed]] = {}
        for which, label in sides:
            cells_listed, nodes_listed = lists.setdefault(label, (Listed(), Listed()))
            _list(cells_listed, {}, [which], cell_sets)
            _list(nodes_listed, {}, [which], node_sets)
        faces = [rows for label, (listed, _) in lists.items() for rows in _faces(chosen(listed), label)]
        nodes = [np.flatnonzero(listed.among(known)) for _, listed in lists.values()]
        if name and name not in named and (faces or any(map(len, nodes))):
            all_nodes = np.concatenate([rows.ravel() for rows in faces] or nodes)
            corners = [rows[:, : 4 if rows.shape[1] in (4, 8, 9) else 3] for rows in faces]
            named[name] = NamedSet(np.unique(all_nodes), corners)
    return FileMesh(
        np.array(list(coordinates.values())),
        gathered([(kind, nodes) for kind, nodes, _ in cells]),
        named,
        not_read(list(beside)),
    )


def _faces(cells: list[tuple[str, np.ndarray]], label: str) -> Iterator[np.ndarray]:
    """Yield the nodes (f, m) of a line of a surface: cells that are faces, and the face S1 to S6 of those that are solids."""
    for kind, nodes in cells:
        if not len(nodes):
            continue
        if kind in FACES:
            yield nodes
        elif label and label.upper() not in _SHELL_SIDES and kind in SOLIDS:
            shape = element(kind)
            sides = {f"S{number}": list(corners) for number, corners in enumerate(_SIDES[shape.corners], start=1)}
            side = sides.get(f"S{label.upper().removeprefix('S')}")
            if side is None:
                raise ValueError(f"a *SURFACE has the face {label} of {kind} elements")
            # Nodes on the edges of the face too.
            yield nodes[:, shape.face_nodes[[sorted(face) == side for face in shape.faces].index(True)]]


def _keywords(path: Path) -> Iterator[tuple[str, dict[str, str], list[str]]]:
    """Yield keyword, options (names in capitals) and lines of data of every block."""
    lines = [line for raw in text_lines(path, MESH.most_bytes) if (line := raw.strip()) and not line.startswith("**")]
    for block in re.split(r"^\*", "\n".join(lines), flags=re.MULTILINE)[1:]:
        head, *data = block.rstrip("\n").split("\n")
        for _ in range(_MOST_CONTINUED):
            if not (head.endswith(",") and data):
                break
            head += data.pop(0)  # a keyword goes on in the next line
        keyword, *items = head.split(",")
        options = (item.partition("=") for item in items)
        yield (
            keyword.strip().upper(),
            {key.strip().upper(): value.strip().strip('"') for key, _, value in options},
            data,
        )


def _element(name: str) -> tuple[str, int]:
    # C3D10M and C3D20R are C3D10 and C3D20; C3D100 would be neither.
    known = [start for start in _ELEMENTS if name.startswith(start) and not name[len(start) : len(start) + 1].isdigit()]
    if not known:
        raise ValueError(f"elements of the type {name or 'without a name'}")
    return _ELEMENTS[max(known, key=len)]


def _list(listed: Listed, options: dict[str, str], lines: list[str], sets: dict[str, Listed]) -> None:
    """Add what lines of data list: numbers, ranges, and names of other sets."""
    for line in lines:
        items = [item.strip() for item in line.split(",") if item.strip()]
        if "GENERATE" in options:
            if not 2 <= len(items) <= 3:
                raise ValueError("GENERATE without first and last number")
            first, last, step = (*map(whole_of, items), 1)[:3]
            if step < 1:
                raise ValueError(f"GENERATE with the step {step}")
            listed.ranges.append((first, last, step))
            continue
        for item in items:
            if is_count(item):
                listed.numbers.append(int(item))
            else:
                listed.add(sets.get(item.strip('"'), Listed()))
