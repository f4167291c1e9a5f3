"""Shafts that their bearings let move along the axis far more than the teeth give way are named."""

from __future__ import annotations

from typing import Any

import pytest

import rotorgear as rg
from rotorgear.note import sentences
from tests.paths import MODELS

PAIR = rg.load(MODELS / "helical_pair.toml")


def said(model: rg.Model) -> list[Any]:
    return [note for note in rg.static(model).warnings if "along its axis" in note]


def softer(share: float, *shafts: str) -> rg.Model:
    """The helical stage with the axial stiffness of the bearings of some shafts at a share of what they have."""
    values = {
        f"bearings.{name}.stiffness.axial": share * float(bearing.stiffness.as_rows()[2][2])
        for name, bearing in PAIR.bearings.items()
        if bearing.shaft in shafts and bearing.stiffness is not None
    }
    return PAIR.with_(values)


def test_a_shaft_that_its_bearings_hardly_hold_along_its_axis_is_named_with_them_and_the_remedy() -> None:
    (note,) = said(softer(0.1, "input"))
    assert note.part == "shafts.input"
    moved = rg.static(softer(0.1, "input")).place_displacement["bearings.input_left"][2]
    assert note.value.startswith(f"{1e6 * moved:+.3g} um, ")
    assert note.value.endswith(" times, 10 N/um of input_left")
    both = said(softer(0.1, "input", "output"))
    assert [note.part for note in both] == ["shafts.input", "shafts.output"]
    assert len(sentences(both)) == 1  # one cause, one sentence


def test_bearings_that_hold_their_shafts_as_the_teeth_need_it_are_not_named() -> None:
    assert said(PAIR) == []
    # Where nothing pushes along the axis, it does not matter how soft a shaft is held.
    assert said(rg.load(MODELS / "overhung_pinion.toml")) == []
    # A shaft that is pushed by its load and not by its teeth.
    assert said(softer(0.5, "input", "output")) == []


def test_rolling_bearings_are_seen_in_their_equilibrium() -> None:
    def on(**rolling: Any) -> rg.Model:
        known = [f"bearings.{name}" for name in PAIR.bearings]
        clean = {f"{name}.{key}": None for name in known for key in ("stiffness", "damping")}
        return PAIR.with_(clean | {f"{name}.rolling": rolling for name in known})

    deep = said(on(designation="6208"))
    assert {note.part for note in deep} == {"shafts.input", "shafts.output"}
    for note in deep:
        side = note.part.removeprefix("shafts.")
        assert f" N/um of {side}_left and {side}_right" in note


@pytest.mark.parametrize("turned", [1.0, -1.0])
def test_the_sense_of_the_rotation_turns_the_thrust_and_the_note_stays(turned: float) -> None:
    assert PAIR.operating_speed is not None
    model = softer(0.1, "output").with_("operation.speed", turned * PAIR.operating_speed)
    (note,) = said(model)
    assert note.part == "shafts.output"
