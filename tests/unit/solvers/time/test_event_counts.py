"""Time on either flank and losses of contact, from the sides that a law reports: switches are found between steps."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.solvers.time.arguments import Carried
from rotorgear.solvers.time.kernel_events import take_account
from rotorgear.solvers.time.kernel_time import gather as take
from rotorgear.solvers.time.local_forces import gather
from rotorgear.solvers.time.local_system import Rotation
from rotorgear.solvers.time.statistics import blank_gathered

GAP = MeshContact(1.0, backlash=0.9, ramp=1e-3, order=1.0, error_cos=(0.3,))
TURNS = 3


def counted(steps: int) -> np.ndarray:
    """Shares of d = cos 2t - .4 on the flanks of a gap that moves by .3 cos t, and contact losses."""
    laws = gather((GAP,))
    h = 2.0 * np.pi * TURNS / steps
    rotation = Rotation.constant(1.0).table
    x = np.zeros(1)
    events = np.zeros((1, 4))
    nothing = blank_gathered(np.array([0.0, 0.6]))
    carried = Carried(x, x, x, x, x, x, np.zeros((1, 2)), np.array([1]), events, nothing)
    for number in range(1, steps + 1):
        t = number * h
        d = np.array([np.cos(2.0 * t) - 0.4])
        # The side at the end, with what depends on time half a step before it.
        _, _, _, energy = laws.answer(t - 0.5 * h, 1.0, t - 0.5 * h, d, np.zeros(1))
        take_account(laws.arguments(), rotation, t, h, energy, d, carried)
        take(carried.gathered, np.concatenate([[0.0], d]), 1, True)
    return np.append(events[0, :3] / steps, events[0, 3])


def test_time_on_a_flank_is_known_to_second_order_whatever_the_step() -> None:
    t = 2.0 * np.pi * (np.arange(4_000_000) + 0.5) / 4_000_000
    depth = np.cos(2.0 * t) - 0.4 - 0.3 * np.cos(t)
    exact = np.array([np.mean(depth > 0.0), np.mean((depth <= 0.0) & (depth >= -0.9)), np.mean(depth < -0.9)])
    off = []
    for steps in (150, 151, 157, 600, 601, 607):
        found = counted(steps)
        assert found[:3].sum() == pytest.approx(1.0, abs=1e-12)
        assert found[3] == 4 * TURNS
        off.append(np.abs(found[:3] - exact).max())
    # Counting the ends of steps would leave up to twelve steps of one in two hundred.
    assert max(off[:3]) < 1.5e-3
    assert max(off[3:]) < max(off[:3]) / 8.0
