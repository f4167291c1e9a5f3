"""Complex modes of whole models: complete, whatever the range of frequencies."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp

import rotorgear as rg
from rotorgear.solvers.eigen.complex_modes import complex_modes
from rotorgear.solvers.time.local_system import Rotation
from rotorgear.system.local import local_model
from rotorgear.system.plan import Plan
from rotorgear.system.system import System
from tests.paths import MODELS


@pytest.mark.parametrize("name", ["helical_pair", "geared_pair", "split_torque", "backlash_pair"])
def test_modes_with_the_rigid_motions_answer_an_impulse_as_the_inertia_does(name: str) -> None:
    model = rg.load(MODELS / f"{name}.toml")
    speed = (model.operating_speed) or 100.0
    system = local_model(System(model, plan=Plan(elements=1, order=2)), Rotation.constant(speed), speed).local
    D = system.velocity_terms(speed) + (system.damping_about - system.D)
    found = complex_modes(system.M, D, system.stiffness_about, system.B.toarray())
    gains = found.gains @ found.basis.T
    inverse = np.linalg.inv(system.M.toarray())
    size = np.sqrt(np.outer(np.diag(inverse), np.diag(inverse)))
    # Velocity after a unit impulse: M^-1, from all modes together; displacement: none yet.
    velocity = np.real((found.shapes * found.s) @ gains) + found.rigid @ found.rigid.T
    assert np.abs((velocity - inverse) / size).max() < 1e-9
    assert np.abs(np.real(found.shapes @ gains)).max() < 1e-9 * (np.abs(found.shapes) @ np.abs(gains)).max()
    vectors = np.hstack([found.rigid, found.basis])
    assert vectors.T @ (system.M @ vectors) == pytest.approx(np.eye(system.n), abs=1e-8)


@pytest.mark.parametrize("ratio", [0.0, 0.03, 0.3])
def test_a_modal_ratio_makes_every_mode_decay_at_that_ratio_of_its_frequency(ratio: float) -> None:
    M = np.diag([1.0, 2.0, 0.5])
    K = np.array([[700.0, -300.0, 0.0], [-300.0, 500.0, -200.0], [0.0, -200.0, 900.0]])
    own = 1e-4 * K  # beside the damping of the structure itself
    matrices = [sp.csc_array(A) for A in (M, own, K)]
    found = complex_modes(*matrices, np.eye(3), modal_ratio=ratio)
    w = np.sqrt(la.eigvalsh(K, M))
    rate = (ratio + 0.5e-4 * w) * w
    assert np.sort(-found.s.real) == pytest.approx(np.sort(rate), rel=1e-9)
    assert np.sort(np.abs(found.s)) == pytest.approx(w, rel=1e-9)
