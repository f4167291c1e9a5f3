"""What the compliance of teeth in space will take before it is computed: memory and seconds.

Layers are stacked by dense Cholesky factorisations (`tooth_fe/sector`): with i unknowns of a plane that are condensed and k that
are kept, joining p and q layers takes a matrix of size N = 3 i + (2 (p + q) + 1) k, of which i unknowns are eliminated by

    i^3/3 + i^2 (N - i) + 2 i (N - i)^2 operations.

The largest of these matrices decides the memory, their sum the time. The gauge is a factorisation of the same kind, a few
milliseconds long, on the machine at hand. Measured on three helical pairs and five meshes each: memory within 10 % (40 % on the
coarsest), operations a second of CPU time within 25 %. A wheel is left out: its blank has unknowns of its own.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.gears.loaded.tooth_contact import gear_key, in_space
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.compliance_cache import cache_folder, entry_name
from rotorgear.gears.tooth_fe.compliance_model import ComplianceKey, pitch_of

# The largest matrix stands in memory as often, copies included; and what the program takes by itself (bytes).
_COPIES = 3.3
_PROGRAM = 150e6
# Size of the gauge. Whole compliances run at this share of its speed: they also assemble, copy and solve for the flanks.
_GAUGE = 700
_SHARE = 0.8


@dataclass(frozen=True)
class Forecast:
    """Memory (bytes) and seconds that compliances in space will take; zero where all are on disk or none is needed."""

    memory: float
    seconds: float


def forecast(pairs: tuple[ToothPair, ...]) -> Forecast:
    """For the gears of some tooth pairs that are solved one after the other."""
    keys = {gear_key(teeth, gear, space=True): None for teeth in pairs if in_space(teeth)[0] for gear in (0, 1)}
    missing = [key for key in keys if not key.blank and not (cache_folder() / f"{entry_name(key)}.npz").exists()]
    if not missing:
        return Forecast(0.0, 0.0)
    costs = [_cost(key) for key in missing]
    memory = _PROGRAM + _COPIES * 8.0 * max(size for size, _ in costs) ** 2
    return Forecast(memory, sum(operations for _, operations in costs) / (_SHARE * _speed()))


def _cost(key: ComplianceKey) -> tuple[int, float]:
    """Size of the largest matrix, and operations."""
    mesh = pitch_of(key)[1]
    layers = key.size.face
    kept = 6 * len(mesh.left) + len(mesh.flank)
    inside = 3 * (len(mesh.points) - len(mesh.inner)) - kept
    sizes = [3 * (inside + kept)]
    # As layers are doubled, and put together for each binary digit that is 1.
    block = 1
    stack = 0
    rest = layers
    while rest:
        if rest % 2:
            if stack:
                sizes.append(3 * inside + (2 * (stack + block) + 1) * kept)
            stack += block
        rest //= 2
        if rest:
            block *= 2
            sizes.append(3 * inside + (2 * block + 1) * kept)
    operations = sum(_eliminated(size, inside) for size in sizes)
    last = 2 * inside + (2 * layers + 1) * kept
    planes = 2 * layers + 1
    pitches = key.arc or key.geometry.teeth
    operations += _eliminated(last, 2 * inside) + (planes * len(mesh.flank)) ** 3
    operations += 4.0 * pitches * (3 * planes * len(mesh.left)) ** 3
    return max(*sizes, last), operations


def _eliminated(size: int, inside: int) -> float:
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
        matrix[_GAUGE:, _GAUGE:] -= W.T @ W
        seconds.append(time.perf_counter() - start)
    return _eliminated(2 * _GAUGE, _GAUGE) / max(min(seconds), 1e-6)
