"""The equations of a curve of folds, of equations in closed form with a cusp: their slopes are difference quotients."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from rotorgear.solvers.periodic.curves import SpecialCurve
from rotorgear.solvers.periodic.special import FOLD


@dataclass(frozen=True)
class Coupled:
    """r = [y0 - y1 (1 + q/2) - sin(p), q y0 - y0^3 + p y1], smooth in both parameters."""

    q: float

    def values(self, y: np.ndarray, p: float, *, smooth: bool = False) -> tuple[np.ndarray, np.ndarray]:
        a = 1.0 + 0.5 * self.q
        r = np.array([y[0] - a * y[1] - np.sin(p), self.q * y[0] - y[0] ** 3 + p * y[1]])
        return r, np.array([[1.0, -a], [self.q - 3.0 * y[0] ** 2, p]])

    def prepare_at(self, p: float) -> None:
        pass


def curve(**changed: Any) -> SpecialCurve:
    given = {"y": np.array([0.4, 0.2]), "p": 0.3, "q": 0.7, **changed}
    return SpecialCurve(Coupled, FOLD, **given)  # type: ignore[arg-type]


def test_slopes_of_residual_and_border_are_difference_quotients() -> None:
    equations = curve()
    z, q = np.array([0.45, 0.25, 0.28]), 0.65
    found = equations.linear(z, q)
    np.testing.assert_allclose(found.residual, equations.residual(z, q), rtol=1e-12)
    h = 1e-5
    for k, step in enumerate(h * np.eye(3)):
        quotient = (equations.residual(z + step, q) - equations.residual(z - step, q)) / (2.0 * h)
        np.testing.assert_allclose(found.in_y[:, k], quotient, atol=3e-5)
    quotient = (equations.residual(z, q + h) - equations.residual(z, q - h)) / (2.0 * h)
    np.testing.assert_allclose(found.in_p, quotient, atol=3e-5)


def test_the_border_vanishes_where_the_matrix_is_singular() -> None:
    y = np.array([0.5, 0.1])
    q = 0.6
    p = -(q - 3.0 * y[0] ** 2) * (1.0 + 0.5 * q)  # the determinant p + a (q - 3 y0^2) is zero
    assert curve(y=y, p=p, q=q).residual(np.append(y, p), q)[-1] == pytest.approx(0.0, abs=1e-12)
    assert abs(curve(y=y, p=p, q=q).residual(np.append(y, p + 0.1), q)[-1]) > 1e-3
