"""Offset halves, tilting pads and thrust pads against an independent solution of Reynolds' equation by finite elements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from rotorgear.forces.journal_film import JournalFilm
from rotorgear.forces.thrust_film import ThrustFilm
from rotorgear.forces.tilting_pads import TiltingPads
from tests.unit.forces.reynolds_elements import Pad

R, L, C, MU, SPEED = 0.05, 0.05, 1e-4, 0.02, 500.0
CELLS = (48, 12)


def journal_force(pads, own: float, preload: float, d, v, cells=CELLS) -> np.ndarray:
    """Force on pads (start, extent, place of the least gap), by elements over the whole length."""
    total = np.zeros(2)
    for start, extent, least in pads:
        grid = Pad((start, start + extent), (-0.5 * L, 0.5 * L), *cells, radius=R)
        p = grid.pressure(
            lambda t, s, q=least: own - d[0] * np.cos(t) - d[1] * np.sin(t) - preload * own * np.cos(t - q),
            lambda t, s, q=least: d[0] * np.sin(t) - d[1] * np.cos(t) + preload * own * np.sin(t - q),
            lambda t, s: v[0] * np.cos(t) + v[1] * np.sin(t),
            MU,
            SPEED,
        )
        total += grid.moments(p, lambda t, s: np.cos(t), lambda t, s: np.sin(t))
    return total


def quotients(force, d, step, speed):
    """K and C of a force (d, v) by central differences."""
    K = [(force(d + step * e, 0 * d) - force(d - step * e, 0 * d)) / (2 * step) for e in np.eye(len(d))]
    C = [(force(d, speed * e) - force(d, -speed * e)) / (2 * speed) for e in np.eye(len(d))]
    return np.column_stack(K), np.column_stack(C)


def test_offset_halves_have_force_stiffness_and_damping_of_finite_elements():
    law = JournalFilm(
        MU, R, L, C, lobes=2, arc=np.radians(160.0), at=np.pi / 2, preload=0.5, offset=1.0, around=200, along=12
    )
    d = np.array([-2e-5, -4e-5])
    starts = [np.pi / 2 - np.radians(80.0), -np.pi / 2 - np.radians(80.0)]
    pads = [(start, np.radians(160.0), start + np.radians(160.0)) for start in starts]

    def by_elements(d, v):
        return journal_force(pads, C / 0.5, 0.5, d, v)

    here = law.evaluate(d, speed=SPEED)
    F = by_elements(d, np.zeros(2))
    np.testing.assert_allclose(here.force, F, atol=0.01 * np.abs(F).max())
    K, D = quotients(by_elements, d, 1e-7, 1e-3)
    np.testing.assert_allclose(here.in_displacement, K, atol=0.02 * np.abs(K).max())
    np.testing.assert_allclose(here.in_velocity, D, atol=0.02 * np.abs(D).max())


@pytest.mark.parametrize("pivot", [0.5, 0.6])
def test_a_tilting_pad_has_its_synchronous_stiffness_and_damping_from_finite_elements(pivot):
    """One loaded pad at the bottom: its tilt from F_t = 0, then Z_rr - Z_rt Z_tr/Z_tt with difference quotients."""
    arc, preload = np.radians(60.0), 0.3
    law = TiltingPads(
        MU, R, L, C, pads=5, arc=arc, at=-np.pi / 2, pivot=pivot, preload=preload, around=240, along=12
    ).settled(np.zeros(2))
    own = C / (1.0 - preload)
    d = np.array([0.0, -6e-5])
    Z = np.zeros((2, 2), complex)
    F = np.zeros(2)
    loaded = 0
    for q in -np.pi / 2 + 2.0 * np.pi * np.arange(5) / 5:
        e = np.array([np.cos(q), np.sin(q)])
        pad = [(-pivot * arc, arc, 0.0)]

        def local(x, v, pad=pad):
            return journal_force(pad, own, preload, x, v)

        xi = float(e @ d)
        trailing = (1.0 - pivot) * arc
        most = (own - (xi + preload * own) * np.cos(trailing)) / np.sin(trailing)

        def moment(eta, xi=xi, local=local):
            return local(np.array([xi, eta]), np.zeros(2))[1]

        # From where the trailing edge is nearly closed, where the film presses behind the pivot, to where it presses before it:
        # of tilts that balance the largest, which is the loaded one of a pad that the journal moved away from.
        tilts = most - own * np.array([0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0])
        before = next((eta for eta in tilts if moment(eta) < 0.0), None)
        if before is None:
            continue  # nothing presses it: its gap closes towards both edges
        loaded += 1
        eta = brentq(moment, before, tilts[0], xtol=1e-13)
        K, D = quotients(local, np.array([xi, eta]), 1e-7, 1e-3)
        z = K + 1j * SPEED * D
        Z += (z[0, 0] - z[0, 1] * z[1, 0] / z[1, 1]) * np.outer(e, e)
        F += local(np.array([xi, eta]), np.zeros(2))[0] * e
    assert loaded == (3 if pivot == 0.5 else 5)
    about = law.linearised(d, speed=SPEED)
    np.testing.assert_allclose(about.force, F, atol=0.01 * np.abs(F).max())
    np.testing.assert_allclose(about.stiffness, Z.real, atol=0.03 * np.abs(Z.real).max())
    np.testing.assert_allclose(about.damping, Z.imag / SPEED, atol=0.03 * np.abs(Z.imag).max() / SPEED)


def test_thrust_pads_have_force_stiffness_and_damping_of_finite_elements():
    arc, taper = 0.9, 40e-6
    law = ThrustFilm(
        0.03, 40e-3, 70e-3, 60e-6, pads=1, arc=arc, taper=taper, taper_share=0.75, acts="+z", around=40, across=16
    )
    grid = Pad((-0.5 * arc, 0.5 * arc), (40e-3, 70e-3), 40, 16)
    fields = (lambda t, r: np.ones_like(t), lambda t, r: r * np.sin(t), lambda t, r: -r * np.cos(t))

    def by_elements(q, v):
        def closed(t, r, by):
            return sum(b * f(t, r) for b, f in zip(by, fields, strict=True))

        length = 0.75 * arc
        p = grid.pressure(
            lambda t, r: 60e-6 + taper * np.maximum(1.0 - (t + 0.5 * arc) / length, 0.0) - closed(t, r, q),
            lambda t, r: (
                np.where(t + 0.5 * arc < length, -taper / length, 0.0) - (q[1] * r * np.cos(t) + q[2] * r * np.sin(t))
            ),
            lambda t, r: closed(t, r, v),
            0.03,
            SPEED,
        )
        return grid.moments(p, *fields)

    q = np.array([10e-6, 1e-4, -5e-5])
    here = law.evaluate(np.concatenate([[0.0, 0.0], q]), speed=SPEED)
    F = by_elements(q, np.zeros(3))
    np.testing.assert_allclose(here.force[2:], F, atol=0.01 * np.abs(F).max())
    size = np.array([1.0, 0.055, 0.055])  # tilts at the mean radius
    scale = np.outer(size, size)
    step = 1e-7
    K = (
        np.column_stack(
            [
                (by_elements(q + step * e, 0 * q) - by_elements(q - step * e, 0 * q)) / (2 * step)
                for e in np.diag(1 / size)
            ]
        )
        * size
    )
    D = (
        np.column_stack([(by_elements(q, 1e-4 * e) - by_elements(q, -1e-4 * e)) / 2e-4 for e in np.diag(1 / size)])
        * size
    )
    for found, exact in ((here.in_displacement[2:, 2:], K), (here.in_velocity[2:, 2:], D)):
        np.testing.assert_allclose(found / scale, exact / scale, atol=0.01 * np.abs(exact / scale).max())


def test_a_plain_bearing_with_a_fixed_inlet_has_the_force_of_finite_elements():
    law = JournalFilm(MU, R, L, C, inlet=2.0)
    d = np.array([3e-5, -5e-5])
    F = journal_force([(2.0, 2.0 * np.pi, 0.0)], C, 0.0, d, np.zeros(2), (120, 12))
    np.testing.assert_allclose(replace(law).evaluate(d, speed=SPEED).force, F, atol=0.01 * np.abs(F).max())
