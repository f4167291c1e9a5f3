"""Fourier coefficients over a mesh cycle: of curves that the file gives, of corner impacts, and of the state of loaded teeth.

A curve x(u) over a cycle u = 0 to 1 is its mean plus the sum of Re(c_n e^{2 pi i n u}).
"""

from __future__ import annotations

from functools import cache

import numpy as np

# Harmonics of a given curve that count: up to this one, and not below this share of the strongest.
HIGHEST = 10
SMALLEST = 0.01
# Of the size of a curve: what is rounding, and no harmonic, however small the strongest is.
ROUNDING = 1e-12
# Harmonics of a given curve that are looked at, so that what is left out has a size.
SEEN = 100
# Harmonics of loaded teeth below the first share of the strongest are minor ones. They are left out while all of them together
# change no peak to peak by more than the second share of it, or of the third share of the largest one where that is more: helices
# that carry little have small curves, which count like the others.
_MINOR = 0.004
_PEAK_TO_PEAK = 0.005
_SMALL_CURVE = 0.1
# First orders of the mesh, and of a cycle in which teeth differ, that are looked at by themselves: none of them is left out
# that reaches the first share of the largest among them, however small they all are beside the others.
_FIRST = 5
# Teeth that differ have orders without end; this is the largest number that is taken.
_MOST = 1024
_NODES = 256
# The rule of Gauss and Legendre takes longer to find than to use.
_gauss = cache(np.polynomial.legendre.leggauss)


def harmonics_of_pieces(pieces: tuple[tuple[float, float, float], ...]) -> np.ndarray:
    """Coefficients (SEEN,) of straight pieces (start, value there, value at its end), over their mean.

    By parts over each piece: with w = 2 pi n the integral of x e^{-iwu} is [x e^{-iwu}] i/w + [e^{-iwu}] x'/w^2 between its ends.
    """
    start, first, last = np.array(pieces, dtype=float).T
    end = np.append(start[1:], 1.0)
    mean = float((0.5 * (first + last) * (end - start)).sum())
    return _of_straight(start, end, first, last) / mean


def harmonics_of_line(u: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Coefficients (SEEN,) of values x (k,) at rising places u (k,) from 0 to 1, linear in between."""
    return _of_straight(u[:-1], u[1:], x[:-1], x[1:])


def _of_straight(start: np.ndarray, end: np.ndarray, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    w = 2.0 * np.pi * np.arange(1, SEEN + 1)[:, None]
    a = np.exp(-1j * w * start)
    b = np.exp(-1j * w * end)
    slope = (last - first) / (end - start)
    return np.asarray(2.0 * ((last * b - first * a) * 1j / w + (b - a) * slope / w**2).sum(axis=1))


def harmonics_of_pulse(duration: float, at: float) -> np.ndarray:
    """Coefficients (SEEN,) of a half sine of height 1 that lasts a share of the cycle from `at` on."""
    nodes, weights = _gauss(_NODES)
    x = 0.5 * (nodes + 1.0)
    n = np.arange(1, SEEN + 1)[:, None]
    return np.asarray(
        duration * (weights * np.sin(np.pi * x) * np.exp(-2j * np.pi * n * (at + duration * x))).sum(axis=1)
    )


def strong(coefficients: np.ndarray) -> tuple[list[tuple[int, complex]], float]:
    """Numbers and coefficients of the harmonics that count, and the largest other one relative to the strongest.

    The coefficients are those of a curve of size 1.
    """
    size = np.where(np.abs(coefficients) > ROUNDING, np.abs(coefficients), 0.0)
    largest = float(size.max(initial=0.0))
    counts = (size > SMALLEST * largest) & (np.arange(len(size)) < HIGHEST)
    rest = float(size[~counts].max(initial=0.0))
    # Rounding is no harmonic.
    share = rest / largest if rest > 1e-9 * largest else 0.0
    return [(int(n) + 1, complex(coefficients[n])) for n in np.flatnonzero(counts)], share


def harmonics_of_cycle(values: np.ndarray) -> np.ndarray:
    """Coefficients (h, c) of values (p, c), evenly spaced over a cycle."""
    count = (len(values) - 1) // 2
    return np.asarray(2.0 * np.fft.fft(values, axis=0)[1 : count + 1] / len(values))


def that_matter(
    values: np.ndarray, periods: int = 1, sizes: np.ndarray | float = 0.0
) -> tuple[list[int], set[int], float, float]:
    """Which harmonics of values (p, c) over a cycle of some mesh periods are needed for their peak to peak.

    The first orders of the mesh and of the cycle are among them, too. Values that vary by no more than the rounding of `sizes`
    (c,), of which they are a part, do not vary.

    Returns:
        Their numbers, rising; those of them that are large by themselves; the largest of the others, relative to the strongest;
        and the largest change of a peak to peak without the others, relative to it, or to a tenth of the largest one.
    """
    rounding = ROUNDING * np.maximum(sizes, np.abs(values).max(axis=0))
    values = np.where(np.ptp(values, axis=0) > rounding, values, 0.0)
    spectrum = np.fft.rfft(values, axis=0)
    spectrum[0] = 0.0
    size = np.abs(spectrum).max(axis=1)
    largest = float(size.max(initial=0.0))
    if not largest:
        return [], set(), 0.0, 0.0
    first = _first_orders(np.abs(spectrum), periods)
    order = np.lexsort((-size, ~first))
    least = min(int(np.count_nonzero(first | (size > _MINOR * largest))), _MOST)
    whole = np.ptp(values, axis=0)
    scale = np.maximum(whole, _SMALL_CURVE * whole.max())

    def change(count: int) -> float:
        kept = np.zeros_like(spectrum)
        kept[order[:count]] = spectrum[order[:count]]
        parts = np.fft.irfft(kept, len(values), axis=0)
        return float((np.abs(np.ptp(parts, axis=0) - whole) / scale).max())

    count = least
    while count < min(len(order) - 1, _MOST) and change(count) > _PEAK_TO_PEAK:
        count += max(1, count // 16)
    # Rounding is no harmonic, and the highest of an even number of values has no phase.
    numbers = sorted(int(n) for n in order[:count] if size[n] > ROUNDING * largest and 2 * n < len(values))
    major = {n for n in numbers if size[n] > _MINOR * largest}
    weak = float(np.delete(size, numbers).max(initial=0.0)) / largest
    return (numbers, major, weak, change(count)) if weak > 1e-9 else (numbers, major, 0.0, 0.0)


def _first_orders(size: np.ndarray, periods: int) -> np.ndarray:
    """Which of the harmonics (h, c) are among the first of the mesh or of the cycle, and not minor among them in every curve."""
    found = np.zeros(len(size), dtype=bool)
    for step in {1, periods}:
        own = size[step : _FIRST * step + 1 : step]
        found[step : _FIRST * step + 1 : step] |= np.any(own > _MINOR * own.max(axis=0, initial=0.0), axis=1)
    return found
