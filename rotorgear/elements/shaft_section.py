"""Data of shaft elements, their sections, and Gauss points along them.

Shear coefficient: G. R. Cowper, J. Appl. Mech. 33 (1966) 335.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

# Gauss points: a uniform element needs polynomials up to degree 6 exactly; a cone's 1/d^4 converges spectrally.
POINTS_UNIFORM = 6
POINTS_CONE = 16


@dataclass(frozen=True)
class ShaftElements:
    """Data of e elements on one shaft, arrays of shape (e,) or (e, 4), in SI.

    `stiffness_diameters` and `mass_diameters` hold outer and inner diameter at the left end, then at the right end.
    `shear_coefficient` may hold NaN, which stands for Cowper's; infinity switches shear deformation off.
    """

    length: np.ndarray
    stiffness_diameters: np.ndarray
    mass_diameters: np.ndarray
    youngs_modulus: np.ndarray
    shear_modulus: np.ndarray
    poisson_ratio: np.ndarray
    density: np.ndarray
    shear_coefficient: np.ndarray

    def kappa(self, ratio: np.ndarray) -> np.ndarray:
        """Shear coefficients (e, g) at points with the diameter ratios d_i/d_o (e, g)."""
        given = self.shear_coefficient[:, None]
        return np.where(np.isnan(given), cowper(self.poisson_ratio[:, None], ratio), given)

    def unique(self) -> tuple[ShaftElements, np.ndarray]:
        """Return the different elements, and for each element its place among them."""
        columns = [np.reshape(getattr(self, name), (len(self.length), -1)) for name in self.__dataclass_fields__]
        # NaN (Cowper) is unequal to itself; -1 can't be a shear coefficient.
        table = np.nan_to_num(np.hstack(columns), nan=-1.0, posinf=-2.0)
        _, first, inverse = np.unique(table, axis=0, return_index=True, return_inverse=True)
        picked = {name: getattr(self, name)[first] for name in self.__dataclass_fields__}
        return ShaftElements(**picked), inverse.ravel()


def cowper(nu: np.ndarray | float, ratio: np.ndarray | float) -> np.ndarray:
    """Shear coefficient of a hollow circle with diameter ratio d_i/d_o (Cowper, J. Appl. Mech. 33, 1966)."""
    q = (1.0 + np.square(ratio)) ** 2
    return 6.0 * (1.0 + nu) * q / ((7.0 + 6.0 * nu) * q + (20.0 + 12.0 * nu) * np.square(ratio))


def torsional_flexibility(
    lengths: Sequence[float], diameters: Sequence[tuple[float, float, float, float]], moduli: Sequence[float]
) -> float:
    """Sum of the integrals of dz/(G J) over shaft segments in rad/(N m); 0 for no pieces."""
    if not lengths:
        return 0.0
    points, weights, _ = gauss(POINTS_CONE)
    outer, inner = profile(np.asarray(diameters, float), points)
    J = np.pi / 32.0 * (outer**4 - inner**4)
    return float(np.sum(np.asarray(lengths)[:, None] * weights / (np.asarray(moduli)[:, None] * J)))


@lru_cache(maxsize=64)
def gauss(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gauss points and weights on 0..1, and the matrix that integrates from 0 to each point (exact to degree count - 1)."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    points = 0.5 * (nodes + 1.0)
    # Integrate the interpolating Legendre series: columns are unit values at one point each.
    coefficients = np.linalg.inv(np.polynomial.legendre.legvander(nodes, count - 1))
    integral = np.polynomial.legendre.legint(coefficients, lbnd=-1, axis=0)
    return points, 0.5 * weights, 0.5 * np.polynomial.legendre.legval(nodes, integral).T


def profile(diameters: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Outer and inner diameter of each element at each point, shapes (e, g)."""
    left = diameters[:, :2, None]
    right = diameters[:, 2:, None]
    at = left + (right - left) * points
    return at[:, 0], at[:, 1]


def section(diameters: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Area, second moment of area and diameter ratio at each point; products keep thin walls exact."""
    outer, inner = profile(diameters, points)
    area = np.pi / 4.0 * (outer - inner) * (outer + inner)
    return area, area * (outer**2 + inner**2) / 16.0, inner / outer


def is_uniform(data: ShaftElements) -> bool:
    """Whether every element has one and the same section from end to end."""
    both = np.hstack([data.stiffness_diameters, data.mass_diameters])
    return bool(np.array_equal(both[:, [0, 1, 4, 5]], both[:, [2, 3, 6, 7]]))


def point_count(data: ShaftElements, order: int) -> int:
    """Gauss points that integrate elements of an order exactly (uniform) or to rounding (cones)."""
    return (POINTS_UNIFORM if is_uniform(data) else POINTS_CONE) + max(order - 1, 0)
