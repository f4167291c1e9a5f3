"""The map of a helix whose flanks tilt, from contact maps written by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.gears.maps.face_map import FaceMap

ALONE = ContactMap(
    position=np.array([0.0, 0.5]),
    periods=1,
    load=np.array([0.0, 1e3, 2e3]),
    approach=1e-6 * np.array([[1.0, 4.0, 6.0], [2.0, 5.0, 7.0]]),
    moment=np.array([[0.0, 3.0, 4.0], [0.0, 2.0, 5.0]]),
    error=2e-8,
)
FACE = FaceMap(
    np.array([-1e-4, 3e-4]),
    (ALONE, replace(ALONE, approach=ALONE.approach + 2e-6, moment=2.0 * ALONE.moment, error=1e-8)),
)


def test_from_the_other_end_of_the_face_tilts_and_moments_change_their_sign() -> None:
    turned = FACE.mirrored
    assert list(turned.tilt) == [-3e-4, 1e-4]
    for one, other in zip(turned.maps, reversed(FACE.maps), strict=True):
        assert np.array_equal(one.approach, other.approach)
        assert np.array_equal(one.moment, -other.moment)
    again = turned.mirrored
    assert np.array_equal(again.tilt, FACE.tilt)
    assert np.array_equal(again.maps[0].moment, ALONE.moment)


def test_between_its_tilts_and_positions_first_touch_is_linear() -> None:
    assert FACE.no_load(0.0, np.array([0.0, 0.25, 0.5])) == pytest.approx([1.5e-6, 2.0e-6, 2.5e-6])


def test_its_error_is_the_largest_of_its_maps() -> None:
    assert FACE.error == 2e-8
