"""Pairs that rounding has blurred are mended on the pencil, before all of a large spectrum is solved instead."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.solvers.eigen import damped
from rotorgear.solvers.eigen.damped import damped_modes
from tests.unit.solvers.spring_chains import bar


def test_blurred_pairs_of_a_large_chain_are_refined_and_not_solved_densely(monkeypatch: pytest.MonkeyPatch) -> None:
    M, K, _ = bar(300, ground={0: 1.0, 299: 1.0})
    # Damping in proportion to mass: s = -a/2 +- i sqrt(w^2 - a^2/4), with w the undamped frequency.
    a = 1e-3
    whole = damped._arnoldi

    def blurred(*arguments: object) -> damped.Pairs:
        values, vectors, reach = whole(*arguments)  # type: ignore[arg-type]
        values[2] *= 1.0 + 1e-6
        vectors[:, 2] += 1e-6 * np.sin(np.arange(300))
        return values, vectors, reach

    monkeypatch.setattr(damped, "_arnoldi", blurred)
    found = damped_modes(M, sp.csc_array(a * M), K, count=8, below=None, rigid_vectors=np.zeros((300, 0)))
    exact = 2.0 * np.sin(np.arange(1, 9) * np.pi / (2 * 300 + 2))
    assert "Arnoldi" in found.method
    np.testing.assert_allclose(np.abs(found.eigenvalues), exact, rtol=1e-9)
