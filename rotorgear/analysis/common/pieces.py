"""How the shafts were cut into elements, as results tell it."""

from __future__ import annotations

from rotorgear.results.steady.modal import Piece
from rotorgear.system.nodes import Element
from rotorgear.system.system import System


def pieces(system: System) -> tuple[Piece, ...]:
    """Say how each shaft segment was cut."""
    found = []
    for shaft, elements in system.nodes.elements.items():
        of_piece: dict[int, list[Element]] = {}
        for element in elements:
            of_piece.setdefault(element.piece, []).append(element)
        for _, cut in sorted(of_piece.items()):
            start = system.nodes.z[cut[0].left]
            end = system.nodes.z[cut[-1].right]
            found.append(Piece(shaft, start, end, len(cut), cut[0].order))
    return tuple(found)
