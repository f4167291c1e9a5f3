"""Portraits: trajectories through the Poincare points of the batch, spectra against closed forms, the points that get one."""

from __future__ import annotations

from dataclasses import fields
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.axes import Axis
from rotorgear.analysis.sweep.point import Point, PointMaker, at_rest, ready, table_of
from rotorgear.analysis.sweep.request import start_of
from rotorgear.analysis.sweep.sweep import length_of, spread, wanted_points
from rotorgear.errors import AnalysisError
from rotorgear.forces.ball_bearing import BallBearing
from rotorgear.forces.law import ForceLaw
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.forces.mesh_friction import MeshFriction
from rotorgear.forces.torque_curve import TorqueCurve
from rotorgear.results.portrait import DISPLACEMENT, FORCE, Portraits
from rotorgear.solvers.batch.run_block import BatchPlan, run_block, trajectory
from tests.unit.analysis.sweep.test_sweep import PAIR, TWO_STAGES
from tests.unit.analysis.sweep.test_sweep_laws import MESH, with_law
from validation.oscillators import local_system


def point_of(law: MeshContact, speed: float = 0.9) -> Point:
    """Three masses, two of them in mesh."""
    M = np.array([[1.0, 0.1, 0.0], [0.1, 2.0, 0.0], [0.0, 0.0, 1.5]])
    K = np.diag([0.4, 0.3, 0.5])
    local = local_system(M, 0.05 * M, K, [0.1, -0.05, 0.0], [(law, [[1.0], [-1.0], [0.2]])], speed=speed)
    return ready(at_rest(local, [Fraction(1)], ("m",)), speed)


LAWS = {
    "never parts": MeshContact(1.0, 0.05, 0.0, gap="bilateral", order=1.0, stiffness_cos=(0.2, 0.05), error_sin=(0.1,)),
    "undamped": MeshContact(1.0, 0.0, 0.5, order=1.0, phase=0.4, stiffness_cos=(0.2,), error_cos=(0.3,)),
    "penetration": MeshContact(1.0, 0.05, 0.5, contact_damping="penetration", ramp=0.1, order=1.0, error_cos=(0.3,)),
    "adhesive": MeshContact(1.0, 0.4, 0.5, contact_damping="adhesive", ramp=0.02, order=1.0, error_cos=(0.3,)),
    "non-adhesive with impact": MeshContact(
        1.0, 0.4, 0.5, ramp=0.02, order=1.0, error_cos=(0.3,), impact=0.2, impact_share=0.5
    ),
    "unilateral": MeshContact(1.0, 0.05, gap="unilateral", ramp=0.05, order=1.0, error_cos=(0.3,)),
}


def check(point: Point, steps: int, periods: int, settle: int = 20) -> None:
    """The trajectory begins with the last Poincare point and goes through those of the batch, with their forces."""
    table = table_of(point, steps)
    system = point.system
    settled = run_block([system], [start_of(system, 1, 3)], [table], BatchPlan(steps, settle, 2, 0))[0]
    whole = run_block([system], [start_of(system, 1, 3)], [table], BatchPlan(steps, settle + 2, periods, 0))[0]
    path = trajectory(system, settled.end, table, steps, periods + 1, begun=settle + 2)
    mesh = system.columns.counted
    length = system.turns * steps
    size = np.abs(path[:, mesh]).max(axis=0)
    points = path[::length, mesh]
    assert points[0, :, :2] == pytest.approx(settled.section[-1, mesh], abs=1e-12 * size[:, :2].min())
    assert np.abs((points[1:, :, :2] - whole.section[:, mesh]) / size[:, :2]).max() < 1e-12
    counted = path[: periods * length, mesh]
    force = whole.sums[mesh]
    assert counted[:, :, FORCE].max(axis=0) == pytest.approx(force[:, 9], rel=1e-11)
    assert counted[:, :, FORCE].sum(axis=0) == pytest.approx(force[:, 10], rel=1e-11)
    assert np.array_equal(
        trajectory(system, settled.end, table, steps, 1, 10, settle + 2)[:, mesh], path[:length:10, mesh]
    )


@pytest.mark.parametrize("name", LAWS)
def test_the_trajectory_passes_through_the_poincare_points_of_the_lanes(name: str) -> None:
    check(point_of(LAWS[name]), 100, 6)


@pytest.mark.parametrize(
    ("law", "columns"),
    [
        (BallBearing(7, 0.3, 1.2, clearance=0.02, order=0.37, youngs_modulus=8.0), np.eye(5)),
        (MeshFriction(MESH, 0.9, -0.7, 0.6, 1.5, 0.1, smooth=0.2), np.eye(5)[:, [0, 2, 4]]),
        (TorqueCurve(-0.2, 1.0, 2.0, 0.9, damping=0.02, ripple=0.3, order=1.0), np.eye(5)[:, [1]]),
    ],
    ids=["ball bearing", "friction", "torque over speed"],
)
def test_it_does_so_with_laws_that_lanes_run_one_at_a_time(law: ForceLaw, columns: np.ndarray) -> None:
    # Rolling elements do not repeat with the mesh: what they do depends on the periods that went by.
    check(ready(at_rest(with_law(law, columns), [Fraction(1)], ("m",)), 0.9), 100, 4)


