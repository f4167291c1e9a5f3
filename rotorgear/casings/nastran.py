"""Reads the mesh of a Nastran deck (.bdf): GRID, solid elements, and the faces of shells by their properties.

Fields are free (commas), small (8 columns) or large (16 columns, a star). meshio wants BEGIN BULK, which meshers leave out, and
has no sets; here the faces of property N are the set "property_N", and SET N of the case control, SET1 cards and SPC1 cards of a
number N are the sets of nodes "set_N" and "spc_N".
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rotorgear.casings.file_mesh import FileMesh, NamedSet, gathered, not_read, set_of

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
# Beams and shells that are not computed, whatever they stand on: without them the body would be softer than it is meant.
_STRUCTURE = ("CBAR", "CBEAM", "CBEND", "CROD", "CONROD", "CTUBE", "CTRIAR", "CQUADR", "CSHEAR")
# What decks put on a body beside its elements; it is not read, and that is said.
_BESIDE = ("RBE1", "RBE2", "RBE3", "RBAR", "RROD", "MPC", "CONM1", "CONM2", "CBUSH", "CELAS1", "CELAS2")
# Nastran counts the upright edges of a hexahedron before those of its top.
_HEXA = [*range(12), *range(16, 20), *range(12, 16)]


def read_nastran(path: Path) -> FileMesh:
    """Read a deck; ValueError says what in it can't be read."""
    points: dict[int, list[float]] = {}
    rows: dict[tuple[str, int], list[list[int]]] = {}
    node_sets: dict[str, list[tuple[int, int]]] = {}
    beside: dict[str, int] = {}
    for fields in _cards(path):
        name = fields[0].upper()
        if name in _STRUCTURE:
            raise ValueError(f"{name} {fields[1]} is a beam or a shell: mesh it as solids, or leave it out of the file")
        if name.startswith("INCLUDE"):
            raise ValueError("it includes another file: put both into one")
        if name in _BESIDE:
            beside[name] = beside.get(name, 0) + 1
        elif name == "GRID":
            if fields[2].strip() not in ("", "0"):
                raise ValueError(
                    f"GRID {fields[1]} stands in a coordinate system of its own: export global coordinates"
                )
            place = [_number(text) for text in (*fields[3:6], "", "", "")[:3]]
            if points.setdefault(int(fields[1]), place) != place:
                raise ValueError(f"GRID {fields[1]} is given twice, at two places")
        elif name in _ELEMENTS:
            nodes = [int(text) for text in fields[3:] if re.fullmatch(r"\d+", text)]
            kinds = _ELEMENTS[name]
            if name in _SOLIDS and (len(nodes) not in kinds or any(fields[3 + len(nodes) :])):
                raise ValueError(f"{name} {fields[1]} has {len(nodes)} nodes, not {' or '.join(map(str, kinds))}")
            count = next((count for count in sorted(kinds, reverse=True) if len(nodes) >= count), 0)
            if not count:
                raise ValueError(f"{name} {fields[1]} has {len(nodes)} nodes")
            rows.setdefault((kinds[count], int(fields[2] or 0)), []).append(nodes[:count])
        elif name == "SET1":
            node_sets.setdefault(f"set_{fields[1]}", []).extend(_listed(fields[2:]))
        elif name == "SPC1":
            node_sets.setdefault(f"spc_{fields[1]}", []).extend(_listed(fields[3:]))
        elif name == "SET":
            node_sets.setdefault(f"set_{fields[1]}", []).extend(_listed(fields[2:]))
    if not points:
        raise ValueError("it has no GRID")
    order = {number: place for place, number in enumerate(points)}
    try:
        blocks = {key: np.array([[order[node] for node in row] for row in found]) for key, found in rows.items()}
    except KeyError as error:
        raise ValueError(f"GRID {error.args[0]} is named but not given") from None
    for key in blocks:
        if key[0] == "hexahedron20":
            blocks[key] = blocks[key][:, _HEXA]
    sets = {
        f"property_{number}": set_of([(kind, cells)])
        for (kind, number), cells in blocks.items()
        if kind.startswith(("triangle", "quad"))
    }
    numbers = np.array(list(points))
    for name, ranges in node_sets.items():
        # A set of the case control may be one of elements: only nodes that are there count.
        nodes = [order[first] for first, last in ranges if first == last and first in order]
        for first, last in ranges:
            if first < last:
                nodes += np.flatnonzero((numbers >= first) & (numbers <= last)).tolist()
        if nodes:
            sets[name] = NamedSet(np.unique(nodes))
    return FileMesh(
        np.array(list(points.values())),
        gathered([(kind, cells) for (kind, _), cells in blocks.items()]),
        sets,
        not_read([f"{count} {name}" for name, count in beside.items()]),
    )


def _cards(path: Path) -> Iterator[list[str]]:
    """Yield the fields of each card, with those of its continuations."""
    card: list[str] = []
    pending = ""
    number = ""
    with path.open(encoding="utf-8", errors="replace") as file:
        for raw in file:
            line = raw.partition("$")[0].rstrip("\n").expandtabs(8)
            if not line.strip():
                continue
            case = re.match(r"\s*SET\s+(\d+)\s*=\s*(.*)", line, re.IGNORECASE)
            if case or pending:
                pending += case.group(2) if case else line
                number = case.group(1) if case else number
                if not pending.rstrip().endswith(","):  # a set goes on in the next line
                    yield ["SET", number, *(text.strip() for text in re.split(r"[,\s]+", pending) if text)]
                    pending = ""
                continue
            goes_on = line[0] in "+* ," and bool(card)
            fields = _fields(line)
            if goes_on:
                card += fields[1:]
                continue
            if card:
                yield card
            card = fields
    if card:
        yield card


def _listed(fields: list[str]) -> Iterator[tuple[int, int]]:
    """First and last number of each entry of a list with "a THRU b"."""
    words = [text.upper() for text in fields if text]
    for place, word in enumerate(words):
        if word == "THRU":
            yield int(words[place - 1]), int(words[place + 1])
        elif word.isdigit():
            yield int(word), int(word)


def _fields(line: str) -> list[str]:
    """Name and up to eight (large: four) fields of a line, without what marks a continuation."""
    if "," in line:
        return [text.strip().rstrip("*") for text in line.split(",")][:9]
    width = 16 if "*" in line[:8] else 8
    count = 4 if width == 16 else 8
    body = line[8:].ljust(width * count)
    return [line[:8].strip().rstrip("*"), *(body[width * i : width * (i + 1)].strip() for i in range(count))]


def _number(text: str) -> float:
    """A number as Nastran writes it: 1.5-3 is 1.5e-3, and nothing is 0."""
    return float(re.sub(r"(?<=[0-9.])([+-]\d+)$", r"e\1", text.replace("D", "E"))) if text else 0.0
