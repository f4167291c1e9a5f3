"""The shaft element at speed, with lumped mass too, and the terms that a short thick shaft shows."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad

import rotorgear as rg
from rotorgear.elements.shaft import shaft_elements
from rotorgear.elements.shaft_section import ShaftElements, torsional_flexibility
from rotorgear.elements.spring import between, rigid_transfer, spring
from tests.models import RHO, STEEL, elements


@pytest.mark.parametrize("lumped", [True, False])
def test_a_turning_element_that_tilts_has_the_angular_momentum_of_its_polar_inertia(lumped: bool) -> None:
    """A rigid tilt rate about x of a body that spins takes a moment W J_p about y, whatever the distribution of its mass."""
    L = 0.2
    outer = 0.12
    inner = 0.05
    matrices = shaft_elements(elements(L, outer, inner), lumped=lumped)
    polar = RHO * np.pi / 32 * (outer**4 - inner**4) * L
    about_x = np.zeros(12)
    about_x[[3, 9]] = 1.0
    about_x[[1, 7]] = 0.5 * L, -0.5 * L  # y = -tx z about the middle
    about_y = np.zeros(12)
    about_y[[4, 10]] = 1.0
    about_y[[0, 6]] = -0.5 * L, 0.5 * L
    assert matrices.gyroscopic is not None
    assert about_x @ matrices.gyroscopic[0] @ about_y == pytest.approx(polar, rel=1e-12)


@pytest.mark.parametrize("speed", [0.0, 8000.0])
def test_many_lumped_elements_turn_as_a_few_consistent_ones(speed: float) -> None:
    def frequencies(kind: str, count: int) -> np.ndarray:
        model = rg.Model(
            motions=["bending"],
            materials=STEEL,
            shafts={"rotor": {"mass_matrix": kind, "sections": [{"length": 0.6, "outer_diameter": 0.15}]}},
            bearings={end: {"shaft": "rotor", "at": end, "stiffness": {"radial": 5e8}} for end in ("start", "end")},
            operation={"input_shaft": "rotor", "speed": 100.0},
        )
        found = rg.modal(model, speed=speed, modes=4, elements=count, error_estimate=False)
        return np.asarray(found.frequency_hz)

    exact = frequencies("consistent", 12)
    lumped = frequencies("lumped", 60)
    assert lumped == pytest.approx(exact, rel=2e-3)
    if speed:  # both whirls of a pair are apart by their gyroscopic moment
        split = exact[1::2] - exact[::2]
        assert split.min() > 5.0
        assert lumped[1::2] - lumped[::2] == pytest.approx(split, rel=0.02)


def test_the_mass_of_a_lumped_element_is_that_of_the_consistent_one_in_every_rigid_motion() -> None:
    one, other = (shaft_elements(elements(0.2, 0.12, 0.05), lumped=lumped).mass for lumped in (True, False))
    assert one is not None
    assert other is not None
    for dof in (0, 1, 2, 5):
        shift = np.zeros(12)
        shift[[dof, dof + 6]] = 1.0
        assert shift @ one[0] @ shift == pytest.approx(shift @ other[0] @ shift, rel=1e-12)


def test_a_round_shaft_has_its_bending_modes_in_equal_pairs_of_both_planes() -> None:
    from rotorgear.system.plan import Plan
    from rotorgear.system.system import System

    model = rg.Model(
        motions=["bending"],
        materials=STEEL,
        shafts={
            "rotor": {
                "sections": [
                    {"length": 0.3, "outer_diameter": 0.15},
                    {"length": 0.2, "outer_diameter": 0.1, "outer_diameter_end": 0.05},
                ]
            }
        },
        bearings={end: {"shaft": "rotor", "at": end, "stiffness": {"radial": 5e8}} for end in ("start", "end")},
    )
    for order in (2, 3):
        found = rg.modal(System(model, plan=Plan(1, order)), modes=8, error_estimate=False).frequency_hz
        assert found[1::2] == pytest.approx(found[::2], rel=1e-9)


def test_two_points_on_different_axes_joined_by_a_coupling_are_free_in_all_rigid_motions() -> None:
    rng = np.random.default_rng(3)
    first = np.array([0.1, -0.2, 0.3])
    second = np.array([-0.2, 0.1, 0.9])
    link = spring(between(first, second), np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), np.zeros((6, 6)))
    both = np.vstack([rigid_transfer(first), rigid_transfer(second)])
    assert link.strain is not None
    assert np.abs(link.strain[0] @ both @ rng.normal(size=6)).max() < 1e-14


@pytest.mark.parametrize("kappa", [0.83, np.nan, np.inf])
def test_a_hollow_cone_clamped_at_its_left_end_gives_as_the_unit_load_method_says(kappa: float) -> None:
    """Integrals of 1/(E A), 1/(G J), 1/(E I) with the levers of tip loads, and of 1/(kappa G A), by a quadrature of their own."""
    L, E, nu = 0.17, 206e9, 0.3
    G = E / 2.6
    left, right = (0.06, 0.01), (0.09, 0.045)
    sizes = np.array([[*left, *right]])
    data = ShaftElements(
        *(np.array([x]) for x in (L,)), sizes, sizes, *(np.array([x]) for x in (E, G, nu, 7850.0, kappa))
    )
    K = shaft_elements(data).stiffness
    assert K is not None
    give = np.linalg.inv(K[0, 6:, 6:])

    def at(z: float) -> tuple[float, float, float]:
        outer, inner = (a + (b - a) * z / L for a, b in zip(left, right, strict=True))
        area, second = np.pi / 4.0 * (outer**2 - inner**2), np.pi / 64.0 * (outer**4 - inner**4)
        q, m = (1.0 + (inner / outer) ** 2) ** 2, (inner / outer) ** 2
        cowper = 6.0 * (1.0 + nu) * q / ((7.0 + 6.0 * nu) * q + (20.0 + 12.0 * nu) * m)
        return area, second, cowper if np.isnan(kappa) else kappa

    def integral(of: Callable[[float], float]) -> float:
        return float(quad(of, 0.0, L, epsabs=0.0, epsrel=1e-12)[0])

    across = integral(lambda z: (L - z) ** 2 / (E * at(z)[1]) + 1.0 / (at(z)[2] * G * at(z)[0]))
    turn = integral(lambda z: (L - z) / (E * at(z)[1]))
    tilt = integral(lambda z: 1.0 / (E * at(z)[1]))
    expected = np.diag(
        [across, across, integral(lambda z: 1.0 / (E * at(z)[0])), tilt, tilt, integral(lambda z: 0.5 / (G * at(z)[1]))]
    )
    # A force along x turns the end about +y, one along y about -x.
    expected[0, 4] = expected[4, 0] = turn
    expected[1, 3] = expected[3, 1] = -turn
    assert give == pytest.approx(expected, rel=1e-9, abs=1e-9 * tilt)
    twist = torsional_flexibility([L], [(*left, *right)], [G])
    assert twist == pytest.approx(expected[5, 5], rel=1e-12)


def test_masses_of_a_cone_are_those_of_its_slices_in_every_rigid_motion() -> None:
    L, rho = 0.17, 7850.0
    sizes = np.array([[0.06, 0.01, 0.09, 0.045]])
    one = np.ones(1)
    data = ShaftElements(L * one, sizes, sizes, 206e9 * one, 79e9 * one, 0.3 * one, rho * one, np.nan * one)
    found = shaft_elements(data)
    assert found.mass is not None

    def integral(power: int, of: Callable[[float, float], float]) -> float:
        return float(
            quad(lambda z: rho * z**power * of(0.06 + 0.03 * z / L, 0.01 + 0.035 * z / L), 0.0, L, epsrel=1e-12)[0]
        )

    def area(outer: float, inner: float) -> float:
        return np.pi / 4.0 * (outer**2 - inner**2)

    def second(outer: float, inner: float) -> float:
        return np.pi / 64.0 * (outer**4 - inner**4)

    R = np.vstack([rigid_transfer(np.array([0.0, 0.0, z])) for z in (0.0, L)])
    M = R.T @ found.mass[0] @ R
    m, first = integral(0, area), integral(1, area)
    tilting = integral(2, area) + integral(0, second)
    expected = np.diag([m, m, m, tilting, tilting, 2.0 * integral(0, second)])
    # The centre lies above the origin: a turn about y moves it along x, one about x against y.
    expected[0, 4] = expected[4, 0] = first
    expected[1, 3] = expected[3, 1] = -first
    assert pytest.approx(expected, rel=1e-9, abs=1e-12) == M
    assert found.gyroscopic is not None
    G = R.T @ found.gyroscopic[0] @ R
    assert abs(G[3, 4]) == pytest.approx(2.0 * integral(0, second), rel=1e-9)
    assert (
        np.abs(G - G[3, 4] * (np.outer(np.eye(6)[3], np.eye(6)[4]) - np.outer(np.eye(6)[4], np.eye(6)[3]))).max()
        < 1e-12
    )
