"""Maps of tooth pairs against the loaded contact at single loads, with pitch errors, and kept on disk."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.flank import FlankGrid, FlankModification
from rotorgear.gears.loaded.loaded_contact import PositionContact, solve_contact, solve_many
from rotorgear.gears.loaded.mesh_cycle import loaded_cycle
from rotorgear.gears.loaded.tooth_contact import contact_problem
from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.gears.maps.solved_map import _error, contact_map, faded, kept_map, with_start
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.settings import ToothFe
from tests.unit.gears.tooth_pairs import LOAD, cycle, helical, pair, spur

POSITIONS = 8


def normal(teeth: ToothPair, map_: ContactMap, factor: float) -> np.ndarray:
    """Approach (p,) along the flank normal of the loaded contact itself, at a multiple of the working load."""
    cosine = np.cos(teeth.pair.base_helix_angle)
    return np.asarray(cycle(teeth, factor * LOAD * cosine, len(map_.position)).deflection * cosine)


@pytest.mark.parametrize("factor", [0.13, 1.0, 3.21])
def test_the_map_of_a_spur_pair_is_its_loaded_contact(factor: float) -> None:
    found = contact_map(spur(), LOAD, POSITIONS)
    exact = normal(spur(), found, factor)
    assert found.approach_at(factor * LOAD, found.position) == pytest.approx(exact, rel=2e-3)
    assert found.force(exact, found.position) == pytest.approx(np.full(POSITIONS, factor * LOAD), rel=3e-3)


def test_the_map_of_a_helical_pair_is_its_loaded_contact() -> None:
    found = contact_map(helical(), LOAD, POSITIONS)
    # Slices and patches are the same under all these loads, so that what is left lies between two loads.
    for factor, tolerance in ((1.0, 1e-9), (0.3, 1e-6), (0.77, 1e-6), (1.5, 2e-5), (5.0, 1e-9)):
        exact = normal(helical(), found, factor)
        assert found.approach_at(factor * LOAD, found.position) == pytest.approx(exact, rel=tolerance)


def test_patches_of_a_helical_pair_are_those_that_each_load_asks_for() -> None:
    """Under strips of up to 0.4 modules: a map that looked for them under a few loads only was 1e-3 off between."""
    found = contact_map(helical(), 4.5 * LOAD, 8)
    widths = set()
    for load in found.load[found.load > 9.0 * LOAD]:
        exact = cycle(helical(), load * np.cos(helical().pair.base_helix_angle), 8)
        widths |= set(exact.patch)
        along = exact.deflection * np.cos(helical().pair.base_helix_angle)
        assert found.approach_at(load, found.position) == pytest.approx(along, rel=1e-9)
    assert sorted(widths) == pytest.approx([0.25, 0.3125, 0.390625])


@pytest.mark.parametrize("teeth", [spur(), helical()], ids=["spur", "helical"])
def test_force_rises_with_approach_and_its_tangent_is_the_slope(teeth: ToothPair) -> None:
    found = contact_map(teeth, LOAD, POSITIONS)
    delta = np.linspace(0.0, 1.3 * found.approach.max(), 400)
    for u in (0.0, 0.3, 0.62):
        force = found.force(delta, u)
        assert np.all(np.diff(force[delta > found.no_load(u)]) > 0.0)
        step = 1e-6 * delta[1:]
        slope = (found.force(delta[1:] + step, u) - found.force(delta[1:] - step, u)) / (2.0 * step)
        inside = delta[1:] > found.no_load(u) + 1e-7
        assert found.stiffness(delta[1:], u)[inside] == pytest.approx(slope[inside], rel=1e-3)


def test_slices_that_do_not_feel_each_other_take_the_loads_of_space() -> None:
    teeth = pair(20.86, ToothFe("preview"))
    found = contact_map(teeth, LOAD, POSITIONS, near=True)
    assert found.load[-1] == pytest.approx(2.0 * LOAD)  # up to five times it in the plane
    assert found.approach_at(LOAD, found.position) == pytest.approx(normal(teeth, found, 1.0), rel=1e-9)


def test_above_its_loads_a_map_says_so() -> None:
    found = contact_map(spur(), LOAD, POSITIONS)
    assert found.beyond([0.0, found.largest_load]) is None
    assert "solved up to" in str(found.beyond(1.01 * found.largest_load))


def test_many_contacts_at_once_are_each_of_them_alone() -> None:
    rng = np.random.default_rng(3)
    b, n = 40, 3
    root = rng.normal(size=(b, n, n))
    many = PositionContact(
        compliance=1e-10 * (root @ root.transpose(0, 2, 1) + 4.0 * np.eye(n)),
        gap=8e-6 * rng.random((b, n)),
        length=np.full((b, n), 54e-3),
        local=np.full(2, 2.8e-12),
        log_width=np.full((b, n, 2), np.log(1e-3)),
        radius=np.full((b, n), 0.02),
        modulus=1.13e11,
        least_tangent=-2.0,
    )
    load = np.geomspace(10.0, 1e5, b)
    approach, tangent = solve_many(many, load)
    for i in range(b):
        state = solve_contact(many.chosen(i), load[i])
        assert approach[i] == pytest.approx(state.approach, rel=1e-10)
        assert tangent[i] == pytest.approx(state.tangent, rel=1e-8)


@pytest.mark.parametrize("tooth", [5, 0])  # tooth 0 stands in the first period, where the commonest one does not begin
def test_a_wrong_tooth_is_felt_once_a_turn(tooth: int) -> None:
    teeth = spur(first_flank=FlankModification(pitch_error=((tooth, 20e-6),)))
    found = contact_map(teeth, LOAD, POSITIONS)
    assert found.periods == 34
    exact = loaded_cycle(teeth, LOAD, found.position)[1].deflection
    assert found.approach_at(LOAD, found.position) == pytest.approx(exact, rel=1e-9)
    exact_teeth = contact_map(spur(), LOAD, POSITIONS).approach_at(LOAD, found.position)
    assert np.abs(found.approach_at(LOAD, found.position) - exact_teeth).max() > 3e-6
    assert np.sum(np.abs(found.approach_at(LOAD, found.position) - exact_teeth) > 1e-9) <= 3 * POSITIONS


def test_topography_of_one_tooth_is_felt_once_a_turn() -> None:
    line = contact_problem(spur()).line
    deep = FlankGrid((line.form[0], line.tip[0]), (-0.1, 0.1), ((4e-6, 4e-6), (4e-6, 4e-6)))
    measured = contact_map(spur(first_flank=FlankModification(tooth_topography=((5, deep),))), LOAD, POSITIONS)
    set_back = contact_map(spur(first_flank=FlankModification(pitch_error=((5, 4e-6),))), LOAD, POSITIONS)
    assert measured.periods == 34
    assert measured.approach == pytest.approx(set_back.approach, rel=1e-6)


def test_alike_errors_of_all_teeth_only_shift_the_map() -> None:
    teeth = spur(first_flank=FlankModification(pitch_error=tuple((i, 7e-6) for i in range(34))))
    moved = contact_map(teeth, LOAD, POSITIONS)
    exact = contact_map(spur(), LOAD, POSITIONS)
    assert moved.periods == 1
    assert moved.approach == pytest.approx(exact.approach + 7e-6, rel=1e-9)


def test_too_many_differing_periods_are_refused() -> None:
    rng = np.random.default_rng(1)
    flanks = [FlankModification(pitch_error=tuple(enumerate(1e-6 * rng.random(z)))) for z in (34, 80)]
    with pytest.raises(AnalysisError, match="of 1360 base pitches differ"):
        contact_map(spur(first_flank=flanks[0], second_flank=flanks[1]), LOAD, POSITIONS)


def test_a_map_that_no_machine_holds_is_refused_before_it_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    """An odd tooth of each gear: 1360 base pitches, of which few differ."""
    odd = FlankModification(pitch_error=((0, 5e-6),))
    monkeypatch.setattr("rotorgear.memory.free_memory", lambda: 2e9)
    sentence = r"over 1360 base pitches would take ([\d.]+) GB of memory, and 2 GB are free: give pitch errors"
    with pytest.raises(AnalysisError, match=sentence) as caught:
        contact_map(spur(first_flank=odd, second_flank=odd), LOAD)
    # Twelve numbers of eight bytes for each of 512 positions a base pitch under each load.
    said = re.search(sentence, str(caught.value))
    assert said is not None
    loads = len(contact_map(spur(), LOAD, POSITIONS).load)
    assert float(said[1]) == pytest.approx(12 * 8 * 1360 * 512 * loads / 1e9, rel=0.02)


def test_a_kept_map_is_read_again_and_another_key_is_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROTORGEAR_CACHE", str(tmp_path))
    monkeypatch.setattr("rotorgear.gears.maps.solved_map._WORTH", 0.0)
    u = np.arange(4) / 4
    long = np.zeros(5000)
    made = ContactMap(u, 1, np.array([0.0, 1.0]), np.ones((4, 2)), ("a note",), np.ones((4, 2)))
    calls = []

    def solve() -> ContactMap:
        calls.append(1)
        return made

    first = kept_map((pair(), 1.0, long), solve)
    again = kept_map((pair(), 1.0, long), solve)
    assert len(calls) == 1
    assert np.array_equal(again.approach, first.approach)
    assert again.warnings == ("a note",)
    # The middle of a long array counts as well.
    long[2500] = 1.0
    kept_map((pair(), 1.0, long), solve)
    kept_map((pair(fe=ToothFe("fine")), 1.0, long), solve)
    assert len(calls) == 3
    for file in tmp_path.iterdir():
        file.write_bytes(b"broken")
    kept_map((pair(), 1.0, long), solve)
    assert len(calls) == 4


def test_periods_without_the_odd_tooth_are_solved_on_patches_of_their_own() -> None:
    """An odd tooth carries more, on wider patches, and the load of the others stays on those that it asks for."""
    teeth = helical(first_flank=FlankModification(pitch_error=((0, 20e-6),)))
    found = contact_map(teeth, LOAD, 8, near=True)
    far = found.periods // 2 + np.arange(8) / 8
    problem, exact = loaded_cycle(teeth, LOAD * np.cos(contact_problem(teeth).line.base_helix_angle), far)
    along_normal = exact.deflection * np.cos(problem.line.base_helix_angle)
    assert found.approach_at(np.full(8, LOAD), far) == pytest.approx(along_normal, rel=1e-6)


@pytest.mark.parametrize("near", [True, False])
@pytest.mark.parametrize("share", [0.3, 0.54, 1.3])
def test_a_helix_that_carries_another_load_than_its_mesh_has_its_own_curve(share: float, near: bool) -> None:
    """Misaligned flanks touch on a part of their face that grows with the load: between the loads of the map, too."""
    teeth = replace(helical(), misalignment=20e-6)
    found = contact_map(teeth, LOAD, 8, near)
    exact = normal(teeth, found, share)
    curve = found.approach_at(share * LOAD, found.position)
    assert curve - curve.mean() == pytest.approx(exact - exact.mean(), abs=0.025 * np.ptp(exact))


def test_the_slope_at_no_load_is_that_of_the_parabola_through_both_points() -> None:
    """delta = a + b F + c F^2 of two positions, of which the second hardens so little that rounding would turn it about."""
    a, b, c = np.array([3e-6, 1e-6]), np.array([2e-9, 5e-9]), np.array([-1e-13, 1e-13])
    loads = np.array([0.0, 4e3, 9e3])
    approach = a[:, None] + b[:, None] * loads + c[:, None] * loads**2
    slope = b[:, None] + 2.0 * c[:, None] * loads[1:]
    found = with_start(slope, approach, loads)
    assert found[:, 1:] == pytest.approx(slope)
    assert found[0, 0] == pytest.approx(b[0], rel=1e-9)
    # Contacts stiffen with the load: a parabola that softens begins with the slope of its second point.
    assert found[1, 0] == slope[1, 0]


def test_what_a_change_of_slices_moves_fades_away_towards_the_last_load() -> None:
    """Approach and moment go on from those below the bound and end as their own; slopes are their own at once."""
    rng = np.random.default_rng(4)
    columns, below = rng.normal(size=(3, 4, 5)), rng.normal(size=(3, 5))
    factors = [1.0, 1.4, 2.0, 2.5]
    found = faded(columns, below, factors)
    assert found.shape == (3, 3, 5)
    assert found[1] == pytest.approx(columns[1, 1:])
    for kind in (0, 2):
        assert found[kind, -1] == pytest.approx(columns[kind, -1])
        jump = columns[kind, 0] - below[kind]
        for k, left in enumerate((1.1 / 1.5, 0.5 / 1.5, 0.0)):
            assert found[kind, k] == pytest.approx(columns[kind, k + 1] - left * jump)


def test_the_error_of_a_map_is_its_largest_difference_to_contacts_that_it_has_not_seen() -> None:
    """A map moved by 3 um along the normal is 3 um off, and one of eight positions more than one of 64."""
    found = contact_map(spur(), LOAD, 64)
    problem = contact_problem(spur())
    moved = replace(found, approach=found.approach + 3e-6)
    assert _error(problem, moved, LOAD) == pytest.approx(3e-6, abs=2.0 * found.error)
    assert _error(problem, found, LOAD) == pytest.approx(found.error, rel=1e-9)
    assert found.error < 0.3 * contact_map(spur(), LOAD, POSITIONS).error
