"""Torques whose digits are rounded balance, and statics takes them; others are refused before it."""

from __future__ import annotations

import pytest

import rotorgear as rg
from tests.paths import ROOT


def with_torques(off: float) -> rg.Model:
    model = rg.load(ROOT / "models" / "helical_pair.toml")
    ratio = abs(model.layout.train.ratio("output"))
    return model.with_(
        {
            "operation.power": None,
            "operation.output_shaft": None,
            "loads.motor": {"shaft": "input", "kind": "input", "torque": 190.0},
            "loads.brake": {"shaft": "output", "kind": "output", "torque": 190.0 / ratio * (1.0 + off)},
        }
    )


@pytest.mark.parametrize("off", [1e-9, 3e-8, -1e-7, 9e-7])
def test_torques_that_are_rounded_have_an_equilibrium(off: float) -> None:
    exact = rg.static(with_torques(0.0))
    found = rg.static(with_torques(off))
    assert found.place_displacement["gears.wheel"] == pytest.approx(exact.place_displacement["gears.wheel"], rel=3e-6)
    assert found.warnings == exact.warnings


def test_torques_that_are_not_balanced_are_refused() -> None:
    with pytest.raises(rg.ModelError, match="torques that leave"):
        rg.static(with_torques(3e-6))
