"""Fourier coefficients over a mesh cycle of what the file gives as a curve: stiffness from a model of the teeth, corner impacts.

A curve x(u) over a cycle u = 0 to 1 is its mean plus the sum of Re(c_n e^{2 pi i n u}).
"""

from __future__ import annotations

import numpy as np

# Harmonics of a curve that count: up to this one, and not below this share of the strongest.
HIGHEST = 10
SMALLEST = 0.01
_NODES = 64


def harmonics_of_pieces(pieces: tuple[tuple[float, float, float], ...]) -> np.ndarray:
    """Coefficients (HIGHEST,) of straight pieces (start, value there, value at its end), over their mean.

    By parts over each piece: with w = 2 pi n the integral of x e^{-iwu} is [x e^{-iwu}] i/w + [e^{-iwu}] x'/w^2 between its ends.
    """
    start, first, last = np.array(pieces, dtype=float).T
    end = np.append(start[1:], 1.0)
    mean = float((0.5 * (first + last) * (end - start)).sum())
    w = 2.0 * np.pi * np.arange(1, HIGHEST + 1)[:, None]
    a = np.exp(-1j * w * start)
    b = np.exp(-1j * w * end)
    slope = (last - first) / (end - start)
    return np.asarray(2.0 / mean * ((last * b - first * a) * 1j / w + (b - a) * slope / w**2).sum(axis=1))


def harmonics_of_pulse(duration: float, at: float) -> np.ndarray:
    """Coefficients (HIGHEST,) of a half sine of height 1 that lasts a share of the cycle from `at` on."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    x = 0.5 * (nodes + 1.0)
    n = np.arange(1, HIGHEST + 1)[:, None]
    return np.asarray(
        duration * (weights * np.sin(np.pi * x) * np.exp(-2j * np.pi * n * (at + duration * x))).sum(axis=1)
    )


def strong(coefficients: np.ndarray) -> list[tuple[int, complex]]:
    """Numbers and coefficients of the harmonics that count."""
    size = np.abs(coefficients)
    return [(n + 1, complex(c)) for n, c in enumerate(coefficients) if size[n] > SMALLEST * size.max(initial=0.0)]
