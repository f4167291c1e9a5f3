"""Lyapunov exponents where contacts open and close within steps."""

from __future__ import annotations

import pytest

from validation.cases.lyapunov_exponents.exponents import measure


def test_exponents_of_an_orbit_with_parting_flanks_hold_at_the_usual_steps() -> None:
    # By exact shooting; the sum is the divergence -2 zeta, whatever the contact does.
    assert measure("doubled", "1") == pytest.approx(-0.026946, abs=1e-4)
    assert measure("doubled", "sum") == pytest.approx(-0.1, rel=1e-6)
