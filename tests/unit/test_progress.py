"""Progress of long work reaches whoever listens, also from deep inside."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.gears.stiffness_models import mesh_stiffness
from rotorgear.progress import listener, listening, part_of, silent
from tests.models import pair_file


def test_a_part_of_the_work_takes_its_share() -> None:
    told: list[tuple[float, str]] = []
    step = part_of(lambda fraction, text: told.append((fraction, text)), 0.2, 0.6)
    step(0.0, "first")
    step(0.5, "second")
    assert [text for _, text in told] == ["first", "second"]
    assert [fraction for fraction, _ in told] == pytest.approx([0.2, 0.4])


def test_teeth_that_a_model_asks_for_tell_what_they_do() -> None:
    told: list[float] = []
    mesh_stiffness.cache_clear()
    mesh = 'stiffness = "tooth_fe"\ntooth_fe = { preset = "preview" }'
    with listening(lambda fraction, text: told.append(fraction)):
        rg.System(rg.loads(pair_file(torque="777 N m", mesh=mesh)))
    assert len(told) > 10
    assert np.all((np.array(told) >= 0.0) & (np.array(told) <= 1.0))
    assert listener() is silent
