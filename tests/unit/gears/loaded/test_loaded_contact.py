"""Loaded contact of teeth: contact conditions, symmetries, limits, and loads nobody would wish for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.optimize as so

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.flank import FlankModification
from rotorgear.gears.loaded.contact_points import contact_slices
from rotorgear.gears.loaded.loaded_contact import PositionContact, hertz_half_width, solve_contact
from rotorgear.gears.loaded.mesh_cycle import corner_reach, loaded_cycle, mesh_cycle
from rotorgear.gears.loaded.patched_contacts import patched_contacts
from rotorgear.gears.loaded.tooth_contact import contact_problem, line_of_action
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.settings import ToothFe
from tests.unit.gears.tooth_pairs import COARSE, LOAD, WIDTH, cycle, helical, pair, spur, swapped
from validation.benchmarks.overload import least_eigenvalue

# CalculiX, plane strain, spur 34/80 at the pitch point: approach 10 um, arc of three pitches, rim of three modules.
PITCH_POINT = 18.708e9


def test_one_slice_approaches_as_the_hertz_strip_and_the_rest_of_the_body() -> None:
    E = 206e9
    nu = 0.3
    R = 20e-3
    L = 10e-3
    load = 5e3
    K = 2.0 * (1.0 - nu**2) / (np.pi * E)
    modulus = E / (2.0 * (1.0 - nu**2))
    log_c = np.log(1.2e-3)
    contact = PositionContact(
        np.array([[3e-9]]),
        np.zeros(1),
        np.array([L]),
        np.full(2, K),
        np.full((1, 2), log_c),
        np.array([R]),
        modulus,
    )
    state = solve_contact(contact, load)
    a = float(hertz_half_width(np.array(load / L), np.array(R), modulus))
    assert a == pytest.approx(np.sqrt(4.0 * load / L * R / (np.pi * modulus)), rel=1e-14)
    exact = 3e-9 * load + 2.0 * K * load / L * (0.25 + log_c - np.log(a))
    assert state.approach == pytest.approx(exact, rel=1e-12)
    # The tangent is the derivative of the force.
    step = 1e-4 * load
    slope = 2.0 * step / (solve_contact(contact, load + step).approach - solve_contact(contact, load - step).approach)
    assert state.tangent == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("teeth", [spur(), helical()], ids=["spur", "helical"])
def test_the_contact_conditions_hold_and_the_forces_carry_the_load(teeth: ToothPair) -> None:
    found = cycle(teeth)
    normal = LOAD / np.cos(teeth.pair.base_helix_angle)
    assert found.residual <= 1e-12  # m
    assert found.force.min() >= 0.0
    assert np.bincount(found.slices.position, found.force) == pytest.approx(np.full(16, normal), rel=1e-9)
    assert least_eigenvalue(found) > 0.0
    assert sum(found.share_by_pair().values()) == pytest.approx(np.ones(16), rel=1e-12)


def test_the_tangent_stiffness_of_many_slices_is_the_slope_of_the_load() -> None:
    rng = np.random.default_rng(5)
    A = rng.normal(size=(30, 30))
    C = 1e-10 * (A @ A.T / 30.0 + np.eye(30))
    contact = PositionContact(
        C,
        3e-6 * rng.random(30),
        np.full(30, 2e-3),
        np.full(2, 2.8e-12),
        np.full((30, 2), np.log(1e-3)),
        np.full(30, 0.02),
        1.13e11,
    )
    load = 4e3
    step = 1e-5
    low, middle, high = (solve_contact(contact, load * (1.0 + s)) for s in (-step, 0.0, step))
    assert 0 < np.sum(middle.force > 0.0) < 30
    assert middle.tangent == pytest.approx(2.0 * step * load / (high.approach - low.approach), rel=1e-6)


def test_the_tangent_stiffness_over_a_cycle_is_the_slope_of_the_load() -> None:
    # The reach of tip corners, and with it the slicing, follows the load: a light one has none.
    load = 1e-3 * LOAD
    step = 1e-4
    low, middle, high = (cycle(spur(), load * (1.0 + s), 8) for s in (-step, 0.0, step))
    assert middle.tangent == pytest.approx(2.0 * step * load / (high.deflection - low.deflection), rel=1e-5)


def test_how_far_corners_of_oblique_lines_are_followed_changes_nothing() -> None:
    problem = contact_problem(helical())
    positions = np.arange(4) / 4
    reach = corner_reach(problem, LOAD, positions)
    approach = []
    for factor in (1.0, 1.5):
        beyond = (factor * reach[0], factor * reach[1])
        slices = contact_slices(problem.line, positions, problem.width, problem.slices, beyond)
        found = patched_contacts(problem, slices, problem.gap(slices), LOAD)
        force = np.concatenate([state.force for state in found.states])
        assert np.any(force[slices.corner] > 0.0)
        approach.append([state.approach for state in found.states])
    assert approach[1] == pytest.approx(approach[0], rel=1e-9)


def test_a_corner_comes_into_contact_without_a_jump_of_the_approach() -> None:
    """The face's end passes the borders of corner slices: where these stood still the approach jumped by 0.2 um here."""
    u = np.linspace(0.4, 0.6, 41)
    found = mesh_cycle(contact_problem(helical(misalignment=60e-6)), LOAD, u)
    corners = np.bincount(found.slices.position, found.slices.corner & (found.force > 0.0), len(u))
    assert len(set(corners)) > 1
    assert np.abs(np.diff(found.deflection, 2)).max() < 0.04e-6


