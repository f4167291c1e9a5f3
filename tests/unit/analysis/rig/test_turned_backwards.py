"""Updates of a gearbox that turns the other way: its flanks are those of that sense, so that a mirror image learns the same."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.rig.measured import MeasuredFrf
from tests.paths import MODELS

FREE = "meshes.*.stiffness, bearings.*.stiffness"
SPEED = 240.0
PORT = "gears.pinion:y"


@cache
def gearbox(mirrored: bool = False) -> rg.Model:
    """A helical stage with bearings that differ, or its mirror image in the plane x = 0."""
    model = rg.load(MODELS / "helical_pair.toml").with_({"bearings.input_left.stiffness.radial": "7e7 N/m"})
    if not mirrored:
        return model
    return model.with_(
        {
            "shafts.output.position": ["-135 mm", "0 mm"],
            "gears.pinion.hand": "left",
            "gears.wheel.hand": "right",
            "operation.speed": "-2970 rpm",
        }
    )


def lines_of(model: rg.Model, speed: float) -> list[float]:
    hz = rg.modal(model, speed=speed, modes=12, elements=2).frequency_hz
    return [float(f) for f in hz if f > 1.0][:9]


def factors(model: rg.Model, speed: float) -> np.ndarray:
    found = rg.update(model, lines_of(model, speed), free=FREE, speed=speed, elements=2)
    off = [abs(pair.after_hz / pair.rig.frequency_hz - 1.0) for pair in found.lines]
    assert max(off) < 1e-4
    return np.array([number.factor for number in found.parameters])


def test_a_gearbox_that_turns_backwards_learns_its_own_stiffnesses() -> None:
    assert factors(gearbox(), -SPEED) == pytest.approx(1.0, abs=0.01)


def test_a_mirror_image_turned_the_other_way_learns_the_same() -> None:
    assert lines_of(gearbox(mirrored=True), -SPEED) == pytest.approx(lines_of(gearbox(), SPEED), rel=1e-9)
    assert factors(gearbox(mirrored=True), -SPEED) == pytest.approx(factors(gearbox(), SPEED), rel=1e-6)


def test_campaigns_of_both_senses_learn_the_same_gearbox() -> None:
    model = gearbox()
    rigs = [rg.Campaign(rig=lines_of(model, speed), speed=speed, name=f"{speed:g}") for speed in (SPEED, -SPEED)]
    found = rg.update(model, campaigns=rigs, free=FREE, elements=2)
    assert [number.factor for number in found.parameters] == pytest.approx([1.0] * len(found.parameters), abs=0.01)


def test_frequency_responses_of_a_gearbox_that_turns_backwards_are_its_own() -> None:
    hz = np.linspace(60.0, 900.0, 60)
    model = gearbox()
    H = rg.frf(model, hz, inputs=[PORT], outputs=[PORT], modal_damping=0.02, elements=2, speed=-SPEED).receptance
    measured = MeasuredFrf(hz, (PORT,), (PORT,), H[:, :, 0].T)
    found = rg.update(model, frf=measured, free=FREE, speed=-SPEED, modal_damping=0.02, elements=2)
    assert [number.factor for number in found.parameters] == pytest.approx([1.0] * len(found.parameters), abs=0.01)
