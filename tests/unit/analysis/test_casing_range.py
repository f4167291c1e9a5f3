"""Casings get as many modes of their own as the range of an analysis asks for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.common.casings import MOST_MODES, with_casing_modes
from rotorgear.casings.casing import forget
from tests.unit.casings.blocks import block, write_inp

pytest.importorskip("meshio")
MODEL = """
[operation]
input_shaft = "rotor"
speed = "3000 rpm"

[casings.box]
mesh = "box.inp"
unit = "m"
material = "steel"
held = ["low"]
seats = { left = "high" }
damping_ratio = 0.01

[shafts.rotor]
position = ["100 mm", "60 mm"]
start = "400 mm"
sections = [{ length = "100 mm", outer_diameter = "60 mm", rigid = true }]

[unbalances]
one = { shaft = "rotor", at = "end", magnitude = "100 g mm" }

[bearings.left]
shaft = "rotor"
at = "start"
stiffness = { radial = "1e9 N/m", axial = "1e9 N/m", tilt = "1e6 N m/rad" }
casing = "box"
"""


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> rg.Model:
    folder = tmp_path_factory.mktemp("box")
    write_inp(folder / "box.inp", block((0.2, 0.12, 0.4), (2, 1, 2)))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROTORGEAR_CACHE", str(folder / "cache"))
        forget()
        found = rg.loads(MODEL, folder=folder)
        found.layout.casing("box")
    return found


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROTORGEAR_CACHE", str(tmp_path / "cache"))


def test_a_range_within_the_usual_modes_leaves_the_model_as_it_is(model: rg.Model) -> None:
    reach = model.layout.casing("box").left_frequency
    assert with_casing_modes(model, 0.49 * reach) == (model, ())
    assert with_casing_modes(model, None)[0] is model
    given = model.with_("casings.box.modes_to", reach)
    assert with_casing_modes(given, 10.0 * reach) == (given, ())


def test_a_wider_range_takes_modes_to_twice_its_end(model: rg.Model) -> None:
    reach = model.layout.casing("box").left_frequency
    served, short = with_casing_modes(model, 0.7 * reach)
    asked = served.casings["box"].modes_to
    assert asked is not None
    assert 1.4 * reach <= asked <= 1.6 * reach
    assert served.layout.casing("box").left_frequency > asked
    assert short == ()
    served, short = with_casing_modes(model, 20.0 * reach)
    assert len(served.layout.casing("box").fixed_frequency) < 2 * MOST_MODES
    assert short[0].endswith("modes_to takes in more")


def test_modes_and_responses_of_a_wide_range_are_those_of_many_modes(model: rg.Model) -> None:
    reach = model.layout.casing("box").left_frequency
    many = model.with_("casings.box.modes_to", 3.0 * reach)
    few = model.with_("casings.box.modes_to", 0.99 * reach)
    found, right, usual = (rg.modal(one, fmax=0.9 * reach, elements=1) for one in (model, many, few))
    assert found.model is model
    elastic = ~right.rigid
    off, before = (np.abs(one.frequency_hz[elastic] / right.frequency_hz[elastic] - 1.0) for one in (found, usual))
    assert off.max() < 1e-4
    assert before.max() > 1e-3
    counted = rg.modal(model, modes=len(found.frequency_hz), elements=1)
    np.testing.assert_allclose(counted.frequency_hz, right.frequency_hz, rtol=1e-4)
    hz = [0.5 * reach, 0.9 * reach]
    there = {"inputs": ["bearings.left:y"], "outputs": ["casings.box(200 mm; 120 mm; 200 mm):x"], "elements": 1}
    here, wide = (rg.frf(one, hz, **there).receptance for one in (model, many))
    np.testing.assert_allclose(here, wide, rtol=0.02)


@pytest.mark.long  # two motions of a gearbox in its casing
def test_motions_over_time_say_where_the_modes_of_a_casing_end(model: rg.Model) -> None:
    reach = model.layout.casing("box").left_frequency
    buzz = {"shaft": "rotor", "at": "end", "force": [100.0, 0.0, 0.0]}
    words = f"casings.box: its 20 modes serve up to {0.5 * reach:.4g} Hz"
    for share, told in ((0.4, False), (0.6, True)):
        loaded = model.with_({"loads": {"buzz": {**buzz, "order": round(share * reach / 50.0)}}})
        found = rg.transient(loaded, time=0.04, steps=4, records=4, error_estimate=False)
        assert any(note.startswith(words) for note in found.warnings) == told


def test_campbell_diagrams_of_a_number_of_modes_say_what_the_reduction_makes_wrong(model: rg.Model) -> None:
    few = model.with_("casings.box.modes_to", 0.3 * model.layout.casing("box").left_frequency)
    wide, narrow = (rg.campbell(few, points=2, modes=count, elements=1) for count in (20, 2))
    assert any("their reduction makes" in note for note in wide.warnings)
    assert not any("their reduction makes" in note for note in narrow.warnings)


def test_critical_speeds_state_the_error_by_the_reduction_of_casings(model: rg.Model) -> None:
    reach = model.layout.casing("box").left_frequency
    few, many = (model.with_("casings.box.modes_to", share * reach) for share in (0.4, 2.0))
    top = 2.0 * np.pi * 0.35 * reach
    found, right = (rg.critical(one, stop=top, elements=1, damped=False) for one in (few, many))
    assert len(found.speeds) == len(right.speeds) > 2
    off = np.array([abs(one.speed / other.speed - 1.0) for one, other in zip(found.speeds, right.speeds, strict=True)])
    stated = np.array([one.error_estimate for one in found.speeds])
    assert off.max() > 1e-6
    assert np.all(off <= 2.0 * stated + 1e-9)
    assert stated.max() < 30.0 * off.max()
