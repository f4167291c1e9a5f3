"""Shipped models with loaded teeth: their contact is solved up to five times the load; what a gear in two meshes leaves out."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.common.mesh_notes import unlike_teeth_left_out
from rotorgear.system.system import System
from tests.paths import MODELS

LOADED = sorted(
    file.name for file in MODELS.glob("*.toml") if 'stiffness = "tooth_fe"' in file.read_text(encoding="utf-8")
)


def test_there_are_models_with_loaded_teeth() -> None:
    assert {"overhung_pinion.toml", "relieved_pair.toml", "web_wheel.toml"} <= set(LOADED)


@pytest.mark.long
@pytest.mark.parametrize("name", LOADED)
def test_the_contact_of_a_shipped_model_converges_at_five_times_the_load(name: str) -> None:
    model = rg.load(MODELS / name)
    states = [
        state for state in model.torque_flow(1).forces if model.meshes[state.contact.mesh].stiffness == "tooth_fe"
    ]
    for state in states:
        found = model.layout.mesh(state.contact.mesh).contact_map(
            state.contact.helix, state.normal_force, state.torque_sense
        )
        assert found is not None
        assert found.largest_load == pytest.approx(5.0 * state.normal_force, rel=1e-9)
        assert np.all(np.diff(found.approach, axis=1) > 0.0)


def train() -> rg.Model:
    """Three gears in a row, whose middle one is in two meshes."""
    gear = {"at": "50 mm", "kind": "spur", "normal_module": "5 mm", "width": "30 mm", "teeth": 30}
    section = [{"length": "100 mm", "outer_diameter": "50 mm"}]
    teeth = {"stiffness": "tooth_fe"}
    return rg.Model(
        operation={"input_shaft": "one", "output_shaft": "three", "speed": 100.0, "torque": 200.0},
        shafts={
            name: {"position": [x, 0.0], "sections": section}
            for name, x in (("one", 0.0), ("two", 0.15), ("three", 0.3))
        },
        gears={
            "a": {"shaft": "one", **gear},
            "b": {"shaft": "two", **gear, "flank": {"pitch_errors": {"3": "8 um"}}},
            "c": {"shaft": "three", **gear},
        },
        meshes={"ab": {"pinion": "a", "gear": "b", **teeth}, "bc": {"pinion": "b", "gear": "c", **teeth}},
        bearings={
            f"{shaft}_{end}": {"shaft": shaft, "at": end, "stiffness": {"radial": 1e9, "axial": 1e9}}
            for shaft in ("one", "two", "three")
            for end in ("start", "end")
        },
    )


def test_unlike_teeth_whose_place_is_not_known_are_named() -> None:
    model = train()
    assert not list(unlike_teeth_left_out(System(model)))
    given = System(model.with_("meshes.bc.phase", "10 deg"))
    (said,) = unlike_teeth_left_out(given)
    assert said.startswith("gears.b: which of its teeth are in meshes.ab and meshes.bc")
    stiffnesses = {f"meshes.{name}.stiffness": 1e8 for name in model.meshes}
    assert not list(unlike_teeth_left_out(System(given.model.with_(stiffnesses))))


@pytest.mark.parametrize("speed", [100.0, -100.0])
@pytest.mark.parametrize(("place", "teeth"), [((0.3, 0.0), 15), ((0.15, 0.15), 7.5), ((0.15, -0.15), 22.5)])
def test_a_tooth_of_a_middle_gear_comes_into_its_second_mesh_after_its_turn(
    place: tuple[float, float], teeth: float, speed: float
) -> None:
    """From the pitch point with its driver to that with what it drives it turns by the angle between them: so many teeth.

    The teeth of b push against a with their backs and against c with their fronts, half a pitch apart without backlash.
    """
    model = train().with_({"shafts.three.position": list(place), "operation.speed": speed})
    load = model.torque_flow(1 if speed > 0.0 else -1)
    turns = []
    for name in ("ab", "bc"):
        contact = load.of_mesh(name)[0].contact
        phase = load.path_phase(contact)
        assert phase is not None
        turns.append(phase / (2.0 * np.pi))
    # The middle gear turns against the sense of the first one.
    sense = -1.0 if speed > 0.0 else 1.0
    angle = (np.arctan2(place[1], place[0] - 0.15) - np.pi) * sense
    apart = angle / (2.0 * np.pi) * 30.0
    assert np.mod(turns[0] - turns[1] - (apart - 0.5) + 1.0, 30.0) == pytest.approx(1.0, abs=1e-9)
    assert teeth in (np.mod(apart, 30.0), np.mod(-apart, 30.0))
