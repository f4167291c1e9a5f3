"""What the compliance of a gear in space takes, known before it is computed: memory and seconds.

Layers are stacked by dense Cholesky factorisations (`sector.py`): with i unknowns of a plane that are condensed and k that are
kept, joining p and q layers takes a matrix of size N = 3 i + (2 (p + q) + 1) k, or less where an outer plane of theirs is one of
the whole stack and is condensed before. Of that, i unknowns are eliminated by

    i^3/3 + i^2 (N - i) + 2 i (N - i)^2 operations.

The largest of these matrices decides the memory, their sum the time. The gauge is a factorisation of the same kind, a few
milliseconds long, on the machine at hand. `python -m validation.benchmarks.mesh_cost` prints forecast and measurement.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.errors import AnalysisError
from rotorgear.memory import free_memory

# The largest matrix stands in memory as often, copies included; and what the program takes by itself (bytes).
_COPIES = 3.3
_PROGRAM = 150e6
# Size of the gauge. Whole compliances run at this share of its speed: they also assemble, copy and solve for the flanks.
_GAUGE = 700
_SHARE = 0.8


@dataclass(frozen=True)
class Forecast:
    """Memory (bytes) of the process and seconds."""

    memory: float
    seconds: float

    def require_room(self) -> None:
        """AnalysisError where the machine has less memory to give."""
        free = free_memory()
        if free is not None and self.memory > free:
            raise AnalysisError(
                f"These teeth in space would take {1e-9 * self.memory:.2g} GB of memory, and {1e-9 * free:.2g} GB are free: "
                'take tooth_fe = { preset = "preview" } (--preset preview), a narrower face, or a machine with more memory.'
            )

    def __str__(self) -> str:
        return f"about {self.seconds:.0f} s and {1e-9 * self.memory:.1f} GB"


@dataclass(frozen=True)
class Stack:
    """Sizes that decide the cost of a gear in layers.

    Attributes:
        inside: unknowns of a plane that are condensed; kept: those that are not.
        cut: of these on one cut; flank: on the flank.
        layers: along the face; pitches: that are chained.
    """

    inside: int
    kept: int
    cut: int
    flank: int
    layers: int
    pitches: int

    def forecast(self) -> Forecast:
        """What this machine needs for it."""
        sizes = self._condensed()
        operations = sum(_eliminated(size, self.inside) for size in sizes)
        planes = 2 * self.layers + 1
        operations += (planes * self.flank) ** 3
        operations += 4.0 * self.pitches * (planes * self.cut) ** 3
        memory = _PROGRAM + _COPIES * 8.0 * max(sizes) ** 2
        return Forecast(memory, operations / (_SHARE * _speed()))

    def _condensed(self) -> list[int]:
        """Sizes of the matrices, each of which loses the inside of one plane, in the order of `sector.stacked_layers`."""

        def size(planes_inside: int, layers: int) -> int:
            return planes_inside * self.inside + (2 * layers + 1) * self.kept

        sizes = [size(3, 1)]
        block = 1
        stack = 0
        rest = self.layers
        while rest > 2 or (rest == 2 and stack):
            if rest % 2:
                sizes.append(size(2, stack + block))
                stack += block
            rest //= 2
            block *= 2
            sizes.append(size(3, block))
        if self.layers == 1:
            return [*sizes, size(2, 1), size(1, 1)]
        if not stack:
            sizes.append(size(2, block))
        return [*sizes, size(2, block), size(1, self.layers)]


def _eliminated(size: int, inside: int) -> float:
    """Operations that eliminate so many unknowns of a dense matrix."""
    rest = float(size - inside)
    return inside**3 / 3.0 + inside**2 * rest + 2.0 * inside * rest**2


def _speed() -> float:
    """Operations a second of this machine, with as many threads as it takes."""
    matrix = np.eye(2 * _GAUGE) + 1e-3
    seconds = []
    for _ in range(3):  # others may use the machine for a moment
        start = time.perf_counter()
        L = la.cholesky(matrix[:_GAUGE, :_GAUGE], lower=True, check_finite=False)
        W = la.solve_triangular(L, matrix[:_GAUGE, _GAUGE:], lower=True, check_finite=False)
        matrix[_GAUGE:, _GAUGE:] -= 1e-9 * (W.T @ W)
        seconds.append(time.perf_counter() - start)
    return _eliminated(2 * _GAUGE, _GAUGE) / max(min(seconds), 1e-6)
