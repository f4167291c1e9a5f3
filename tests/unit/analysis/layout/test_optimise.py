"""Layouts: gradients against difference quotients, margins against other analyses, bounds, files."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.layout.modes_at_speed import ModesAtSpeed, total_mass
from rotorgear.analysis.layout.penalty import frequency_slopes, near_modes
from rotorgear.analysis.layout.problem import Problem, bounds_of
from rotorgear.analysis.sensitivity.forms import forms_of, modes_of
from rotorgear.analysis.static import state_at
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.model.numbers import numbers_of
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.system.plan import Plan
from tests.paths import ROOT

PLAN = Plan(1, 2)


@cache
def model(name: str) -> rg.Model:
    return rg.load(ROOT / "models" / f"{name}.toml")


def slopes_of(rotor: rg.Model, address: str, step: float = 2e-3) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """f, and df / f over dx / |x| by energies and by difference quotients of order six, of the first eight modes at speed."""
    numbers = numbers_of(rotor, [address])
    x = float(numbers.start[0])
    speed = rotor.operation.speed

    def state(value: float) -> ModesAtSpeed:
        system = linear_system(numbers.at(np.array([value])), [speed], PLAN)
        # Strains keep the digits that K of all dofs would lose.
        S = system.strain_factor(speed)
        V = lowest_modes(system.mass, system.stiffness(speed), strain=lambda Y: S @ Y).vectors
        forms = forms_of(system, speed, V)
        modes = modes_of(forms, 8, 1.0, V.shape[1])
        return ModesAtSpeed(system, speed, V, forms, modes, np.zeros((0, 8)), np.zeros(0))

    def quotient(h: float) -> np.ndarray:
        return (state(x + h).hz - state(x - h).hz) / (2.0 * h)

    h = step * abs(x)
    by_quotient = 1.5 * quotient(h) - 0.6 * quotient(2.0 * h) + 0.1 * quotient(3.0 * h)
    here = state(x)
    shapes = here.V @ here.modes.q
    X = np.hstack([shapes.real, shapes.imag])
    narrow = 1e-5 * abs(x)
    above, below = (
        forms_of(linear_system(numbers.at(np.array([x + side])), [speed], PLAN), speed, X) for side in (narrow, -narrow)
    )
    C = np.vstack([np.eye(8), 1j * np.eye(8)])
    change = C.conj().T @ ((above - below)[:3] / (2.0 * narrow)) @ C
    by_energies = frequency_slopes(here, list(range(8)), change) / (2.0 * np.pi)
    return here.hz, by_energies / here.hz * abs(x), by_quotient / here.hz * abs(x)


ROTOR = """
[operation]
input_shaft = "rotor"
speed = "9000 rpm"
[shafts.rotor]
material = "steel"
sections = [{ length = "300 mm", outer_diameter = "60 mm" }, { length = "500 mm", outer_diameter = "80 mm" }]
[disks.disk]
shaft = "rotor"
at = "520 mm"
mass = "40 kg"
polar_inertia = "0.8 kg m^2"
diametral_inertia = "0.45 kg m^2"
[bearings.left]
shaft = "rotor"
at = "70 mm"
stiffness = { x = "3e8 N/m", y = "2.4e8 N/m", axial = "1e7 N/m" }
[bearings.right]
shaft = "rotor"
at = "700 mm"
stiffness = { x = "2e8 N/m", y = "2.2e8 N/m" }
[unbalances.disk]
shaft = "rotor"
at = "400 mm"
magnitude = "100 g mm"
"""


# Steps between the rounding of frequencies, over the step, and its sixth power: narrow where modes soon veer.
@pytest.mark.parametrize(
    ("address", "step"),
    [
        ("bearings.left.at", 4e-3),
        ("shafts.rotor.sections[1].outer_diameter", 3e-3),
        ("bearings.right.stiffness", 1e-2),
        ("bearings.right.at", 1e-3),
    ],
)
def test_slopes_of_frequencies_are_difference_quotients_with_rotation(address, step):
    _, energies, quotients = slopes_of(rg.loads(ROTOR), address, step)
    assert np.abs(energies).max() > 1e-2
    assert energies == pytest.approx(quotients, abs=1e-6 * np.abs(quotients).max())


def test_the_mean_slope_at_a_veering_is_that_of_the_space():
    """An almost symmetric rotor: pairs of modes closer than 1e-3, turned into each other by spin."""
    changes = {
        "bearings.left.stiffness": {"x": 3e8, "y": 2.999e8, "axial": 1e7},
        "bearings.right.stiffness": {"radial": 2e8},
        "operation.speed": "1 rpm",
    }
    near = rg.loads(ROTOR).with_(changes)
    hz, energies, quotients = slopes_of(near, "bearings.left.at")
    pair = int(np.argmin(np.diff(hz[:6])))
    assert hz[pair + 1] / hz[pair] - 1.0 < 1e-3
    pairs = slice(pair, pair + 2)
    assert energies[pairs].mean() == pytest.approx(quotients[pairs].mean(), rel=1e-6)


def test_the_slope_of_the_penalty_is_its_difference_quotient_where_participation_begins_to_count():
    pair = model("geared_pair")
    numbers = numbers_of(pair, "bearings.*.stiffness, meshes.*.stiffness, shafts.rotor_1.sections.*.outer_diameter")
    low, high, _ = bounds_of(numbers, {})
    # An order of the mesh that lies among the modes, at 55 Hz.
    lines = (ExcitationOrder("mesh pair", "mesh", ("pair",), 2.2),)
    problem = Problem(numbers, low, high, (pair.operation.speed,), lines, PLAN, 150.0, 0.4, 0.4, 1e-3)
    t = problem.start + 0.03 * np.sin(1.0 + np.arange(len(low)))
    state = problem.states(t)[0]
    inside = np.abs(state.hz / state.line_hz[0] - 1.0) < 0.35
    # The participation that most depends on the numbers stands on the ramp, so that its slope takes part.
    problem.least = float(np.sort(state.taken[0, inside])[-2]) / 0.85
    near = near_modes(state, np.full(state.taken.shape, 0.4), problem.least)
    (height, *_) = [height for _, _, _, weight_slope, height, _ in near if weight_slope > 0.0]
    assert height > 1e-2
    slopes = problem.slopes(t, problem.states(t))

    def value(j: int, h: float) -> float:
        step = np.zeros(len(t))
        step[j] = h
        return problem.penalty(problem.states(t + step))

    quotients = np.array([(value(j, 2e-4) - value(j, -2e-4)) / 4e-4 for j in range(len(t))])
    assert np.abs(quotients).max() > 1e-2
    assert slopes == pytest.approx(quotients, abs=1e-4 * np.abs(quotients).max())


@pytest.mark.long  # a search, then run-ups of what it found
def test_a_rotor_is_led_away_from_its_unbalance_and_other_analyses_agree(tmp_path):
    rotor = rg.loads(ROTOR)
    # At 9000 rpm, 150 Hz, a forward mode stands at 185 Hz.
    free = "bearings.*.at, shafts.*.sections.*.outer_diameter"
    result = rg.optimise(rotor, free, margin="30 %", shaft_orders=[1], searches=1)
    assert not all(abs(row.before_margin) >= 0.3 for row in result.lines)
    assert result.reached
    assert result.forbidden_by == ()
    diagram = rg.campbell(result.optimised, shaft_orders=[1.0], accuracy=1e-4)
    (line,) = [row for row in diagram.margins if row.line == "shaft rotor 1x"]
    driven = [row for row in result.modes_after if abs(row.margin) < 0.3]
    assert all(row.participation < result.participation for row in driven)
    assert abs(line.margin) > 0.3 or line.participation < result.participation
    source = tmp_path / "rotor.toml"
    source.write_text(ROTOR.replace('at = "70 mm"', 'at = "70 mm"   # the cold end'))
    written = rg.load(rg.write_optimised_model(result, source, tmp_path / "new.toml"))
    assert "the cold end" in (tmp_path / "new.toml").read_text()
    for row in result.numbers:
        own = numbers_of(written, [row.address])
        assert own.start[0] == pytest.approx(row.after, rel=1e-5)


def test_a_margin_out_of_reach_names_the_bounds_that_forbid_it():
    result = rg.optimise(
        rg.loads(ROTOR),
        "shafts.*.sections.*.outer_diameter",
        margin="30 %",
        bounds={"shafts.*.sections.*.outer_diameter": "-1 %:1 %"},
        searches=1,
    )
    assert not result.reached
    assert result.forbidden_by
    assert "bound of" in result.forbidden_by[0]
    assert "NOT reached" in result.text()
    assert result.penalty_after < result.penalty_before


# A backward mode of ROTOR, 10.4 % above the unbalance, takes part by this much: the only mode within 15 %.
TAKES_PART = 1.2400e-4


def inside_of(least: float, bounds: dict[str, str]) -> tuple[rg.OptimiseResult, list[float], list[float]]:
    """A layout that keeps 15 %, and the participations within them before and after, over the least one that counts."""
    given = {"margin": "15 %", "shaft_orders": [1], "searches": 1}
    result = rg.optimise(rg.loads(ROTOR), "bearings.*.stiffness", **given, participation=least, bounds=bounds)
    before, after = (
        [row.participation / least for row in rows if abs(row.margin) < 0.15]
        for rows in (result.modes_before, result.modes_after)
    )
    return result, before, after


def test_no_search_ends_just_below_the_participation_that_counts():
    result, [before], after = inside_of(TAKES_PART / 1.02, {})
    assert before > 1.0
    assert result.reached
    assert max(after, default=0.0) < 0.7
    assert len(result.nearly_counting) == len([share for share in after if share >= 0.5])


def test_a_mode_just_below_the_least_participation_is_no_margin_and_is_named():
    result, [before], [after] = inside_of(TAKES_PART / 0.9, {"bearings.*": "-0.1 %:0.1 %"})
    assert 0.7 < after <= before < 1.0
    assert not result.reached
    [named] = result.nearly_counting
    assert "Hz (+10.4 % from shaft rotor 1x, participation 0.012 %)" in named
    assert named in " ".join(result.text().split())


def test_the_least_mass_is_lighter_than_the_least_change_and_keeps_the_margin():
    free = "shafts.*.sections.*.outer_diameter, bearings.left.at"
    change = rg.optimise(rg.loads(ROTOR), free, margin="30 %", searches=1)
    mass = rg.optimise(rg.loads(ROTOR), free, margin="30 %", searches=1, objective="mass")
    assert change.reached
    assert mass.reached
    assert mass.mass_after_kg <= change.mass_after_kg


def test_several_speeds_keep_their_margins_at_once():
    result = rg.optimise(
        rg.loads(ROTOR),
        "shafts.*.sections.*.outer_diameter",
        margin="20 %",
        speeds=["9000 rpm", "10000 rpm"],
        searches=1,
    )
    before = [abs(row.before_margin) < 0.2 for row in result.lines]
    assert before == [False, True]
    assert result.reached
    assert [round(row.frequency_hz) for row in result.lines] == [150, 167]


SCATTERING = """
[scatter]
"bearings.*.stiffness" = { sigma = "15 %" }
"""


def test_the_layout_least_sensitive_to_scatter_keeps_the_margin_by_more_deviations():
    rotor = rg.loads(ROTOR + SCATTERING)
    free = "shafts.*.sections.*.outer_diameter, bearings.left.at"
    bounds = {"shafts.*": "-5 %:5 %"}
    change = rg.optimise(rotor, free, margin="20 %", searches=1, bounds=bounds)
    steady = rg.optimise(rotor, free, margin="20 %", searches=1, bounds=bounds, objective="scatter")
    assert steady.reached
    assert steady.deviations_before == pytest.approx(change.deviations_before, rel=1e-3)
    assert steady.deviations_after > change.deviations_after + 0.5
    assert "standard deviations" in steady.text()


def test_deviations_of_a_layout_are_the_bands_of_scatter():
    rotor = rg.loads(ROTOR + SCATTERING)
    bands = rg.scatter(rotor, samples=2, modes=6, elements=1)
    numbers = numbers_of(rotor, "bearings.left.at")
    low, high, _ = bounds_of(numbers, {})
    lines = (ExcitationOrder("shaft rotor 1x", "shaft", ("rotor",), 1.0),)
    problem = Problem(numbers, low, high, (rotor.operation.speed,), lines, Plan(1), 400.0, 0.5, 0.5, 1e-9, 0.0)
    (state,) = problem.states(problem.start)
    looked_at = np.flatnonzero(state.sigma)
    assert len(looked_at) >= 2
    for k in looked_at:
        (band,) = [band for band in bands.bands if band.nominal_hz == pytest.approx(state.hz[k], rel=1e-6)]
        assert state.sigma[k] == pytest.approx(band.sigma_first_order, rel=1e-4)


def test_the_mass_of_the_rotors_is_that_of_the_check():
    pair = model("geared_pair")
    assert total_mass(linear_system(pair, [None], Plan(1))) == pytest.approx(rg.check(pair).total_mass_kg, rel=1e-12)


def test_a_mass_asks_for_no_equilibrium(monkeypatch):
    numbers = numbers_of(model("geared_pair"), "shafts.rotor_1.sections.*.outer_diameter")
    low, high, _ = bounds_of(numbers, {})
    problem = Problem(numbers, low, high, (100.0,), (), PLAN, 150.0, 0.4, 0.4, 1e-3)
    monkeypatch.setattr(state_at, "_state_at", None)
    mass, slopes = problem.mass(problem.start)
    assert mass == pytest.approx(rg.check(model("geared_pair")).total_mass_kg, rel=1e-12)
    assert np.all(slopes > 0.0)


def test_a_margin_that_the_mesh_does_not_resolve_is_told():
    given = {"free": "shafts.rotor.sections.*.outer_diameter", "margin": "20 %", "searches": 1}
    # At 2 kHz with one element of order 4 a mode is not there that one of order 5 has.
    [coarse] = rg.optimise(model("jeffcott"), speeds=["120000 rpm"], **given).warnings
    assert "the margin of shaft rotor 1x changes by" in coarse
    assert "ask for more elements" in coarse
    assert not rg.optimise(model("jeffcott"), speeds=["1500 rpm"], **given).warnings


def test_places_stay_on_their_side_of_what_is_beside_them():
    rotor = rg.loads(ROTOR)
    low, high, _ = bounds_of(numbers_of(rotor, "bearings.*.at"), {"bearings.*.at": "-400 mm:1000 mm"})
    assert low[0] == pytest.approx(0.0)
    assert high[0] == pytest.approx(0.52 - 0.008)
    assert (low[1], high[1]) == pytest.approx((0.528, 0.8))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"free": "bearings.nobody.at"}, "no 'nobody'"),
        ({"free": "bearings.*.at", "margin": "0 %"}, "margin"),
        ({"free": "bearings.*.at", "objective": "beauty"}, "change or mass or scatter"),
        ({"free": "bearings.*.at, operation.speed"}, "operation.speed can't vary.*give --speeds"),
        ({"free": "bearings.*.at", "objective": "scatter"}, "nothing scatters"),
        ({"free": "bearings.*.at", "bounds": {"disks.*.at": "-1 mm:1 mm"}}, "none of the free numbers"),
        ({"free": "bearings.*.at", "bounds": {"bearings.left.at": "5 mm"}}, "LOW:HIGH"),
        ({"free": "bearings.*.at", "bounds": {"bearings.left.at": "100 mm:200 mm"}}, "do not hold"),
        ({"free": "bearings.*.at", "bounds": {"bearings.left.at": "90 mm:50 mm"}}, "leave no room"),
        ({"free": "bearings.*.at", "searches": 0}, "searches"),
        ({"free": "bearings.*.at", "searches": 1.5}, "must be a whole number"),
        ({"free": "bearings.*.at", "participation": 2.0}, "participation"),
        ({"free": "bearings.*.at", "mesh_orders": [], "shaft_orders": []}, "no excitation"),
    ],
)
def test_what_cannot_be_optimised_is_refused_in_a_sentence(given, words):
    with pytest.raises(rg.RotorgearError, match=words):
        rg.optimise(rg.loads(ROTOR), **given)


@pytest.mark.long
def test_a_split_torque_gearbox_gets_its_margin_at_every_first_mesh_order():
    split = model("split_torque")
    result = rg.optimise(split, "bearings.*.at, shafts.*.sections.*.outer_diameter", margin=0.15, searches=1)
    meshes = [row for row in result.lines if row.line.startswith("mesh")]
    assert any(abs(row.before_margin) < 0.15 for row in meshes)
    assert result.reached
