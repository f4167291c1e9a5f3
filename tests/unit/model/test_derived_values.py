"""Derived values are kept by a part for as long as it lives, and never copied, compared or pickled."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.model.layout.layout import Layout
from rotorgear.model.model import Model

Data = dict[str, Any]


def asked(model: Model) -> Model:
    """The model after it was asked for everything that it derives."""
    assert all(gear.geometry for gear in model.gears.values())
    assert all(mesh.pair and mesh.contacts for mesh in model.layout.meshes)
    assert model.torque_flow(1).phases
    return model


def test_a_copy_of_a_gear_with_other_teeth_has_their_geometry(pair: Data) -> None:
    gear = asked(Model(**pair)).gears["pinion"]
    other = gear.model_copy(update={"teeth": 48})
    assert gear.geometry is not None
    assert other.geometry is not None
    assert other.geometry.base_radius == pytest.approx(2.0 * gear.geometry.base_radius, rel=1e-14)


def test_a_copy_of_a_model_with_another_gear_has_its_train_contacts_and_forces(pair: Data) -> None:
    model = asked(Model(**pair))
    pair["gears"]["pinion"]["teeth"] = 25
    pair["gears"]["wheel"]["teeth"] = 71
    fresh = Model(**pair)
    changed = model.model_copy(update={"gears": fresh.gears})
    assert changed.layout.train.ratio("output") == fresh.layout.train.ratio("output") == -25 / 71
    assert changed.layout.mesh("stage").contacts == fresh.layout.mesh("stage").contacts
    assert changed.torque_flow().forces == fresh.torque_flow().forces
    assert changed.torque_flow().forces != model.torque_flow().forces


@pytest.mark.parametrize("twin", [copy.copy, copy.deepcopy, lambda model: pickle.loads(pickle.dumps(model))])
def test_copies_carry_fields_only(pair: Data, twin: Any) -> None:
    model = asked(Model(**pair))
    other = twin(model)
    assert other.__dict__.keys() == type(model).model_fields.keys()
    assert other == model
    assert other.torque_flow().forces == model.torque_flow().forces


def test_models_and_parts_are_equal_whatever_they_have_derived(pair: Data) -> None:
    model = asked(Model(**pair))
    fresh = Model(**pair)
    assert fresh == model
    assert fresh.model_copy(update={"title": "other"}) != model
    assert fresh.gears["pinion"] != fresh.gears["wheel"]


def test_a_model_pickles_no_larger_after_an_analysis(pair: Data) -> None:
    model = Model(**pair)
    before = pickle.dumps(model)
    first = rg.modal(model, modes=6, elements=1)
    after = pickle.dumps(model)
    assert len(after) == len(before)
    again = rg.modal(pickle.loads(after), modes=6, elements=1)
    assert np.array_equal(first.frequency_hz, again.frequency_hz)


def test_a_layout_goes_to_another_process_as_its_model(pair: Data) -> None:
    model = asked(Model(**pair))
    other = pickle.loads(pickle.dumps(model.layout))
    assert isinstance(other, Layout)
    assert other.mesh("stage").contacts == model.layout.mesh("stage").contacts
