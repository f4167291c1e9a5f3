"""Pieces of a continuation as a stream keeps them: solutions along a branch, and what equations remember behind each piece."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rotorgear.analysis.common.stream import Piece, unkept
from rotorgear.solvers.periodic.arclength import Node
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.periodic.shooting import ShootingOrbits
from rotorgear.solvers.periodic.special import Certified

AnyOrbits = HarmonicOrbits | ShootingOrbits


def remembering(piece: Piece, *equations: AnyOrbits) -> Piece:
    """Pieces of work with equations whose answers depend, in the last digits, on what they were asked before.

    Args:
        piece: does the work of a piece, or takes it over. equations: what the work asks; their memory is kept with its results.
    """
    if piece is unkept:
        return piece

    def own(work: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        def both() -> dict[str, Any]:
            found = work()
            return {"found": found, "memories": tuple(one.memory() for one in equations)}

        done = piece(both)
        for one, memory in zip(equations, done["memories"], strict=True):
            one.recall(memory)
        found: dict[str, Any] = done["found"]
        return found

    return own


def packed(solutions: Sequence[Certified]) -> dict[str, Any]:
    """Solutions as values that a chunk may have."""
    return {
        "z": tuple(one.node.z for one in solutions),
        "tangent": tuple(one.node.tangent for one in solutions),
        "iterations": tuple(np.array(one.node.iterations) for one in solutions),
        "multipliers": tuple(one.multipliers for one in solutions),
    }


def unpacked(values: dict[str, Any]) -> list[Certified]:
    """The solutions again."""
    columns = (values[name] for name in ("z", "tangent", "iterations", "multipliers"))
    return [
        Certified(Node(z, tangent, int(iterations)), multipliers)
        for z, tangent, iterations, multipliers in zip(*columns, strict=True)
    ]
