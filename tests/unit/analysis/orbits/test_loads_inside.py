"""Loads inside couplings over periodic motions: a pair that parts behind one, by hand from the harmonics of its contact."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.unit.analysis.static.test_static import data_of

DRIVE, PINION, RADIUS, DAMPING = 2e-2, 3.2e-3, 0.0564, 0.4


def driven() -> rg.Model:
    data = data_of("backlash_pair")
    data["shafts"]["m"] = {}
    data["disks"] = {"m": {"shaft": "m", "at": "start", "polar_inertia": DRIVE}}
    data["couplings"] = {
        "c": {"from_shaft": "m", "to_shaft": "a", "stiffness": {"torsion": 3e3}, "damping": {"torsion": DAMPING}}
    }
    data["operation"]["input_shaft"] = "m"
    data["points"] = {"torque": {"on": "couplings.c", "quantity": "torque"}}
    return rg.Model(**data)


def by_hand(force: np.ndarray, base: float, stiffness: float) -> np.ndarray:
    """Torque harmonics (H,) of the coupling between the drive and the pinion that the contact pushes."""
    found = []
    for h, F in enumerate(force[1:], 1):
        s = 1j * h * base
        z = stiffness + s * DAMPING
        A = np.array([[DRIVE * s**2 + z, -z], [-z, PINION * s**2 + z]])
        drive, pinion = np.linalg.solve(A, [0.0, RADIUS * F])
        found.append(z * (pinion - drive))
    return np.array(found)


@pytest.mark.parametrize(
    ("over", "options"),
    [
        ({"operation.speed": "9000 rpm:9050 rpm"}, {}),
        pytest.param({"operation.speed": "9000 rpm:9050 rpm"}, {"method": "harmonic balance"}, marks=pytest.mark.long),
        pytest.param({"couplings.c.stiffness.torsion": "3000 N m/rad:3200 N m/rad"}, {}, marks=pytest.mark.long),
    ],
)
def test_the_torque_behind_a_contact_is_that_of_its_harmonics(over: dict[str, str], options: dict[str, Any]) -> None:
    model = driven() if "operation.speed" in over else driven().with_("operation.speed", "9000 rpm")
    result = rg.orbits(model, over, step=0.5, **options)
    assert result.load_points == ("torque",)
    assert not any("quantity" in note for note in result.left_out)
    for i in (0, len(result.value) - 1):
        stiffness = result.value[i] if "operation.speed" not in over else 3e3
        torque = by_hand(result.force_harmonics[i, :, 0], 2.0 * np.pi / result.period[i], stiffness)
        mean, rms, largest, smallest = result.load_statistics[i, 0]
        assert mean == pytest.approx(-10.0, rel=1e-9)
        assert rms == pytest.approx(np.sqrt(0.5 * np.sum(np.abs(torque) ** 2)), rel=1e-4)
        turn = np.exp(2j * np.pi * np.outer(np.arange(4000) / 4000, np.arange(1, len(torque) + 1)))
        swing = np.real(turn @ torque)
        swing = swing if abs(swing.max() + mean - largest) < abs(-swing.min() + mean - largest) else -swing
        assert (largest, smallest) == pytest.approx((mean + swing.max(), mean + swing.min()), rel=1e-5)
        assert np.all(result.load_error[i, 0] < 1e-3 * rms)
    assert "Load at torque" in result.text()
