"""How the shafts were cut into elements, as results tell it."""

from __future__ import annotations

from itertools import groupby
from operator import attrgetter

from rotorgear.results.modal import Piece
from rotorgear.system.system import System

_PIECE = attrgetter("piece")


def pieces(system: System) -> tuple[Piece, ...]:
    """Say how each shaft segment was cut."""
    found = []
    for shaft, elements in system.nodes.elements.items():
        for _, of_piece in groupby(sorted(elements, key=_PIECE), key=_PIECE):
            cut = list(of_piece)
            start = system.nodes.z[cut[0].left]
            end = system.nodes.z[cut[-1].right]
            found.append(Piece(shaft, start, end, len(cut), cut[0].order))
    return tuple(found)
