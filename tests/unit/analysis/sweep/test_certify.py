"""Response types stand where exponents agree with them and nothing still changes; what does not settles longer by itself."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.certify import judged
from rotorgear.solvers.batch.run_block import Orbit

REQUEST: Any = SimpleNamespace(tolerance=0.02, chaos=0.02)
POINT: Any = SimpleNamespace(system=SimpleNamespace(turns=1, columns=SimpleNamespace(counted=np.array([True]))))


def run(x: np.ndarray, exponent: float, doubt: float = 0.0, scatter: float = 1e-4, **known: Any) -> Any:
    """A run with a section x in um of a motion 10 um from peak to peak, and an exponent that scatters."""
    section = np.zeros((len(x), 1, 2))
    section[:, 0, 0] = 1e-6 * x
    growth = exponent + scatter * np.random.default_rng(0).standard_normal((len(x), 1))
    sums = np.zeros((1, 14))
    sums[0, 7] = sums[0, 5] = 10e-6
    orbit = Orbit(section, growth, sums, np.zeros((2, 2)), None, True, np.array([doubt]), 300, **known)  # type: ignore[arg-type]
    kind, stands = judged(orbit, POINT, REQUEST)
    return kind, stands


def test_a_period_stands_with_a_negative_exponent_and_falls_with_a_positive_one() -> None:
    still = np.full(200, 3.0)
    assert run(still, -0.01) == ("1T", True)
    assert not run(still, 0.012)[1]
    # Where the sign of the exponent is not known, the section has to repeat exactly.
    assert run(still, 0.0) == ("1T", True)
    assert run(still, 0.012, doubt=0.02) == ("1T", False)
    assert run(still + 1e-4 * np.arange(200), 0.0) == ("1T", False)
    # What repeats stands where tangents that turn, or the step, hide how fast it comes back.
    assert run(still, -0.05, scatter=0.5) == ("1T", True)
    assert run(still, -0.01, doubt=0.02) == ("1T", True)
    assert run(still + 1e-4 * np.arange(200), -0.01, doubt=0.02) == ("1T", False)


def test_a_spiral_that_still_comes_down_is_no_long_period() -> None:
    n = np.arange(200)
    turning = 2.0 * np.cos(2.0 * np.pi * n / 20.0)
    assert run(turning, -0.01) == ("20T", True)
    assert run(turning * np.exp(-0.001 * n), -0.01)[1] is False


def test_a_period_stands_where_the_orbit_is_stable_and_repeats_as_the_run_does() -> None:
    alternating = 3.0 + 1.0 * (-1.0) ** np.arange(200)
    assert run(alternating, 0.0, multiplier=-1e-3, repeats=2) == ("2T", True)
    assert run(alternating, 0.0, multiplier=-1e-3, repeats=1) == ("2T", False)
    assert run(alternating, 0.0, multiplier=1e-3, repeats=2) == ("2T", False)


def test_two_frequencies_have_no_exponent_but_zero() -> None:
    turning = 2.0 * np.cos(0.61803 * np.arange(200))
    assert run(turning, 0.0) == ("quasi-periodic", True)
    assert not run(turning, -0.005)[1]
    assert not run(turning, 0.005)[1]
    assert not run(turning, 0.0, doubt=0.03)[1]
    assert run(turning, 0.05) == ("chaotic", True)
    assert not run(turning, 0.05, doubt=0.045)[1]


@pytest.mark.long
def test_what_a_sweep_calls_settled_is_so_thirty_times_later() -> None:
    model = rg.load("models/herringbone_pair_24dof_set2.toml")
    over = {"operation.speed": "3000 rpm:40000 rpm:75"}
    first = rg.sweep(model, over, steps=160, discard=200, sample=64)
    later = rg.sweep(model, over, steps=160, discard=30 * 200, sample=30 * 64)
    for one, other in zip(first.motion, later.motion, strict=True):
        assert one in (other, "not settled")


@pytest.mark.long
def test_a_symmetric_start_does_not_hide_that_the_helices_part() -> None:
    model = rg.load("models/herringbone_pair_24dof_set2.toml")
    found = rg.sweep(model, {"operation.speed": ["12500 rpm"]}, steps=160, discard=200, sample=64)
    assert found.motion[0] != "1T"
