"""The estimate from the bubbles of each element against the error itself, on thick shafts whose gyroscopic moments count."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.common.points import moving_rows
from rotorgear.analysis.modal.refine import errors_of, total_error
from rotorgear.analysis.modal.solve import Wanted, solve
from rotorgear.analysis.response.mesh import damped_plant
from rotorgear.system.bubble_errors import ForcedChanges, bubble_errors
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


@pytest.mark.parametrize("turned", [0.1, 0.3, 0.6, 1.3, 2.0])
@pytest.mark.parametrize("speed", [5000.0, -8000.0, 20000.0])
def test_the_estimate_is_the_error_of_shafts_whose_material_damps_strongly(speed: float, turned: float) -> None:
    model = rg.Model(
        motions=["bending", "axial", "torsion"],
        materials=STEEL,
        shafts={
            "rotor": {
                "sections": [{"length": 0.5, "outer_diameter": 0.3}, {"length": 0.3, "outer_diameter": 0.2}],
                "internal_damping": turned / abs(speed),
            }
        },
        bearings={
            "start": {"shaft": "rotor", "at": "start", "stiffness": {"radial": 1e9, "axial": 1e9}},
            "end": {"shaft": "rotor", "at": "end", "stiffness": {"radial": 2e9}},
        },
        supports={"held": {"shaft": "rotor", "at": "start", "stiffness": {"torsion": 1e8}}},
        operation={"input_shaft": "rotor"},
    )

    def solved(order: int) -> tuple[np.ndarray, np.ndarray]:
        system = System(model, plan=Plan(2, order))
        found = solve(system, Wanted(speed, 5, None, model.motions))
        parts = errors_of(system, speed, found.eigenvalues, found.vectors, found.rigid)
        return found.eigenvalues, total_error(parts, 5)

    exact, _ = solved(7)
    s, estimate = solved(2)
    # Motions that the material damps this much have no stiffness of their own, and no estimate (docs/theory_structure.md).
    light = np.abs(s.real) < 0.5 * np.abs(s)
    assert np.count_nonzero(light) >= 2
    nearest = exact[np.argmin(np.abs(s[:, None] - exact), axis=1)]
    error = np.abs(s - nearest) / np.abs(nearest)
    light &= error > 1e-8
    ratio = estimate[light] / error[light]
    assert ratio == pytest.approx(1.0, rel=0.05)


@pytest.mark.parametrize("alpha", [0.0, 3e4])
def test_what_bubbles_change_of_a_receptance_is_its_error_in_a_medium_that_brakes_strongly(alpha: float) -> None:
    """At the place of the force, where the first order of the change is a product of the response with itself."""
    model = rg.Model(
        motions=["bending"],
        materials=STEEL,
        shafts={"rotor": {"sections": [{"length": 0.9, "outer_diameter": 0.25}]}},
        bearings={end: {"shaft": "rotor", "at": end, "stiffness": {"radial": 3e9}} for end in ("start", "end")},
        operation={"input_shaft": "rotor"},
        supports={"middle": {"shaft": "rotor", "at": 0.45, "stiffness": {"radial": 1e6}}},
        damping={"rayleigh_alpha": alpha, "rayleigh_beta": 1e-6},
    )
    w = np.array([2500.0, 9000.0])

    def answers(system: System) -> tuple[np.ndarray, np.ndarray]:
        """Responses (n, m) to a force in the middle, and what of them is seen there (m,)."""
        f = moving_rows(system, ["supports.middle:y"]).T
        dynamics = damped_plant(system, 0.0, 0.0, 0.0).dynamics(0.0)
        q = np.hstack([dynamics.solve(float(one), f) for one in w])
        return q, (f.T @ q)[0]

    coarse = System(model, plan=Plan(4, 1))
    q, seen = answers(coarse)
    _, exact = answers(System(model, plan=Plan(12, 4)))
    estimate = ForcedChanges.of(coarse).change(0.0, w, q, turning=False)
    assert estimate == pytest.approx(np.abs(exact - seen), rel=0.05)
