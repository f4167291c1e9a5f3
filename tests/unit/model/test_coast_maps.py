"""Coast flanks of teeth that stand askew: what opens the working flanks at one end of the face closes those behind them there."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

import rotorgear as rg
from rotorgear.gears.stiffness.face_load import uniform_line
from rotorgear.model.layout.mesh_layout import MeshLayout
from tests.paths import MODELS

GIVEN = 14e-6


def test_they_stand_askew_the_other_way_whoever_says_how_askew_the_working_ones_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[tuple[Any, ...]] = []

    def recorded(mesh: MeshLayout, helix: int, load: float, sense: int, near: bool = False, misalignment: Any = None):
        asked.append((sense, misalignment))

    state = rg.load(MODELS / "helical_pair.toml").with_("meshes.stage.misalignment", GIVEN).torque_flow()
    (force,) = state.forces
    face = uniform_line(force.contact.stiffness, 0.042, force.normal_force, GIVEN)
    tilted = replace(state, faces={"stage": (face,)})
    monkeypatch.setattr(MeshLayout, "contact_map", recorded)
    for one in (state, tilted):
        one.contact_map(force)
        one.coast_map(force)
    sense = force.torque_sense
    # None leaves the teeth as the file has them, GIVEN askew.
    assert asked == [(sense, None), (-sense, -GIVEN), (sense, GIVEN), (-sense, -GIVEN)]
