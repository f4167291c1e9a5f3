"""Sensors that seem to look the other way, to be turned, or to be exchanged: which one change makes measured and model agree.

All matched shapes y_k are compared with the planes of their modes. Taking one sensor otherwise changes the sum of squares
R = sum |y_k - P_k y_k|^2. Of independent errors of unknown size the log likelihood grows by N/2 ln(R / R'), N values: a change is
named where that beats by far what the best of as many useless changes would bring, and nothing is applied.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rotorgear.results.correlation import SensorDoubt

_AXES = "xyz"
# A change has to leave less than this share of the misfit, and to beat chance by so much in the log likelihood.
_LEFT = 0.88
_BEATS = 5.0
# Fewer sensors are all scale and sign.
_FEWEST = 4
_MOST_CHANGES = 6
# Only the worst of many sensors are tried otherwise, and fewer in each other's place.
_TURNED = 64
_EXCHANGED = 16


@dataclass(frozen=True)
class Wiring:
    """Which channel and axis each sensor has: `channel` (s,), `sign` (s,), `axis` (s,) 0 to 5 at its place."""

    channel: NDArray[np.intp]
    sign: NDArray[np.float64]
    axis: NDArray[np.intp]


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
    now = Wiring(np.arange(len(points)), np.ones(len(points)), axes)
    before, alike, share = _misfit(y, planes, now)
    values = sum(int(np.isfinite(row).sum()) - len(plane) for row, plane in zip(y, planes, strict=True))
    found = []
    for _ in range(min(_MOST_CHANGES, len(points) // 2)):
        tried = [
            (*_misfit(y, planes, wiring)[:2], wiring, point, what)
            for wiring, point, what in _changes(now, points, share)
        ]
        after, better, wiring, point, what = min(tried, key=lambda entry: entry[0])
        gain = 0.5 * values * np.log(before / max(after, 1e-300)) if before > 0.0 else 0.0
        if after > _LEFT * before or gain < np.log(len(tried)) + _BEATS:
            break
        found.append(SensorDoubt(point, what, alike, better))
        now = wiring
        before, alike, share = _misfit(y, planes, now)
    return tuple(found)


def _changes(now: Wiring, points: tuple[str, ...], share: NDArray[np.float64]) -> Iterator[tuple[Wiring, str, str]]:
    """All single changes of a wiring, of the sensors that fit worst: wiring, sensor, words."""
    order = np.argsort(-share, kind="stable")
    for s in sorted(order[:_TURNED]):
        point = points[s]
        turned = now.sign.copy()
        turned[s] = -turned[s]
        yield replace(now, sign=turned), point, "does it look the other way"
        family = 3 * (now.axis[s] // 3)
        for axis in range(family, family + 3):
            if axis == now.axis[s]:
                continue
            other = now.axis.copy()
            other[s] = axis
            name = ("" if family == 0 else "r") + _AXES[axis - family]
            yield replace(now, axis=other), point, f"does it look along {name}"
            yield replace(now, axis=other, sign=turned), point, f"does it look along -{name}"
    worst = order[:_EXCHANGED]
    for first in worst:
        for second in worst:
            if first < second:
                swapped = now.channel.copy()
                swapped[[first, second]] = swapped[[second, first]]
                yield replace(now, channel=swapped), points[first], f"is it exchanged with {points[second]}"


def _misfit(
    y: NDArray[np.complex128], planes: list[NDArray[np.complex128]], wiring: Wiring
) -> tuple[float, float, NDArray[np.float64]]:
    """Sum of squares off the planes, mean MAC (share in the plane), and the squares by sensor."""
    everyone = np.arange(y.shape[1])
    total = 0.0
    inside = []
    by_sensor = np.zeros(y.shape[1])
    for row, plane in zip(y, planes, strict=True):
        taken = wiring.sign * row[wiring.channel]
        known = np.isfinite(taken)
        Q = np.linalg.qr(plane[:, everyone, wiring.axis][:, known].T)[0]
        off = taken[known] - Q @ (Q.conj().T @ taken[known])
        squares = np.abs(off) ** 2
        size = float(np.sum(np.abs(taken[known]) ** 2))
        total += float(squares.sum())
        inside.append(1.0 - float(squares.sum()) / size if size > 0.0 else 1.0)
        by_sensor[known] += squares
    return total, float(np.mean(inside)), by_sensor
