"""Steps on either flank and losses of contact, counted from the sides that a law reports."""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.arguments import Carried
from rotorgear.solvers.time.kernel_time import take_account
from rotorgear.solvers.time.statistics import blank_gathered


def test_contact_is_lost_each_time_a_flank_is_left() -> None:
    sides = [1, 1, 0, 0, 1, 0, -1, -1, 0, 1, -1, 0]
    events = np.zeros((2, 4), np.int64)
    last = np.array([1, 0], np.int64)
    nothing = blank_gathered(np.zeros(2))
    x = np.zeros(2)
    carried = Carried(x, x, x, x, x, x, np.zeros((2, 2)), last, events, nothing)
    for side in sides:
        energy = np.zeros(8)
        energy[3] = side
        energy[7] = 0.0  # the second law is apart all the time: it never loses what it has not
        take_account(energy, 0.1, carried)
    lost = sum(before != 0 and now == 0 for before, now in zip([1, *sides], sides, strict=False))
    assert lost == 4
    assert events[0].tolist() == [sides.count(1), sides.count(0), sides.count(-1), lost]
    assert events[1].tolist() == [0, len(sides), 0, 0]
