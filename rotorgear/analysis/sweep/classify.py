"""Response type from a Poincare section, and the Lyapunov exponents with their statistical uncertainty.

With x the displacements of the contacts at the end of each least common period T, p their peak-to-peak value over time (with or
without the transmission error, whichever is larger) and L the largest exponent per period of the fastest mesh, the first
criterion that holds decides:

    chaotic         L > chaos (0.02), L > 2 standard errors, and x does not grow from one half of the section to the other
    kT              any two x that are k T apart differ by at most tolerance (0.02) of max(p, 0.05 um), for the least k up to 32;
                    where the range of all x is larger than that, by at most half that range
    chaotic         as above with L > 1 standard error: a response that does not repeat needs less evidence
    quasi-periodic  |L| <= chaos, and the two halves of the section cover the same range to 10 %
    not settled     anything else
"""

from __future__ import annotations

import numpy as np

LONGEST = 32
TOLERANCE = 0.02
CHAOS = 0.02
LEAST_MOTION = 0.05e-6  # m, peak to peak
SAME_RANGE = 0.1
# Largest range of x that are k periods apart, relative to the range of all x. For a period-k response that ratio is small. For
# scattered x, picking every k-th of a few samples hardly narrows the range, so a scattered response is not taken for periodic.
_APART = 0.5
_GROWTH = 5.0
# Batches of consecutive periods whose means are taken as independent.
_BATCHES = 16
CHAOTIC = "chaotic"
QUASI_PERIODIC = "quasi-periodic"
NOT_SETTLED = "not settled"
NOT_PERIODIC = "not periodic"
FAILED = "failed"


def exponents(growth: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Means and standard errors of growth (p, t) over a length each, from the scatter between batches of consecutive periods."""
    count = len(growth)
    mean = growth.mean(axis=0) / length
    batches = min(_BATCHES, count // 2)
    if batches < 2:
        return mean, np.full(mean.shape, np.nan)
    size = count // batches
    means = growth[count - size * batches :].reshape(batches, size, -1).mean(axis=1) / length
    return mean, means.std(axis=0, ddof=1) / np.sqrt(batches)


def classify(
    x: np.ndarray,
    extent: np.ndarray,
    exponent: float | None,
    error: float,
    tolerance: float = TOLERANCE,
    chaos: float = CHAOS,
) -> str:
    """Return the response type; one that repeats is "kT", k its period in least common periods.

    Args:
        x: (p, c) displacements of the contacts at the section; extent: (c,) their peak-to-peak value over time.
        exponent, error: largest Lyapunov exponent per period of the fastest mesh; None where it is not known.
        tolerance, chaos: the bounds in the criteria above.
    """
    if exponent is not None and exponent > max(chaos, 2.0 * error):
        return NOT_SETTLED if _grows(x) else CHAOTIC
    if period := period_of(x, extent, tolerance):
        return f"{period}T"
    if exponent is None:
        return NOT_PERIODIC
    if exponent > max(chaos, error) and not _grows(x):
        return CHAOTIC
    half = len(x) // 2
    if half and abs(exponent) <= chaos:
        # Both halves of the section cover the same range.
        first, second, whole = (np.array([part.min(axis=0), part.max(axis=0)]) for part in (x[:half], x[half:], x))
        if np.all(np.abs(first - second) <= SAME_RANGE * np.maximum(whole[1] - whole[0], 1e-300)):
            return QUASI_PERIODIC
    return NOT_SETTLED


def period_of(x: np.ndarray, extent: np.ndarray, tolerance: float = TOLERANCE) -> int:
    """Least number k of least common periods after which x (p, c) repeats; 0 where it does not."""
    allowed = tolerance * np.maximum(extent, LEAST_MOTION)
    spread = np.ptp(x, axis=0)
    allowed = np.where(spread > allowed, np.minimum(allowed, _APART * spread), allowed)
    for k in range(1, min(LONGEST, len(x) // 3) + 1):
        if all(np.all(np.ptp(x[j::k], axis=0) <= allowed) for j in range(k)):
            return k
    return 0


def period_in(kind: str) -> int:
    """Least common periods after which a response type repeats; 0 where it does not."""
    return int(kind[:-1]) if kind.endswith("T") else 0


def _grows(x: np.ndarray) -> bool:
    """Whether the range of the second half of a section is far larger than that of the first: unstable, not chaotic."""
    half = len(x) // 2
    return half > 0 and bool(np.any(np.ptp(x[half:], axis=0) > _GROWTH * np.ptp(x[:half], axis=0)))
