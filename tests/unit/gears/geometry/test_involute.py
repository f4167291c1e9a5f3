"""The involute function and its inverse against table values and exact arithmetic."""

from __future__ import annotations

import math

import mpmath
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import inverse_involute, involute

deg = math.radians


def exact_inverse(value: float) -> mpmath.mpf:
    with mpmath.workdps(400):  # t - atan(t) cancels 200 digits at 1e-300
        t = mpmath.cbrt(3 * mpmath.mpf(value))
        for _ in range(40):
            t -= (t - mpmath.atan(t) - value) * (1 + t**-2)
        return mpmath.atan(t)


@pytest.mark.parametrize("value", [1e-300, 1e-18, 1e-9, 1e-4, 0.014904383867, 0.0363, 0.0365, 0.3, 1.0, 3.0, 50.0])
def test_the_inverse_involute_is_accurate_to_rounding(value: float) -> None:
    exact = exact_inverse(value)
    assert abs(mpmath.mpf(inverse_involute(value)) / exact - 1) < 1e-15


@pytest.mark.parametrize("angle", [1e-8, 1e-4, 0.01, 0.35, 0.46, 0.48, 1.0, 1.5])
def test_the_involute_keeps_its_digits_at_small_angles(angle: float) -> None:
    with mpmath.workdps(60):
        exact = mpmath.tan(mpmath.mpf(angle)) - mpmath.mpf(angle)
    assert abs(mpmath.mpf(involute(angle)) / exact - 1) < 2e-15


def test_the_involute_of_twenty_degrees_is_the_table_value() -> None:
    assert involute(deg(20.0)) == pytest.approx(0.014904383867, abs=5e-13)
    assert involute(0.0) == 0.0
    assert inverse_involute(0.0) == 0.0


@pytest.mark.parametrize("angle", [-0.1, math.pi / 2, 3.0, math.nan])
def test_the_involute_refuses_angles_outside_its_domain(angle: float) -> None:
    with pytest.raises(AnalysisError, match="involute function needs an angle"):
        involute(angle)


@pytest.mark.parametrize("value", [-1e-9, math.inf, math.nan])
def test_the_inverse_involute_refuses_values_without_an_angle(value: float) -> None:
    with pytest.raises(AnalysisError, match="No angle has the involute function"):
        inverse_involute(value)
