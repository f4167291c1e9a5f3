"""Complex modes of whole models: complete, whatever the range of frequencies."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.solvers.eigen.complex_modes import complex_modes
from rotorgear.solvers.time.motion import Rotation
from rotorgear.system.local import local_model
from rotorgear.system.plan import Plan
from rotorgear.system.system import System
from tests.paths import MODELS


@pytest.mark.parametrize("name", ["helical_pair", "geared_pair", "split_torque", "backlash_pair"])
def test_modes_with_the_rigid_motions_answer_an_impulse_as_the_inertia_does(name: str) -> None:
    model = rg.load(MODELS / f"{name}.toml")
    speed = (model.operation.speed if model.operation else None) or 100.0
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
