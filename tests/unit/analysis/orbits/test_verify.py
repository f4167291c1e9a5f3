"""Growth of a deviation in transients that start on a periodic motion: that of its largest multiplier."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.orbits.verify import _growth
from tests.paths import MODELS
from validation.cases.journal_whirl.whirl import SHORT, closed_form, model
from validation.studies.dead_zone import DeadZone


@pytest.mark.parametrize(
    "leading",
    [np.diag([-1.3, 0.2]), 0.96 * np.array([[np.cos(1.0), -np.sin(1.0)], [np.sin(1.0), np.cos(1.0)]])],
    ids=["real", "pair"],
)
def test_growth_is_the_largest_multiplier_of_the_map(leading: np.ndarray) -> None:
    rng = np.random.default_rng(1)
    turned = rng.normal(size=(4, 4))
    A = (
        turned
        @ np.block([[leading, np.zeros((2, 2))], [np.zeros((2, 2)), np.diag([0.1, -0.3])]])
        @ np.linalg.inv(turned)
    )
    x = rng.normal(size=4)
    seen = rng.normal(size=(30, 4))
    waves, shares = [], []
    for _ in range(40):
        waves.append(seen @ x)
        shares.append(1e-4 / np.abs(waves[-1]).max())
        x = shares[-1] * (A @ x)
    assert _growth(waves, shares) == pytest.approx(np.abs(np.linalg.eigvals(A)).max(), rel=1e-6)


@pytest.mark.long  # transients of stable and unstable motions, some with flanks that part, and of an oil film
def test_transients_leave_and_come_back_with_the_largest_multiplier() -> None:
    threshold, _ = closed_form()
    found = [
        rg.orbits(
            rg.load(MODELS / "backlash_pair.toml"), {"operation.speed": "3900 rpm:4100 rpm"}, step=0.5, verify=True
        ),
        DeadZone(amplitude=0.05).orbits((0.74, 0.76), verify=True),
        DeadZone(amplitude=0.2).orbits((1.63, 1.59), step=0.2, switch=True, verify=True),
        rg.orbits(
            model(SHORT, "1 g mm"),
            {"operation.speed": [0.95 * threshold, 1.05 * threshold]},
            harmonics=4,
            step=0.5,
            verify=True,
        ),
    ]
    seen = [one for result in found for one in result.verifications]
    assert {one.stable for one in seen} == {True, False}
    for one in seen:
        assert np.log(one.growth) == pytest.approx(np.log(one.expected), rel=0.02)