@pytest.mark.parametrize("teeth", [spur(), helical()], ids=["spur", "helical"])
def test_pinion_and_gear_may_change_names(teeth: ToothPair) -> None:
    # The path runs the other way, so position u becomes -u.
    one = cycle(teeth)
    other = cycle(swapped(teeth))
    back = (-np.arange(16)) % 16
    assert other.secant[back] == pytest.approx(one.secant, rel=1e-9)
    assert other.deflection[back] == pytest.approx(one.deflection, rel=1e-9)


def test_the_pitch_point_value_of_another_program() -> None:
    teeth = spur(fe=ToothFe(arc=3))

    def approach(load: float) -> float:
        return float(loaded_cycle(teeth, load, np.array([0.0]))[1].deflection[0])

    load = so.brentq(lambda F: approach(F) - 10e-6, 1e3, 5e4, rtol=1e-12)
    assert load / 10e-6 / WIDTH == pytest.approx(PITCH_POINT, rel=5e-3)


@pytest.mark.parametrize("position", [0.0, 0.45])
def test_the_width_of_the_load_patches_drops_out(position: float) -> None:
    fine = ToothFe("fine")
    k = [
        float(loaded_cycle(spur(fe=replace(fe, patch=patch)), LOAD, np.array([position]))[1].secant[0])
        for fe in (fine,)
        for patch in (0.2, 0.3)
    ]
    assert k[1] == pytest.approx(k[0], rel=3e-3)


def test_the_width_of_a_spur_pair_is_only_a_factor() -> None:
    narrow = replace(spur(), width=0.1 * WIDTH)
    assert cycle(narrow, 0.1 * LOAD).secant == pytest.approx(0.1 * cycle(spur()).secant, rel=1e-12)


def test_a_spur_pair_in_space_is_a_little_softer_than_in_its_plane() -> None:
    plane = cycle(spur())
    space = cycle(spur(fe=ToothFe(space=True, size=COARSE)))
    ratio = space.secant.mean() / plane.secant.mean()
    assert 0.97 < ratio < 1.03


def test_a_light_load_has_the_contact_ratio_of_the_geometry() -> None:
    found = cycle(spur(), 1e-7 * LOAD, 64)
    assert found.contact_ratio == pytest.approx(spur().pair.transverse_contact_ratio, abs=1.5 / 64)
    assert not np.any(found.slices.corner & (found.force > 0.0))


def test_more_load_brings_more_of_the_flank_into_contact() -> None:
    ratios = [cycle(spur(), factor * LOAD, 32).contact_ratio for factor in (1e-3, 1.0, 5.0)]
    assert ratios[0] < ratios[1] < ratios[2]


def test_stiffness_grows_with_the_load_as_the_hertz_logarithm_does() -> None:
    # In single contact u/F = const - K/(2b) ln F for each body, so equal ratios of load give equal steps of compliance.
    c = [1.0 / float(cycle(spur(), factor * LOAD, 64).secant[0]) for factor in (1e-4, 1e-3, 1e-2)]
    K = 2.0 * (1.0 - 0.3**2) / (np.pi * 206e9)
    assert c[0] - c[1] == pytest.approx(c[1] - c[2], rel=1e-6, abs=0)
    assert c[0] - c[1] == pytest.approx(2.0 * 0.5 * K / WIDTH * np.log(10.0), rel=1e-6, abs=0)


@pytest.mark.parametrize("factor", [1e-6, 1e-4, 1e-2, 10.0])
@pytest.mark.parametrize("teeth", [spur(), helical()], ids=["spur", "helical"])
def test_light_and_heavy_loads_come_to_rest(teeth: ToothPair, factor: float) -> None:
    found = cycle(teeth, factor * LOAD, 8)
    assert np.all(np.isfinite(found.secant))
    assert found.residual <= 1e-9 * float(np.abs(found.deflection).max()) + 1e-18
    assert least_eigenvalue(found) > 0.0


def test_a_load_that_makes_no_line_contact_is_refused() -> None:
    with pytest.raises(AnalysisError, match="no line contact"):
        cycle(spur(), 2000.0 * LOAD)


@pytest.mark.parametrize("factor", [0.01, 1.0])
def test_a_misaligned_pair_carries_at_one_end(factor: float) -> None:
    straight = helical()
    found = cycle(replace(straight, misalignment=60e-6), factor * LOAD, 8)
    mirror = cycle(replace(spur(fe=ToothFe(size=COARSE)), misalignment=60e-6), factor * LOAD, 8)
    other = cycle(replace(spur(fe=ToothFe(size=COARSE)), misalignment=-60e-6), factor * LOAD, 8)
    centre = float((found.force * (found.slices.z @ found.slices.weight)).sum() / found.force.sum())
    assert centre < -0.2 * WIDTH  # the flanks stand apart at larger z
    assert found.secant.mean() < cycle(straight, factor * LOAD, 8).secant.mean()
    assert mirror.secant == pytest.approx(other.secant, rel=1e-9)


