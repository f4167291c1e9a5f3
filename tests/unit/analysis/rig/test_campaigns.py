"""Updates at a speed and by several campaigns, on rigs whose truth is known; derivatives of rotating modes."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.rig.rig_model import RigModel
from rotorgear.errors import AnalysisError, ModelError
from rotorgear.model.numbers import free_numbers
from rotorgear.system.plan import Plan
from tests.paths import MODELS

FREE = "meshes.*.stiffness, bearings.*.stiffness"
POINTS = {
    f"{name}_{direction}": {"on": part, "direction": direction}
    for name, part in {"generator": "disks.generator", "coupling": "disks.coupling", "pinion": "gears.pinion"}.items()
    for direction in "xy"
}
SPEED = 300.0
HEAVY = {"disks.coupling.mass": "1500 kg"}


@pytest.fixture(scope="module")
def model():
    return rg.load(MODELS / "geared_pair.toml").with_("points", POINTS)


def measured(model, x, noise, *, speed=0.0, seed=1, modes=10, shapes=True):
    """What a rig with numbers times exp(x) shows; its shapes have any scale and phase."""
    random = np.random.default_rng(seed)
    true = RigModel(free_numbers(model, FREE), Plan(1), 120.0, tuple(POINTS), speed).modes(x)
    hz = true.frequency_hz[:modes] * np.exp(noise * random.standard_normal(modes))
    lines = tuple(rg.RigLine(float(f), f"true {k + 1}", noise * float(f)) for k, f in enumerate(hz))
    if not shapes:
        return rg.Measured(lines)
    y = np.asarray(true.at_points[:modes], dtype=complex)
    y = y / np.sqrt(np.mean(np.abs(y) ** 2, axis=1, keepdims=True))
    parts = random.standard_normal((2, *y.shape)) * (
        1.0 / np.sqrt(2.0) if speed else np.array([1.0, 0.0])[:, None, None]
    )
    turned = np.exp(1j * random.uniform(0.0, 6.0, (modes, 1)))
    return rg.Measured(lines, tuple(POINTS), turned * (y + 2 * noise * (parts[0] + 1j * parts[1])))


def test_derivatives_of_rotating_modes_are_those_of_modes_solved_anew(model):
    numbers = free_numbers(model, f"{FREE}, shafts.rotor_1.sections[1].outer_diameter, disks.generator.mass")
    problem = RigModel(numbers, Plan(1, 3), 120.0, tuple(POINTS), SPEED)
    x = np.zeros(len(numbers.addresses))
    modes = problem.modes(x)
    chosen = np.arange(8)
    slopes, moved = problem.derivatives(x, modes, chosen, shapes=True)

    def projector(v):
        return np.outer(v, v.conj()) / np.vdot(v, v)

    h = 1e-4
    for j, address in enumerate(numbers.addresses):
        step = h * np.eye(len(x))[j]
        high, low = problem.modes(x + step), problem.modes(x - step)
        logs = (np.log(high.frequency_hz) - np.log(low.frequency_hz))[chosen] / (2 * h)
        np.testing.assert_allclose(slopes[:, j], logs, atol=1e-6, err_msg=address)
        for k in chosen:
            v = modes.at_points[k]
            P = projector(v)
            across = (np.eye(len(v)) - P) @ np.outer(moved[k, :, j], v.conj()) / np.vdot(v, v)
            differences = (projector(high.at_points[k]) - projector(low.at_points[k])) / (2 * h)
            np.testing.assert_allclose(across + across.conj().T, differences, atol=1e-5, err_msg=address)


def test_shapes_at_a_speed_give_back_every_number(model):
    x = 0.2 * np.random.default_rng(7).standard_normal(5)
    rig = measured(model, x, 1e-8, speed=SPEED)
    result = rg.update(model, rig, free=FREE, speed=SPEED, shape_noise=2e-8, elements=1)
    np.testing.assert_allclose(np.log([row.factor for row in result.parameters]), x, atol=1e-6)
    assert result.modal_solutions <= 20
    # What `left_out` says at rest is no idle word: taken for lines at rest, the same lines fit no numbers.
    lines = [rg.RigLine(line.frequency_hz, "", 1e-3 * line.frequency_hz) for line in rig.lines]
    resting = rg.update(model, lines, free="meshes.*.stiffness", elements=1)
    assert any("damping and rotation" in sentence for sentence in resting.left_out)
    assert not any("rotation" in sentence for sentence in result.left_out)
    assert resting.misfit_probability < 1e-6


def test_campaigns_at_speeds_and_in_states_share_their_numbers(model):
    x = 0.2 * np.random.default_rng(7).standard_normal(5)
    few = {"modes": 4, "noise": 1e-8}
    campaigns = [
        rg.Campaign(measured(model, x, **few), name="at rest"),
        rg.Campaign(measured(model, x, speed=SPEED, seed=2, **few), speed=SPEED, name="turning"),
        rg.Campaign(measured(model.with_(HEAVY), x, seed=3, **few), changes=HEAVY, name="heavy"),
    ]
    result = rg.update(model, campaigns=campaigns, free=FREE, shape_noise=2e-8, elements=1)
    np.testing.assert_allclose(np.log([row.factor for row in result.parameters]), x, atol=1e-6)
    assert [line.campaign for line in result.lines] == ["at rest"] * 4 + ["turning"] * 4 + ["heavy"] * 4
    # Modes have the numbers of `modal`, where the train's turning is the first.
    changes = {"": {}, "at rest": {}, "turning": {"operation.speed": SPEED}, "heavy": HEAVY}
    for line in result.lines:
        there = rg.modal(
            result.updated_model().with_(changes[line.campaign]),
            speed=SPEED if line.campaign == "turning" else None,
            elements=1,
        )
        assert there.natural_frequency_hz[line.mode_number - 1] == pytest.approx(line.after_hz, rel=1e-3)
    assert result.model == model
    assert "turning" in result.text()
    # More campaigns teach more: none of them alone knows what all do.
    plain = {"modes": 4, "noise": 3e-3, "shapes": False}
    lines = [
        rg.Campaign(measured(model, x, **plain)),
        rg.Campaign(measured(model, x, speed=SPEED, **plain), speed=f"{SPEED} rad/s"),
    ]
    together = rg.update(model, campaigns=lines, free=FREE, elements=1).learnt_parameters
    assert together > rg.update(model, campaigns=lines[:1], free=FREE, elements=1).learnt_parameters


def test_a_file_of_campaigns_names_files_beside_it_and_its_mistakes(model, tmp_path):
    (tmp_path / "rest.csv").write_text("frequency_hz\n10.7\n11.3\n17.5\n")
    file = tmp_path / "campaigns.toml"
    file.write_text(
        '[[campaign]]\nrig = "rest.csv"\n[[campaign]]\nrig = "rest.csv"\nspeed = "10 rpm"\nname = "slow"\n'
        'changes = { "disks.coupling.mass" = "120 kg" }\n'
    )
    first, second = rg.read_campaigns(file)
    assert (first.name, second.name, second.speed) == ("campaign 1", "slow", "10 rpm")
    found = rg.update(model, campaigns=(first, second), free="meshes.*.stiffness", elements=1)
    assert {line.campaign for line in found.lines} == {"campaign 1", "slow"}
    for text, words in [
        ("campaign = 3", "expected tables"),
        ('[[campaign]]\nrigs = "rest.csv"', "only name, rig"),
        ("[[campaign]]\nrig = 3", "a text"),
        ('[[campaign]]\nrig = "rest.csv"\nchanges = 3', "a table of addresses"),
        ("[[campaign", "no file of campaigns"),
    ]:
        file.write_text(text)
        with pytest.raises(ModelError, match=words):
            rg.read_campaigns(file)
    with pytest.raises(AnalysisError, match="campaigns have their own"):
        rg.update(model, campaigns=[first], speed=3.0)
    with pytest.raises(AnalysisError, match="no campaigns"):
        rg.update(model, campaigns=[])
    with pytest.raises(AnalysisError, match="give what was measured"):
        rg.update(model, campaigns=[rg.Campaign()])
    with pytest.raises(ModelError, match="coupling"):
        rg.update(model, campaigns=[rg.Campaign([10.0], changes={"disks.couplin.mass": 1.0})])
