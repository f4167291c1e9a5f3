"""The rules as closed forms: limits that depend on speed, mass and amplification alone.

API 617, 8th edition (2014), and API 684, 2nd edition (2005): amplification factor, separation margins, vibration limit and
unbalance, logarithmic decrement, torsional interference. ISO 21940-11:2016: permissible residual unbalance.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from rotorgear.results.standards import RuleTable

LATERAL = "API 617, 8th edition, 2014"
BALANCE = "ISO 21940-11:2016"

AMPLIFICATION = RuleTable(
    "amplification factor", LATERAL, "AF = N_c/(N_2 - N_1), N_1 and N_2 where the response is 0.707 of its peak at N_c"
)
SEPARATION = RuleTable(
    "separation margin",
    LATERAL,
    "17 (1 - 1/(AF - 1.5)) % where the critical speed lies below the operating speed, 10 + that where above; none where AF < 2.5",
)
VIBRATION = RuleTable(
    "vibration limit",
    LATERAL,
    "min(25.4, 25.4 sqrt(12000/N)) um peak to peak, with an unbalance of 2 x 6350 W/N g mm at the antinodes",
)
CLEARANCE = RuleTable(
    "clearance", LATERAL, "major axis of the orbit below 75 % of the diametral clearance, with the same unbalance"
)
STABILITY = RuleTable("stability", LATERAL, "logarithmic decrement of 0.1 or more")
INTERFERENCE = RuleTable(
    "torsional interference", LATERAL, "torsional natural frequencies 10 % away from 1x, 2x and the mesh orders"
)
RESIDUAL = RuleTable("residual unbalance", BALANCE, "U = 9549 G m/N g mm, G in mm/s, m in kg, N in rpm")
RULES = (AMPLIFICATION, SEPARATION, VIBRATION, CLEARANCE, STABILITY, INTERFERENCE, RESIDUAL)

# Peaks below it ask for no margin.
LEAST_AMPLIFICATION = 2.5
LEAST_DECREMENT = 0.1
LEAST_TORSIONAL_MARGIN = 0.10
CLEARANCE_SHARE = 0.75
_HALF_POWER = 1.0 / math.sqrt(2.0)
# The half-power speeds are found to this share of the width between them.
_EXACT = 1e-6
_STEPS = 400


@dataclass(frozen=True)
class ResponsePeak:
    """A peak of a response over speed: its place and height, and the half-power speeds (NaN where the response does not fall)."""

    speed: float
    height: float
    below: float
    above: float

    @property
    def amplification_factor(self) -> float:
        """N_c/(N_2 - N_1); of one side alone N_c over twice the distance to it; NaN where there is neither."""
        if math.isnan(self.below) and math.isnan(self.above):
            return math.nan
        if math.isnan(self.below):
            return self.speed / (2.0 * (self.above - self.speed))
        if math.isnan(self.above):
            return self.speed / (2.0 * (self.speed - self.below))
        return self.speed / (self.above - self.below)


def response_peak(
    amplitude: Callable[[float], float], near: float, width: float, least: float = 0.0
) -> ResponsePeak | None:
    """The peak of a response next to a speed, and where it has fallen to 0.707 of it, found by roots and not on a grid.

    Args:
        amplitude: of the response at a speed; any unit.
        near: speed to begin at, such as a damped critical speed.
        width: relative width that is expected, such as the damping ratio there.
        least: speed below which the response is not known.

    Returns:
        The peak; None where the response has none within a tenth (or ten widths) of the speed.
    """
    from scipy.optimize import brentq, minimize_scalar

    step = max(0.25 * width, 1e-7) * near
    bracket = (near - step, near + step)
    found = minimize_scalar(
        lambda speed: -amplitude(max(abs(speed), least)), bracket=bracket, method="brent", options={"xtol": 1e-9}
    )
    peak = abs(float(found.x))
    if not abs(peak / near - 1.0) <= max(0.1, 10.0 * width):
        return None
    height = amplitude(peak)
    level = _HALF_POWER * height

    def fallen(sign: float) -> float:
        """The half-power speed to one side; NaN where the response rises again before, or the speed falls to nothing."""
        here = peak
        last = height
        stride = 0.2 * step
        for _ in range(_STEPS):
            beyond = here + sign * stride
            if beyond <= least or beyond > 3.0 * peak:
                return math.nan
            size = amplitude(beyond)
            if size <= level:
                low, high = sorted((here, beyond))
                return float(
                    brentq(lambda speed: amplitude(speed) - level, low, high, xtol=_EXACT * abs(beyond - peak))
                )
            if size > last:
                return math.nan
            here = beyond
            last = size
            stride *= 1.15
        return math.nan

    return ResponsePeak(peak, height, fallen(-1.0), fallen(1.0))


def separation_margin(amplification: float, below: bool) -> float | None:
    """Margin in % of the operating speed that a peak asks for, which lies below or above it; None where it asks for none."""
    if amplification < LEAST_AMPLIFICATION:
        return None
    share = 17.0 * (1.0 - 1.0 / (amplification - 1.5))
    return share if below else 10.0 + share


def vibration_limit(rpm: float) -> float:
    """Largest displacement in m, peak to peak, at a speed of the shaft in rpm."""
    return 25.4e-6 * min(1.0, math.sqrt(12000.0 / rpm))


def trial_unbalance(mass: float, rpm: float) -> float:
    """Unbalance in kg m to put on a rotor of a mass in kg: 2 x 6350 W/N g mm."""
    return 2.0 * 6350.0 * mass / rpm * 1e-6


def residual_unbalance(grade: float, mass: float, rpm: float) -> float:
    """Permissible residual unbalance in kg m of a rotor of a mass in kg, for a balance quality grade in mm/s."""
    return 9549.0 * grade * mass / rpm * 1e-6
