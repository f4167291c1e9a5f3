"""The state is an object of its own: a model is what its file says after every verb, and nothing found hides in it."""

from __future__ import annotations

import ast
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.static.state_at import state_at
from rotorgear.model.layout.spring import constant_spring
from tests.paths import MODELS, ROOT

PACKAGE = ROOT / "rotorgear"


def calls(folder: Path, name: str) -> list[str]:
    """Where something is called by this name."""
    return [
        f"{file.relative_to(PACKAGE)}:{node.lineno}"
        for file in sorted(folder.rglob("*.py"))
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] == name
    ]


def test_no_part_of_a_model_keeps_what_an_analysis_found() -> None:
    assert calls(PACKAGE / "model", "PrivateAttr") == []


def test_analyses_assemble_a_system_and_change_a_model_in_few_places() -> None:
    assert len(calls(PACKAGE / "analysis", "System")) <= 4
    assert len(calls(PACKAGE / "analysis", "model_copy")) <= 4


def askew() -> rg.Model:
    """A helical pair of unlike gears whose teeth feel the tilt, on one soft oil film and unlike springs."""
    film = {
        "diameter": "44 mm",
        "length": "28 mm",
        "clearance": "31 um",
        "oil": "VG 46",
        "inlet_temperature": "41 degC",
    }
    return rg.load(MODELS / "helical_pair.toml").with_(
        {
            "meshes.stage.tilt": True,
            "meshes.stage.stiffness": "iso",
            "bearings.input_right": {"shaft": "input", "at": "62 mm", "journal": {**film, "around": 60, "along": 4}},
        }
    )


VERBS: dict[str, Callable[[rg.Model], Any]] = {
    "static": lambda model: rg.static(model, elements=1),
    "modal": lambda model: rg.modal(model, modes=6, elements=1),
    "modal at a speed": lambda model: rg.modal(model, modes=6, elements=1, speed="2500 rpm"),
    "campbell": lambda model: rg.campbell(model, modes=4, points=3, start="2000 rpm", elements=1),
    "critical": lambda model: rg.critical(
        model, elements=1, start="2000 rpm", stop="4000 rpm", shaft_orders=(1.0,), mesh_orders=()
    ),
    "critical map": lambda model: rg.critical_map(model, stiffness=[3e7, 4e8], elements=1),
    "frf": lambda model: rg.frf(
        model, [300.0], inputs=["gears.pinion:x"], outputs=["gears.wheel:y"], elements=1, speed="2900 rpm"
    ),
    "response": lambda model: rg.response(
        model.with_("meshes.stage.transmission_error", [{"harmonic": 1, "amplitude": "1 um"}]),
        speeds=["2900 rpm"],
        elements=1,
    ),
    "transient": lambda model: rg.transient(model, time=0.002, steps=20, error_estimate=False),
    "bearing": lambda model: rg.bearing(model, "input_right"),
    "update": lambda model: rg.update(
        model,
        [float(f) for f in rg.modal(model, modes=8, elements=1).frequency_hz if f > 1.0],
        free="bearings.output_left.stiffness",
        elements=1,
    ),
    "scatter": lambda model: rg.scatter(
        model, "meshes.stage.misalignment", sigma="2 um", samples=4, modes=4, elements=1, speed="2970 rpm"
    ),
}


@pytest.mark.parametrize("verb", VERBS)
def test_a_model_is_what_it_was_after_every_verb(verb: str) -> None:
    model = askew()
    before = model.model_dump()
    VERBS[verb](model)
    assert model.model_dump() == before
    assert model == askew()


def test_two_models_are_equal_exactly_when_their_parts_are() -> None:
    first, second = askew(), askew()
    state_at(first, [200.0])
    assert first == second
    assert first != second.with_("meshes.stage.misalignment", "1 um")
    assert first.meshes == second.meshes


