"""How finely each shaft segment is cut: elements and their order.

A *piece* is a stretch of one section between two neighbouring places. Order 1 is the basic element, p >= 2 adds internal
polynomials.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

# (name of the shaft, number of the piece from the left)
PieceKey = tuple[str, int]


@dataclass(frozen=True)
class Plan:
    """Elements and order of every piece: the same everywhere, except where `cut` says otherwise.

    Attributes:
        elements: elements in each piece of every section that does not say itself.
        order: their order.
        cut: piece -> (elements, order) where they differ.
    """

    elements: int = 1
    order: int = 1
    cut: Mapping[PieceKey, tuple[int, int]] = field(default_factory=dict)

    def of(self, piece: PieceKey, given: int | None) -> tuple[int, int]:
        """Elements and order of a piece; `given` is what its section says."""
        return self.cut.get(piece, (given or self.elements, self.order))
