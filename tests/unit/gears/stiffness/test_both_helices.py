"""Two unlike helices side by side: each has half of the load, and their approaches are averaged."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness

U = np.arange(4) / 4
ONE = np.array([3e8, 4e8, 5e8, 3.5e8])
TWO = np.array([6e8, 2e8, 2.5e8, 7e8])


def helix(k: np.ndarray, tangent: np.ndarray | None) -> MeshStiffness:
    return MeshStiffness("fe", U, k, "secant", 900.0, "rim", 0.3, tangent=tangent)


@pytest.mark.parametrize(("stagger", "steps"), [(0.0, 0), (0.25, 1), (0.5, 2)])
def test_half_the_load_on_each_of_two_unlike_helices_gives_the_mean_of_their_approaches(
    stagger: float, steps: int
) -> None:
    both = helix(ONE, 1.3 * ONE).of_both_helices(stagger, helix(TWO, 1.7 * TWO))
    ahead = np.roll(TWO, -steps)
    assert (both.helices, both.load) == (2, 1800.0)
    assert both.load / both.transverse == pytest.approx(0.5 * (900.0 / ONE + 900.0 / ahead), rel=1e-12)
    # A little more load, half of it on each.
    assert 2.0 / both.tangent == pytest.approx(0.5 * (1.0 / (1.3 * ONE) + 1.0 / (1.7 * ahead)), rel=1e-12)
    plain = helix(ONE, None).of_both_helices(stagger, helix(TWO, None))
    assert plain.transverse == pytest.approx(ONE + ahead, rel=1e-12)
