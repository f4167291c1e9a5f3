"""Peaks of frequency responses between the frequencies, and units by the places."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.results.frequency_response import peak_between


@pytest.mark.parametrize("power", [0, 1, 2])
def test_the_peak_of_one_mode_is_found_between_coarse_frequencies(power: int) -> None:
    """H = 1/(w_r^2 - w^2 + 2 i zeta w_r w) has its largest receptance at w_r sqrt(1 - 2 zeta^2), mobility at w_r."""
    natural = 100.0
    zeta = 0.03
    w = np.array([96.0, 101.5, 107.0])
    peak = peak_between(w**2, np.abs(1.0 / (natural**2 - w**2 + 2j * zeta * natural * w)), power)
    assert peak is not None
    best = natural * {0: np.sqrt(1 - 2 * zeta**2), 1: 1.0, 2: 1.0 / np.sqrt(1 - 2 * zeta**2)}[power]
    exact = best**power / abs(natural**2 - best**2 + 2j * zeta * natural * best)
    assert 2.0 * np.pi * peak.frequency_hz == pytest.approx(best, rel=1e-9)
    assert peak.size == pytest.approx(exact, rel=1e-9)


def test_a_peak_much_narrower_than_the_grid_is_not_claimed_to_be_resolved() -> None:
    w = np.array([96.0, 101.5, 107.0])
    peak = peak_between(w**2, np.abs(1.0 / (100.0**2 - w**2 + 2j * 1e-4 * 100.0 * w)), 0)
    assert peak is None or not peak.resolved


def test_heights_of_a_coarse_grid_are_those_of_a_fine_one_and_units_follow_the_places() -> None:
    model = rg.Model(
        shafts={"rotor": {"sections": [{"length": 0.6, "outer_diameter": 0.03}]}},
        bearings={e: {"shaft": "rotor", "at": e, "stiffness": {"radial": 1e7, "axial": 1e7}} for e in ("start", "end")},
        disks={"disk": {"shaft": "rotor", "at": 0.2, "mass": 5.0, "polar_inertia": 0.02, "diametral_inertia": 0.012}},
        motions=["bending"],
    )
    places = {"inputs": ["disks.disk:x", "disks.disk:tilt_y"], "outputs": ["disks.disk:x"], "modal_damping": 0.02}

    def highest(points: int) -> tuple[float, float]:
        result = rg.frf(model, np.linspace(20.0, 150.0, points), elements=1, **places)
        assert [result.unit(0, i, "mobility") for i in (0, 1)] == ["m/(N s)", "m/(N m s)"]
        peak = result.peaks(0, 0)[0]
        assert peak.resolved
        return peak.frequency_hz, peak.size

    coarse = highest(70)
    fine = highest(4001)
    assert coarse[0] == pytest.approx(fine[0], rel=1e-4)
    assert coarse[1] == pytest.approx(fine[1], rel=1e-3)
