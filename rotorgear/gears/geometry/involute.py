"""The involute function inv(a) = tan a - a and its inverse, both to rounding.

Reference: ISO 21771-1, Cylindrical involute gears and gear pairs. Angles in rad.
"""

from __future__ import annotations

import math

from rotorgear.errors import AnalysisError

# Below tan(angle) = 0.5 the series of t - atan(t) is used: the plain difference would lose digits.
_SERIES_LIMIT = 0.5


def _tangent_minus_angle(t: float) -> float:
    """t - atan(t) for t >= 0 with full relative accuracy: t^3/3 - t^5/5 + ... where the difference would cancel."""
    if t >= _SERIES_LIMIT:
        return t - math.atan(t)
    total = 0.0
    power = t**3
    order = 3
    while power / order > 1e-18 * abs(total):
        total += power / order if order % 4 == 3 else -power / order
        power *= t * t
        order += 2
    return total


def involute(angle: float) -> float:
    """Involute function inv(angle) = tan(angle) - angle for 0 <= angle < pi/2 rad; AnalysisError outside."""
    if not 0.0 <= angle < math.pi / 2:
        raise AnalysisError(
            f"The involute function needs an angle from 0 to below 90 deg, not {math.degrees(angle):g} deg."
        )
    return _tangent_minus_angle(math.tan(angle))


def inverse_involute(value: float) -> float:
    """Angle (rad) whose involute function is `value` >= 0, to rounding; AnalysisError for a negative or infinite value.

    Newton on t = tan(angle): f(t) = t - atan(t) - value is convex and increasing, so from the second step on the
    iterates come down to the root monotonically; it ends where rounding stops the descent.
    """
    if not 0.0 <= value < math.inf:
        raise AnalysisError(f"No angle has the involute function {value:g}: give a finite value of zero or more.")
    if value == 0.0:
        return 0.0
    t = 1.44 * math.cbrt(value)  # just below cbrt(3 value), the leading term of the series: left of the root
    t -= (_tangent_minus_angle(t) - value) * (1.0 + t**-2)
    while (lower := t - (_tangent_minus_angle(t) - value) * (1.0 + t**-2)) < t:
        t = lower
    return math.atan(t)
