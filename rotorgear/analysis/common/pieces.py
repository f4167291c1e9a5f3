"""How the shafts were cut into elements, as results tell it."""

from __future__ import annotations

from rotorgear.results.modal import Piece
from rotorgear.system.system import System


def pieces(system: System) -> tuple[Piece, ...]:
    """Say how each shaft segment was cut."""
    found = []
    for shaft, elements in system.nodes.elements.items():
        for number in sorted({element.piece for element in elements}):
            cut = [element for element in elements if element.piece == number]
            start = system.nodes.z[cut[0].left]
            end = system.nodes.z[cut[-1].right]
            found.append(Piece(shaft, start, end, len(cut), cut[0].order))
    return tuple(found)
