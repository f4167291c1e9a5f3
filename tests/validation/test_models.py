"""The models that come with the program load, and are what their comments say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.system.system import System
from tests.paths import MODELS, SHIPPED


@pytest.mark.parametrize("file", SHIPPED)
def test_a_shipped_model_loads_and_gives_its_modes_at_its_speed(file: Path) -> None:
    model = rg.load(file)
    speed = model.operating_speed
    result = rg.modal(model, speed=speed, modes=5)
    assert len(result) == min(5, rg.System(model).n)
    assert np.all(result.damping_ratio > -1e-9)
    assert model.title
    assert "schema_version = 1" in file.read_text(encoding="utf-8")


def test_the_jeffcott_rotor_runs_above_its_critical_speed_of_1190_rpm_with_1_percent_of_damping() -> None:
    model = rg.load(MODELS / "jeffcott.toml")
    result = rg.modal(model, speed="1190 rpm", modes=3)
    assert result.frequency_hz[1:] * 60 == pytest.approx([1187, 1187], abs=3)
    assert result.frequency_hz[1:] == pytest.approx([19.8, 19.8], abs=0.05)
    assert result.damping_ratio[1:] == pytest.approx([0.01, 0.01], rel=0.1)


def test_the_helical_pair_is_pushed_as_its_comment_says_and_checks_without_a_warning() -> None:
    model = rg.load(MODELS / "helical_pair.toml")
    system = System(model)
    (force,) = system.state.forces
    (mesh,) = (group.matrices.strain for group in system.groups if group.part == "meshes.stage")
    assert force.pinion_drives
    assert mesh is not None
    assert -force.normal_force * mesh[0, 0, 2] > 1000.0  # the pinion, to +z
    assert not rg.check(model).warnings


def test_the_meshes_of_the_marine_model_are_rigid_to_1_6_in_10_000() -> None:
    model = rg.load(MODELS / "marine_double_reduction.toml")
    got = 60.0 * rg.modal(model, modes=6).frequency_hz[1:]
    rigid = np.array([177.711, 220.176, 1282.585, 2496.867, 2883.382])
    assert np.all(got < rigid)
    assert np.max(1.0 - got / rigid) == pytest.approx(1.55e-4, abs=0.1e-4)
