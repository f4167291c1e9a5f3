"""A mesh as its file has it: points, solid cells by kind, and named sets of nodes and faces."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rotorgear.files.bounds import MOST_LISTED

# Kinds of cells, in the words of meshio, by what rotorgear does with them.
SOLIDS = ("tetra", "tetra10", "hexahedron", "hexahedron20", "hexahedron27")
# How the names of all kinds of solids begin, of higher orders too.
SOLID_BEGINNINGS = ("tetra", "hexahedron", "wedge", "pyramid", "polyhedron", "VTK")
FACES = {"triangle": 3, "triangle6": 3, "triangle7": 3, "quad": 4, "quad8": 4, "quad9": 4}


@dataclass
class NamedSet:
    """Nodes of a set, and its faces by their corners where the file has cells for them."""

    nodes: np.ndarray
    faces: list[np.ndarray] = field(default_factory=list)

    def renumbered(self, numbers: np.ndarray) -> NamedSet:
        """The set by new numbers (p,) of all nodes, without nodes of the number -1 and faces with such nodes."""
        nodes = numbers[self.nodes]
        faces = [numbers[face] for face in self.faces]
        return NamedSet(nodes[nodes >= 0], [face[(face >= 0).all(axis=1)] for face in faces])

    def faces_among(self, faces: np.ndarray, corners: int) -> np.ndarray:
        """Which (f,) of faces (f, m), corners first, belong to the set: by its faces, or by its nodes where it has no faces."""
        if self.faces:
            own = {tuple(row) for listed in self.faces for row in np.sort(listed[:, :corners], axis=1).tolist()}
            return np.array([tuple(row) in own for row in np.sort(faces[:, :corners], axis=1).tolist()], dtype=bool)
        member = np.isin(faces, self.nodes)
        # Some meshers list the corners of quadratic faces only.
        whole = member.all(axis=1)
        return np.asarray(whole if whole.any() else member[:, :corners].all(axis=1))


@dataclass
class FileMesh:
    """The contents of a mesh file.

    Attributes:
        points: (p, 3) in the unit of the file.
        cells: nodes (e, k) of the cells of every kind, solids and others, in the order of VTK.
        sets: by name.
        notes: sentences on what was left out or made of something else.
    """

    points: np.ndarray
    cells: dict[str, np.ndarray]
    sets: dict[str, NamedSet] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


class Listed:
    """Numbers as a deck lists them: single ones, and ranges, which stay ranges: of a million million there may be three nodes."""

    def __init__(self) -> None:
        self.numbers: list[int] = []
        self.ranges: list[tuple[int, int, int]] = []

    def add(self, other: Listed) -> None:
        """Take the numbers of another list; ValueError where they are more than any mesh has."""
        if len(self.numbers) + len(self.ranges) + len(other.numbers) + len(other.ranges) > MOST_LISTED:
            raise ValueError(f"a set of more than {MOST_LISTED} numbers")
        self.numbers += other.numbers
        self.ranges += other.ranges

    def among(self, numbers: np.ndarray) -> np.ndarray:
        """Which of some numbers (n,) are listed, (n,).

        Raises:
            ValueError: ranges with steps go through them more often than any mesh asks for.
        """
        found = np.isin(numbers, np.array(self.numbers, dtype=np.int64))
        if not self.ranges:
            return found
        first, last, step = np.array(self.ranges, dtype=np.int64).T
        order = np.argsort(numbers, kind="stable")
        low = np.searchsorted(numbers, first, "left", sorter=order)
        high = np.searchsorted(numbers, last, "right", sorter=order)
        # Ranges begin and end: where more have begun than ended, a number is inside of one.
        plain = (step == 1) & (high > low)
        edges = np.zeros(len(numbers) + 1, dtype=np.int64)
        np.add.at(edges, low[plain], 1)
        np.add.at(edges, high[plain], -1)
        found[order[np.cumsum(edges[:-1]) > 0]] = True
        if int((high - low)[(step > 1) & (high > low)].sum()) > MOST_LISTED:
            raise ValueError(f"ranges with steps over more than {MOST_LISTED} numbers")
        for k in np.flatnonzero((step > 1) & (high > low)):
            some = order[low[k] : high[k]]
            found[some[(numbers[some] - first[k]) % step[k] == 0]] = True
        return found


def not_read(cards: list[str]) -> list[str]:
    """The note on cards of a deck that are not read; no note where there are none."""
    if not cards:
        return []
    return [f"Not read from the deck: {', '.join(cards)}; seats, mounts, joins and masses stand in the model file."]


def places_of(points: Iterable[int], word: str) -> Callable[[Any], np.ndarray]:
    """A function from numbers of points, in an array of any shape, to the places of these points in the order of the file.

    It raises a ValueError for a number that no point has; `word` is what the deck calls a point.
    """
    numbers = np.array(list(points), dtype=np.int64)
    order = np.argsort(numbers)

    def places(wanted: Any) -> np.ndarray:
        wanted = np.asarray(wanted, dtype=np.int64)
        found = order[np.searchsorted(numbers, wanted, sorter=order).clip(max=len(order) - 1)]
        missing = wanted[numbers[found] != wanted]
        if missing.size:
            raise ValueError(f"{word} {missing[0]} is named but not given")
        return np.asarray(found)

    return places


def gathered(blocks: list[tuple[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Blocks of cells as one array a kind."""
    found: dict[str, list[np.ndarray]] = {}
    for kind, nodes in blocks:
        if len(nodes):
            found.setdefault(kind, []).append(np.asarray(nodes, dtype=np.int64))
    return {kind: np.vstack(parts) for kind, parts in found.items()}


def set_of(blocks: list[tuple[str, np.ndarray]]) -> NamedSet:
    """The set of the nodes of cells; faces among them are its faces."""
    nodes = [np.unique(cells) for _, cells in blocks if len(cells)]
    faces = [cells[:, : FACES[kind]] for kind, cells in blocks if kind in FACES and len(cells)]
    return NamedSet(np.unique(np.concatenate(nodes)) if nodes else np.zeros(0, dtype=np.int64), faces)
