"""The map F(delta, u) of a helix against the loaded contact that it was made of."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.gears.maps.contact_map import ContactMap


@pytest.fixture(scope="module")
def hertz() -> ContactMap:
    """delta = delta_0(u) + c(u) F^0.9, as of a contact that stiffens with the load."""
    u = np.arange(32) / 32
    gap = 1e-6 * (1.0 + np.cos(2 * np.pi * u))
    compliance = 2e-9 * (1.0 + 0.2 * np.sin(2 * np.pi * u))
    load = np.concatenate([[0.0], np.geomspace(10.0, 5e4, 40)])
    return ContactMap(u, 1, load, gap[:, None] + compliance[:, None] * load**0.9)


def test_force_and_approach_are_inverse_to_each_other(hertz: ContactMap) -> None:
    u = np.linspace(-1.3, 2.1, 41)
    F = np.geomspace(1.0, 2e5, 41)
    assert hertz.force(hertz.approach_at(F, u), u) == pytest.approx(F, rel=1e-9)


def test_no_force_before_the_first_touch(hertz: ContactMap) -> None:
    u = np.linspace(0.0, 1.0, 17)
    assert np.all(hertz.force(hertz.no_load(u) - 1e-9, u) == 0.0)
    assert np.all(hertz.stiffness(hertz.no_load(u) - 1e-9, u) == 0.0)


def test_stiffness_is_the_slope_of_the_force(hertz: ContactMap) -> None:
    u = np.linspace(0.0, 1.0, 9)
    delta = hertz.approach_at(1.3e4, u)
    step = 1e-4 * delta
    slope = (hertz.force(delta + step, u) - hertz.force(delta - step, u)) / (2.0 * step)
    assert hertz.stiffness(delta, u) == pytest.approx(slope, rel=1e-3)


def test_it_repeats_after_its_periods(hertz: ContactMap) -> None:
    assert hertz.approach_at(5e3, 0.4) == pytest.approx(hertz.approach_at(5e3, 7.4), rel=1e-12)


def test_approaches_under_the_loads_of_the_map_are_its_rows_between_positions(hertz: ContactMap) -> None:
    u = np.linspace(-0.7, 1.9, 23)
    found = hertz.at_loads(u)
    assert found == pytest.approx(hertz.approach_at(hertz.load, u[:, None]), rel=1e-14)
    assert hertz.at_loads(hertz.position) == pytest.approx(hertz.approach, rel=1e-15)


def test_slopes_stay_within_three_times_the_chords_beside_them_and_the_cubics_rise() -> None:
    """Compliances that are given as they are, but where a cubic with them would turn back (Fritsch and Carlson)."""
    load = np.array([0.0, 2e3, 3e3, 7e3])
    approach = np.array([[1e-6, 5e-6, 6e-6, 30e-6], [0.0, 2e-6, 5e-6, 9e-6]])
    chord = np.array([[2e-9, 1e-9, 6e-9], [1e-9, 3e-9, 1e-9]])
    given = np.array([[2.5e-9, 9e-9, 2e-9, 40e-9], [5e-9, 1e-9, 2.9e-9, 1e-9]])
    found = ContactMap(np.array([0.0, 0.5]), 1, load, approach, compliance=given)
    least = np.column_stack([chord[:, 0], np.minimum(chord[:, :-1], chord[:, 1:]), chord[:, -1]])
    assert found.slopes == pytest.approx(np.minimum(given, 3.0 * least), rel=1e-12)
    assert found.slopes[0, 0] == given[0, 0]
    assert found.slopes[0, 1] == pytest.approx(3e-9)
    fine = np.linspace(0.0, 7e3, 701)
    assert np.all(np.diff(found.approaches(fine), axis=1) > 0.0)
    # Above its loads a map goes on along its last slope.
    assert found.approach_at(9e3, 0.0) == pytest.approx(30e-6 + 2e3 * 18e-9, rel=1e-12)
