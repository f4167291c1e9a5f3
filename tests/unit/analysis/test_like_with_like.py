"""Studies of a sweep compare states that end on one motion, and leave the others out."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.studies.motions import on_same_motion


def test_the_motion_of_most_states_is_told_by_its_type_and_its_size() -> None:
    kinds = ("1T", "1T", "1T", "2T", "chaotic", "1T")
    sizes = np.array([3.0, 3.01, 9.0, 3.0, 3.0, 2.99])
    assert on_same_motion(kinds, sizes).tolist() == [True, True, False, False, False, True]
    assert on_same_motion(kinds, sizes, ("1T", 9.1)).tolist() == [False, False, True, False, False, False]
    assert on_same_motion(kinds, sizes, ("2T", 3.0)).tolist() == [False, False, False, True, False, False]


def test_chaotic_motions_are_one_whatever_their_size_in_a_window() -> None:
    kinds = ("chaotic", "chaotic", "1T")
    assert on_same_motion(kinds, np.array([10.0, 14.0, 10.0])).tolist() == [True, True, False]
