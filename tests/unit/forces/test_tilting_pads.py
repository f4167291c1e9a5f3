"""Tilting pads: level pads, symmetry, reduction of their tilt, and the grid."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.errors import AnalysisError
from rotorgear.forces.tilting_pads import TiltingPads
from tests.unit.forces.reynolds_elements import Pad

SPEED = 500.0
GRID = {"around": 120, "along": 4}


def pads(**changes: object) -> TiltingPads:
    given = {"viscosity": 0.02, "radius": 0.05, "length": 0.05, "clearance": 1e-4, "preload": 0.3, **GRID, **changes}
    return TiltingPads(**given)  # type: ignore[arg-type]


def pushed(law: TiltingPads, load: np.ndarray) -> np.ndarray:
    """Where the journal stands under a load."""
    d = np.zeros(2)
    for _ in range(40):
        about = law.linearised(d, speed=SPEED)
        step = np.linalg.solve(about.stiffness, load - about.force)
        d = d + step * min(1.0, 0.3 * law.clearance / np.abs(step).max())
        if np.abs(step).max() < 1e-13:
            return d
    raise AssertionError("no equilibrium")


@pytest.mark.parametrize("at", [-90.0, -54.0])
@pytest.mark.parametrize("pivot", [0.5, 0.6])
def test_a_load_on_or_between_pads_moves_the_journal_along_itself_without_cross_stiffness(at, pivot) -> None:
    law = pads(at=np.radians(at), pivot=pivot)
    d = pushed(law, np.array([0.0, -3000.0]))
    state = law.settled(d).linearised(d, speed=SPEED)
    K = state.stiffness
    C = state.damping
    assert abs(d[0]) < 1e-8 * abs(d[1])
    assert max(abs(K[0, 1]), abs(K[1, 0])) < 1e-8 * np.abs(K).max()
    assert max(abs(C[0, 1]), abs(C[1, 0])) < 1e-8 * np.abs(C).max()
    assert np.linalg.eigvalsh(C).min() > 0.0


def test_pads_stand_where_their_pressure_has_no_moment_about_the_pivot() -> None:
    law = pads(at=-1.2)
    d = np.array([1e-5, -5e-5])
    film = law.inside(d, speed=SPEED)
    pivots = law.at + 2.0 * np.pi * np.arange(5) / 5
    for k, pressure in enumerate(np.split(film.pressure, 5)):
        angle = np.split(film.angle, 5)[k] - pivots[k]
        moment = np.sum(pressure.sum(axis=1) * np.sin(angle))
        assert abs(moment) <= 1e-9 * max(np.sum(pressure), 1.0)
    assert film.gap.min() > 0.0
    total = np.array([np.sum(film.pressure.T * f(film.angle)) for f in (np.cos, np.sin)])
    force = law.evaluate(d, speed=SPEED).force
    assert total[1] / total[0] == pytest.approx(force[1] / force[0], rel=1e-9)


def test_slow_motions_have_the_stiffness_of_the_difference_quotient() -> None:
    law = pads(at=-1.0, pivot=0.55)
    d = np.array([1e-5, -4e-5])
    slow = law.settled(d)
    h = 1e-9
    quotient = np.column_stack(
        [
            (law.evaluate(d + h * e, speed=SPEED).force - law.evaluate(d - h * e, speed=SPEED).force) / (2 * h)
            for e in np.eye(2)
        ]
    )
    reduced = replace(slow, whirl_ratio=1e-4).linearised(d, speed=SPEED).stiffness
    np.testing.assert_allclose(reduced, quotient, atol=2e-4 * np.abs(quotient).max())
    # At the speed itself the pads lag behind, and the stiffness is another one.
    assert np.abs(slow.linearised(d, speed=SPEED).stiffness - quotient).max() > 1e-3 * np.abs(quotient).max()


def test_a_mirrored_bearing_that_turns_the_other_way_is_the_mirror_image() -> None:
    there = pads(at=0.3, pivot=0.6)
    mirrored = pads(at=np.pi - 0.3, pivot=0.6, order=-1.0)
    d = np.array([2e-5, -3e-5])
    flip = np.array([-1.0, 1.0])
    np.testing.assert_allclose(
        mirrored.evaluate(flip * d, speed=SPEED).force, flip * there.evaluate(d, speed=SPEED).force, rtol=1e-8
    )


def test_the_force_converges_with_the_square_of_the_grid() -> None:
    d = np.array([0.0, -5e-5])
    forces = [pads(at=-np.pi / 2, around=60 * n, along=3 * n).evaluate(d, speed=SPEED).force[1] for n in (1, 2, 4)]
    assert np.log2((forces[1] - forces[0]) / (forces[2] - forces[1])) > 1.6


def test_pads_that_do_not_fit_are_refused() -> None:
    with pytest.raises(AnalysisError, match="pads that fit"):
        pads(arc=1.3)


def film_force(law: TiltingPads, d: np.ndarray, pad: int) -> float:
    """Force of the journal on one pad, along its pivot, from the pressure."""
    film = law.inside(d, speed=SPEED)
    angle = np.split(film.angle, law.pads)[pad] - law.at - 2.0 * np.pi * pad / law.pads
    area = 2.0 * law.radius * (angle[1] - angle[0]) * 0.5 * law.length / law.along
    return float(area * np.sum(np.split(film.pressure, law.pads)[pad].T * np.cos(angle)))


def by_elements(law: TiltingPads, away: float, tilt: float) -> np.ndarray:
    """Force (along the pivot and across) of a pad the journal moved away from, by elements.

    away: a. tilt: share of what closes the trailing edge.
    """
    own = law.pad_clearance
    behind = (1.0 - law.pivot) * law.arc
    eta = tilt * own * (1.0 + away * np.cos(behind)) / np.sin(behind)
    half = 0.5 * law.length
    grid = Pad((-law.pivot * law.arc, behind), (-half, half), 40, 10, radius=law.radius)
    p = grid.pressure(
        lambda t, s: own * (1.0 + away * np.cos(t)) - eta * np.sin(t),
        lambda t, s: -own * away * np.sin(t) - eta * np.cos(t),
        lambda t, s: np.zeros_like(t),
        law.viscosity,
        SPEED,
    )
    return grid.moments(p, lambda t, s: np.cos(t), lambda t, s: np.sin(t))


def test_a_pad_that_the_journal_left_carries_at_its_loaded_tilt_up_to_the_fold() -> None:
    """Four pads of 65 deg, pivots at 0.57: by elements the least moment about the pivot rises through 0 at a_f."""
    law = pads(pads=4, arc=np.radians(65.0), pivot=0.57, preload=0.2, at=-np.pi / 2, around=240, along=12)
    shares = np.linspace(0.04, 0.4, 13)

    def place(away: float) -> np.ndarray:
        return np.array([0.0, -(away + law.preload) * law.pad_clearance])

    def least(away: float) -> float:
        """The least moment about the pivot over tilts, by a parabola about the smallest of some."""
        moments = [by_elements(law, away, tilt)[1] for tilt in shares]
        k = int(np.argmin(moments))
        a, b, c = np.polyfit(shares[k - 1 : k + 2], moments[k - 1 : k + 2], 2)
        return float(c - b * b / (4.0 * a))

    fold = float(brentq(least, 0.05, 0.9, xtol=1e-4))
    assert 0.1 < fold < 0.8
    for away in (0.01, 0.3 * fold, 0.75 * fold):
        begin = shares[np.argmin([by_elements(law, away, tilt)[1] for tilt in shares])]
        tilt = float(brentq(lambda one, away=away: by_elements(law, away, one)[1], begin, 0.6, xtol=1e-7))
        force = by_elements(law, away, tilt)[0]
        assert film_force(law, place(away), 2) == pytest.approx(force, rel=0.01)
    assert film_force(law, place(0.97 * fold), 2) > 0.0
    assert film_force(law, place(1.02 * fold), 2) == 0.0


@pytest.mark.parametrize(
    ("count", "at", "pivot", "preload"),
    [
        (4, -90.0, 0.5, 0.3),
        (4, -90.0, 0.51, 0.3),
        (5, -54.0, 0.51, 0.0),
        (5, -54.0, 0.53, 0.3),
        (4, -45.0, 0.55, 0.0),
        (5, -90.0, 0.6, 0.3),
        (4, -90.0, 0.6, 0.6),
        (5, -54.0, 0.7, 0.0),
    ],
)
def test_the_force_is_a_continuous_function_of_the_place_of_the_journal(count, at, pivot, preload) -> None:
    """Over a thousandth of the clearance it changes by less than 1 % of the largest force; from a fifth of the clearance on
    these changes differ by less than 1 % of the force there.
    """
    arc = 0.8 * 2.0 * np.pi / count
    law = pads(pads=count, arc=arc, at=np.radians(at), pivot=pivot, preload=preload, around=24 * count, along=3)
    along = np.array([np.cos(-1.4), np.sin(-1.4)])
    r = np.arange(0, 951) * 1e-3
    F = np.array([law.evaluate(x * law.clearance * along, speed=SPEED).force for x in r])
    size = np.linalg.norm(F, axis=1)
    steps = np.linalg.norm(np.diff(F, axis=0), axis=1)
    assert steps[:900].max() < 0.01 * size.max()
    far = (r[1:-1] > 0.2) & (r[1:-1] < 0.9)
    leaps = np.linalg.norm(np.diff(F, 2, axis=0), axis=1)
    assert (leaps / size[1:-1])[far].max() < 0.01


@pytest.mark.parametrize("away", [0.0, 0.5, 0.9])
def test_tangents_of_pads_the_journal_left_are_difference_quotients(away) -> None:
    """Also where a pad gives way: at 0.9 of the distance to its fold."""
    law = pads(pads=4, arc=1.2, pivot=0.55, preload=0.2, at=-np.pi / 2)
    fold = law.parameters()[-4]
    d = np.array([0.0, -(away * fold + 1e-6 + law.preload) * law.pad_clearance])
    h = 1e-11
    quotient = np.column_stack(
        [
            (law.evaluate(d + h * e, speed=SPEED).force - law.evaluate(d - h * e, speed=SPEED).force) / (2 * h)
            for e in np.eye(2)
        ]
    )
    np.testing.assert_allclose(
        law.evaluate(d, speed=SPEED).in_displacement, quotient, atol=1e-4 * np.abs(quotient).max()
    )


def test_small_motions_feel_every_loaded_pad() -> None:
    """Slow ones have the stiffness of the difference quotient where the journal has left one of four loaded pads."""
    law = pads(pads=4, arc=1.2, pivot=0.6, preload=0.2, at=-0.3)
    d = np.array([0.0, -5e-5])
    q = law.at + 0.5 * np.pi * np.arange(4)
    assert np.sum(d[1] * np.sin(q) + law.preload * law.pad_clearance < 0.0) == 1
    assert all(film_force(law, d, pad) > 0.0 for pad in range(4))
    h = 1e-10
    quotient = np.column_stack(
        [
            (law.evaluate(d + h * e, speed=SPEED).force - law.evaluate(d - h * e, speed=SPEED).force) / (2 * h)
            for e in np.eye(2)
        ]
    )
    reduced = replace(law, moves=True, whirl_ratio=1e-4).linearised(d, speed=SPEED).stiffness
    np.testing.assert_allclose(reduced, quotient, atol=1e-4 * np.abs(quotient).max())


def test_a_reversed_journal_finds_the_pivots_before_the_middle_of_the_pads() -> None:
    """Then no pad carries that it has moved away from, and the bearing is the mirror image of one with such pivots."""
    there = pads(pads=4, arc=1.2, at=0.3, pivot=0.6, preload=0.1)
    other = pads(pads=4, arc=1.2, at=np.pi - 0.3, pivot=0.4, preload=0.1)
    d = np.array([1e-5, -4e-5])
    flip = np.array([-1.0, 1.0])
    backwards = there.evaluate(d, speed=-SPEED).force
    np.testing.assert_allclose(other.evaluate(flip * d, speed=SPEED).force, flip * backwards, rtol=1e-8)
    assert np.linalg.norm(backwards - there.evaluate(d, speed=SPEED).force) > 1.0


ON_PADS = """
operation = {{ input_shaft = "r", speed = "{speed} rpm" }}
shafts.r = {{}}
disks.d = {{ shaft = "r", at = "start", mass = 1.0, polar_inertia = 0.01, diametral_inertia = 0.01 }}
supports.s = {{ shaft = "r", at = "start", fixed = ["z", "tilt_x", "tilt_y"] }}
loads.w = {{ shaft = "r", at = "start", force = [0.0, -1.0, 0.0] }}
[bearings.b]
shaft = "r"
at = "start"
[bearings.b.journal]
diameter = "100 mm"
length = "50 mm"
viscosity = "20 mPa s"
clearance = "100 um"
pads = 5
pad_arc = "62 deg"
pad_at = "{at} deg"
preload = {preload}
pivot = {pivot}
around = 120
along = 3
"""


@pytest.mark.parametrize(
    ("at", "pivot", "preload", "speed"),
    [
        (-90.0, 0.52, 0.0, 3000.0),
        (-54.0, 0.52, 0.0, -3000.0),
        (-90.0, 0.55, 0.25, -3000.0),
        (-54.0, 0.55, 0.25, 3000.0),
        (-54.0, 0.6, 0.1, 3000.0),
    ],
)
def test_statics_finds_the_journal_under_every_load(at, pivot, preload, speed) -> None:
    """From 1 N to nearly the film's limit, among them loads about that at which a pad gives way."""
    model = rg.loads(ON_PADS.format(at=at, pivot=pivot, preload=preload, speed=speed))
    law = model.bearings["b"].law(1.0, np.sign(speed))
    fold = law.parameters()[-4]
    places = -law.pad_clearance * (law.preload + fold * np.array([0.0, 0.7, 0.9, 0.97, 1.0, 1.05]))
    omega = speed * np.pi / 30.0
    loads = [-law.evaluate(np.array([0.0, y]), speed=omega).force[1] for y in (*places, -0.9 * law.clearance)]
    for load in (*np.geomspace(1.0, loads[-1], 7), *loads[:-1]):
        if not 1.0 <= load <= loads[-1]:
            continue
        found = rg.static(model.with_("loads.w.force", [0.0, -float(load), 0.0])).laws[0]
        assert found.force[1] == pytest.approx(-load, rel=1e-6)
        assert -0.91 * law.clearance < found.displacement[1] < 0.0