def test_it_does_so_over_a_common_period_of_two_meshes() -> None:
    point = PointMaker()(rg.loads(TWO_STAGES))
    assert point.system.turns == 17
    check(point, 200, 2, settle=4)


def test_records_that_miss_the_poincare_points_are_refused() -> None:
    point = point_of(LAWS["undamped"])
    with pytest.raises(ValueError, match="no multiple of 7"):
        trajectory(point.system, start_of(point.system, 0, 1), table_of(point, 100), 100, 1, 7)


def test_a_linear_forced_oscillator_has_the_lines_of_its_closed_form() -> None:
    k = 1.0
    c = 0.05
    ground = 0.3
    damping = 0.1
    w = 0.7
    e = np.array([0.02, 0.005])
    law = MeshContact(k, c, 0.0, gap="bilateral", order=1.0, error_sin=tuple(e))
    local = local_system(np.eye(1), [[damping]], [[ground]], [0.1], [(law, [[1.0]])], speed=w)
    point = ready(at_rest(local, [Fraction(1)], ("m",)), w)
    table = table_of(point, 400)
    settled = run_block([point.system], [start_of(point.system, 0, 1)], [table], BatchPlan(400, 80, 1, 0))[0]
    path = trajectory(point.system, settled.end, table, 400, 16)
    own = Portraits(*(np.array(x) for x in ([0], [0], [1], [16], [400])), path[None, None])
    order, _ = own.spectrum(0)
    for n, error in enumerate(e, 1):
        s = 1j * n * w
        x = (k + c * s) * error / (ground + k + (damping + c) * s + s**2)
        at = int(np.flatnonzero(np.isclose(order, n))[0])
        for what, value in (("displacement", x), ("velocity", s * x), ("force", (k + c * s) * (x - error))):
            assert own.spectrum(0, what=what)[1][at] == pytest.approx(abs(value), rel=1e-6)
    assert [f for f, _ in own.lines(0)] == pytest.approx([1.0, 2.0], abs=1e-4)
    with pytest.raises(AnalysisError, match="got 'acceleration', expected one of displacement, velocity, force"):
        own.spectrum(0, what="acceleration")


def test_a_line_between_two_bins_is_found_in_its_place_and_height() -> None:
    i = np.arange(64 * 50)
    values = np.zeros((1, 1, i.size, 1, 3))
    values[0, 0, :, 0, 0] = 3.0 + 2.0 * np.cos(2.0 * np.pi * 0.3456 * i / 50) + 0.1 * np.sin(2.0 * np.pi * 1.2 * i / 50)
    own = Portraits(*(np.array(x) for x in ([0], [0], [1], [64], [50])), values)
    (first, high), (second, low) = own.lines(0)
    assert (first, high) == (pytest.approx(0.3456, abs=1e-4), pytest.approx(2.0, rel=1e-3))
    assert (second, low) == (pytest.approx(1.2, abs=1e-3), pytest.approx(0.1, rel=1e-2))


@pytest.fixture(scope="module")
def swept() -> rg.SweepResult:
    over = {"operation.speed": "3000 rpm:4000 rpm:5"}
    return rg.sweep(rg.load(PAIR), over, discard=1000, sample=64, steps=400, portraits=[3000.0, "3250 rpm", 3500, 4000])


def test_subharmonics_stand_at_the_fractions_that_the_kind_of_motion_says(swept: rg.SweepResult) -> None:
    own = swept.portraits
    assert own is not None
    assert [swept.motion_at(p) for p in own.point] == ["1T", "2T", "4T", "chaotic"]
    for k, period in enumerate((1, 2, 4)):
        found = np.array([f for f, _ in own.lines(k)])
        assert found.min() == pytest.approx(1.0 / period, abs=1e-6)
        assert found * period == pytest.approx(np.round(found * period), abs=1e-6)
        order, amplitude = own.spectrum(k)
        between = np.abs(order * period - np.round(order * period)) > 0.3
        assert amplitude[between].max() < 1e-4 * amplitude.max()
    order, amplitude = own.spectrum(3)
    assert np.median(amplitude[(order > 0.05) & (order < 1.0)]) > 0.02 * amplitude.max()


