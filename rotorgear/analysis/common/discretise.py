"""How shafts are cut: as modes were found, or for analyses in time, alike in a transient and a sweep."""

from __future__ import annotations

from collections.abc import Iterable

from rotorgear.analysis.common.request import check_whole
from rotorgear.results.modal import Piece
from rotorgear.system.plan import PieceKey, Plan


def plan_in_time(elements: int | None = None) -> Plan:
    """Return one element of second order for each shaft segment, or as many basic ones as were asked for.

    Basic elements are exact in statics only. In flexible_pair.toml one of them a piece puts a mode of the shafts 0.5 % off, and
    the largest contact force near its resonance 0.9 %.

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
