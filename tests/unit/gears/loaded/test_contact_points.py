"""Slices of contact lines: they fill the lines, their places integrate, and corners follow where the line of action ends."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import trapezoid

from rotorgear.gears.geometry.line_of_action import LineOfAction
from rotorgear.gears.loaded.contact_points import Slices, contact_slices, patch_loads
from rotorgear.gears.loaded.face import load_per_width
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, beyond_line
from rotorgear.gears.loaded.tooth_contact import line_of_action
from tests.unit.gears.tooth_pairs import WIDTH, pair

COUNT = 14
POSITIONS = np.array([0.0, 0.23, 0.61, 0.94])


def line_of(helix: float) -> LineOfAction:
    return line_of_action(pair(helix))


def lines_at(line: LineOfAction, u: float, low: float, high: float) -> dict[int, tuple[float, float]]:
    """The range of z over which each pair lies between two roll lengths of the pinion, by its straight line in the face."""
    tangent = math.tan(line.base_helix_angle)
    found = {}
    for k in range(-6, 7):
        middle = line.pitch_point + (u + k) * line.base_pitch
        ends = (max(-0.5 * WIDTH, (low - middle) / tangent), min(0.5 * WIDTH, (high - middle) / tangent))
        if ends[1] - ends[0] > 1e-3 * WIDTH / COUNT:
            found[k] = ends
    return found


def of(slices: Slices, position: int, k: int) -> Slices:
    return slices.take(np.flatnonzero((slices.position == position) & (slices.pair == k) & ~slices.corner))


@pytest.mark.parametrize("helix", [8.0, 20.86, 34.0])
def test_slices_fill_the_contact_lines_and_integrate_along_them(helix: float) -> None:
    line = line_of(helix)
    slices = contact_slices(line, POSITIONS, WIDTH, COUNT, (0.0, 0.0))
    for p, u in enumerate(POSITIONS):
        expected = lines_at(line, u, line.start, line.end)
        assert set(slices.pair[(slices.position == p) & ~slices.corner]) == set(expected)
        for k, (low, high) in expected.items():
            own = of(slices, p, k)
            z = own.z / WIDTH
            assert own.length.sum() == pytest.approx(high - low, rel=1e-9)
            # Three places of Gauss integrate z^5 exactly.
            for power in (1, 4, 5):
                moment = own.length @ (z**power @ own.weight)
                exact = WIDTH * ((high / WIDTH) ** (power + 1) - (low / WIDTH) ** (power + 1)) / (power + 1)
                assert moment == pytest.approx(exact, rel=1e-9, abs=1e-12 * WIDTH)
            # On the line of action both roll lengths add up to T1T2.
            on_pinion = line.pitch_point + (u + k) * line.base_pitch + own.z * math.tan(line.base_helix_angle)
            assert own.roll[0] == pytest.approx(on_pinion, rel=1e-12)
            assert own.roll.sum(axis=0) == pytest.approx(np.full(own.z.shape, line.length), rel=1e-12)
            assert not own.gap.any()
            # As many slices as the longest line has, finer at the ends.
            longest = min(WIDTH, (line.end - line.start) / math.tan(line.base_helix_angle))
            assert len(own) == max(1, int(longest / (WIDTH / COUNT) + 1e-9))
            if len(own) > 4:
                shares = own.length / own.length.sum()
                edges = np.linspace(-1.0, 1.0, len(own) + 1)
                edges = 0.6 * edges + 0.4 * np.sin(0.5 * np.pi * edges)
                assert shares == pytest.approx(0.5 * np.diff(edges), rel=1e-9)


@pytest.mark.parametrize("helix", [8.0, 20.86])
@pytest.mark.parametrize("beyond", [(0.1, 0.3), (0.4, 0.05)])
def test_corners_are_followed_before_the_start_and_after_the_end(helix: float, beyond: tuple[float, float]) -> None:
    line = line_of(helix)
    reach = (beyond[0] * line.base_pitch, beyond[1] * line.base_pitch)
    slices = contact_slices(line, POSITIONS, WIDTH, COUNT, reach)
    tangent = math.tan(line.base_helix_angle)
    nominal = (
        line.pitch_point + (POSITIONS[slices.position] + slices.pair)[:, None] * line.base_pitch + slices.z * tangent
    )
    before, after = slices.corner & (nominal[:, 1] < line.start), slices.corner & (nominal[:, 1] > line.end)
    assert np.array_equal(before | after, slices.corner)
    for gear, some, excess in ((1, before, line.start - nominal), (0, after, nominal - line.end)):
        assert some.any()
        gap, mate = line.corner(gear, excess[some])
        assert slices.gap[some] == pytest.approx(gap * math.cos(line.base_helix_angle), rel=1e-12)
        assert slices.roll[gear, some] == pytest.approx(np.full(gap.shape, line.tip[gear]), rel=1e-15)
        assert slices.roll[1 - gear, some] == pytest.approx(mate, rel=1e-12)
    # Every place that is followed has its slice: together with the line they fill the range.
    for p, u in enumerate(POSITIONS):
        for k, (low, high) in lines_at(line, u, line.start - reach[0], line.end + reach[1]).items():
            own = slices.take(np.flatnonzero((slices.position == p) & (slices.pair == k)))
            middle = own.z @ own.weight
            order = np.argsort(middle)
            left, right = (middle[order] + side * 0.5 * own.length[order] for side in (-1.0, 1.0))
            assert left[0] <= low + 2e-3 * WIDTH / COUNT
            assert right[-1] >= high - 2e-3 * WIDTH / COUNT
            assert right[:-1] == pytest.approx(left[1:], abs=2e-3 * WIDTH / COUNT)


@pytest.mark.parametrize("helix", [0.0, 20.86])
def test_stations_stand_at_fixed_places_along_the_face(helix: float) -> None:
    line = line_of(helix)
    reach = (0.2 * line.base_pitch, 0.1 * line.base_pitch)
    slices = contact_slices(line, POSITIONS, WIDTH, COUNT, reach, stations=True)
    places = (np.arange(COUNT) + 0.5) * WIDTH / COUNT - 0.5 * WIDTH
    assert set(np.round(slices.z.ravel(), 12)) <= set(np.round(places, 12))
    assert slices.length == pytest.approx(np.full(len(slices), WIDTH / COUNT))
    for p, u in enumerate(POSITIONS):
        here = slices.take(slices.at(p))
        nominal = (
            line.pitch_point
            + (u + np.arange(-6, 7))[:, None] * line.base_pitch
            + places * math.tan(line.base_helix_angle)
        )
        followed = (nominal > line.start - reach[0]) & (nominal < line.end + reach[1])
        on_line = (nominal >= line.start) & (nominal <= line.end)
        assert len(here) == np.count_nonzero(followed)
        assert np.count_nonzero(~here.corner) == np.count_nonzero(on_line)


def test_a_slice_carries_evenly_along_its_length_wherever_stretches_of_the_face_end() -> None:
    """Two slices, of 3 and 2 kN over 8 and 5 mm, at two positions that stand for 0.7 and 0.3 of the cycle."""
    slices = SimpleNamespace(
        position=np.array([0, 1]),
        z=np.array([[-4e-3, 2e-3], [9e-3, 11e-3]]),
        weight=np.array([0.25, 0.75]),
        length=np.array([8e-3, 5e-3]),
    )
    found: Any = SimpleNamespace(slices=slices, force=np.array([3e3, 2e3]), weight=np.array([0.7, 0.3]))
    width, places = 30e-3, 7
    z, load = load_per_width(found, width, places)
    edges = np.linspace(-15e-3, 15e-3, places + 1)
    assert z == pytest.approx(0.5 * (edges[1:] + edges[:-1]))
    expected = np.zeros(places)
    for middle, length, force in ((0.5e-3, 8e-3, 0.7 * 3e3), (10.5e-3, 5e-3, 0.3 * 2e3)):
        inside = np.minimum(edges[1:], middle + 0.5 * length) - np.maximum(edges[:-1], middle - 0.5 * length)
        expected += force / length * np.maximum(inside, 0.0) / np.diff(edges)
    assert load == pytest.approx(expected, rel=1e-9, abs=1e-6)


@pytest.mark.parametrize("periods", [1, 3])
def test_positions_stand_for_half_of_the_intervals_beside_them(periods: int) -> None:
    """Of a closed cycle: a sum with these weights is the trapezoidal rule over its periods."""
    u = np.sort(np.random.default_rng(periods).random(9)) * 0.97 + 0.01
    u = np.concatenate([u + k for k in range(periods)]) + 4.2
    weight = MeshCycle.weight.fget(SimpleNamespace(position=u))  # type: ignore[attr-defined]
    values = np.random.default_rng(5).random(len(u))
    closed_u, closed = np.append(u, u[0] + periods), np.append(values, values[0])
    assert weight @ values == pytest.approx(trapezoid(closed, closed_u) / periods, rel=1e-12)


@pytest.mark.parametrize("gear", [0, 1])
def test_patches_are_semi_ellipses_of_unit_load_about_their_slices(gear: int) -> None:
    """Sum 1, centre at the slice, mean square c^2/4 across: elements of second order integrate these exactly."""
    module, base = 4e-3, 17.0
    arc = np.linspace(0.5, 4.5, 41)  # nodes across the flank, in modules along its arc xi^2/(2 r_b)
    height = np.linspace(-3.0, 3.0, 9)
    body: Any = SimpleNamespace(
        base_radius=base,
        flank_start=math.sqrt(2.0 * base * arc[0]),
        flank_end=math.sqrt(2.0 * base * arc[-1]),
        roll=np.sqrt(2.0 * base * arc),
        height=height,
    )
    centre = np.array([[2.0, 2.1, 2.2], [0.6, 0.61, 0.62], [3.3, 3.2, 3.1]])
    z = 1e-3 * np.array([[-9.0, -8.0, -7.0], [1.0, 2.5, 4.0], [6.0, 6.5, 7.0]])
    weight = np.array([5.0, 8.0, 5.0]) / 18.0
    roll = np.sqrt(2.0 * base * centre) * module

    class Three(SimpleNamespace):
        def __len__(self) -> int:
            return 3

    slices: Any = Three(roll=np.stack([roll, roll]), z=z, weight=weight)
    least, most = np.array([0.05, 0.05, 0.4]), 0.3
    found = patch_loads(slices, gear, body, module, least, most)
    loads = found.loads.reshape(3, len(height), len(arc))
    assert loads.sum(axis=(1, 2)) == pytest.approx(np.ones(3), rel=1e-12)
    # As wide as the flank leaves room, at least and at most so much.
    c = np.clip(np.minimum(centre - arc[0], arc[-1] - centre), least[:, None], np.maximum(least, most)[:, None])
    assert c[:, 0] == pytest.approx([0.3, 0.1, 0.4])
    assert found.log_width == pytest.approx(np.log(c) @ weight, rel=1e-12)
    across = loads.sum(axis=1)
    assert across @ arc == pytest.approx(centre @ weight, rel=1e-12)
    assert across @ arc**2 == pytest.approx((centre**2 + 0.25 * c**2) @ weight, rel=1e-9)
    # Along the face the place of the slice; the gear's face runs the other way.
    along = loads.sum(axis=2)
    side = 1.0 if gear == 0 else -1.0
    assert along @ height == pytest.approx(side * (z / module) @ weight, rel=1e-9)
    ends = side * z / module
    for row in range(3):
        low, high = found.layers[row]
        assert height[2 * low] <= ends[row].min() <= height[2 * low + 2]
        assert height[2 * high] <= ends[row].max() <= height[2 * high + 2]
    # Displacements of the slices by a flexibility of the nodes are those of whole matrices.
    G = np.random.default_rng(1).normal(size=(found.loads.shape[1],) * 2)
    assert found.moved(G, np.array([2, 0])) == pytest.approx(found.loads[[2, 0]] @ G, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("approach", [2e-6, 15e-6])
def test_corners_can_touch_as_far_as_their_gap_is_the_approach(approach: float) -> None:
    line = line_of(20.86)
    problem: Any = SimpleNamespace(line=line)
    before, after = beyond_line(problem, approach)
    step = 0.45 * line.base_pitch / 400
    for gear, reach in ((1, before), (0, after)):
        assert line.corner(gear, np.array([reach]))[0][0] >= approach
        assert line.corner(gear, np.array([reach - step]))[0][0] < approach
    # No farther than corners are followed at all.
    assert beyond_line(problem, 1.0) == pytest.approx((0.45 * line.base_pitch, 0.45 * line.base_pitch))