def test_tip_relief_takes_load_from_the_ends_of_the_path() -> None:
    relief = FlankModification(tip_relief=20e-6, tip_relief_length=5e-3)
    plain = cycle(spur())
    relieved = cycle(replace(spur(), first_flank=relief, second_flank=relief))
    assert relieved.contact_ratio < plain.contact_ratio
    assert relieved.no_load == pytest.approx(np.zeros(16), abs=20e-6)


def test_the_flank_carries_in_the_middle_where_it_is_crowned() -> None:
    crowned = cycle(replace(helical(), first_flank=FlankModification(crowning=30e-6)))
    z = crowned.slices.z @ crowned.slices.weight
    load = crowned.force / crowned.slices.length
    middle = np.abs(z) < 0.15 * WIDTH
    end = np.abs(z) > 0.42 * WIDTH
    assert load[middle].mean() > 2.0 * load[end].mean()


def test_a_tooth_that_stands_back_leaves_its_load_to_its_neighbours() -> None:
    teeth = replace(spur(), first_flank=FlankModification(pitch_error=((1, 60e-6),)))
    problem, found = loaded_cycle(teeth, 0.5 * LOAD, np.arange(48) / 16)
    share = found.share_by_pair()
    assert problem.flanks[0].pitch_error
    assert share[-1].max() < 1.0  # pair -1 is tooth 1, one period after tooth 0
    exact = loaded_cycle(spur(), 0.5 * LOAD, np.arange(48) / 16)[1]
    assert share[-1].sum() < 0.5 * exact.share_by_pair()[-1].sum()
    assert np.ptp(found.no_load) > 5e-6


@pytest.mark.parametrize("target", [1.0, 2.0])
def test_whole_contact_ratios_are_no_trouble(target: float) -> None:
    def ratio(addendum: float) -> float:
        return pair(addendum=addendum).pair.transverse_contact_ratio - target

    teeth = pair(addendum=so.brentq(ratio, 0.3, 1.24, xtol=1e-14))
    found = cycle(teeth, 1e-4 * LOAD)
    assert found.contact_ratio == pytest.approx(target, abs=0.08)
    assert np.all(np.isfinite(found.secant))


def test_teeth_that_lose_contact_are_refused() -> None:
    with pytest.raises(AnalysisError, match="contact ratio is 0"):
        cycle(pair(addendum=0.45))


def test_slices_that_do_not_feel_each_other_are_stiffer_than_the_body() -> None:
    assert cycle(pair(20.86, ToothFe("preview"))).secant.mean() > cycle(helical()).secant.mean()


def test_slices_of_helical_lines_change_smoothly_over_the_cycle() -> None:
    """A line that grows or ends keeps its number of slices: no step but where a line comes or goes."""
    line = line_of_action(helical())
    u = np.linspace(0.0, 1.0, 801)
    slices = contact_slices(line, u, WIDTH, 8, (0.0, 0.0))
    for k in np.unique(slices.pair):
        of_pair = slices.pair == k
        places = np.unique(slices.position[of_pair])
        counts = np.bincount(slices.position[of_pair])[places]
        assert set(counts) == {8}
        lengths = slices.length[of_pair].reshape(len(places), 8)
        beside = np.diff(places) == 1
        # A contact line's end runs along the face as fast as the base pitch over tan b_b; a slice has an eighth of it.
        fastest = line.base_pitch / np.tan(line.base_helix_angle) / 800.0
        assert np.abs(np.diff(lengths, axis=0)[beside]).max() <= fastest / 4.0


def test_slices_are_finer_at_the_ends_and_fill_the_line() -> None:
    line = line_of_action(helical())
    slices = contact_slices(line, np.zeros(1), WIDTH, 8, (0.0, 0.0))
    length = slices.length[slices.pair == 0]
    assert length.sum() == pytest.approx(WIDTH, rel=1e-12)
    assert length[0] == pytest.approx(length[-1], rel=1e-12)
    assert np.all(np.diff(length[:4]) > 0.0)


def test_without_load_a_crowned_flank_touches_at_its_crown_whatever_the_slices() -> None:
    """The first touch is that of places, not of means over slices: the middle of the face stands 0 deep."""
    flank = FlankModification(crowning=30e-6)
    for slices in (3, 8):
        teeth = replace(helical(), first_flank=flank, fe=replace(helical().fe, slices=slices))
        found = cycle(teeth, positions=4)
        # An odd number of slices has a place on the crown; others are a part of a slice from it.
        assert found.no_load.min() <= 30e-6 * (2.0 / 8.0 * 0.25) ** 2
        assert np.all(found.no_load >= 0.0)
