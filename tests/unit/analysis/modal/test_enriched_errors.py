"""Rough error estimates of a coarse mesh are replaced by the difference from a richer one, against a bar in closed form."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.modal.refine import enriched_errors
from rotorgear.analysis.modal.solve import Wanted, solve
from rotorgear.system.plan import Plan
from rotorgear.system.system import System
from tests.models import RHO, G, cantilever


def test_rough_estimates_become_the_true_errors_and_others_stay() -> None:
    """Torsion of a clamped bar, w = (n - 1/2) pi c / L, on two elements of order one."""
    length = 0.7
    model = cantilever({"length": length, "outer_diameter": 0.04}).with_("motions", ["torsion"])
    system = System(model, plan=Plan(2, 1))
    wanted = Wanted(None, 2, None)
    found = solve(system, wanted)
    exact = ((np.arange(2) + 0.5) * np.pi * np.sqrt(G / RHO) / length) ** 2
    own = np.abs(found.eigenvalues) ** (2 if np.iscomplexobj(found.eigenvalues) else 1)
    true = own / exact - 1.0
    assert np.all(true > 0.02)
    errors = enriched_errors(system, wanted, found, np.array([0.5, 0.5]))
    # Of eigenvalues s that oscillate it is half of that of their squares.
    share = np.sqrt(1.0 + true) - 1.0 if np.iscomplexobj(found.eigenvalues) else true
    np.testing.assert_allclose(errors, share, rtol=1e-3)
    # A small estimate and one that says nothing stay.
    kept = enriched_errors(system, wanted, found, np.array([1e-9, np.inf]))
    np.testing.assert_array_equal(kept, [1e-9, np.inf])
