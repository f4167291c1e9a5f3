"""Derivatives of modes against a closed form and against modes solved anew."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.rig.rig_model import RigModel
from rotorgear.analysis.sensitivity.derivatives import changes_of
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import AnalysisError, ModelError
from rotorgear.model.numbers import free_numbers
from rotorgear.system.plan import Plan
from tests.paths import MODELS

FREE = "meshes.*.stiffness, bearings.*.stiffness, shafts.rotor_1.sections[1].outer_diameter, disks.generator.mass"


@pytest.fixture(scope="module")
def pair():
    model = rg.load(MODELS / "geared_pair.toml")
    points = {"a": {"on": "disks.generator", "direction": "y"}, "b": {"on": "gears.pinion", "direction": "torsion"}}
    model = model.with_("points", points)
    return RigModel(free_numbers(model, FREE), Plan(1, 3), 120.0, ("a", "b"))


def test_derivatives_of_frequencies_and_shapes_are_those_of_modes_solved_anew(pair):
    x = np.zeros(len(pair.numbers.addresses))
    modes = pair.modes(x)
    chosen = np.arange(8)
    slopes, shape_slopes = pair.derivatives(x, modes, chosen, shapes=True)
    h = 1e-4
    for j, address in enumerate(pair.numbers.addresses):
        step = np.zeros(len(x))
        step[j] = h
        high, low = pair.modes(x + step), pair.modes(x - step)
        logs = (np.log(high.frequency_hz) - np.log(low.frequency_hz))[chosen] / (2 * h)
        np.testing.assert_allclose(slopes[:, j], logs, atol=1e-6, err_msg=address)

        def along(other):
            sign = np.sign(np.sum(other.vectors * (modes.system.mass @ modes.vectors), axis=0))
            return (other.at_points * sign[:, None])[chosen]

        differences = (along(high) - along(low)) / (2 * h)
        np.testing.assert_allclose(
            shape_slopes[..., j], differences, atol=1e-5 * abs(differences).max(), err_msg=address
        )


def test_the_plane_of_two_modes_at_one_frequency_moves_as_differences_say():
    """A rotor alike along x and y: each shape is any of a plane, and what leaves the plane is what a rig can see."""
    points = {name: {"on": f"bearings.{name}", "direction": "y"} for name in ("left", "right")}
    points |= {f"{name}_x": {"on": f"bearings.{name}", "direction": "x"} for name in ("left", "right")}
    model = rg.load(MODELS / "jeffcott.toml").with_("points", points | {"disk": {"on": "disks.disk", "direction": "y"}})
    problem = RigModel(free_numbers(model, "bearings.left.stiffness"), Plan(2), 200.0, tuple(model.points))
    x = np.zeros(1)
    modes = problem.modes(x)
    first = np.arange(2)
    assert modes.eigenvalues[1] / modes.eigenvalues[0] == pytest.approx(1.0, abs=1e-9)
    _, slopes = problem.derivatives(x, modes, first, shapes=True)
    high, low = problem.modes(x + 1e-4), problem.modes(x - 1e-4)

    def projector(plane):
        Q = np.linalg.qr(plane.T)[0]
        return Q @ Q.T

    plane = modes.at_points[first]
    Q = np.linalg.qr(plane.T)[0]
    off = np.eye(len(Q)) - Q @ Q.T
    moved = off @ slopes[..., 0].T @ np.linalg.pinv(plane.T)
    differences = (projector(high.at_points[first]) - projector(low.at_points[first])) / 2e-4
    np.testing.assert_allclose(moved + moved.T, differences, atol=1e-5 * abs(differences).max())


def test_springs_by_their_energy_are_springs_by_differences(pair):
    x = np.full(len(pair.numbers.addresses), 0.1)
    modes = pair.modes(x)
    X = modes.vectors[:, :5]
    # At w = 0 what a number changes is the stiffness alone.
    own = changes_of(pair.numbers, x, modes.system, 0.0, np.zeros(5), X, shapes=True)
    h = 1e-4
    for j, address in enumerate(pair.numbers.addresses):
        step = h * np.eye(len(x))[j]
        high, low = (linear_system(pair.numbers.at(x + sign * step), [None], pair.plan) for sign in (1.0, -1.0))
        K = (high.stiffness() - low.stiffness()) @ X / (2 * h)
        np.testing.assert_allclose(own[j].forces, K, atol=1e-6 * abs(K).max(), err_msg=address)
        np.testing.assert_allclose(own[j].form, np.sum(X * K, axis=0), rtol=1e-5, atol=1e-6 * abs(own[j].form).max())


def test_all_springs_and_moduli_together_raise_every_frequency_by_half():
    # f ~ sqrt(k): a model whose every stiffness is doubled has all frequencies times sqrt 2.
    model = rg.load(MODELS / "geared_pair.toml")
    free = "meshes.*.stiffness, bearings.*.stiffness, materials.*.youngs_modulus, materials.*.shear_modulus"
    problem = RigModel(free_numbers(model, free), Plan(1, 3), 120.0)
    x = np.zeros(len(problem.numbers.addresses))
    modes = problem.modes(x)
    slopes, _ = problem.derivatives(x, modes, np.arange(6), shapes=False)
    np.testing.assert_allclose(slopes.sum(axis=1), 0.5, rtol=1e-7)


def test_numbers_are_scaled_whole_and_only_numbers():
    model = rg.load(MODELS / "split_torque.toml")
    numbers = free_numbers(model, "bearings.input_left.stiffness, meshes.stage_1a.stiffness", {"meshes.*": "10 %"})
    np.testing.assert_array_equal(numbers.prior, [0.3, 0.1])
    changed = numbers.at(np.log([2.0, 3.0]))
    old, new = (np.array(m.bearings["input_left"].stiffness.as_rows()) for m in (model, changed))
    np.testing.assert_allclose(new, 2.0 * old, rtol=1e-12)
    assert changed.meshes["stage_1a"].stiffness == pytest.approx(3.0 * model.meshes["stage_1a"].stiffness)
    assert numbers.at(np.zeros(2)) == model


@pytest.mark.parametrize(
    ("free", "prior", "text"),
    [
        ("bearings.left.stiffness", 0.3, "no 'left'"),
        ("gears.*.kind", 0.3, "only numbers can vary"),
        ("", 0.3, "addresses of numbers"),
        ("bearings.*.stiffness", "-5 %", "relative standard deviation"),
        ("bearings.*.stiffness", "many", "relative standard deviation"),
    ],
)
def test_what_has_no_spread_is_refused_with_its_address(free, prior, text):
    with pytest.raises(ModelError, match=text):
        free_numbers(rg.load(MODELS / "split_torque.toml"), free, prior)


def test_a_place_that_coincides_with_another_is_refused_with_its_address():
    numbers = free_numbers(rg.load(MODELS / "split_torque.toml"), "gears.pinion_1.width")
    problem = RigModel(numbers, Plan(1, 2), 1000.0)
    modes = problem.modes(np.zeros(1))
    with pytest.raises(AnalysisError, match=r"gears\.pinion_1\.width: a change moves a place away"):
        problem.derivatives(np.zeros(1), modes, np.arange(3), shapes=False)
