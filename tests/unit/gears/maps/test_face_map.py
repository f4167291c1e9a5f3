"""The map of a helix whose flanks tilt, from contact maps written by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.gears.maps.face_map import FaceMap, face_map, holds, misalignments
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from tests.unit.gears.tooth_pairs import WIDTH, spur

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


@pytest.mark.parametrize(
    ("state", "given", "deflection", "spread"),
    [(30e-6, 10e-6, 8e-6, 20e-6), (-5e-6, 10e-6, 8e-6, 15e-6), (9e-6, 10e-6, 8e-6, 8e-6)],
)
def test_a_face_is_solved_about_its_state_as_far_as_shafts_tilt_or_teeth_give(
    state: float, given: float, deflection: float, spread: float
) -> None:
    """Two, 0.8 and 0.15 spreads to either side, falling; a map holds for states that have a cell on either side."""
    asked = misalignments(state, given, deflection)
    expected = [state + share * spread for share in (2.0, 0.8, 0.15, -0.15, -0.8, -2.0)]
    assert asked == pytest.approx(expected, rel=1e-8, abs=1e-14)
    for share, held in ((-0.81, False), (-0.79, True), (0.0, True), (0.79, True), (0.81, False)):
        assert holds(asked, state + share * spread) == held


def test_a_tilt_takes_a_misalignment_away_over_the_width(monkeypatch: pytest.MonkeyPatch) -> None:
    """tilt = (f_0 - f)/b, and each map is that of its misalignment."""
    asked = []

    def solved(teeth: ToothPair, load: float, near: bool) -> ContactMap:
        asked.append((teeth.misalignment, load, near))
        return ALONE

    monkeypatch.setattr("rotorgear.gears.maps.face_map.contact_map", solved)
    found = face_map(spur(), 700.0, (30e-6, 12e-6, -8e-6), 10e-6, near=True)
    assert found.tilt == pytest.approx(np.array([-20e-6, -2e-6, 18e-6]) / WIDTH)
    assert asked == [(30e-6, 700.0, True), (12e-6, 700.0, True), (-8e-6, 700.0, True)]
    assert (found.periods, found.position.tolist()) == (1, [0.0, 0.5])
