"""Sobol indices against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.solvers.sampling import design, sobol_indices, unit_points


def test_indices_of_a_product_are_those_of_its_closed_form_and_errors_cover_them():
    # f = prod(1 + a_j x_j), x uniform on -1 ... 1: V_j = a_j^2 / 3, V = prod(1 + V_j) - 1.
    a = np.array([0.9, 0.6, 0.3])
    points = 2.0 * design(unit_points("sobol", 4096, 6, 3)) - 1.0
    found = sobol_indices(np.prod(1.0 + a * points, axis=1)[:, None], 3)
    part = a**2 / 3.0
    whole = np.prod(1.0 + part) - 1.0
    first = part / whole
    total = part * np.prod(1.0 + part) / (1.0 + part) / whole
    assert found.first[0] == pytest.approx(first, abs=0.02)
    assert found.total[0] == pytest.approx(total, abs=0.02)
    assert np.all(np.abs(found.first[0] - first) < 4.0 * found.first_error[0])
    assert np.all(found.total_error[0] < 0.02)


@pytest.mark.parametrize("sampling", ["sobol", "latin", "random"])
def test_points_fill_the_cube_and_a_seed_repeats_them(sampling):
    points = unit_points(sampling, 256, 3, 7)
    assert points.shape == (256, 3)
    assert np.array_equal(points, unit_points(sampling, 256, 3, 7))
    assert points.mean(axis=0) == pytest.approx([0.5] * 3, abs=0.06)
