"""Frequencies and damping of vibrations that die away, from records of them.

All channels share frequencies and damping ratios; each has its own amplitudes, phases, and a cubic under them, which is what
else changes in the meantime, such as the torque of a drive that slows down:

    x(t) = a + b t + c t^2 + d t^3 + sum_m exp(-zeta_m w_m t) (A_m cos wd_m t + B_m sin wd_m t),    wd_m = w_m sqrt(1 - zeta_m^2)

Frequencies and ratios are those of the least squares, amplitudes being eliminated for each of them (Golub and Pereyra, The
differentiation of pseudo-inverses and nonlinear least squares problems, SIAM J. Numer. Anal. 10 (1973)). Standard errors are
those of noise that is independent from sample to sample; what a filter has smoothed, or what else vibrates, makes them larger.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rotorgear.errors import AnalysisError

# A vibration is looked for from so many periods in the record on, which no cubic follows, with these damping ratios.
_LEAST_PERIODS = 3.0
_RATIOS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.2)
_STARTS = 12
_PADDED = 2
_LEAST_SAMPLES = 12
_DEGREE = 3
_MOST_SAMPLES = 20_000
# Samples at both ends of a thinned record that the filter before it reaches beyond.
_REACH = 10
_WITHIN = (1e-6, 0.7)


@dataclass(frozen=True)
class RingDownFit:
    """A vibration that dies away.

    Attributes:
        natural_hz: w / 2 pi; with its standard error. damping_ratio: zeta; with its standard error.
        explained: share of the variance about cubics that all vibrations of the fit explain, mean of the channels.
    """

    natural_hz: float
    natural_hz_sigma: float
    damping_ratio: float
    damping_ratio_sigma: float
    explained: float


def ring_down(step: float, values: NDArray[np.float64], count: int = 1) -> tuple[RingDownFit, ...]:
    """Return the vibrations that explain most of some channels, in ascending frequency.

    Args:
        step: between samples, in s.
        values: channels (c, n) while nothing but the vibrations that die away is in them. Of more than 20 000 samples so many are
            kept, behind a filter that lets nothing fold down.
        count: number of vibrations, 1 or more.

    Raises:
        AnalysisError: too few samples, or nothing that varies.
    """
    from scipy.optimize import least_squares

    thin = values.shape[1] // _MOST_SAMPLES
    if thin > 1:
        from scipy.signal import decimate

        # A filter of linear phase leaves frequency and damping of a vibration as they are.
        values = decimate(values, thin, ftype="fir", axis=1)[:, _REACH:-_REACH]
        step = step * thin
    n = values.shape[1]
    least = max(_LEAST_SAMPLES, 4 * count + 2 * _DEGREE)
    if n < least:
        raise AnalysisError(f"a ring-down needs {least} samples or more; its time holds {n}")
    t = step * np.arange(n)
    under = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, n), _DEGREE)
    Q = np.linalg.qr(under)[0]
    about = values.T - Q @ (Q.T @ values.T)
    size = np.sqrt(np.mean(about**2, axis=0))
    if not np.all(size > 1e-12 * np.abs(values).max(axis=1, initial=0.0)):
        raise AnalysisError("a ring-down needs channels that vary within its time")
    scaled = values.T / size

    def basis(x: NDArray[np.float64]) -> NDArray[np.float64]:
        columns = [*under.T]
        for f, zeta in x.reshape(-1, 2):
            falls = np.exp(-2.0 * np.pi * f * zeta * t)
            angle = 2.0 * np.pi * f * np.sqrt(1.0 - zeta**2) * t
            columns += [falls * np.cos(angle), falls * np.sin(angle)]
        return np.column_stack(columns)

    def left(x: NDArray[np.float64]) -> NDArray[np.float64]:
        Q = np.linalg.qr(basis(x))[0]
        return np.asarray((scaled - Q @ (Q.T @ scaled)).ravel())

    lowest = _LEAST_PERIODS / (n * step)
    hz = np.fft.rfftfreq(_PADDED * n, step)
    x = np.zeros(0)
    for _ in range(count):
        # Begin at the largest peaks in the spectrum of what is left.
        power = np.sum(np.abs(np.fft.rfft(left(x).reshape(n, -1), _PADDED * n, axis=0)) ** 2, axis=1)
        peaks = np.flatnonzero((power[1:-1] >= power[:-2]) & (power[1:-1] >= power[2:])) + 1
        peaks = peaks[(hz[peaks] >= lowest) & (hz[peaks] < 0.5 / step)]
        largest = hz[peaks[np.argsort(-power[peaks])[:_STARTS]]]
        starts = largest if largest.size else np.array([2.0 * lowest])
        tried = [np.append(x, (f, zeta)) for f in starts for zeta in _RATIOS]
        x = min(tried, key=lambda one: float(np.sum(left(one) ** 2)))
        low, high = (np.tile(ends, len(x) // 2) for ends in ((0.3 * lowest, _WITHIN[0]), (0.5 / step, _WITHIN[1])))
        x = least_squares(left, x, bounds=(low, high), x_scale=np.maximum(np.abs(x), 1e-3)).x
    end = least_squares(left, x, bounds=(low, high), x_scale=np.maximum(np.abs(x), 1e-3))
    unknowns = len(x) + (1 + _DEGREE + len(x)) * values.shape[0]
    noise = 2.0 * end.cost / max(scaled.size - unknowns, 1)
    spread = np.sqrt(np.maximum(np.diag(noise * np.linalg.pinv(end.jac.T @ end.jac)), 0.0))
    explained = float(1.0 - 2.0 * end.cost / np.sum((about / size) ** 2))
    rows = zip(end.x.reshape(-1, 2).tolist(), spread.reshape(-1, 2).tolist(), strict=True)
    fits = [RingDownFit(f, df, zeta, dz, explained) for (f, zeta), (df, dz) in rows]
    return tuple(sorted(fits, key=lambda fit: fit.natural_hz))
