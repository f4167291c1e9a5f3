"""Bending of rings, which their rigid bodies leave out: the frequency against straight beams all round, and who is told."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg as la

import rotorgear as rg
from rotorgear.analysis.common.rings import ring_notes
from rotorgear.system.system import flow_system
from tests.paths import ROOT
from tests.planetary import helical_stage


def planetary(body: str) -> rg.Model:
    text = (ROOT / "models" / "planetary.toml").read_text(encoding="utf-8")
    return rg.loads(text.replace('{ outer_diameter = "250 mm" }', body))


def ring_of_beams(E: float, area: float, inertia: float, mass: float, R: float, count: int) -> float:
    """Lowest frequency in Hz of bending of a closed polygon of Euler-Bernoulli beams in its plane, mass per length."""
    n = 3 * count
    K, M = np.zeros((n, n)), np.zeros((n, n))
    L = 2.0 * R * np.sin(np.pi / count)
    b = E * inertia / L**3
    a = E * area / L
    k = np.zeros((6, 6))
    k[np.ix_([0, 3], [0, 3])] = a * np.array([[1, -1], [-1, 1]])
    bending = b * np.array(
        [
            [12, 6 * L, -12, 6 * L],
            [6 * L, 4 * L * L, -6 * L, 2 * L * L],
            [-12, -6 * L, 12, -6 * L],
            [6 * L, 2 * L * L, -6 * L, 4 * L * L],
        ]
    )
    k[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = bending
    for e in range(count):
        angle = 2.0 * np.pi * (e + 0.5) / count + 0.5 * np.pi
        c, s = np.cos(angle), np.sin(angle)
        turn = np.kron(np.eye(2), np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]))
        dofs = np.concatenate([3 * e + np.arange(3), 3 * ((e + 1) % count) + np.arange(3)])
        K[np.ix_(dofs, dofs)] += turn.T @ k @ turn
        M[dofs[[0, 1, 3, 4]], dofs[[0, 1, 3, 4]]] += 0.5 * mass * L
        M[dofs[[2, 5]], dofs[[2, 5]]] += 1e-3 * mass * L**3
    squares = la.eigh(K, M, eigvals_only=True, subset_by_index=[0, 4])
    return float(np.sqrt(squares[3]) / (2.0 * np.pi))


@pytest.mark.parametrize("rim", [1e-3, 4e-3])
def test_the_frequency_of_a_rim_is_that_of_straight_beams_all_round(rim: float) -> None:
    model = planetary(f'{{ rim_thickness = "{1e3 * rim} mm" }}')
    geometry = model.layout.gear("ring").geometry
    assert geometry is not None
    inner = -0.5 * geometry.root_diameter
    R = inner + 0.5 * rim
    body = next(body for address, _, body in model.layout.bodies if address == "gears.ring")
    width = 0.032
    frequency = ring_of_beams(206e9, rim * width, width * rim**3 / 12.0, body.mass / (2.0 * np.pi * R), R, 160)
    (note,) = ring_notes(flow_system(model))
    assert note.part == "gears.ring"
    assert float(note.value.split()[0]) == pytest.approx(frequency, rel=6e-3)


def test_modes_above_the_bending_of_a_rim_are_warned_about_and_those_below_are_not() -> None:
    thin = rg.modal(planetary('{ rim_thickness = "1 mm" }'), modes=4)
    assert any("gears.ring: taken as rigid" in str(text) for text in thin.warnings)
    thick = rg.modal(planetary('{ rim_thickness = "25 mm" }'), modes=4)
    assert not any("taken as rigid" in str(text) for text in thick.warnings)
    assert any("bending of the rim" in str(text) for text in thick.left_out)


def test_lumped_rings_say_nothing() -> None:
    assert not list(ring_notes(flow_system(rg.loads(helical_stage(3)))))
