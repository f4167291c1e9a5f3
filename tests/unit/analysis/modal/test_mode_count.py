"""The number of modes to expect, against modes on pinned or free ends, whose wave numbers are n pi / L exactly."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.analysis.modal.mode_count import MOST_MODES, check_count, expected_modes
from rotorgear.errors import AnalysisError
from tests.models import NU, RHO, STEEL, E, G

LENGTH = 2.0
OUTER = 0.08
BORE = 0.05


def shaft(**section: object) -> rg.Model:
    hollow = {"length": LENGTH, "outer_diameter": OUTER, "bore": BORE, **section}
    stub = {"length": 0.5, "outer_diameter": 0.02, "rigid": True}
    return rg.Model(materials=STEEL, shafts={"rotor": {"sections": [hollow, stub]}})


def bending_frequencies(k: np.ndarray) -> np.ndarray:
    """Both frequencies (2, n) of waves of Timoshenko's beam with deflection v and tilt theta, by wave number (n,).

    w^2 [rho A, rho I] is an eigenvalue of [[kG A k^2, -kG A k], [-kG A k, E I k^2 + kG A]].
    """
    area = np.pi / 4.0 * (OUTER**2 - BORE**2)
    inertia = np.pi / 64.0 * (OUTER**4 - BORE**4)
    shear = 0.9 * G * area
    K = np.array([[shear * k**2, -shear * k], [-shear * k, E * inertia * k**2 + shear]]).transpose(2, 0, 1)
    mass = np.sqrt(RHO * np.array([area, inertia]))
    return np.sqrt(np.linalg.eigvalsh(K / np.outer(mass, mass))).T


@pytest.mark.parametrize("hertz", [3e3, 15e3, 30e3, 60e3])
def test_expected_modes_are_those_of_a_pinned_beam_and_a_free_bar_but_for_their_ends(hertz: float) -> None:
    """Below and above the frequency from which bending has a second kind of waves, here 19 kHz; a rigid stub has none."""
    limit = 2.0 * np.pi * hertz
    n = np.arange(1, 2000)
    k = n * np.pi / LENGTH
    bending = 2 * np.count_nonzero(bending_frequencies(k) < limit)
    axial = np.count_nonzero(k * np.sqrt(E / RHO) < limit)
    torsion = np.count_nonzero(k * np.sqrt(G / RHO) < limit)
    # Each of the six kinds is off by less than the one mode of the last part of a wave.
    assert 0.0 <= expected_modes(shaft(), limit) - (bending + axial + torsion) < 6.0


def test_the_cut_off_lies_where_the_test_above_has_frequencies_on_both_sides() -> None:
    assert 15e3 < bending_frequencies(np.array([1e-9]))[1, 0] / (2.0 * np.pi) < 30e3
    assert pytest.approx(E / 2.0 / (1.0 + NU)) == G


def test_expected_modes_add_up_over_shafts_and_lengths() -> None:
    one = {"length": LENGTH, "outer_diameter": OUTER, "bore": BORE}
    twice = rg.Model(materials=STEEL, shafts={"left": {"sections": [one, one]}, "right": {"sections": [one]}})
    assert expected_modes(twice, 1e5) == pytest.approx(3.0 * expected_modes(shaft(), 1e5), rel=1e-12)


def test_a_frequency_is_refused_from_where_more_modes_lie_below_it_than_can_be_used() -> None:
    model = shaft()
    hertz = float(brentq(lambda f: expected_modes(model, 2.0 * np.pi * f) - MOST_MODES, 1e3, 1e8))
    check_count(model, 0.99 * hertz)
    with pytest.raises(AnalysisError, match=f"more than {MOST_MODES}"):
        check_count(model, 1.01 * hertz)
