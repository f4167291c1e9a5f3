"""The estimate from the bubbles of each element against the error itself, on thick shafts whose gyroscopic moments count."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.system.bubble_errors import bubble_errors
from rotorgear.system.plan import Plan
from rotorgear.system.system import System
from tests.models import STEEL


@pytest.mark.parametrize(
    ("damping", "shaft"),
    [
        ({}, {}),
        ({"rayleigh_beta": 2e-6, "rayleigh_alpha": 300.0}, {}),
        ({}, {"internal_damping": 2e-6}),
    ],
)
@pytest.mark.parametrize(("size", "speed", "count"), [(0.3, 20000.0, 4), (0.5, -15000.0, 8)])
def test_the_estimate_is_the_error_while_a_thick_shaft_turns(
    size: float, speed: float, count: int, damping: dict[str, float], shaft: dict[str, object]
) -> None:
    model = rg.Model(
        motions=["bending"],
        materials=STEEL,
        shafts={"rotor": {"sections": [{"length": size, "outer_diameter": size}], **shaft}},
        bearings={end: {"shaft": "rotor", "at": end, "stiffness": {"radial": 1e10}} for end in ("start", "end")},
        operation={"input_shaft": "rotor"},
        damping=damping,
    )
    coarse = System(model, plan=Plan(count, 1))
    found = rg.modal(coarse, speed=speed, modes=4, error_estimate=False)
    fine = rg.modal(System(model, plan=Plan(6, 4)), speed=speed, modes=4, error_estimate=False)
    error = np.abs(np.abs(found.eigenvalues) / np.abs(fine.eigenvalues) - 1.0)
    shapes = np.moveaxis(found.shapes, 2, 0).reshape(4, -1).T
    x = np.linalg.lstsq(coarse.dofs.transform.toarray(), shapes, rcond=None)[0]
    (estimate,) = bubble_errors(coarse, speed, found.eigenvalues, x).values()
    assert estimate == pytest.approx(error, rel=0.05)
