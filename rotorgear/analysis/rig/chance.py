"""What a random list of rig lines would match: the yardstick of every rig comparison.

N lines are thrown on the band, uniform in log frequency and independent, and assigned one-to-one to the same modes as
the rig lines were. Monte Carlo significance (1 + hits) / (1 + samples): Davison & Hinkley, Bootstrap Methods and their
Application (1997), section 4.2. In closed form, if lines could share a mode: the number of matches is binomial with the
covered share of the band as probability.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rotorgear.results.comparison import Chance
from rotorgear.solvers.eigen.assignment import assign, covered_share, miss_cost

# A random list that does as well to the last digit is a hit; rounding must not decide it.
TIE = 1e-12


def estimate_chance(
    rig_hz: NDArray[np.float64],
    mode_hz: NDArray[np.float64],
    tolerance: float,
    band: tuple[float, float],
    *,
    samples: int = 2000,
    seed: int = 0,
) -> Chance:
    """Return what chance gives for as many lines as `rig_hz` (r,) against the elastic modes `mode_hz` (m,), all in Hz.

    Args:
        tolerance: relative, between 0 and 1.
        band: lowest and highest frequency of a random line, in Hz.
        samples, seed: number of random lists, and their seed.
    """
    low, high = band
    in_reach = mode_hz[(mode_hz >= low * (1.0 - tolerance)) & (mode_hz <= high * (1.0 + tolerance))]
    matched, distance = _score(rig_hz, mode_hz, tolerance)
    draws = np.random.default_rng(seed).random((samples, rig_hz.size))
    scores = np.array([_score(low * (high / low) ** draw, in_reach, tolerance) for draw in draws])
    coverage = covered_share(mode_hz, tolerance, low, high)
    return Chance(
        band_low_hz=low,
        band_high_hz=high,
        modes_in_band=int(np.count_nonzero((mode_hz >= low) & (mode_hz <= high))),
        coverage=coverage,
        expected_random_matches=float(scores[:, 0].mean()),
        probability_as_many=_significance(scores[:, 0] >= matched),
        probability_as_close=_significance(scores[:, 1] <= distance + TIE),
        binomial_expected=rig_hz.size * coverage,
        binomial_probability=binomial_tail(rig_hz.size, matched, coverage),
        samples=samples,
        seed=seed,
    )


def binomial_tail(count: int, at_least: int, probability: float) -> float:
    """Return the probability of `at_least` or more successes in `count` independent trials.

    The tail is the incomplete beta function I_p(k, n - k + 1) (Abramowitz & Stegun 26.5.24), whose terms do not overflow.
    """
    from scipy.special import betainc

    return 1.0 if at_least == 0 else float(betainc(at_least, count - at_least + 1, probability))


def _score(lines: NDArray[np.float64], modes: NDArray[np.float64], tolerance: float) -> tuple[int, float]:
    """Return the number of matches and the sum of |ln(f / r)|, an unmatched line counting with the full tolerance."""
    pairs = assign(lines, modes, tolerance)
    distance = math.fsum(abs(math.log(modes[mode] / lines[line])) for line, mode in pairs)
    return len(pairs), distance + (lines.size - len(pairs)) * miss_cost(tolerance)


def _significance(hits: NDArray[np.bool_]) -> float:
    return float((1 + np.count_nonzero(hits)) / (1 + hits.size))
