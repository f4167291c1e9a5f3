"""Where a tilting pad loses its film: the fold of its loaded tilts, as the shaft moves away from its pivot.

Over the arc of a pad the gap is

    h = H (1 + a cos t - u sin t/U),   u: the tilt,   U: the gap is H (1 + a cos t) at the tilt 0

t from the pivot in the sense of rotation. With a > 0 it is widest at the pivot: the journal has moved away from the pad of a
journal bearing (H its clearance), or the collar leans away from the pad of a thrust bearing. A pad whose pivot lies behind its
middle then has two stable tilts up to a fold a_f, one with a film that is whole and one without a film; behind the fold the
second alone. Pressures over mu omega/H^2 depend on a and on the tilt over the one that closes the trailing edge, so that a_f
follows from the shape of a pad and the place of its pivot alone. With pivots up to the middle a_f = 0.

Which tilt a pad has below a_f depends on what went before, and at a_f its force jumps. A law is a function of place and
velocity, and loads beside a jump would have no equilibrium. So pads take the loaded tilt, and over the last part of the way to
the fold their force is weighted down to 0. This weight is no physics: no real pad rests between its two tilts, and the width is
a choice. The force is one of the two possible ones before that part, the only one behind the fold, and between the two within
it, where `doubts` says so. Pads without a film can vibrate by themselves (Adams and Payandeh, J. Lubr. Tech. 105 (1983) 377).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np
from scipy.optimize import brentq

from rotorgear.solvers.time.compiled import compiled

# What laws keep of a fold among their parameters: a_f, the loaded tilt there and at a = 0 over the one that closes the trailing
# edge, and the range of a below a_f over which the weight falls.
FOLD, TILT_THERE, TILT_AT_0, RANGE = range(4)
KEPT = 4
# The weight falls over this share of the distance to the fold, and over no less than this change of a, if a_f is that large: pads
# whose pivots are hardly behind the middle lose small forces at small a_f, over which Newton's method still has to find its way.
_GIVES_WAY = 0.2
_LEAST_RANGE = 0.005
# a of pads that no shaft comes to, and a_f of those whose film fails nowhere before.
_FARTHEST = 3.0
_NEVER = 1e3
# a of a shaft that is not away.
_ROUNDING = 1e-9
_ITERATIONS = 60
# Of a and the tilt over the one that closes the trailing edge: the moment about the pivot, its change with a, that with the tilt.
Moment = Callable[[float, float], tuple[float, float, float]]


@compiled(entry=False)
def loaded_tilt(p, at, away):  # type: ignore[no-untyped-def]
    """About where the loaded tilt is, over the one that closes the trailing edge, with the fold at p[at]; 0 < a < a_f.

    It is more than the tilt at the fold, and changes with the root of the distance to it.
    """
    there = p[at + TILT_THERE]
    return there + (p[at + TILT_AT_0] - there) * np.sqrt(1.0 - away / p[at + FOLD])


@compiled(entry=False)
def film_weight(p, at, away):  # type: ignore[no-untyped-def]
    """The weight of the loaded film of a pad, and its change with a, with the fold at p[at]; a >= 0."""
    if away >= p[at + FOLD]:
        return 0.0, 0.0
    left = (p[at + FOLD] - away) / p[at + RANGE]
    if left >= 1.0:
        return 1.0, 0.0
    return left * left * (3.0 - 2.0 * left), -6.0 * left * (1.0 - left) / p[at + RANGE]


def fold_of(moment: Moment, most: float) -> tuple[float, float, float, float]:
    """What a law keeps of the fold of a pad whose pivot lies behind its middle.

    Args:
        moment: of the film; more tilt presses the trailing edge. most: the largest tilt, where the edge stops the pad.
    """

    def least_at(away: float, low: float, high: float) -> float:
        return float(brentq(lambda tilt: moment(away, tilt)[2], low, high, xtol=1e-12))

    if moment(0.0, most)[0] <= 0.0:
        return _NEVER, 0.5 * most, most, _NEVER  # on its trailing edge
    high = most
    while moment(0.0, low := 0.8 * high)[2] > 0.0:
        high = low
    away = 0.0
    tilt = least_at(away, low, high)
    at_0 = float(brentq(lambda tilt: moment(0.0, tilt)[0], tilt, most, xtol=1e-6))
    # The least moment rises with a, the less the farther, so that Newton's steps stay below the fold.
    for _ in range(_ITERATIONS):
        least, rises, _ = moment(away, tilt)
        step = min(-least / rises, _FARTHEST - away)
        if step < 1e-12:
            break
        away += step
        low = high = tilt
        if moment(away, tilt)[2] <= 0.0:
            while moment(away, high := 1.1 * high)[2] <= 0.0:
                low = high
        else:
            while moment(away, low := 0.9 * low)[2] > 0.0:
                high = low
        tilt = least_at(away, low, high)
    if away >= _FARTHEST:
        return _NEVER, tilt, at_0, _NEVER
    return away, tilt, at_0, min(away, max(_GIVES_WAY * away, _LEAST_RANGE))


def doubts(pads: Iterable[tuple[int, bool, float]], fold: np.ndarray, side: str = "") -> Iterator[tuple[str, str]]:
    """What pads leave out: flutter without a film, the other stable tilt, and the jump at the fold.

    Args:
        pads: number of each, whether it has a film, and a. fold: what the law keeps of it. side: words behind the numbers.
    """
    empty = []
    either = []
    failing = []
    for number, carries, away in pads:
        if not carries:
            empty.append(number)
        elif away > fold[FOLD] - fold[RANGE]:
            failing.append(number)
        elif away > _ROUNDING:
            either.append(number)
    for what, numbers in (
        ("flutter of pads that have no film", empty),
        ("the tilt without a film at which pads may stay as well, after a shock", either),
        ("the jump of pads that lose their film: near it a part of their force is counted", failing),
    ):
        if numbers:
            yield what, f"pad{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))}{side}"