def test_portraits_go_on_where_the_counted_run_ended_and_have_its_statistics(swept: rg.SweepResult) -> None:
    own = swept.portraits
    assert own is not None
    assert own.periods.tolist() == [64] * 4
    for k, p in enumerate(own.point):
        path = own.trajectory(k)
        points = own.section(k)
        assert points.shape == (64, 1, 3)
        size = np.ptp(path[:, 0], axis=0)
        assert np.all(np.abs(points[0, 0, :2] - swept.section[p, 0, -1, 0]) <= 1e-12 * size[:2])
        if swept.motion_at(p) == "chaotic":
            continue
        assert np.abs((points[:32, 0, :2] - swept.section[p, 0, 31:63, 0]) / size[:2]).max() < 1e-9
        assert size[DISPLACEMENT] == pytest.approx(swept.peak_to_peak_approach[p, 0, 0], rel=1e-9)
        assert path[:, 0, FORCE].max() == pytest.approx(swept.largest_force[p, 0, 0], rel=1e-9)
        assert path[:, 0, FORCE].mean() == pytest.approx(swept.mean_force[p, 0, 0], rel=1e-9)


def test_portraits_do_not_change_the_sweep_and_are_kept_in_the_file(swept: rg.SweepResult, tmp_path: Path) -> None:
    plain = rg.sweep(rg.load(PAIR), {"operation.speed": "3000 rpm:4000 rpm:5"}, discard=1000, sample=64, steps=400)
    assert plain.portraits is None
    assert plain.to_dict()["portraits"] == []
    assert np.array_equal(plain.section, swept.section)
    for result in (plain, swept):
        rg.save(result, tmp_path / "s.h5")
        read = rg.read(tmp_path / "s.h5").portraits
        assert (read is None) == (result.portraits is None)
        for field in fields(Portraits) if read else ():
            assert np.array_equal(getattr(read, field.name), getattr(result.portraits, field.name), equal_nan=True)


def test_two_parameters_two_directions_and_failed_points() -> None:
    over: dict[str, Any] = {
        "meshes.pair.backlash": ["20 um", "40 um"],
        "operation.speed": ["8000 rpm", "0 rpm", "300 rpm"],
    }
    result = rg.sweep(
        rg.load(PAIR),
        over,
        discard=60,
        sample=40,
        direction="both",
        initial_conditions=2,
        portraits=[(20, 8000), "39,310", (40, 0)],
    )
    own = result.portraits
    assert own is not None
    assert own.point.tolist() == [0, 5]  # nothing stands at 0 rpm
    assert [result.run[r] for r in own.run] == ["up", "down"]
    # The slow speed takes more steps in a mesh period, so that the faster point's records end first.
    assert own.records[0] < own.records[1]
    assert np.isnan(own.values[0, :, len(own.trajectory(0)) :]).all()
    assert all(np.isfinite(own.trajectory(k, j)).all() for k in (0, 1) for j in (0, 1))
    spreadout = rg.sweep(rg.load(PAIR), over, discard=60, sample=40, portraits=9).portraits
    assert spreadout is not None
    assert spreadout.point.tolist() == [0, 2, 3, 5]


def test_points_are_spread_over_the_sweep() -> None:
    assert spread([241], [True] * 241, 3) == [0, 120, 240]
    assert spread([3], [True, False, True], 9) == [0, 2]
    assert spread([5, 4], [True] * 20, 9) == [0, 2, 3, 8, 10, 11, 16, 18, 19]
    assert spread([1, 4], [True] * 4, 3) == [0, 2, 3]
    assert spread([40, 2], [True] * 80, 8) == [0, 1, 26, 27, 52, 53, 78, 79]
    assert spread([4], [True] * 4, 0) == []


@pytest.mark.parametrize(
    ("turns", "steps", "repeats", "periods", "every"),
    [
        (1, 200, 1, 64, 1),
        (1, 283, 3, 63, 1),
        (1, 200, 5, 60, 1),
        (1, 200, 29, 58, 1),
        (17, 200, 1, 29, 1),
        (113, 283, 1, 8, 1),  # no divisor leaves 20 records in a mesh period
        (113, 400, 3, 6, 4),
        (1000, 200, 1, 8, 10),
        (1000, 4999, 1, 8, 200),
        (1000, 4999, 29, 8, 200),
    ],
)
def test_portraits_have_whole_periods_and_no_more_records_than_they_need(
    turns: int, steps: int, repeats: int, periods: int, every: int
) -> None:
    assert length_of(turns, steps, repeats) == (periods, every)
    assert turns * steps % every == 0


def test_wishes_that_make_no_sense_are_refused_in_a_sentence() -> None:
    speed = Axis("operation.speed", (1000.0, 2000.0), "rpm")
    torque = Axis("operation.torque", (5.0, 10.0), "N m")
    assert wanted_points([1400.0, "1600 rpm", 1999], [speed]) == [0, 1]
    assert wanted_points(["2000,5.1 N m"], [speed, torque]) == [2]
    for wish, axes, words in (
        (17, [speed], "0 to 16 points"),
        ([2001.0], [speed], "from 1000 to 2000 rpm"),
        (["1500 Hz"], [speed], "a number in rpm"),
        ([1500.0], [speed, torque], "two values with a comma"),
        ([(1500.0, 5.0)], [speed], "expected a value of operation.speed"),
    ):
        with pytest.raises(AnalysisError, match=words):
            wanted_points(wish, axes)