def test_a_state_is_found_once_and_its_arrays_are_not_written_to() -> None:
    model = askew()
    state = state_at(model, [250.0])
    assert state_at(model, [250.0]) is state
    assert state_at(model, [-250.0]).direction == -1
    spring = state.springs["bearings.input_right"]
    with pytest.raises(ValueError, match="read-only"):
        spring.stiffness[0, 0, 0] = 1.0


def test_a_spring_of_its_own_is_a_copy() -> None:
    given = np.eye(6)
    spring = constant_spring(given, given)
    given[0, 0] = 2.0
    assert spring.stiffness[0, 0, 0] == 1.0


def test_a_system_has_the_layout_of_its_model_whatever_the_state_was_found_on() -> None:
    model = askew()
    changed = model.with_("damping.rayleigh_alpha", 1.0)
    system = rg.System(changed, state=model.torque_flow())
    assert system.layout is changed.layout
    assert system.state.layout is system.layout


def on_films(**changes: Any) -> rg.Model:
    """A helical pair whose pinion floats in oil across its shaft, under its weight."""
    film = {
        "diameter": "40 mm",
        "length": "30 mm",
        "clearance": "30 um",
        "viscosity": "0.02 Pa s",
        "around": 60,
        "along": 4,
    }
    return rg.load(MODELS / "helical_pair.toml").with_(
        {
            "operation.gravity": [0.0, -9.81, 0.0],
            "bearings.input_right": {"shaft": "input", "at": "60 mm", "journal": film},
            **changes,
        }
    )


@pytest.mark.parametrize("speed", [200.0, -200.0, "-2970 rpm"])
def test_a_system_has_the_equilibrium_of_its_model_at_a_speed_of_either_sense(speed: float | str) -> None:
    model = on_films()
    expected = rg.modal(model, speed=speed, modes=8, elements=2).eigenvalues
    for direction in (1, -1):
        system = rg.System(model, 2, state=model.torque_flow(direction))
        assert rg.modal(system, speed=speed, modes=8).eigenvalues == pytest.approx(expected, rel=1e-9)


def test_a_system_at_standstill_has_the_equilibrium_of_its_own_sense() -> None:
    model = on_films()
    system = rg.System(model, 2, state=model.torque_flow(-1))
    expected = rg.modal(on_films(**{"operation.speed": "-2970 rpm"}), modes=6, elements=2).frequency_hz
    assert rg.modal(system, modes=6).frequency_hz == pytest.approx(expected, rel=1e-9)


def test_motions_in_time_take_laws_and_not_what_another_equilibrium_found_of_them() -> None:
    model = on_films()
    plain, about = (
        rg.transient(rg.System(model, 1, state=state), speed=250.0, time=0.002, steps=40, error_estimate=False)
        for state in (None, state_at(model, [250.0]))
    )
    assert np.array_equal(plain.mesh_force, about.mesh_force)
    assert plain.left_out == about.left_out


def test_a_system_says_what_its_model_says_of_laws_with_a_stiffness_beside_them() -> None:
    model = rg.load(MODELS / "helical_pair.toml").with_(
        {
            "nonlinear_elements.guard": {
                "law": "journal_bearing",
                "shaft": "input",
                "at": "30 mm",
                "parameters": {"radius": "20 mm", "length": "20 mm", "clearance": "90 um", "viscosity": "0.01 Pa s"},
                "stiffness": {"radial": "1e6 N/m"},
            }
        }
    )
    said = rg.modal(rg.System(model, 1), modes=4).left_out
    assert any(
        "nonlinear_elements.guard.parameters: the stiffness given beside the law is taken" in note for note in said
    )


def test_old_names_of_the_state_are_read_with_a_warning() -> None:
    model = askew()
    with pytest.warns(FutureWarning, match="torque_flow"):
        state = model.mean_load(-1)
    with pytest.warns(FutureWarning, match="state="):
        system = rg.System(model, load=state)
    with pytest.warns(FutureWarning, match=r"System\.state"):
        assert system.load.direction == -1
