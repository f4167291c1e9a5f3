"""Sensors that seem to look the other way, to be turned, or to be exchanged: which one change makes measured and model agree.

All matched shapes y_k are compared with the planes of their modes. Taking one sensor otherwise changes the sum of squares
R = sum |y_k - P_k y_k|^2. Of independent errors of unknown size the log likelihood grows by N/2 ln(R / R'), N values: a change is
named where that beats by far what the best of as many useless changes would bring, and nothing is applied.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np
from numpy.typing import NDArray

from rotorgear.results.correlation import SensorDoubt
from rotorgear.uff.datasets import AXES

# The channel and the direction of each sensor, (2, s): directions count from 1 to 6, negative where it looks the other way.
Wiring = NDArray[np.intp]
# A change has to leave less than this share of the misfit, and to beat chance by this much in the log likelihood.
_LEFT = 0.88
_BEATS = 5.0
# With fewer sensors a shape is hardly more than a scale and a sign.
_FEWEST = 4
_MOST_CHANGES = 6
# Only the worst of many sensors are tried otherwise, and fewer in each other's place.
_TURNED = 64
_EXCHANGED = 16


def sensor_doubts(
    points: tuple[str, ...],
    axes: NDArray[np.intp],
    shapes: NDArray[np.complex128],
    planes: list[NDArray[np.complex128]],
) -> tuple[SensorDoubt, ...]:
    """Return the changes that evidence speaks for, most telling first.

    Args:
        points: names of the sensors (s).
        axes: 0 to 5, the direction of each in the model (s,).
        shapes: matched measured shapes (k, s), NaN where unknown.
        planes: of each, its modes in all six directions at the sensors, (c, s, 6).
    """
    if len(points) < _FEWEST or not planes:
        return ()
    size = np.sqrt(np.nanmean(np.abs(shapes) ** 2, axis=1, keepdims=True))
    y = shapes / np.where(size > 0.0, size, 1.0)
    now = np.array([np.arange(len(points)), axes + 1])
    before, alike, share = _misfit(y, planes, now)
    values = sum(int(np.isfinite(row).sum()) - len(plane) for row, plane in zip(y, planes, strict=True))
    found = []
    for _ in range(min(_MOST_CHANGES, len(points) // 2)):
        tried = [(*_misfit(y, planes, change[0]), *change) for change in _changes(now, points, share)]
        after, better, its_share, wiring, point, what = min(tried, key=lambda entry: entry[0])
        gain = 0.5 * values * np.log(before / max(after, 1e-300)) if before > 0.0 else 0.0
        if after > _LEFT * before or gain < np.log(len(tried)) + _BEATS:
            break
        found.append(SensorDoubt(point, what, alike, better))
        now = wiring
        before = after
        alike = better
        share = its_share
    return tuple(found)


def _changes(now: Wiring, points: tuple[str, ...], share: NDArray[np.float64]) -> Iterator[tuple[Wiring, str, str]]:
    """All single changes of a wiring, of the sensors that fit worst: wiring, sensor, words."""
    order = np.argsort(-share, kind="stable")
    for s in sorted(order[:_TURNED]):
        axis = abs(now[1, s]) - 1
        sense = np.sign(now[1, s])
        # The other sense of its direction, then both senses of the other two of its place.
        others = [(-sense * (axis + 1), "does it look the other way")]
        for other in range(3 * (axis // 3), 3 * (axis // 3) + 3):
            if other != axis:
                others += [
                    (side * sense * (other + 1), f"does it look along {'-' if side < 0 else ''}{AXES[other]}")
                    for side in (1, -1)
                ]
        for direction, what in others:
            turned = now.copy()
            turned[1, s] = direction
            yield turned, points[s], what
    worst = order[:_EXCHANGED]
    for first, second in product(worst, worst):
        if first < second:
            swapped = now.copy()
            swapped[0, [first, second]] = now[0, [second, first]]
            yield swapped, points[first], f"is it exchanged with {points[second]}"


def _misfit(
    y: NDArray[np.complex128], planes: list[NDArray[np.complex128]], wiring: Wiring
) -> tuple[float, float, NDArray[np.float64]]:
    """Sum of squares off the planes, mean MAC (share in the plane), and the squares by sensor."""
    channel, direction = wiring
    everyone = np.arange(y.shape[1])
    total = 0.0
    inside = []
    by_sensor = np.zeros(y.shape[1])
    for row, plane in zip(y, planes, strict=True):
        taken = np.sign(direction) * row[channel]
        known = np.isfinite(taken)
        Q = np.linalg.qr(plane[:, everyone, np.abs(direction) - 1][:, known].T)[0]
        off = taken[known] - Q @ (Q.conj().T @ taken[known])
        squares = np.abs(off) ** 2
        size = float(np.sum(np.abs(taken[known]) ** 2))
        total += float(squares.sum())
        inside.append(1.0 - float(squares.sum()) / size if size > 0.0 else 1.0)
        by_sensor[known] += squares
    return total, float(np.mean(inside)), by_sensor
