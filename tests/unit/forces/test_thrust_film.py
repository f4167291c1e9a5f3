"""Thrust bearings: closed form of the wide slider, symmetry, pads in balance, tangents at the equilibrium of a rotor."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console
from scipy.integrate import trapezoid
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.forces.thrust_film import ThrustFilm
from rotorgear.forces.thrust_pressure import sector_film
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


# Five pads that take pushes to one side, with pivots hardly behind their middle: films fail where the collar leans away.
LEANING = ThrustFilm(0.03, 45e-3, 70e-3, 60e-6, pads=5, arc=1.0, at=0.4, pivot=0.55, acts="+z", around=16, across=6)


def leaned(law: ThrustFilm, away: float, z: float = 0.0) -> np.ndarray:
    """Displacements at which the collar leans away from the first pivot by a = away, with the gap as it is at z."""
    pivot = law.at + (law.pivot - 0.5) * law.arc
    size = away * (law.clearance - z) / law.outer_radius
    return np.array([0.0, 0.0, z, -size * np.sin(pivot), size * np.cos(pivot)])


def test_a_pad_the_collar_leans_away_from_keeps_its_film_up_to_the_fold():
    """The moment of fixed pads at many tilts: it has a zero with a film up to the fold, and none behind."""
    law = LEANING
    fold = law.parameters()[-4]
    pivot = law.at + (law.pivot - 0.5) * law.arc
    behind = (1.0 - law.pivot) * law.arc
    start = law.at - 0.5 * law.arc
    assert 0.05 < fold < 0.9

    def film(away: float, z: float, share: float) -> np.ndarray:
        """Force and moment about the pivot of a fixed pad turned by a share of what closes its trailing edge."""
        d = leaned(law, away, z)
        turn = share * (law.clearance - z) * (1.0 + away * np.cos(behind)) / (law.outer_radius * np.sin(behind))
        G = np.zeros(4)
        q = np.array([*d[2:], turn])
        out = (np.zeros((4, 4)), np.zeros((4, 4)), np.zeros((law.around - 1, law.across - 1)))
        sector_film(law.parameters(), SPEED, start, q, np.zeros(4), 0, 4, G, *out)
        return G

    for z in (0.0, -40e-6, 25e-6):
        for share in (0.2, 0.7, 0.97):
            away = share * fold
            tilts = np.linspace(0.01, 0.9, 90)
            last = tilts[max(k for k, tilt in enumerate(tilts) if film(away, z, tilt)[3] < 0.0)]
            tilt = brentq(lambda one, away=away, z=z: film(away, z, one)[3], last, last + 0.01, xtol=1e-12)
            *_, G, _, _, _ = next(iter(law._each_pad(leaned(law, away, z), SPEED)))
            weight = 1.0 if share < 0.8 else G[0] / film(away, z, tilt)[0]
            assert 0.0 < weight <= 1.0
            np.testing.assert_allclose(G[:3], weight * film(away, z, tilt)[:3], rtol=1e-9)
        assert all(film(1.01 * fold, z, tilt)[3] >= 0.0 for tilt in np.linspace(0.01, 0.9, 90))
        *_, G, _, _, _ = next(iter(law._each_pad(leaned(law, 1.01 * fold, z), SPEED)))
        assert not G.any()
    assert np.isclose(np.sin(pivot) * leaned(law, 0.5)[3] - np.cos(pivot) * leaned(law, 0.5)[4], -0.5 * 60e-6 / 70e-3)


@pytest.mark.parametrize("pivot", [0.5, 0.52, 0.56, 0.62])
def test_forces_and_moments_are_continuous_as_the_collar_leans(pivot):
    law = replace(LEANING, pivot=pivot)
    leans = np.arange(0, 901) * 1e-3
    way = leaned(law, 1.0)
    F = np.array([law.evaluate(a * way, speed=SPEED).force[2:] for a in leans]) / [1.0, 0.07, 0.07]
    size = np.linalg.norm(F, axis=1)
    assert np.linalg.norm(np.diff(F, axis=0), axis=1)[:850].max() < 0.01 * size.max()
    # A collar that hardly leans has next to no force on pads with central pivots.
    leaps = (np.linalg.norm(np.diff(F, 2, axis=0), axis=1) / size[1:-1])[40:850]
    assert leaps.max() < 0.01


@pytest.mark.parametrize("away", [0.0, 0.6, 0.93])
@pytest.mark.parametrize("speed", [SPEED, -SPEED])
def test_tangents_of_pads_the_collar_leans_away_from_are_difference_quotients(away, speed):
    """Also where the film of a pad gives way, and at a collar that is moved along; backwards pads stand on their front half."""
    law = LEANING
    d = leaned(law, (away + 1e-4) * law.parameters()[-4], 7e-6)
    steps = np.diag([0.0, 0.0, 1e-11, 1e-10, 1e-10])[2:]
    quotient = np.array(
        [
            (law.evaluate(d + h, speed=speed).force - law.evaluate(d - h, speed=speed).force) / (2.0 * h.sum())
            for h in steps
        ]
    ).T
    unit = np.array([1.0, 0.07, 0.07])
    found = law.evaluate(d, speed=speed).in_displacement[2:, 2:] / unit[:, None] / unit
    np.testing.assert_allclose(found, quotient[2:] / unit[:, None] / unit, atol=1e-4 * np.abs(found).max())


COLLAR = """
operation = { input_shaft = "r", speed = "5000 rpm" }
shafts.r = {}
disks.d = { shaft = "r", at = "start", mass = 1.0, polar_inertia = 0.01, diametral_inertia = 0.01 }
supports.s = { shaft = "r", at = "start", fixed = ["x", "y"] }
loads.w = { shaft = "r", at = "start", force = [0.0, 0.0, 3000.0], moment = [0.0, 0.0, 0.0] }
[bearings.b]
shaft = "r"
at = "start"
[bearings.b.thrust]
inner_diameter = "90 mm"
outer_diameter = "140 mm"
clearance = "60 um"
viscosity = "0.03 Pa s"
pads = 5
pad_arc = "58 deg"
pad_at = "10 deg"
pivot = 0.55
around = 16
across = 6
"""


def test_a_collar_finds_its_place_under_every_moment_and_names_pads_that_fail():
    model = rg.loads(COLLAR)
    said = set()
    for moment in (0.0, 0.5, 4.0, 20.0, 50.0, 70.0, 100.0, 140.0, 200.0):
        given = [0.6 * moment, -0.8 * moment, 0.0]
        result = rg.static(model.with_({"loads.w.moment": given}))
        (state,) = result.laws
        assert state.force[2:] == pytest.approx([3000.0, *given[:2]], rel=1e-6, abs=1e-6)
        said |= {(note.what, note.value) for note in result.left_out if getattr(note, "part", "") == "bearings.b"}
    assert ("flutter of pads that have no film", "pad 4 for +z") in said
    assert any("may stay as well" in what for what, _ in said)
    assert any("the jump" in what for what, _ in said)


def test_pads_that_follow_slowly_are_as_stiff_as_pads_in_balance_and_fast_ones_keep_their_tilt():
    """A collar that leans, so that what a pad takes from it and gives back differ."""
    law = replace(TILTING, acts="+z", around=12, across=6)
    d = np.array([0.0, 0.0, 8e-6, 2e-4, -1e-4])
    slow = replace(law.settled(d), whirl_ratio=1e-7).linearised(d, speed=SPEED)
    balance = law.evaluate(d, speed=SPEED)
    size = np.array([1.0, 1.0, 1.0, law.outer_radius, law.outer_radius])
    scale = np.abs(balance.in_displacement[2, 2]) * np.outer(size, size)
    assert np.abs(balance.in_displacement - balance.in_displacement.T)[2:, 2:].max() > 1e-3 * scale[2, 2] * size[3]
    np.testing.assert_allclose(slow.stiffness / scale, balance.in_displacement / scale, atol=1e-6)
    np.testing.assert_allclose(slow.force, balance.force, rtol=1e-12)
    # Between both a pad without a moment follows by its own tilt, b = -Z_bb^-1 Z_ba a. Z is singular: a pad that tilts with
    # the collar about its pivot strains nothing.
    middle = replace(law.settled(d), whirl_ratio=0.5).linearised(d, speed=SPEED)
    omega = 0.5 * SPEED
    pads = [K + 1j * omega * C for _, _, _, _, K, C, _ in law._each_pad(d, SPEED)]
    follow = [np.vstack([np.eye(3), -np.linalg.solve(Z[3:, 3:], Z[3:, :3])]) for Z in pads]
    seen = sum((Z @ own_motion)[:3] for Z, own_motion in zip(pads, follow, strict=True))
    own = scale[2:, 2:]
    np.testing.assert_allclose(middle.stiffness[2:, 2:] / own, seen.real / own, atol=1e-9)
    np.testing.assert_allclose(omega * middle.damping[2:, 2:] / own, seen.imag / own, atol=1e-9)
