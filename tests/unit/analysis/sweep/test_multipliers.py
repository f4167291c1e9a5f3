"""Orbits near a run by Newton's method, their multipliers, and where a run goes on from beside an unstable one."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rotorgear.analysis.sweep.multipliers import SURE, certificate
from rotorgear.solvers.batch.run_block import Start

SIZE = 1e-5
# The orbit passes here; the last displacement and velocity are those of a rigid motion.
ORBIT = 1e-5 * np.array([0.3, -0.2, 0.0, 0.1, 0.4, 0.0])


def found(
    multipliers: tuple[float, ...],
    begun: np.ndarray,
    periods: int = 1,
    curved: float = 1e3,
    other: float = 0.0,
    sizes: tuple[float, ...] = (SIZE,),
) -> tuple[float, int, Start] | None:
    """The certificate of a map with known multipliers, curved by a square term; half way it passes as far from its begin."""
    turned = np.linalg.qr(np.random.default_rng(0).standard_normal((4, 4)))[0]
    inner = turned @ np.diag(multipliers) @ turned.T
    elastic = [0, 1, 3, 4]
    M = np.zeros((6, 6))
    M[np.ix_(elastic, elastic)] = inner
    M[2, 2] = M[5, 5] = M[2, 5] = 1.0

    def advance(states: Any, length: int) -> list[Start]:
        ends = []
        for one in states:
            off = np.concatenate([one.z, one.dz]) - ORBIT
            end = ORBIT + M @ off + curved * off**2 * np.array([1, 1, 0, 1, 1, 0])
            if length < periods:
                end[0] += other
            ends.append(Start(end[:3], end[3:]))
        return ends

    columns = SimpleNamespace(counted=np.ones(len(sizes), dtype=bool))
    system: Any = SimpleNamespace(n=3, rigid=np.array([[0.0, 0.0, 1.0]]), B=np.eye(3)[:, : len(sizes)], columns=columns)
    return certificate(system, Start(begun[:3], begun[3:]), np.array(sizes), periods, advance, 0.02)


@pytest.mark.parametrize("largest", [0.99, 1.004, -1.2])
@pytest.mark.parametrize("periods", [1, 3])
def test_the_largest_multiplier_on_the_orbit(largest: float, periods: int) -> None:
    begun = ORBIT + 0.02 * SIZE * np.array([1.0, -1.0, 50.0, 0.5, 0.3, 20.0])
    own = found((largest, 0.5, -0.3, 0.1), begun, periods)
    assert own is not None
    assert own[0] == pytest.approx(np.log(abs(largest)) / periods, abs=1e-6)
    assert (own[0] < SURE) == (abs(largest) < 1.0)


def test_a_run_on_an_unstable_orbit_goes_on_beside_it_and_one_on_a_stable_orbit_from_its_end() -> None:
    unstable = found((1.004, 0.5, -0.3, 0.1), ORBIT)
    stable = found((0.99, 0.5, -0.3, 0.1), ORBIT)
    assert unstable is not None
    assert stable is not None
    beside = np.concatenate([unstable[2].z, unstable[2].dz]) - ORBIT
    assert 1e-3 * SIZE < np.linalg.norm(beside) < 0.05 * SIZE
    np.testing.assert_array_equal(np.concatenate([stable[2].z, stable[2].dz]), ORBIT)


def test_without_an_orbit_near_by_nothing_is_said() -> None:
    assert found((0.99, 0.5, -0.3, 0.1), ORBIT + 20.0 * SIZE) is None


@pytest.mark.parametrize(("other", "repeats"), [(0.0, 1), (0.01 * SIZE, 1), (0.03 * SIZE, 2)])
def test_an_orbit_tells_its_own_period_while_a_run_still_spirals_onto_it(other: float, repeats: int) -> None:
    spiral = ORBIT + 0.05 * SIZE * np.array([1.0, 1.0, 0.0, 0.5, 0.3, 0.0])
    own = found((-0.99, 0.5, -0.3, 0.1), spiral, periods=2, other=other)
    assert own is not None
    assert own[1] == repeats


def test_each_displacement_repeats_by_its_own_size() -> None:
    own = found((-0.99, 0.5, -0.3, 0.1), ORBIT, periods=2, other=0.03 * SIZE, sizes=(SIZE, 10.0 * SIZE))
    assert own is not None
    assert own[1] == 2


@pytest.mark.parametrize("phase", range(4))
def test_an_orbit_has_one_period_wherever_the_run_ended_on_it(phase: int) -> None:
    # Period doubling has split both points of this orbit of the logistic map, one far less than the other.
    def advance(states: Any, length: int) -> list[Start]:
        ends = []
        for one in states:
            z = one.z
            for _ in range(length):
                z = 3.5 * z * (1.0 - z)
            ends.append(Start(z, 0.0 * one.dz))
        return ends

    columns = SimpleNamespace(counted=np.ones(1, dtype=bool))
    system: Any = SimpleNamespace(n=1, rigid=np.zeros((0, 1)), B=np.eye(1), columns=columns)
    end = advance([Start(np.array([0.3]), np.zeros(1))], 20000 + phase)[0]
    own = certificate(system, end, np.array([4.0]), 4, advance, 0.02)
    assert own is not None
    assert own[1] == 4
