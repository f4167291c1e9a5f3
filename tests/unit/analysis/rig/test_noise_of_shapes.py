"""Noise of measured shapes: as large at a speed, where both parts of a misfit count, as at standstill."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from rotorgear.analysis.rig.measured import Measured
from rotorgear.analysis.rig.misfit import Misfit, Pair
from rotorgear.results.update import RigLine

POINTS = ("a", "b", "c", "d", "e")


@pytest.mark.parametrize("looseness", [0.0, 0.3])
def test_noise_of_a_shape_has_the_same_mean_square_over_its_points_at_speed_and_at_standstill(looseness: float) -> None:
    random = np.random.default_rng(2)
    given = random.normal(size=(2, 5)) + 0j
    given[1, 3] = np.nan
    computed = random.normal(size=(2, 5)) + 0j
    x = np.zeros(1)
    modes = SimpleNamespace(frequency_hz=np.array([31.0, 47.0]), at_points=computed)
    pairs = (Pair(0, 0, (0,)), Pair(1, 1, (1,)))
    for speed in (0.0, 150.0):
        model = SimpleNamespace(speed=speed, numbers=SimpleNamespace(prior=np.array([0.1])))
        measured = Measured((RigLine(30.0), RigLine(50.0)), POINTS, given)
        misfit = Misfit((cast(Any, model),), measured, np.zeros(2, int), 0.04, 0.1, looseness=looseness)
        fit = misfit.beside(x, cast(Any, modes), pairs)
        for line in (0, 1):
            known = np.isfinite(given[line])
            rows = np.flatnonzero(fit.owner == line)[1:]  # the first one is the frequency
            assert len(rows) == np.count_nonzero(known) * (2 if speed else 1)
            y = given[line, known].real if speed else misfit.shapes[line, known]
            size = np.sum(np.abs(y) ** 2)
            assert np.sum(fit.noise[rows] ** 2) == pytest.approx((0.04**2 + looseness**2) * size)
            # What is left of the measured shape beside the computed one: Pythagoras.
            mode = computed[line, known].real
            left = size - np.dot(y, mode) ** 2 / np.dot(mode, mode)
            assert np.sum(fit.residual[rows] ** 2) == pytest.approx(left)
        expected = np.sum((fit.residual / fit.noise) ** 2)
        assert fit.objective == pytest.approx(expected)
