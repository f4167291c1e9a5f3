"""Motions without strain of random pencils: as many as there are parts, in all units, with bodies that have no inertia."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.errors import RotorgearError
from rotorgear.solvers.time.contact_equilibrium import free_motions


@pytest.mark.parametrize("kind", ["unequal", "equal", "in parts", "without springs"])
def test_each_part_has_one_motion_without_strain(kind: str) -> None:
    rng = np.random.default_rng(5)
    for number in range(250):
        n = int(rng.integers(2, 9))
        inertia = np.ones(n) if kind == "equal" else 10.0 ** rng.uniform(-3.0, 1.0, n)
        if kind != "without springs":
            inertia[rng.random(n) < 0.3] = 0.0
            inertia[0] = 1.0
        K = np.zeros((n, n))
        parts = 1
        for i in range(n - 1):
            if kind == "without springs" or (kind == "in parts" and rng.random() < 0.4 and inertia[i : i + 2].all()):
                parts += 1
                continue
            v = np.zeros(n)
            v[i : i + 2] = (1.0, -1.0) if rng.random() < 0.3 else rng.uniform(0.02, 0.2, 2)
            K += 10.0 ** rng.uniform(4.0, 8.0) * np.outer(v, v)
        unit = 10.0 ** rng.uniform(-9.0, 9.0)
        M = sp.csc_array(np.diag(unit * inertia))
        K = sp.csc_array(unit * K)
        try:
            R = free_motions(M, K)
        except RotorgearError as error:
            raise AssertionError(f"{number}: {inertia}, {K.toarray()}: {error}") from None
        assert R.shape[1] == parts
        gram = R.T @ (M @ R)
        assert gram == pytest.approx(np.eye(parts), abs=1e-9)
        assert np.all(np.abs(K @ R) <= 1e-7 * (abs(K) @ np.abs(R)))
