"""How shafts are cut into elements: as results tell it, as modes were found, or for analyses in time."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby
from operator import attrgetter

from rotorgear.analysis.common.request import check_whole
from rotorgear.results.modal import Piece
from rotorgear.system.plan import PieceKey, Plan
from rotorgear.system.system import System


def plan_in_time(elements: int | None = None) -> Plan:
    """Return the mesh of transients and sweeps: one element of second order for each segment, or as many basic ones as asked for.

    Basic elements are exact in statics only. In flexible_pair.toml one of them in each segment has an error of 0.5 % in a
    mode of the shafts, and of 0.9 % in the largest contact force near its resonance.

    Raises:
        AnalysisError: fewer than one element.
    """
    if elements is not None:
        check_whole("the number of elements", elements)
    return Plan(elements) if elements else Plan(elements=1, order=2)


def cut_of(pieces: Iterable[Piece]) -> dict[PieceKey, tuple[int, int]]:
    """Elements and order of every piece that modes were found on, by shaft and number from the left."""
    found: dict[PieceKey, tuple[int, int]] = {}
    for piece in pieces:
        number = sum(shaft == piece.shaft for shaft, _ in found)
        found[piece.shaft, number] = (piece.elements, piece.order)
    return found


def pieces(system: System) -> tuple[Piece, ...]:
    """Say how each shaft segment was cut."""
    found = []
    number = attrgetter("piece")
    for shaft, elements in system.nodes.elements.items():
        for _, of_piece in groupby(sorted(elements, key=number), key=number):
            cut = list(of_piece)
            start = system.nodes.z[cut[0].left]
            end = system.nodes.z[cut[-1].right]
            found.append(Piece(shaft, start, end, len(cut), cut[0].order))
    return tuple(found)
