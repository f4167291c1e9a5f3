"""Updating on rigs whose truth is known."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.rig.rig_model import RigModel
from rotorgear.errors import AnalysisError
from rotorgear.model.numbers import free_numbers
from rotorgear.system.plan import Plan
from tests.paths import MODELS

FREE = "meshes.*.stiffness, bearings.*.stiffness"
POINTS = {
    "generator_x": ("disks.generator", "x"),
    "generator_y": ("disks.generator", "y"),
    "wheel_x": ("gears.wheel", "x"),
    "wheel_y": ("gears.wheel", "y"),
    "pinion_x": ("gears.pinion", "x"),
    "pinion_y": ("gears.pinion", "y"),
}


@pytest.fixture(scope="module")
def model():
    points = {name: {"on": on, "direction": direction} for name, (on, direction) in POINTS.items()}
    return rg.load(MODELS / "geared_pair.toml").with_("points", points)


def measured(model, x, noise, *, shapes, modes=10, seed=1, elements=8):
    """What a rig with numbers times exp(x) shows: frequencies, and shapes to twice the noise."""
    random = np.random.default_rng(seed)
    mesh = Plan(elements)
    true = RigModel(free_numbers(model, FREE), mesh, 120.0, tuple(POINTS)).modes(np.asarray(x))
    f = true.frequency_hz[:modes] * np.exp(noise * random.standard_normal(modes))
    lines = tuple(rg.RigLine(float(hz), f"true {k + 1}", noise * float(hz)) for k, hz in enumerate(f))
    if not shapes:
        return rg.Measured(lines)
    rows = true.at_points[:modes]
    size = np.sqrt(np.mean(rows**2, axis=1, keepdims=True))
    # A sensor's scale and phase mean nothing.
    turned = np.exp(1j * random.uniform(0.0, 6.0, (modes, 1)))
    return rg.Measured(lines, tuple(POINTS), turned * (rows / size + 2 * noise * random.standard_normal(rows.shape)))


def test_lines_and_shapes_without_noise_give_back_every_number_that_is_learnt(model):
    x = 0.2 * np.random.default_rng(7).standard_normal(5)
    result = rg.update(model, measured(model, x, 1e-8, shapes=True), free=FREE, shape_noise=2e-8, elements=8)
    known = np.array([1.0 - row.learnt < 1e-6 for row in result.parameters])
    assert known.sum() >= 4
    estimate = np.log([row.factor for row in result.parameters])
    np.testing.assert_allclose(estimate[known], x[known], atol=1e-6)
    assert result.modal_solutions <= 20
    # As `modal` counts, the turning of the train is mode 1.
    assert all(line.rig.label == f"true {line.mode_number - 1}" for line in result.lines)
    assert min(line.mac_after for line in result.lines) > 1.0 - 1e-9
    assert result.error_held_out < result.error_before


def test_the_findings_name_a_model_that_no_numbers_of_it_can_save(model):
    rig = measured(model, np.zeros(5), 1e-3, shapes=False)
    wrong = model.with_("shafts.rotor_1.sections[1].outer_diameter", "330 mm")
    result = rg.update(wrong, rig, free="meshes.*.stiffness", prior="10 %", tolerance=0.2)
    assert result.misfit_probability < 1e-6
    assert any("the model is wrong in more than these numbers" in sentence for sentence in result.findings)
    right = rg.update(model, rig, free=FREE)
    assert right.misfit_probability > 1e-3
    assert any("nothing speaks against" in sentence for sentence in right.findings)


def test_the_table_says_what_is_not_identified(model):
    result = rg.update(model, measured(model, np.zeros(5), 5e-3, shapes=False, modes=3), free=FREE)
    unsure = [row for row in result.parameters if not row.identified]
    assert unsure
    assert "not identified" in result.text()
    assert result.learnt_parameters <= 3.0
    assert all(row.sigma <= row.prior for row in result.parameters)


def test_points_that_the_model_has_not_and_lines_far_away_are_refused(model):
    rig = measured(model, np.zeros(5), 1e-3, shapes=True)
    with pytest.raises(AnalysisError, match="no point of the model"):
        rg.update(model, rg.Measured(rig.lines, ("somewhere", *rig.points[1:]), rig.shapes), free=FREE)
    with pytest.raises(AnalysisError, match="near a mode"):
        rg.update(model, [1.0], free=FREE, tolerance=0.01)
    with pytest.raises(AnalysisError, match="one row a line"):
        rg.Measured(rig.lines, rig.points[1:], rig.shapes)


def test_what_a_rig_leaves_open_is_said(model):
    rig = measured(model, np.zeros(5), 5e-3, shapes=False)
    strange = rg.Measured((*rig.lines, rg.RigLine(400.0)))
    result = rg.update(model, strange, free=FREE, elements=8)
    assert any("without the 1 of 11 lines that have no mode" in sentence for sentence in result.findings)
    with_shapes = measured(model, np.zeros(5), 5e-3, shapes=True)
    one = rg.Measured(with_shapes.lines, with_shapes.points[:1], with_shapes.shapes[:, :1])
    assert any("a single sensor" in warning for warning in rg.update(model, one, free=FREE, elements=8).warnings)
    stiff = rg.Campaign(rig, changes={"meshes.pair.stiffness": "1.1e8 N/m"}, name="stiff")
    several = rg.update(model, campaigns=[rg.Campaign(rig), stiff], free="meshes.*.stiffness", elements=8)
    assert any("campaign stiff: meshes.pair.stiffness is free and has another value" in w for w in several.warnings)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"free": "gears.*.teeth"}, "this one is whole"),
        ({"free": "bearings.rotor_1_left.stiffness, bearings.rotor_1_left.stiffness.x"}, "it is a part of"),
        ({"free": FREE, "prior": {"bearing.*": 0.1}}, "an address of the free numbers"),
        ({"free": FREE, "rig": [10.0, 10.0]}, "is given twice"),
    ],
)
def test_numbers_and_lines_that_make_no_sense_are_refused_in_a_sentence(model, change, words):
    with pytest.raises(rg.RotorgearError, match=words):
        rg.update(model, **({"rig": [10.0, 11.0], "elements": 1} | change))


def test_shapes_measured_twice_or_without_end_are_refused_and_still_ones_are_none(model):
    rig = measured(model, np.zeros(5), 1e-3, shapes=True)
    with pytest.raises(AnalysisError, match="measured twice at generator_x"):
        rg.Measured(rig.lines, (*rig.points[:-1], rig.points[0]), rig.shapes)
    with pytest.raises(AnalysisError, match="infinite"):
        rg.Measured(rig.lines, rig.points, rig.shapes * np.inf)
    still = rig.shapes.copy()
    still[2] = 0.0
    assert np.isnan(rg.Measured(rig.lines, rig.points, still).shapes[2]).all()
