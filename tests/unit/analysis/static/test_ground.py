"""Torsional springs to ground on turning shafts carry no mean torque: in statics, responses and in time."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.transient.request import prepare
from tests.models import lumped_gear
from tests.paths import MODELS


def test_statics_response_and_transient_have_one_mean_force() -> None:
    model = rg.load(MODELS / "split_torque.toml").with_("unbalances", {})
    still = rg.static(model)
    shaken = rg.response(model, speeds=[100.0], modal_damping=0.05, elements=1)
    task = prepare(model, "1000 rpm", None)
    assert shaken.mean_force == pytest.approx(still.mesh_force, rel=1e-9)
    assert np.asarray(task.rest_force) == pytest.approx(still.mesh_force, rel=1e-9)
    said = [
        note
        for note in shaken.left_out
        if "mean torque in the torsional stiffness to ground; the loads hold it" in note
    ]
    assert [note.part for note in said] == ["supports.drive", "supports.brake"]


def pair() -> rg.Model:
    return rg.Model(
        motions=["torsion"],
        operation={"input_shaft": "1", "speed": 100.0},
        shafts={"1": {}, "2": {}},
        gears={"p": lumped_gear("1", 0.06, teeth=24), "g": lumped_gear("2", 0.15, teeth=60)},
        meshes={"m": {"pinion": "p", "gear": "g", "stiffness": 4e8, "centre_line_angle": 0.0, "pressure_angle": 0.4}},
        loads={"in": {"shaft": "1", "kind": "input", "torque": 1000.0}, "out": {"shaft": "2", "kind": "output"}},
        supports={"ground": {"shaft": "2", "at": "start", "stiffness": {"torsion": 1e6}}},
    )


def test_the_spring_still_acts_on_vibration() -> None:
    task = prepare(pair(), 100.0, None)
    assert np.asarray(task.rest_force) == pytest.approx([1000.0 / 0.06], rel=1e-9)
    K = task.local.local.K.toarray()
    assert K[1, 1] == pytest.approx(1e6)
    # At rest it carries nothing: what it puts on the shaft is taken back by the load.
    assert task.local.local.load[1] - (K @ task.rest.q)[1] == pytest.approx(1000.0 * 0.15 / 0.06, rel=1e-9)