def test_one_pad_that_carries_alone_holds_the_journal_along_its_pivot_whatever_its_direction() -> None:
    """Across, the film has no stiffness at all: a free motion that nothing pushes, and not one that rounding holds."""
    three = ON_PADS.format(at=-37.0, pivot=0.5, preload=0.0, speed=3000.0).replace("pads = 5", "pads = 3")
    model = rg.loads(three)
    along = np.array([np.cos(np.radians(-37.0)), np.sin(np.radians(-37.0)), 0.0])
    for load in (1.0, 300.0, 6000.0):
        found = rg.static(model.with_("loads.w.force", (load * along).tolist())).laws[0]
        np.testing.assert_allclose(found.force, load * along[:2], rtol=1e-6)
        assert float(np.linalg.norm(found.displacement)) < 95e-6


def test_results_name_pads_without_a_film_and_pads_that_may_lose_it() -> None:
    model = rg.loads(ON_PADS.format(at=-90.0, pivot=0.55, preload=0.25, speed=3000.0))
    law = model.bearings["b"].law(1.0, 1.0)
    fold = law.parameters()[-4]
    heard = {
        0.5: "the tilt without a film at which pads may stay",
        0.9: "the jump of pads that lose their film",
        1.1: "flutter of pads that have no film",
    }
    for share, said in heard.items():
        # The pivots of the two upper pads stand at 54 and 126 deg.
        y = -law.pad_clearance * (law.preload + share * fold) / np.sin(np.radians(54.0))
        load = law.evaluate(np.array([0.0, y]), speed=100.0 * np.pi).force
        loaded = model.with_("loads.w.force", [0.0, float(load[1]), 0.0])
        for result in (rg.static(loaded), rg.modal(loaded), rg.bearing(loaded, "b", speeds=[], stability=False)):
            notes = [note for note in result.left_out if note.value == "pads 3, 4"]
            assert len(notes) == 1, result.left_out
            assert notes[0].part == "bearings.b"
            assert said in notes[0]


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("pads = 1", "bearings.b.journal.pads: got 1, expected 2 to 12 pads"),
        (
            'pads = 5, pad_arc = "80 deg"',
            "bearings.b.journal.pad_arc: got 5 of 80 deg, expected pads that fit on 360 deg",
        ),
        ("pads = 5, lobes = 2", "bearings.b.journal.pads: got pads beside lobes"),
        ("pads = 5, pivot = 1.0", "bearings.b.journal.pivot: got 1"),
        ("whirl_ratio = 0.5", "keys of pads in a fixed bearing"),
    ],
)
def test_keys_of_pads_in_a_file_that_make_no_sense_are_told_by_address(keys: str, said: str) -> None:
    film = 'diameter = "60 mm", length = "30 mm", clearance = "60 um", viscosity = "20 mPa s"'
    text = f'[shafts.a]\n[bearings.b]\nshaft = "a"\nat = "start"\njournal = {{ {film}, {keys} }}\n'
    with pytest.raises(rg.ModelError, match=said):
        rg.loads(text)
