"""Speeds at which a mode runs with the shaft, with internal damping and gyroscopic moments: starts and roots."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.solvers.eigen.synchronous import Affine, _starts, synchronous_speeds


def spinning(internal: float = 3e-4, external: float = 40.0) -> Affine:
    """Two disks that whirl and tilt, M q'' + (C + W G) q' + (K + W N) q = 0, with rotating damping."""
    M = np.diag([2.0, 2.0, 0.05, 0.05])
    K = np.array([[4e5, 0.0, 0.0, 2e4], [0.0, 4e5, -2e4, 0.0], [0.0, -2e4, 9e3, 0.0], [2e4, 0.0, 0.0, 9e3]])
    G = np.zeros((4, 4))
    G[2, 3] = 0.03
    G[3, 2] = -0.03
    turn = np.zeros((4, 4))
    for k in (0, 2):
        turn[k, k + 1] = -1.0
        turn[k + 1, k] = 1.0
    matrices = [M, internal * K + external * M, G, K, -internal * K @ turn]
    none = sp.csc_array(matrices[0].shape)
    return Affine(*(sp.csc_array(A) for A in matrices), none, low=10.0, high=900.0)


@pytest.mark.parametrize("order", [1.0, 2.0, 0.5])
def test_starts_solve_the_eigenproblem_in_the_speed_itself(order: float) -> None:
    family = spinning()
    s, X = _starts(family, order, 0)
    assert s.size >= 3
    for value, x in zip(s, X.T, strict=True):
        # lambda = p s, W = -i s
        speed = -1j * value
        D = family.D0 + speed * family.D1
        K = family.K0 + speed * family.K1
        parts = [(order * value) ** 2 * (family.M @ x), order * value * (D @ x), K @ x]
        assert la.norm(sum(parts)) < 1e-9 * max(map(la.norm, parts))


@pytest.mark.parametrize("order", [1.0, 2.0, 0.5])
def test_every_crossing_of_a_dense_sweep_is_a_root(order: float) -> None:
    family = spinning()
    speeds = np.linspace(10.0, 900.0, 446)
    crossed = []
    for low, high in itertools.pairwise(speeds):
        gaps = []
        for speed in (low, high):
            D, K = (A.toarray() for A in family.at(speed))
            Minv = np.linalg.inv(family.M.toarray())
            A = np.block([[np.zeros((4, 4)), np.eye(4)], [-Minv @ K, -Minv @ D]])
            values = np.linalg.eigvals(A)
            gaps.append(np.sort(values.imag[values.imag > 0.0]) - order * speed)
        for one, other in zip(*gaps, strict=True):
            if one > 0.0 >= other:
                crossed.append(low + (high - low) * one / (one - other))
    found = [root.speed for root in synchronous_speeds(family, order)[0]]
    assert found == pytest.approx(crossed, rel=1e-3)


def test_a_count_confirms_speeds_of_a_conservative_rotor_and_none_of_a_damped_one() -> None:
    found, counted = synchronous_speeds(spinning(), 1.0)
    assert found
    assert not counted
    free = spinning()
    none = sp.csc_array(free.M.shape)
    found, counted = synchronous_speeds(replace(free, D0=none, K1=none), 1.0)
    assert found
    assert counted
