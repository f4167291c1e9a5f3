"""The least of the contact energy: conditions, an independent minimiser, tangents in approach and tilt, any load."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.optimize as so

from rotorgear.gears.loaded.loaded_contact import PositionContact, hertz_half_width, moment_and_tangents, solve_contact

E = 206e9
NU = 0.3
K = 2.0 * (1.0 - NU**2) / (np.pi * E)
MODULUS = E / (2.0 * (1.0 - NU**2))
LENGTH = 2e-3
RADIUS = 20e-3
PATCH = 1.5e-3


def face(slices: int = 12, seed: int = 0) -> PositionContact:
    """Slices of a contact line on a body that bends: neighbours feel each other, and their gaps are uneven."""
    z = _places(slices)
    bending = 4e-10 * np.exp(-np.abs(z[:, None] - z) / 8e-3)
    gap = np.random.default_rng(seed).uniform(0.0, 6e-6, slices)
    return PositionContact(
        compliance=bending + 1e-10 * np.eye(slices),
        gap=gap,
        length=np.full(slices, LENGTH),
        local=np.full(2, K),
        log_width=np.full((slices, 2), np.log(PATCH)),
        radius=np.full(slices, RADIUS),
        modulus=MODULUS,
    )


def _places(slices: int) -> np.ndarray:
    return LENGTH * (np.arange(slices) - 0.5 * (slices - 1))


def added(contact: PositionContact, force: np.ndarray) -> np.ndarray:
    """g(F), written down anew: two bodies with the same patch."""
    load = force / contact.length
    a = hertz_half_width(load, contact.radius, contact.modulus)
    return 2.0 * K * load * (0.25 + np.log(PATCH) - np.log(np.maximum(a, 1e-30)))


@pytest.mark.parametrize("load", [1.0, 1e2, 1e4])
@pytest.mark.parametrize("seed", range(4))
def test_slices_in_contact_touch_and_no_others_overlap(load: float, seed: int) -> None:
    contact = face(seed=seed)
    state = solve_contact(contact, load)
    opening = contact.compliance @ state.force + added(contact, state.force) + contact.gap - state.approach
    assert state.force.sum() == pytest.approx(load, rel=1e-12)
    assert state.force.min() >= 0.0
    assert np.abs(opening[state.force > 0.0]).max() <= 1e-12 * state.approach
    assert opening.min() >= -1e-12 * state.approach


def test_no_other_distribution_has_less_energy() -> None:
    contact = face(6)
    load = 3e3

    def energy(share: np.ndarray) -> float:
        F = load * share
        # Integral of g: K F'^2/2 (3/4 - 1/4 + ln(c/a)) for each body and unit of length.
        a = hertz_half_width(F / LENGTH, contact.radius, contact.modulus)
        strips = K * F**2 / LENGTH * (0.5 + np.log(PATCH) - np.log(np.maximum(a, 1e-30)))
        return float(0.5 * F @ contact.compliance @ F + strips.sum() + contact.gap @ F) / (load * 1e-6)

    even = np.full(6, 1.0 / 6.0)
    whole = {"type": "eq", "fun": lambda share: share.sum() - 1.0}
    least = so.minimize(
        energy, even, bounds=[(0.0, 1.0)] * 6, constraints=whole, method="SLSQP", options={"ftol": 1e-15}
    )
    state = solve_contact(contact, load)
    assert energy(state.force / load) <= least.fun * (1.0 + 1e-12)
    assert state.force / load == pytest.approx(least.x, abs=1e-5)


@pytest.mark.parametrize("load", [1e-3, 1e5, 1e7])
def test_every_load_has_its_solution_even_wider_than_the_patches(load: float) -> None:
    state = solve_contact(face(), load)
    assert state.residual <= 1e-12 * state.approach


def test_the_start_does_not_matter() -> None:
    contact = face(seed=3)
    cold = solve_contact(contact, 2e3)
    warm = solve_contact(contact, 2e3, solve_contact(contact, 40.0).force)
    assert warm.force == pytest.approx(cold.force, abs=1e-9 * 2e3)


def test_more_approach_always_takes_more_load() -> None:
    contact = face(seed=1)
    states = [solve_contact(contact, load) for load in np.geomspace(1.0, 1e6, 60)]
    approach = np.array([state.approach for state in states])
    assert np.all(np.diff(approach) > 0.0)
    assert min(state.tangent for state in states) > 0.0


def test_force_and_moment_follow_approach_and_tilt() -> None:
    z = _places(12)
    contact = face(seed=2)
    load = 4e3

    def at(total: float, tilt: float) -> tuple[np.ndarray, float]:
        leaning = replace(contact, gap=contact.gap + tilt * z)
        state = solve_contact(leaning, total)
        return np.array([total, moment_and_tangents(leaning, state, z)[0]]), state.approach

    moment, slope = moment_and_tangents(contact, solve_contact(contact, load), z)
    assert moment == pytest.approx(at(load, 0.0)[0][1], rel=1e-12)
    assert slope[0, 1] == pytest.approx(-slope[1, 0], rel=1e-12)
    assert slope[0, 0] == pytest.approx(solve_contact(contact, load).tangent, rel=1e-12)
    # Two small changes of (force, tilt) give two changes of (F, M) and of (delta, tilt).
    step = 1e-5
    for total, tilt in ((step * load, 0.0), (0.0, step * 1e-4)):
        (plus, far), (minus, near) = at(load + total, tilt), at(load - total, -tilt)
        assert slope @ np.array([far - near, 2.0 * tilt]) == pytest.approx(plus - minus, rel=1e-5, abs=1e-8 * load)
