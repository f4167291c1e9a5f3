"""Elements that were computed before are not computed again, and nobody can change what others share."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rotorgear.elements.shaft import ShaftElements, distinct_elements


def kinds(density: float) -> ShaftElements:
    one = np.ones(1)
    sizes = np.array([[0.04, 0.0, 0.04, 0.0]])
    return ShaftElements(0.1 * one, sizes, sizes, 2.1e11 * one, 8.1e10 * one, 0.3 * one, density * one, np.nan * one)


def test_equal_kinds_share_their_matrices_and_others_do_not():
    first = distinct_elements(kinds(7850.0), order=3)
    assert distinct_elements(kinds(7850.0), order=3) is first
    assert distinct_elements(kinds(7851.0), order=3).mass == pytest.approx(first.mass * 7851.0 / 7850.0, rel=1e-14)
    assert distinct_elements(kinds(7850.0), order=4).mass.shape != first.mass.shape


def test_what_is_shared_is_read_only():
    shared = distinct_elements(kinds(7850.0), order=3)
    with pytest.raises(ValueError, match="read-only"):
        shared.mass[0, 0, 0] = 0.0
    assert replace(shared, mass=shared.mass * 2.0).mass is not shared.mass
