"""Bubbles of a shaft element as polynomials: zero at both nodes, and stretched, bent and sheared by their own derivatives."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from rotorgear.elements.bodies import gear_body
from rotorgear.elements.shaft_bubbles import bubble_motions, bubble_places, shaft_bubbles
from rotorgear.elements.shaft_section import gauss
from tests.models import E, G, elements

LENGTH = 0.3
POINTS = 12


def polynomials(values: np.ndarray, order: int) -> list[Polynomial]:
    """Those over z from 0 to the length through values at the Gauss points (g, b)."""
    z = LENGTH * gauss(POINTS)[0]
    return [Polynomial.fit(z, one, order + 2, domain=[0.0, LENGTH]) for one in values.T]


@pytest.mark.parametrize("order", [2, 3, 5])
@pytest.mark.parametrize("shear", [True, False])
def test_bubbles_vanish_at_both_nodes_and_their_stiffness_is_that_of_their_derivatives(order: int, shear: bool) -> None:
    data = elements(LENGTH, 0.08, 0.03, kappa=0.9 if shear else np.inf)
    fields, R, turn = shaft_bubbles(data, order, POINTS)
    x, y, z, theta_x, theta_y, theta_z = (polynomials(field[0], order) for field in fields)
    motions = bubble_motions(order, shear)
    assert fields.shape[-1] == len(motions)
    ends = np.array([0.0, LENGTH])
    size = np.abs(fields).max(axis=(1, 2, 3))
    for name, field in (("deflection", x), ("stretch", z), ("twist", theta_z)):
        largest = size[{"deflection": 0, "stretch": 2, "twist": 5}[name]]
        assert max(np.abs(one(ends)).max() for one in field) < 1e-10 * largest
    assert max(np.abs(one(ends)).max() for one in theta_y) < 1e-10 * size[4]

    area = np.pi / 4.0 * (0.08**2 - 0.03**2)
    inertia = np.pi / 64.0 * (0.08**4 - 0.03**4)

    def inner(first: Any, second: Any) -> np.ndarray:
        return np.array([[((a * b).integ())(LENGTH) - ((a * b).integ())(0.0) for b in second] for a in first])

    def rates(field: list[Polynomial]) -> list[Polynomial]:
        return [one.deriv() for one in field]

    sheared = [
        [u.deriv() - t for u, t in zip(*pair, strict=True)] for pair in ((x, theta_y), (y, [-t for t in theta_x]))
    ]
    expected = E * inertia * (inner(rates(theta_y), rates(theta_y)) + inner(rates(theta_x), rates(theta_x)))
    expected += E * area * inner(rates(z), rates(z)) + 2.0 * G * inertia * inner(rates(theta_z), rates(theta_z))
    if shear:
        expected += 0.9 * G * area * (inner(sheared[0], sheared[0]) + inner(sheared[1], sheared[1]))
    else:
        # The slope is the derivative of the deflection.
        for pair in sheared:
            assert max(np.abs(one(0.37 * LENGTH)) for one in pair) < 1e-9 * size[4]
    stiffness = R[0].T @ R[0]
    np.testing.assert_allclose(stiffness, expected, atol=1e-8 * np.abs(expected).max())
    # By +90 degrees x turns into y.
    np.testing.assert_allclose(fields[0] @ turn, -fields[1], atol=1e-14)


def test_bubbles_of_an_order_are_found_among_those_of_a_richer_element() -> None:
    data = elements(LENGTH, 0.08, 0.03, kappa=0.9)
    few, many = (shaft_bubbles(data, order, POINTS)[0] for order in (3, 5))
    np.testing.assert_allclose(many[..., bubble_places(3, 5, shear=True)], few, atol=1e-14)


@pytest.mark.parametrize("ratio", [0.0, 0.03])
def test_an_elastic_gear_body_is_damped_at_its_ratio_and_turns_its_damping_with_the_gear(ratio: float) -> None:
    w = np.array([2e3, 5e3])
    skew = np.array([[0.0, -1.0], [1.0, 0.0]])
    wheel: Any = SimpleNamespace(
        size=2,
        damping_ratio=ratio,
        stiffness=w**2,
        mass=np.eye(8),
        gyroscopic=np.zeros((8, 8)),
        turning=skew,
        spin_stiffness=np.eye(2),
    )
    body = gear_body(wheel)
    if not ratio:
        assert body.viscosity is None
        assert body.circulation_per_speed is None
        return
    assert body.viscosity is not None
    assert body.circulation_per_speed is not None
    np.testing.assert_allclose(body.viscosity[0], np.diag(2.0 * ratio * w))
    np.testing.assert_allclose(body.circulation_per_speed[0], np.diag(2.0 * ratio * w) @ skew)
    np.testing.assert_allclose(body.strain[0] @ np.arange(8.0), [6.0, 7.0])
