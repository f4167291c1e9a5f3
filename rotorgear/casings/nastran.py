"""Reads the mesh of a Nastran deck (.bdf): GRID, solid elements, and the faces of shells by their properties.

Fields are free (commas), small (8 columns) or large (16 columns, a star). meshio wants BEGIN BULK, which meshers leave out, and
has no sets; here the faces of property N are the set "property_N", and SET N of the case control, SET1 cards and SPC1 cards of a
number N are the sets of nodes "set_N" and "spc_N".
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rotorgear.casings.file_mesh import FileMesh, Listed, NamedSet, gathered, not_read, places_of, set_of
from rotorgear.files.bounds import MESH
from rotorgear.files.numbers import is_count, number_of, whole_of
from rotorgear.files.read import text_lines

# A line of fields has 80 columns; free fields may have more.
_LONGEST_LINE = 10_000
_ELEMENTS = {
    "CTETRA": {4: "tetra", 10: "tetra10"},
    "CHEXA": {8: "hexahedron", 20: "hexahedron20"},
    "CPENTA": {6: "wedge", 15: "wedge15"},
    "CPYRAM": {5: "pyramid", 13: "pyramid13"},
    "CTRIA3": {3: "triangle"},
    "CTRIA6": {6: "triangle6", 3: "triangle"},
    "CQUAD4": {4: "quad"},
    "CQUAD8": {8: "quad8", 4: "quad"},
}
_SOLIDS = ("CTETRA", "CHEXA", "CPENTA", "CPYRAM")
# Beams and shells are not computed, and are refused wherever they are: without them the body would be too soft.
_STRUCTURE = ("CBAR", "CBEAM", "CBEND", "CROD", "CONROD", "CTUBE", "CTRIAR", "CQUADR", "CSHEAR")
# Cards of loads and connections that decks hold beside the elements; they are not read, and a note says so.
_BESIDE = ("RBE1", "RBE2", "RBE3", "RBAR", "RROD", "MPC", "CONM1", "CONM2", "CBUSH", "CELAS1", "CELAS2")
# Nastran counts the upright edges of a hexahedron before those of its top.
_HEXA = [*range(12), *range(16, 20), *range(12, 16)]


def read_nastran(path: Path) -> FileMesh:
    """Read a deck; ValueError says what in it can't be read."""
    points: dict[int, list[float]] = {}
    rows: dict[tuple[str, int], list[list[int]]] = {}
    node_sets: dict[str, Listed] = {}
    beside: Counter[str] = Counter()
    for fields in _cards(path):
        name = fields[0].upper()
        if name in _STRUCTURE:
            raise ValueError(f"{name} {fields[1]} is a beam or a shell: mesh it as solids, or leave it out of the file")
        if name.startswith("INCLUDE"):
            raise ValueError("it includes another file: put both into one")
        if name in _BESIDE:
            beside[name] += 1
        elif name == "GRID":
            if fields[2].strip() not in ("", "0"):
                raise ValueError(f"GRID {fields[1]} is in a coordinate system of its own: export global coordinates")
            place = [_number(text) for text in (*fields[3:6], "", "", "")[:3]]
            if points.setdefault(whole_of(fields[1]), place) != place:
                raise ValueError(f"GRID {fields[1]} is given twice, at two places")
        elif name in _ELEMENTS:
            nodes = [int(text) for text in fields[3:] if is_count(text)]
            kinds = _ELEMENTS[name]
            if name in _SOLIDS and (len(nodes) not in kinds or any(fields[3 + len(nodes) :])):
                raise ValueError(f"{name} {fields[1]} has {len(nodes)} nodes, not {' or '.join(map(str, kinds))}")
            count = next((count for count in sorted(kinds, reverse=True) if len(nodes) >= count), 0)
            if not count:
                raise ValueError(f"{name} {fields[1]} has {len(nodes)} nodes")
            rows.setdefault((kinds[count], whole_of(fields[2] or "0")), []).append(nodes[:count])
        elif name in ("SET", "SET1"):
            node_sets.setdefault(f"set_{fields[1]}", Listed()).add(_listed(fields[2:]))
        elif name == "SPC1":
            node_sets.setdefault(f"spc_{fields[1]}", Listed()).add(_listed(fields[3:]))
    if not points:
        raise ValueError("it has no GRID")
    places = places_of(points, "GRID")
    cells = []
    sets = {}
    for (kind, number), found in rows.items():
        corners = places(found)
        cells.append((kind, corners[:, _HEXA] if kind == "hexahedron20" else corners))
        if kind.startswith(("triangle", "quad")):
            sets[f"property_{number}"] = set_of(cells[-1:])
    numbers = np.array(list(points))
    for name, listed in node_sets.items():
        # A set of the case control may be a set of elements: numbers that no node has are passed over.
        member = listed.among(numbers)
        if member.any():
            sets[name] = NamedSet(np.flatnonzero(member))
    left_out = not_read([f"{count} {name}" for name, count in beside.items()])
    return FileMesh(np.array(list(points.values())), gathered(cells), sets, left_out)


def _cards(path: Path) -> Iterator[list[str]]:
    """Yield the fields of each card, with those of its continuations."""
    card: list[str] = []
    pending: list[str] = []
    number = ""
    for raw in text_lines(path, MESH.most_bytes):
        line = raw.partition("$")[0].rstrip("\n")[:_LONGEST_LINE].expandtabs(8)
        if not line.strip():
            continue
        case = re.match(r"\s*+SET\s++([0-9]++)\s*+=\s*+(.*)", line, re.IGNORECASE)
        if case or pending:
            pending.append(case.group(2) if case else line)
            number = case.group(1) if case else number
            if not line.rstrip().endswith(","):  # a set goes on in the next line
                yield ["SET", number, *(text for text in re.split(r"[,\s]++", ",".join(pending)) if text)]
                pending = []
            continue
        fields = _fields(line)
        if card and line[0] in "+* ,":
            card += fields[1:]
            continue
        if card:
            yield card
        card = fields
    if card:
        yield card


def _listed(fields: list[str]) -> Listed:
    """The numbers of a list with "a THRU b"."""
    found = Listed()
    words = [text.upper() for text in fields if text]
    for place, word in enumerate(words):
        if word == "THRU":
            if not (0 < place < len(words) - 1):
                raise ValueError("a list with THRU and no number before or behind it")
            found.ranges.append((whole_of(words[place - 1]), whole_of(words[place + 1]), 1))
        elif is_count(word):
            found.numbers.append(int(word))
    return found


def _fields(line: str) -> list[str]:
    """Name and up to eight (large: four) fields of a line, without the mark of a continuation."""
    if "," in line:
        return [text.strip().rstrip("*") for text in line.split(",")][:9]
    width = 16 if "*" in line[:8] else 8
    return [line[:8].strip().rstrip("*"), *(line[start : start + width].strip() for start in range(8, 72, width))]


def _number(text: str) -> float:
    """A number as Nastran writes it: 1.5-3 is 1.5e-3, and nothing is 0."""
    return number_of(re.sub(r"(?<=[0-9.])([+-][0-9]+)$", r"e\1", text.replace("D", "E"))) if text else 0.0
