"""Map of loaded teeth as compiled code reads it: inverted, forces at even steps of x, a row for each position.

The map gives the approach delta(F_j; u_i), and along a face at some tilts the moment, under loads F_j from 0 at even positions of
the mesh cycle. A row holds the first touch delta_0 at any tilt; then, for each tilt and at each step of x = d - e - delta_0, the
force, its tangent and its energy, and where the flanks tilt dM/dx and the moment M.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from rotorgear.memory import require_memory

# Steps of x up to the largest load. With half as many the curve of a helix in a loop, of 0.02 um on 9 um, was 2.4 % off, and is
# 0.3 % with these. Of flanks that tilt there are as many maps as tilts, with half of the steps.
STEPS = 384
STEPS_OF_A_TILT = 192
# At each step of x: force, tangent stiffness, energy; where the flanks tilt also dM/dx and moment.
FORCE, TANGENT, ENERGY, LIFT, MOMENT = range(5)
NODE = 3
NODE_OF_A_TILT = 5
# Number of loads between which a map is inverted.
_LOADS = 1500
# Inverted maps that are kept: those of four meshes with two helices each. One of many pitches is too large to be kept (bytes).
_KEPT = 8
_LARGE = 6e7
# Copies of an inverted map: it is put among the parameters of a law, and those among all of a system.
_COPIES = 3.0
# Positions that are inverted together: a map of many pitches has tens of thousands, each with thousands of loads between.
_TOGETHER = 256


def shape_of_rows(approach: np.ndarray, tilted: bool) -> tuple[int, int]:
    """Positions, and numbers in a row, of an inverted map with approaches (k, p, l)."""
    tilts, positions, _ = approach.shape
    steps, node = (STEPS_OF_A_TILT, NODE_OF_A_TILT) if tilted else (STEPS, NODE)
    return positions, 1 + node * tilts * (steps + 1)


def is_large(approach: np.ndarray, tilted: bool) -> bool:
    """Whether an inverted map is too large to stand in memory twice, such as one of many pitches."""
    return 8 * int(np.prod(shape_of_rows(approach, tilted))) > _LARGE


def inverted(
    load: np.ndarray,
    approach: np.ndarray,
    moment: np.ndarray,
    into: np.ndarray | None = None,
    slope: np.ndarray | None = None,
) -> tuple[float, np.ndarray]:
    """Return the step of x in m and the rows of a map, (p, 1 + k (steps + 1) node), node being 3, or 5 where the flanks tilt.

    The steps reach from the first touch to the largest load at any tilt and position. The rows are read-only: laws of equal
    maps share them, whatever their stiffness and errors, because to invert a map takes longer than a cycle on it.

    Args:
        load: (l,) forces along the flank normal in N, rising from 0.
        approach: (k, p, l) approach in m at these loads, p positions and k tilts.
        moment: (k, p, l) about the middle of the face in N m; empty of one map without a tilt.
        into: rows to fill; those of a large map are made nowhere else.
        slope: (k, p, l) change of the approach with the load in m/N; None: that of a monotone interpolation (PCHIP).

    Raises:
        AnalysisError: more memory is needed than is free.
    """
    tilted = bool(moment.size)
    shape = shape_of_rows(approach, tilted)
    if is_large(approach, tilted):
        remedy = "give pitch errors to one gear only, or to fewer teeth"
        require_memory(_COPIES * 8 * shape[0] * shape[1], f"Loaded teeth over {shape[0]} positions in time", remedy)
        rows = np.empty(shape) if into is None else into
        return _put_rows(rows, load, approach, moment, slope), rows
    slopes = b"" if slope is None else slope.tobytes()
    spacing, rows = _kept(load.tobytes(), approach.tobytes(), moment.tobytes(), slopes, approach.shape)
    if into is not None:
        into[:] = rows
    return spacing, rows


@lru_cache(maxsize=_KEPT)
def _kept(
    load: bytes, approach: bytes, moment: bytes, slope: bytes, shape: tuple[int, ...]
) -> tuple[float, np.ndarray]:
    loads, approaches, moments, slopes = map(np.frombuffer, (load, approach, moment, slope))
    of_map = approaches.reshape(shape)
    rows = np.empty(shape_of_rows(of_map, bool(moments.size)))
    of_slopes = slopes.reshape(shape) if slopes.size else None
    spacing = _put_rows(rows, loads, of_map, moments.reshape(shape if moments.size else 0), of_slopes)
    rows.setflags(write=False)
    return spacing, rows


def _put_rows(
    found: np.ndarray, load: np.ndarray, approach: np.ndarray, moment: np.ndarray, slope: np.ndarray | None
) -> float:
    """Fill the rows, return the spacing: delta_0, then force and tangent where a curve passes the steps of x, and integrals."""
    steps = STEPS_OF_A_TILT if moment.size else STEPS
    node = NODE_OF_A_TILT if moment.size else NODE
    touch = approach[:, :, 0].min(axis=0)
    spacing = float((approach[:, :, -1].max(axis=0) - touch).max()) / steps
    # Loads between, dense where little carries: half of them up to a fiftieth of the largest.
    share = np.linspace(0.0, 1.0, _LOADS)
    loads = load[-1] * np.concatenate([0.02 * share[:-1], 0.02 + 0.98 * share])
    tilts, positions, _ = approach.shape
    found[:, 0] = touch
    nodes = found[:, 1:].reshape(positions, tilts, steps + 1, node)
    for first in range(0, positions, _TOGETHER):
        some = slice(first, first + _TOGETHER)
        lift = PchipInterpolator(load, moment[:, some], axis=2)(loads) if moment.size else None
        if slope is None:
            curve: Any = PchipInterpolator(load, approach[:, some], axis=2)
        else:
            curve = CubicHermiteSpline(load, approach[:, some], slope[:, some], axis=2)
        _fill(nodes[some], curve, loads, touch[some], spacing, lift)
    return spacing


def _fill(
    nodes: np.ndarray,
    curve: Any,
    loads: np.ndarray,
    touch: np.ndarray,
    spacing: float,
    moments: np.ndarray | None,
) -> None:
    """Fill the nodes (p, k, steps + 1, node) of some positions; moments (k, p, n) are at the n loads between.

    `curve` gives the approach (k, p, n) in m at n loads, and its slope.
    """
    positions, tilts, count, _ = nodes.shape
    deflections = curve(loads) - touch[:, None]
    # A flat end of a curve must not divide by zero.
    softest = 1e-6 * spacing * (count - 1) / loads[-1]
    softness = np.maximum(curve(loads, 1), softest)
    x = spacing * np.arange(count)
    for k in range(tilts):
        for i in range(positions):
            deflection = deflections[k, i]
            beyond = np.maximum(x - deflection[-1], 0.0)
            last = 1.0 / softness[k, i, -1]
            nodes[i, k, :, FORCE] = np.interp(x, deflection, loads, left=0.0) + last * beyond
            nodes[i, k, :, TANGENT] = np.interp(x, deflection, 1.0 / softness[k, i], left=0.0)
            if moments is not None:
                steady = (moments[k, i, -1] - moments[k, i, -2]) / (deflection[-1] - deflection[-2])
                moment = np.interp(x, deflection, moments[k, i], left=0.0) + steady * beyond
                nodes[i, k, :, LIFT] = np.gradient(moment, spacing)
    nodes[:, :, 0] = 0.0
    for rate, whole in ((FORCE, ENERGY), (LIFT, MOMENT))[: 1 if moments is None else 2]:
        means = 0.5 * (nodes[:, :, 1:, rate] + nodes[:, :, :-1, rate])
        nodes[:, :, 1:, whole] = spacing * np.cumsum(means, axis=2)
