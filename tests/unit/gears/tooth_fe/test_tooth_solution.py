"""Displacements and stresses inside the teeth: the same flanks as the condensed model, exact stresses, equilibrium."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.gears.geometry.blank import BlankShape
from rotorgear.gears.tooth_fe.compliance_model import ComplianceKey, compliance_key, gear_compliance
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.gears.tooth_fe.tooth_solution import ToothInside
from tests.unit.gears.tooth_pairs import COARSE, helical, spur

WEBBED = BlankShape(30e-3, 67e-3, 15e-3, 5e-3, 40e-3, 54e-3)


def key_of(body: str, *, space: bool) -> ComplianceKey:
    teeth = helical() if space else spur()
    fe = ToothFe(body=body, size=COARSE if space else None)  # type: ignore[arg-type]
    return compliance_key(teeth.first, fe, 0.3, teeth.width, 30e-3, space=space, blank=WEBBED)


@pytest.mark.parametrize(
    ("body", "space"),
    [
        ("rim", False),
        ("rim", True),
        ("ring", False),
        ("ring", True),
        pytest.param("wheel", True, marks=pytest.mark.long),
    ],
)
def test_the_flanks_move_as_the_condensed_compliance_says(body: str, space: bool) -> None:
    key = key_of(body, space=space)
    compliance = gear_compliance(key)
    n = compliance.flexibility.shape[1]
    rng = np.random.default_rng(2)
    loads = {tooth: -rng.random(n) for tooth in (0, 1)}
    inside = ToothInside(key)
    for tooth, u in zip(*inside.solve(loads), strict=True):
        normal = np.sum(u[inside.pitch.flank] * inside.pitch.normal, axis=1)
        expected = sum(compliance.response(int(tooth) - k) @ force for k, force in loads.items())
        # In an arc that is held at its ends reciprocity was made exact, which moves entries by half of what it was off.
        moved = (
            0.5
            * compliance.asymmetry
            * np.abs(compliance.flexibility).max()
            * sum(np.abs(f).sum() for f in loads.values())
        )
        assert np.abs(normal - expected).max() <= (moved if body == "rim" else 0.0) + 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("space", [False, True])
def test_a_uniform_strain_has_its_stress_everywhere(space: bool) -> None:
    pitch = ToothInside(key_of("rim", space=space)).pitch
    d = pitch.dimension
    gradient = 1e-3 * np.random.default_rng(3).normal(size=(d, d))
    mises, largest = pitch.stress(pitch.points @ gradient.T)
    strain = np.zeros((3, 3))
    strain[:d, :d] = 0.5 * (gradient + gradient.T)
    stress = strain / 1.3 + 0.3 / (1.3 * 0.4) * np.trace(strain) * np.eye(3)
    deviator = stress - np.trace(stress) / 3.0 * np.eye(3)
    assert largest == pytest.approx(np.full(len(largest), np.linalg.eigvalsh(stress)[-1]), rel=1e-8)
    assert mises == pytest.approx(np.full(len(mises), np.sqrt(1.5 * np.sum(deviator**2))), rel=1e-8)


def _flank(space: bool) -> int:
    return int(gear_compliance(key_of("rim", space=space)).flexibility.shape[1])


@pytest.mark.parametrize("space", [False, True])
def test_inside_the_teeth_forces_balance(space: bool) -> None:
    key = key_of("rim", space=space)
    loads = {0: -np.random.default_rng(4).random(_flank(space))}
    inside_teeth = ToothInside(key)
    pitch = inside_teeth.pitch
    d = pitch.dimension
    held = np.concatenate([pitch.left, pitch.right, pitch.inner])
    for tooth, u in zip(*inside_teeth.solve(loads), strict=True):
        force = (pitch.stiffness @ u.ravel()).reshape(-1, d)
        if int(tooth) in loads:
            force[pitch.flank] -= loads[int(tooth)][:, None] * pitch.normal
        inside = np.setdiff1d(np.arange(len(force)), held)
        assert np.abs(force[inside]).max() <= 1e-8


@pytest.mark.parametrize("space", [False, True])
def test_the_whole_pitch_does_not_resist_rigid_motion(space: bool) -> None:
    pitch = ToothInside(key_of("rim", space=space)).pitch
    d = pitch.dimension
    x = pitch.points
    motions = [np.tile(direction, (len(x), 1)) for direction in np.eye(d)]
    spins = [(0, 1)] if d == 2 else [(0, 1), (1, 2), (0, 2)]
    for i, j in spins:
        turned = np.zeros_like(x)
        turned[:, i] = -x[:, j]
        turned[:, j] = x[:, i]
        motions.append(turned)
    scale = abs(pitch.stiffness).max()
    for motion in motions:
        assert np.abs(pitch.stiffness @ motion.ravel()).max() <= 1e-11 * scale * np.abs(motion).max()
