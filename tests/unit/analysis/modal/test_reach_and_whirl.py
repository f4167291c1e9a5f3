"""Which modes a refinement watches, the sense of orbits, and modal damping: by closed forms on numbers made for them."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.analysis.modal.reach import Reach
from rotorgear.analysis.modal.solve import with_modal_damping
from rotorgear.analysis.modal.whirl import orbits, whirl_of
from rotorgear.results.modal import WHIRL_WORDS
from rotorgear.system.system import System
from tests.overhung import overhung_disk

SIZE = np.array([1.0, 2.0, 3.0, 4.0, 5.0])


def test_a_mode_is_watched_while_twice_its_error_may_bring_it_among_those_asked_for() -> None:
    error = np.array([0.0, 0.0, 0.17, 0.24, 0.31])
    # The first two are asked for; the third may come down to 1.98, the fourth to 2.08, the fifth to 1.9.
    assert list(Reach(2, None).watched(SIZE, error)) == [True, True, True, False, True]
    assert list(Reach(None, 2.05).watched(SIZE, error)) == [True, True, True, False, True]
    assert list(Reach(3, 1.95).watched(SIZE, error)) == [True, False, False, False, True]
    assert [Reach(2, None).inside(SIZE), Reach(None, 3.0).inside(SIZE), Reach(2, 3.5).inside(SIZE)] == [2, 3, 2]
    assert Reach(9, None).inside(SIZE) == 5


def test_a_search_is_far_enough_once_a_mode_is_sure_to_lie_beyond() -> None:
    sure = np.array([0.0, 0.0, 0.1, 0.1, 0.1])
    assert Reach(2, None).is_certain(SIZE, sure, complete=False)
    assert not Reach(5, None).is_certain(SIZE, sure, complete=False)
    assert Reach(5, None).is_certain(SIZE, sure, complete=True)
    assert Reach(3, 100.0).solver_request() == (7, pytest.approx(125.0))
    assert Reach(3, None).further().solver_request() == (11, None)
    assert Reach(None, 100.0).further().solver_request() == (None, pytest.approx(150.0))


@pytest.mark.parametrize(("ratio", "net"), [(1.0, 1.0), (-1.0, -1.0), (0.5, 0.8), (-0.25, -8.0 / 17.0), (0.0, 0.0)])
def test_the_net_whirl_of_an_ellipse_is_twice_its_axes_over_the_sum_of_their_squares(ratio: float, net: float) -> None:
    """x = cos(w t), y = b sin(w t) turns from +x to +y, as the shaft does: y lags by a quarter of a turn."""
    system = System(overhung_disk())
    count = len(system.nodes)
    shapes = np.zeros((count, 6, 1), complex)
    size = np.linspace(0.3, 1.0, count)
    shapes[:, 0, 0] = size * np.exp(0.7j)
    shapes[:, 1, 0] = -1j * ratio * size * np.exp(0.7j)
    for speed in (300.0, -300.0):
        found = whirl_of(system, shapes, speed)
        (name,) = system.model.shafts
        assert found.net[name][0] == pytest.approx(np.sign(speed) * net, abs=1e-12)
        word = "planar" if not ratio else "forward" if speed * ratio > 0.0 else "backward"
        assert WHIRL_WORDS[found.numbers[name][0]] == word
    swept, whole = orbits(system, system.nodal_inertia, shapes, name)
    assert np.all(np.abs(swept) <= whole * (1.0 + 1e-12))


def test_a_modal_ratio_is_added_to_that_of_each_mode_and_keeps_its_size() -> None:
    size = np.array([0.0, 10.0, 20.0, 30.0, 40.0])
    ratio = np.array([0.0, 0.0, 0.1, 0.99, -0.02])
    s = size * (-ratio + 1j * np.sqrt(1.0 - ratio**2))
    s = np.append(s, -7.0)  # does not oscillate
    found = with_modal_damping(s, 0.05)
    np.testing.assert_allclose(np.abs(found), np.abs(s), rtol=1e-12)
    np.testing.assert_allclose(-found.real[[1, 2, 4]] / size[[1, 2, 4]], [0.05, 0.15, 0.03], rtol=1e-12)
    assert np.all(found.imag[[1, 2, 4]] > 0.0)
    # What would be overdamped, and what does not oscillate, stays as it is.
    np.testing.assert_array_equal(found[[0, 3, 5]], s[[0, 3, 5]])
