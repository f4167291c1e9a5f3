"""Sweeps of planets that go round: as seen from their carrier, and over its turn, against the motion in axes at rest.

The motion in axes at rest is integrated here by another method, with the laws where the planets are at each instant.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la
from scipy.integrate import solve_ivp

import rotorgear as rg
from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.analysis.sweep.point import Point, PointMaker, table_of
from rotorgear.errors import RotorgearError
from rotorgear.solvers.batch.run_block import BatchPlan, Start, run_block, trajectory
from rotorgear.solvers.time.contact_equilibrium import equilibrium
from rotorgear.solvers.time.local_system import LocalSystem, Rotation
from rotorgear.solvers.time.sisters import turning_matrix
from rotorgear.system.local import local_model
from rotorgear.system.system import flow_system
from tests.planetary import GROUND, helical_stage, springs
from tests.unit.analysis.transient.test_planets import TEETH, UNEQUAL, stage


def point_of(text: str) -> Point:
    made = PointMaker()(rg.loads(text))
    assert isinstance(made, Point)
    return made


def at_rest(text: str) -> LocalSystem:
    """The stage in axes at rest, with its planets on their way."""
    model = rg.loads(text)
    assert model.operating_speed is not None
    system = flow_system(model, plan_in_time(None))
    return local_model(system, Rotation.constant(model.operating_speed), model.operating_speed).local


def contacts_at(local: LocalSystem, q: np.ndarray, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and velocities that the planets see at a time, from rest at q, to 1e-9 or so."""
    n = local.n
    inverse = np.linalg.inv(local.M.toarray())
    speed = float(local.rotation.speeds[0])
    D = local.velocity_terms(speed).toarray()
    K = local.K.toarray()
    B = local.B.toarray()
    WT = speed * turning_matrix(local.sisters, local.m)

    def seen(t: float, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        R = la.expm(-t * WT)
        d = B.T @ y[:n]
        return R, R @ d, R @ (B.T @ y[n:] - WT @ d)

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        R, d, v = seen(t, y)
        F = local.forces.answer(speed * t, speed, t, d, v)[0]
        return np.concatenate([y[n:], inverse @ (local.load - D @ y[n:] - K @ y[:n] - B @ (R.T @ F))])

    atol = np.repeat([1e-15, 1e-11], n)
    found = solve_ivp(rate, (0.0, end), np.concatenate([q, np.zeros(n)]), "DOP853", rtol=1e-9, atol=atol)
    return seen(end, found.y[:, -1])[1:]


def at_mean(local: LocalSystem) -> np.ndarray:
    """Where the mean laws are in equilibrium: planets alike, so that what rests there rests in both axes."""
    return equilibrium(replace(local, forces=local.forces.mean)).q


def after_periods(point: Point, q: np.ndarray, steps: int, count: int = 1) -> np.ndarray:
    """Displacements and velocities (m, 2) of the columns after some periods of the meshes, from rest at q."""
    begin = Start(point.system.root.T @ q, np.zeros(point.system.n))
    orbit = run_block([point.system], [begin], [table_of(point, steps)], BatchPlan(steps, 0, count, 0))[0]
    return orbit.section[-1]


@pytest.mark.parametrize(("planets", "torque", "bound"), [(3, 900.0, 1e-6), (4, 900.0, 1e-6), (4, 40.0, 2e-3)])
def test_seen_from_the_carrier_a_period_is_that_of_axes_at_rest(planets: int, torque: float, bound: float) -> None:
    """Other axes and another method: of the fourth order in the step where teeth stay closed."""
    text = stage(torque, planets, loss=2e-6, ground=GROUND)
    point = point_of(text)
    assert point.system.turns == 1
    assert not point.system.sisters.planets.size
    local = at_rest(text)
    q = at_mean(local)
    d, v = contacts_at(local, q, 2.0 * np.pi / point.system.w)
    off = []
    for steps in (800, 1600):
        found = after_periods(point, q, steps)
        off.append([np.abs(found[:, 0] - d).max() / np.ptp(d), np.abs(found[:, 1] - v).max() / np.ptp(v)])
    coarse, fine = np.array(off)
    assert np.all(fine < bound)
    assert torque < 100.0 or np.all(np.log2(coarse / fine) > 3.5)


def in_few_periods(point: Point, turns: int) -> Point:
    """A point over the turn of its carrier whose runs end after a part of it."""
    return replace(point, system=replace(point.system, turns=turns))


@pytest.mark.long
@pytest.mark.parametrize("planets", [3, 4])
def test_over_a_part_of_a_turn_of_the_carrier_motions_are_those_of_axes_at_rest(planets: int) -> None:
    """Unequal springs to the ground, so that nothing repeats but the turn; compiled anew, with what turns planets."""
    text = stage(900.0, planets, loss=2e-6)
    whole = point_of(text)
    assert whole.system.turns == TEETH[planets][2]
    point = in_few_periods(whole, 2)
    local = at_rest(text)
    q = at_mean(local)
    d, v = contacts_at(local, q, 4.0 * np.pi / point.system.w)
    off = []
    for steps in (800, 1600):
        found = after_periods(point, q, steps)
        off.append([np.abs(found[:, 0] - d).max() / np.ptp(d), np.abs(found[:, 1] - v).max() / np.ptp(v)])
    coarse, fine = np.array(off)
    assert np.all(fine < 1e-6)
    assert np.all(np.log2(coarse / fine) > 3.5)
    # Portraits go the same way step by step.
    begin = Start(point.system.root.T @ q, np.zeros(point.system.n))
    path = trajectory(point.system, begin, table_of(point, 1600), 1600, 2, every=3200)
    assert path[1, :, 0] == pytest.approx(found[:, 0], rel=1e-9)
    assert path[1, :, 1] == pytest.approx(found[:, 1], rel=1e-9)


@pytest.mark.long
@pytest.mark.parametrize(("torque", "bound"), [(900.0, 1e-6), (20.0, 0.02)])
def test_tangents_over_a_turn_are_differences_of_motions(torque: float, bound: float) -> None:
    """Along a random direction, with contacts that stay closed and such that open and close within steps.

    The carrier is made to turn by a quarter within a period of the meshes. Where teeth part, the differences are good to the
    first order in the step only.
    """
    from rotorgear.solvers.batch.kernel_parts import LOSSES

    point = in_few_periods(point_of(stage(torque, 4, loss=2e-6)), 1)
    sets = point.system.sisters
    faster = sets._replace(ratio=25.0 * sets.ratio)
    point = replace(point, system=replace(point.system, sisters=faster, seen_sisters=faster))
    steps = 1600
    plan = BatchPlan(steps, 0, 1, 1)
    system = point.system
    n = system.n
    begin = Start(system.rest, np.zeros(n))
    orbit = run_block([system], [begin], [table_of(point, steps)], plan)[0]
    along = np.random.default_rng(1).standard_normal((1, 2 * n))[0]
    by = 1e-7 * np.linalg.norm(system.rest)
    beside = [Start(begin.z + side * by * along[:n], begin.dz + side * by * along[n:]) for side in (1.0, -1.0)]
    ends = [one.end for one in run_block([system] * 2, beside, [table_of(point, steps)], replace(plan, tangents=0))]
    z, dz = ((getattr(ends[0], name) - getattr(ends[1], name)) / (2.0 * by) for name in ("z", "dz"))
    free = system.rigid
    z, dz = (x - free.T @ (free @ x) for x in (z, dz))
    size = np.sqrt(np.sum((system.energy @ z) ** 2) + np.sum(dz**2))
    assert bool(orbit.sums[:, LOSSES].any()) is (torque < 100.0)
    assert orbit.growth[0, 0] == pytest.approx(np.log(size), abs=bound)


def test_a_settled_point_is_the_transient_in_axes_at_rest() -> None:
    """Ranges of approach and transmission error, mean and largest forces of all contacts."""
    text = stage(150.0, 3, loss=5e-5, speed=2000.0 * np.pi / 30.0, ground=GROUND)
    for values in GROUND.values():
        losses = {name: 5e-5 * value for name, value in values.items()}
        text = text.replace(springs(values), f"{springs(values)}\ndamping = {springs(losses)}")
    model = rg.loads(text)
    found = rg.sweep(model, {"operation.speed": ["2000 rpm"]}, discard=100, sample=10, exponents=1)
    assert found.motion == ("1T",)
    period = 1.0 / found.frequency[0]
    moved = rg.transient(
        model, time=5 * period, discard=150 * period, steps=200, method="exponential", error_estimate=False
    )
    for mine, its, bound in (
        (found.peak_to_peak_transmission_error, moved.peak_to_peak_transmission_error, 1e-4),
        (found.peak_to_peak_approach, moved.peak_to_peak_approach, 1e-4),
        (found.mean_force, moved.mean_force, 1e-6),
        (found.largest_force, moved.force_range[:, 1], 2e-4),  # that of the steps of each
    ):
        assert mine[0, 0] == pytest.approx(its, rel=bound)


def test_planets_that_are_two_or_differ_are_swept_as_seen_from_their_carrier() -> None:
    """Where that is not so, the sentence says why; equal ones are swept over the turn of their carrier then."""
    two = helical_stage(2, teeth=(28, 36, 100)).replace(
        "stiffness = 600000000.0", "stiffness = 600000000.0\ntransmission_error = [{harmonic = 1, amplitude = 1e-6}]"
    )
    assert point_of(two).system.turns == 1
    uneven = helical_stage(2, teeth=(28, 36, 100), ground=UNEQUAL)
    with pytest.raises(RotorgearError, match=r"carriers\.stage: coefficients of planets that are two.*supports"):
        point_of(uneven)
