"""What measured lines teach of uncertain numbers: the linear Gaussian estimate, by singular values.

Unknown is x = ln(p / p0), normal with the standard deviations of the prior, S = diag(sigma_p). Measured is
y = ln(f / f0) = J x + noise, with standard deviations N = diag(sigma_y). In units of both, W = N^-1 J S = U diag(s) V^T.
The direction V_k of the parameters is known from the lines to the share s_k^2 / (1 + s_k^2), the rest is the prior's; the
sum of the shares is the effective number of parameters learnt (MacKay 1992, Bayesian interpolation, Neural Computation 4,
eq. 4.9). Posterior covariance: S (1 - V diag(share) V^T) S.

What lines teach of stiffnesses is known before anybody updates a model: d ln f / d ln k of a spring is half its share in the
strain energy of the mode (Rayleigh's quotient: Fox and Kapoor 1968, Rates of change of eigenvalues and eigenvectors, AIAA
Journal 6), so a modal analysis holds all that is needed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rotorgear.analysis.sensitivity.derivatives import SPRINGS
from rotorgear.model.numbers import DEFAULT_PRIOR
from rotorgear.results.comparison import LearntParameter, RigLine


@dataclass(frozen=True)
class Posterior:
    """The estimate of p parameters from n lines.

    Attributes:
        jacobian: d ln f / d ln p (n, p).
        noise: relative standard deviation of the lines (n,), positive.
        prior: relative standard deviation of the parameters before the test (p,), positive.
    """

    jacobian: NDArray[np.float64]
    noise: NDArray[np.float64]
    prior: NDArray[np.float64]

    @cached_property
    def _directions(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """U (n, r), s (r,) and V (p, r), r = min(n, p)."""
        left, singular, right = np.linalg.svd(self.jacobian * self.prior / self.noise[:, None], full_matrices=False)
        return left, singular, right.T

    @property
    def shares(self) -> NDArray[np.float64]:
        """How much of each direction comes from the lines, s^2 / (1 + s^2), (r,), largest first."""
        singular = self._directions[1]
        return singular**2 / (1.0 + singular**2)

    @property
    def directions(self) -> NDArray[np.float64]:
        """The directions in units of the prior, (p, r), in the order of `shares`."""
        return self._directions[2]

    @property
    def learnt(self) -> NDArray[np.float64]:
        """Share of each parameter's prior variance that the lines removed, (p,); their sum is the number learnt."""
        return self.directions**2 @ self.shares

    @property
    def sigma(self) -> NDArray[np.float64]:
        """Relative standard deviation of each parameter after the test, (p,)."""
        # What no line sees, 1 - sum V^2, and what each direction leaves, V^2 / (1 + s^2): no difference of nearly equal numbers
        # in a direction that is known to 1e-8.
        left = 1.0 / (1.0 + self._directions[1] ** 2)
        whole = self.directions.shape[0] == self.directions.shape[1]
        unseen = 0.0 if whole else np.maximum(1.0 - np.sum(self.directions**2, axis=1), 0.0)
        return self.prior * np.sqrt(unseen + self.directions**2 @ left)

    def spread_of(self, slopes: NDArray[np.float64]) -> NDArray[np.float64]:
        """Standard deviation after the test of quantities with derivatives `slopes` (m, p), (m,)."""
        scaled = slopes * self.prior
        seen = scaled @ self.directions
        variance = np.sum(scaled**2, axis=1) - np.sum(seen**2 * self.shares, axis=1)
        return np.sqrt(np.maximum(variance, 0.0))

    @property
    def correlation(self) -> NDArray[np.float64]:
        """Correlation of the estimates, (p, p)."""
        shared = -(self.directions * self.shares) @ self.directions.T
        spread = self.sigma / self.prior
        found = np.clip(shared / np.outer(spread, spread), -1.0, 1.0)
        np.fill_diagonal(found, 1.0)
        return found

    def estimate(self, residual: NDArray[np.float64]) -> NDArray[np.float64]:
        """Most probable x (p,) for y - f(x_0) + J x_0 = `residual` (n,)."""
        left, singular, right = self._directions
        return self.prior * (right @ (singular / (1.0 + singular**2) * (left.T @ (residual / self.noise))))


# What a rig knows of a frequency for which it states nothing.
LINE_NOISE = 0.005


def learnt_stiffnesses(
    strain_energy: Mapping[str, ArrayLike], modes: Sequence[int], lines: Sequence[RigLine]
) -> tuple[LearntParameter, ...]:
    """Return what each spring's stiffness is known to once mode `modes[k]` is held to `lines[k]`.

    Args:
        strain_energy: share of each part in the strain energy of all m modes, part -> (m,).
        modes: index of the mode of each matched line (n).
        lines: the matched lines (n).
    """
    springs, shares = spring_shares(strain_energy, np.array(modes, dtype=np.intp))
    if not springs or not lines:
        return ()
    noise = np.array([line_noise(line) for line in lines])
    posterior = Posterior(0.5 * shares.T, noise, np.full(len(springs), DEFAULT_PRIOR))
    rows = zip(springs, posterior.sigma, posterior.learnt, strict=True)
    return tuple(
        LearntParameter(f"{part}.stiffness", DEFAULT_PRIOR, float(sigma), float(learnt)) for part, sigma, learnt in rows
    )


def spring_shares(
    strain_energy: Mapping[str, ArrayLike], modes: NDArray[np.intp]
) -> tuple[list[str], NDArray[np.float64]]:
    """The springs among some parts, and the share of each in the strain energy of some modes, (springs, modes)."""
    springs = [part for part in strain_energy if part.partition(".")[0] in SPRINGS]
    rows = [np.asarray(strain_energy[part], dtype=float)[modes] for part in springs]
    return springs, np.array(rows).reshape(len(springs), len(modes))


def line_noise(line: RigLine) -> float:
    """Relative standard deviation of a line: its own, else 0.5 %."""
    # A line that claims to be exact would settle one direction entirely; no reading is better than rounding.
    return LINE_NOISE if line.uncertainty_hz is None else max(line.uncertainty_hz / line.frequency_hz, 1e-12)
