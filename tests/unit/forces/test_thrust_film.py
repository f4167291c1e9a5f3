"""Thrust bearings: closed form of the wide slider, symmetry, pads in balance, tangents at the equilibrium of a rotor."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console
from scipy.integrate import trapezoid

import rotorgear as rg
from rotorgear.forces.thrust_film import ThrustFilm
from rotorgear.system.local_parts import expansion_stiffness

FIXED = ThrustFilm(0.03, 40e-3, 70e-3, 60e-6, pads=6, arc=0.9, taper=40e-6, around=20, across=8)
TILTING = replace(FIXED, taper=0.0, pivot=0.6)
SPEED = 600.0


def slider(x: np.ndarray, h: np.ndarray, viscosity: float, velocity: float) -> np.ndarray:
    """Pressure of an infinitely wide film: p' = 6 mu U (h - h*)/h^3 with p = 0 at both ends."""
    steps = np.diff(x)

    def integral(f: np.ndarray) -> np.ndarray:
        return np.concatenate([[0.0], np.cumsum(0.5 * (f[1:] + f[:-1]) * steps)])

    whole = integral(1.0 / h**2)[-1] / integral(1.0 / h**3)[-1]
    return 6.0 * viscosity * velocity * integral(1.0 / h**2 - whole / h**3)


def wide(around: int) -> ThrustFilm:
    """A pad ten times as wide as long on a large radius, where sectors are rectangles."""
    return ThrustFilm(0.02, 0.95, 1.05, 50e-6, pads=1, arc=0.01, taper=40e-6, acts="+z", around=around, across=20)


def test_the_middle_of_a_wide_taper_land_pad_has_the_pressure_of_the_slider():
    x = np.linspace(0.0, 0.01, 20001)
    exact = slider(x, 50e-6 + 40e-6 * np.maximum(1.0 - x / 8e-3, 0.0), 0.02, 50.0)
    errors = []
    for around in (20, 40, 80):
        middle = wide(around).inside(np.zeros(5), speed=50.0).pressure[:, 10]
        errors.append(np.abs(middle - np.interp(np.linspace(0.0, 0.01, around + 1), x, exact)).max() / exact.max())
    assert errors[-1] < 1e-3
    assert errors[0] / errors[-1] > 8.0  # order 1.5 or better over two halvings, the corner lies on the grid


def test_a_wide_wedge_of_two_to_one_has_the_load_of_the_books():
    # W/b = 6 mu U (B/h_o)^2 (ln K - 2 (K - 1)/(K + 1))/(K - 1)^2 at K = h_i/h_o = 2: .1589 (B/h_o)^2 mu U (Pinkus).
    law = replace(wide(40), taper=50e-6, taper_share=1.0)
    found = law.inside(np.zeros(5), speed=50.0)
    load = trapezoid(found.pressure[:, 10], dx=0.01 / 40)
    factor = 6.0 * (np.log(2.0) - 2.0 / 3.0)
    assert factor == pytest.approx(0.1589, rel=1e-3)
    assert load == pytest.approx(factor * 0.02 * 50.0 * (0.01 / 50e-6) ** 2, rel=3e-3)


def test_a_collar_in_the_middle_carries_nothing_and_pushes_back_from_either_side():
    for law in (FIXED, TILTING):
        middle = law.evaluate(np.zeros(5), speed=SPEED)
        assert middle.force == pytest.approx(np.zeros(5), abs=1e-6)
        up = law.evaluate([0.0, 0.0, 15e-6, 0.0, 0.0], speed=SPEED)
        down = law.evaluate([0.0, 0.0, -15e-6, 0.0, 0.0], speed=SPEED)
        assert up.force[2] == pytest.approx(-down.force[2], rel=1e-9)
        assert up.force[2] > 0.0
        one_sided = replace(law, acts="+z").evaluate(np.zeros(5), speed=SPEED)
        assert middle.in_displacement[2, 2] == pytest.approx(2.0 * one_sided.in_displacement[2, 2], rel=1e-9)
        assert middle.in_velocity[2, 2] == pytest.approx(2.0 * one_sided.in_velocity[2, 2], rel=1e-9)


def test_turned_the_other_way_the_mirrored_bearing_is_the_same():
    for law in (FIXED, TILTING):
        here = law.evaluate([0.0, 0.0, 10e-6, 1e-4, 0.0], speed=SPEED)
        there = replace(law, order=-1.0).evaluate([0.0, 0.0, 10e-6, 1e-4, 0.0], speed=SPEED)
        assert there.force[2] == pytest.approx(here.force[2], rel=1e-9)


