"""Viscosity of oils over temperature, and films in heat balance: energy, limits, agreement with the equilibrium."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.forces.journal_film import JournalFilm
from rotorgear.forces.oil_film import film_temperature, oil_temperature, oil_viscosity
from rotorgear.forces.thrust_film import ThrustFilm
from rotorgear.forces.tilting_pads import TiltingPads
from rotorgear.quantity import ZERO_CELSIUS
from tests.unit.analysis.bearing.test_bearing import journal_rotor

OIL = {"grade": 46e-6, "inlet_temperature": 45.0 + ZERO_CELSIUS}
GRID = {"around": 60, "along": 4}
MU = oil_viscosity(46e-6, 870.0, 45.0 + ZERO_CELSIUS)
JOURNAL = JournalFilm(MU, 0.05, 0.05, 1e-4, follows=True, **GRID, **OIL)
PADS = TiltingPads(MU, 0.05, 0.05, 1e-4, preload=0.3, at=-1.0, **GRID, **OIL)
THRUST = ThrustFilm(MU, 40e-3, 70e-3, 60e-6, pads=6, arc=0.9, taper=40e-6, around=12, across=6, **OIL)
PLACES = [(JOURNAL, [2e-5, -5e-5]), (PADS, [1e-5, -4e-5]), (THRUST, [0.0, 0.0, 1e-5, 0.0, 0.0])]


@pytest.mark.parametrize(("grade", "at_100"), [(32, 5.4), (46, 6.8), (68, 8.7), (100, 11.1), (150, 14.8), (220, 19.0)])
def test_oils_have_the_viscosities_of_their_grade(grade, at_100):
    """At 40 deg C by definition; at 100 deg C those of a viscosity index of 95 to 100 in makers' tables, mm^2/s.

    The density falls by some 0.07 % a K.
    """
    rho = 870.0
    hot = rho * (1.0 - 60.0 * 7e-4)
    assert oil_viscosity(1e-6 * grade, rho, 40.0 + ZERO_CELSIUS) / rho == pytest.approx(1e-6 * grade, rel=1e-4)
    assert 1e6 * oil_viscosity(1e-6 * grade, rho, 100.0 + ZERO_CELSIUS) / hot == pytest.approx(at_100, rel=0.05)


def test_temperature_is_the_inverse_of_viscosity():
    for T in (280.0, 320.0, 400.0):
        assert oil_temperature(46e-6, 870.0, oil_viscosity(46e-6, 870.0, T)) == pytest.approx(T, abs=1e-9)


def test_the_film_temperature_solves_its_balance():
    T = film_temperature(46e-6, 870.0, 318.0, 2000.0)
    assert pytest.approx(318.0 + 1000.0 * oil_viscosity(46e-6, 870.0, T), abs=1e-8) == T
    assert film_temperature(46e-6, 870.0, 318.0, 0.0) == 318.0


@pytest.mark.parametrize(("law", "d"), PLACES)
def test_oil_that_leaves_carries_the_power_loss_away(law, d):
    warm = law.warmed(np.array(d), 300.0)
    field = warm.inside(np.array(d), speed=300.0)
    outlet = 2.0 * warm.temperature - warm.inlet_temperature
    carried = warm.density * warm.specific_heat * field.side_flow * (outlet - warm.inlet_temperature)
    assert carried == pytest.approx(field.power_loss, rel=1e-8)
    assert warm.viscosity < law.viscosity
    assert replace(law, heat_share=0.0).warmed(np.array(d), 300.0).viscosity == law.viscosity
    half = replace(law, heat_share=0.5).warmed(np.array(d), 300.0)
    assert law.inlet_temperature < half.temperature < warm.temperature


def test_a_short_bearing_has_the_flow_and_the_heat_of_its_closed_form():
    """Q = omega R L c eps by continuity, P = 2 pi mu omega^2 R^3 L/(c sqrt(1 - eps^2)) + omega F c eps sin(attitude)/2."""
    R, L, c, eps, speed = 0.05, 0.004, 1e-4, 0.5, 300.0
    law = JournalFilm(MU, R, L, c, follows=True, along=8, **OIL)
    d = np.array([eps * c, 0.0])
    field = law.inside(d, speed=speed)
    assert field.side_flow == pytest.approx(speed * R * L * c * eps, rel=0.01)
    F = law.evaluate(d, speed=speed).force
    shear = 2.0 * np.pi * MU * speed**2 * R**3 * L / (c * np.sqrt(1.0 - eps**2))
    assert field.power_loss == pytest.approx(shear + 0.5 * speed * abs(F[1]) * d[0], rel=0.01)


def heated(**changes: object) -> rg.Model:
    given = {
        "diameter": 0.06,
        "length": 0.03,
        "clearance": 60e-6,
        "oil": "VG 46",
        "inlet_temperature": "45 degC",
        **GRID,
    }
    return journal_rotor().with_("bearings.front.journal", {**given, **changes})


def test_film_and_equilibrium_agree_and_small_motions_are_those_of_the_warm_film():
    sheet = rg.bearing(heated(), speeds=["1500 rpm", "3000 rpm"], stability=False)
    film = sheet.film
    assert sheet.consistency < 1e-6
    heat = 870.0 * 1900.0 * film.side_flow * (film.outlet_temperature - 45.0 - ZERO_CELSIUS)
    assert heat == pytest.approx(film.power_loss, rel=1e-7)
    assert (
        sheet.over_speed[0].film_temperature
        < sheet.over_speed[1].film_temperature
        == pytest.approx(film.film_temperature)
    )
    given = heated(oil=None, inlet_temperature=None, viscosity=film.film_viscosity)
    same = rg.bearing(given, speeds=[], stability=False)
    np.testing.assert_allclose(same.bearing_stiffness, sheet.bearing_stiffness, rtol=1e-6)
    np.testing.assert_allclose(same.bearing_damping, sheet.bearing_damping, rtol=1e-6)
    modes = [rg.modal(model, speed="3000 rpm").eigenvalues for model in (heated(), given)]
    np.testing.assert_allclose(modes[0], modes[1], rtol=1e-6)


def test_an_isothermal_film_has_the_viscosity_of_its_inlet():
    film = rg.bearing(heated(heat_share=0.0), speeds=[], stability=False).film
    assert film.film_temperature == pytest.approx(45.0 + ZERO_CELSIUS, abs=1e-9)
    assert film.film_viscosity == pytest.approx(MU, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"viscosity": 0.02}, "one of the two"),
        ({"oil": None, "inlet_temperature": None}, "neither viscosity nor oil"),
        ({"inlet_temperature": None}, "no temperature beside the oil"),
        ({"oil": "VG 47"}, "VG 46"),
        ({"inlet_temperature": "45 mm"}, "a temperature such as '45 degC'"),
        ({"oil": None, "viscosity": 0.02}, "heat of a film of given viscosity"),
        ({"heat_share": 1.5}, "a share from 0 to 1"),
    ],
)
def test_a_mistake_about_the_oil_is_told_with_its_address(changes, said):
    with pytest.raises(rg.ModelError, match=said) as error:
        heated(**changes)
    assert "bearings.front.journal" in str(error.value)


def test_a_film_that_hardly_any_oil_leaves_is_too_hot():
    with pytest.raises(rg.RotorgearError, match="hotter than mineral oil bears"):
        rg.static(heated(oil="VG 1000", clearance=20e-6), speed="12000 rpm")


def test_an_inlet_temperature_in_the_wrong_unit_is_asked_about():
    assert any("degC meant" in text for text in rg.check(heated(inlet_temperature=45.0)).warnings)