def test_tilting_pads_stand_without_a_moment_and_carry_more_with_a_later_pivot_than_a_middle_one():
    loads = []
    for pivot in (0.55, 0.6, 0.65):
        law = replace(TILTING, pivot=pivot, acts="+z")
        for *_, G, _, _, _ in law._each_pad(np.zeros(5), SPEED):
            assert abs(G[3]) <= 1e-9 * G[0] * law.outer_radius
        loads.append(law.evaluate(np.zeros(5), speed=SPEED).force[2])
    assert np.all(np.array(loads) > 0.0)


def test_tilting_the_collar_is_resisted_and_damped():
    for law in (FIXED, TILTING):
        about = law.settled(np.zeros(5)).linearised(np.zeros(5), speed=SPEED)
        assert about.stiffness[3, 3] == pytest.approx(about.stiffness[4, 4], rel=1e-6)
        assert about.stiffness[3, 3] > 0.0
        assert about.damping[3, 3] > 0.0


def test_force_converges_with_order_two_in_the_grid():
    d = np.array([0.0, 0.0, 12e-6, 1e-4, 2e-4])
    forces = [replace(FIXED, around=n, across=2 * n // 5).evaluate(d, speed=SPEED).force[2] for n in (10, 20, 40, 80)]
    changes = np.diff(forces)
    assert np.all(np.log2(changes[:-1] / changes[1:]) > 1.9)
    exact = forces[-1] + changes[-1] / 3.0
    assert abs(forces[1] / exact - 1.0) < 1.5e-2


ROTOR = """
[operation]
input_shaft = "rotor"
speed = "6000 rpm"
[shafts.rotor]
sections = [{ length = "300 mm", outer_diameter = "60 mm" }]
[bearings.left]
shaft = "rotor"
at = "start"
stiffness = { radial = "200 N/um" }
[bearings.right]
shaft = "rotor"
at = "end"
stiffness = { radial = "200 N/um" }
[bearings.thrust]
shaft = "rotor"
at = "150 mm"
thrust = { inner_diameter = "80 mm", outer_diameter = "140 mm", clearance = "60 um", viscosity = "0.03 Pa s", pads = 6, \
around = 12, across = 6, %s }
[loads.push]
shaft = "rotor"
at = "end"
force = ["0 N", "0 N", "5 kN"]
"""


@pytest.mark.parametrize("kind", ["pivot = 0.6", 'taper = "40 um"'])
def test_a_rotor_stands_on_its_films_and_its_axial_mode_has_their_stiffness(kind):
    model = rg.loads(ROTOR % kind)
    sheet = rg.bearing(model, "thrust", stability=False, speeds=["6000 rpm"])
    assert sheet.bearing_load[2] == pytest.approx(5000.0, rel=1e-9)
    assert sheet.consistency < 1e-6
    # The terminal has 80 columns, and breaks no number.
    out = io.StringIO()
    Console(file=out, width=200).print(sheet.table())
    tables = out.getvalue().partition("x, y, z in um")[0]
    assert "K tilt_y" in tables
    assert max(map(len, tables.splitlines())) <= 80
    assert 0.0 < sheet.thrust_film.minimum_gap < 60e-6
    assert sheet.thrust_film.power_loss > 0.0
    assert sheet.thrust_film.side_flow > 0.0
    mass = 7850.0 * 0.25 * np.pi * 0.06**2 * 0.3
    k, c = sheet.bearing_stiffness[2, 2], sheet.bearing_damping[2, 2]
    roots = np.roots([mass, c, k])
    modes = rg.modal(model, speed="6000 rpm", modes=12)
    near = np.abs(modes.eigenvalues[:, None] - roots[None, :]) / np.abs(roots)
    # The heavily damped motion along the shaft: its slow root; the shaft itself is nearly rigid.
    assert near.min() < 2e-2


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("", "neither taper nor pivot"),
        ('pivot = 0.6, taper = "40 um"', "taper and pivot"),
        ("pivot = 1.5", "share of the arc"),
        ('pivot = 0.6, pad_arc = "80 deg"', "fit on 360 deg"),
    ],
)
def test_pads_that_do_not_carry_or_fit_are_refused(keys, said):
    with pytest.raises(rg.RotorgearError, match=said):
        rg.loads((ROTOR % keys).replace(",  }", " }"))


def test_solvers_expand_a_collar_about_what_carries_its_load_not_about_its_wall():
    for law in ThrustFilm.examples():
        about = expansion_stiffness(law, 1000.0, 600.0)
        carrying = 1000.0 / law.clearance
        # Its wall is stiffer by a million.
        assert carrying < about[2, 2] < 1e3 * carrying
