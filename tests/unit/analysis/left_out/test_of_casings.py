"""What analyses say that they left out of casings and gear bodies is true."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.casings.casing import forget
from rotorgear.casings.fe_body import finite_element_body
from rotorgear.casings.wheel_reduction import reduce_wheel
from rotorgear.model.layout.casings import wheel_settings
from tests.unit.analysis.left_out.sentences import numbers, sentence
from tests.unit.casings.blocks import block, write_inp
from tests.unit.casings.test_wheel import WHEEL
from tests.unit.casings.test_wheel import pair as gear_pair

pytest.importorskip("meshio")
MODEL = """
[casings.box]
mesh = "box.inp"
unit = "m"
material = "steel"
held = ["low"]
seats = { left = "high" }
modes_to = "9 kHz"

[shafts.rotor]
position = ["50 mm", "30 mm"]
start = "200 mm"
sections = [{ length = "100 mm", outer_diameter = "20 mm", rigid = true }]

[bearings.left]
shaft = "rotor"
at = "start"
stiffness = { radial = "5e8 N/m", axial = "5e8 N/m", tilt = "1e6 N m/rad" }
casing = "box"
"""


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> rg.Model:
    folder = tmp_path_factory.mktemp("box")
    write_inp(folder / "box.inp", block((0.1, 0.06, 0.2), (2, 1, 2), "tetra"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROTORGEAR_CACHE", str(folder / "cache"))
        forget()
        found = rg.loads(MODEL, folder=folder)
        found.layout.casing("box")
    return found


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROTORGEAR_CACHE", str(tmp_path / "cache"))


def elastic(model: rg.Model) -> np.ndarray:
    found = rg.modal(model, modes=9, elements=1)
    return found.frequency_hz[~found.rigid]


def test_the_modes_of_a_casing_that_are_left_out_lie_above_those_that_are_counted(model: rg.Model) -> None:
    seats, kept, last = numbers(sentence(rg.modal(model, modes=3, elements=1), "all but the motions of its"))
    further = model.with_("casings.box.modes_to", "16 kHz")
    many = further.layout.casing("box").fixed_frequency
    assert seats == len(model.layout.casing("box").seats) == 1
    assert many[int(kept) - 1] == pytest.approx(last, rel=1e-3)
    assert len(many) > kept
    assert many[int(kept)] > 9e3
    # They change frequencies, all downwards, and by no more than the stated errors allow.
    few = rg.modal(model, modes=9, elements=1)
    off = few.frequency_hz[~few.rigid] / elastic(further) - 1.0
    assert off.max() > 1e-8
    assert np.all(off > -1e-10)
    assert np.all(off <= 2.0 * few.error_estimate[~few.rigid] + 1e-10)


def test_the_error_of_the_mesh_is_no_part_of_what_is_stated(model: rg.Model) -> None:
    found = rg.modal(model, modes=9, elements=1)
    assert "'rotorgear casing' estimates" in sentence(found, "error of its mesh")
    finer = elastic(model.with_("casings.box.splits", 1))
    off = found.frequency_hz[~found.rigid] / finer - 1.0
    assert off.max() > 10.0 * np.nanmax(found.error_estimate)
    estimated = rg.casing(model, modes=3).casings["box"].held_mesh_error
    assert off.max() < 3.0 * estimated.max()


def test_linear_elements_are_computed_as_quadratic_ones(model: rg.Model, tmp_path: Path) -> None:
    assert "raised to quadratic" in sentence(rg.modal(model, modes=3, elements=1), "linear tetrahedra")
    write_inp(tmp_path / "box.inp", block((0.1, 0.06, 0.2), (2, 1, 2), "tetra10"))
    np.testing.assert_allclose(elastic(rg.loads(MODEL, folder=tmp_path)), elastic(model), rtol=1e-9)


def test_a_seat_whose_bearing_stands_elsewhere_is_empty(model: rg.Model) -> None:
    forgotten = model.with_("bearings.left.casing", None)
    found = rg.modal(forgotten, modes=9, elements=1)
    sentence(found, "casings.box.seats.left", "stands elsewhere")
    assert not any("stands elsewhere" in line for line in rg.modal(model, modes=3, elements=1).left_out)
    ground = rg.modal(forgotten.with_("casings", {}), modes=2, elements=1).frequency_hz
    assert all(np.min(np.abs(found.frequency_hz / f - 1.0)) < 1e-9 for f in ground[ground > 1.0])


def test_a_bearing_beside_its_seat_is_carried_rigidly(model: rg.Model) -> None:
    beside = model.with_("bearings.left.at", "230 mm")
    (distance,) = numbers(
        sentence(rg.modal(beside, modes=3, elements=1), "carries it rigidly").split(" mm")[0].split("over the ")[1]
    )
    assert distance == pytest.approx(30.0)
    # A force at the bearing moves a rigid shaft by the seat's own flexibility, the arm's moment, and the bearing's springs.
    body = model.layout.casing("box")
    seat = np.linalg.inv(body.stiffness[:6, :6])
    arm = np.eye(6)
    arm[0, 4], arm[1, 3] = 0.03, -0.03
    expected = (arm @ seat @ arm.T)[0, 0] + 1.0 / 5e8
    moved = rg.frf(beside, [1e-3], inputs=["bearings.left:x"], outputs=["bearings.left:x"], elements=1).receptance[
        0, 0, 0
    ]
    assert moved.real == pytest.approx(expected, rel=1e-5)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("wheel")


def test_modes_of_a_gear_body_that_are_left_out_change_less_than_those_that_are_kept(folder: Path) -> None:
    found = rg.modal(gear_pair(folder), modes=12, elements=1)
    kept, limit = numbers(
        sentence(found, "modes of its mesh on its bore below").partition(";")[0].replace(" Hz", " Hz ")
    )
    assert kept > 0
    assert limit == pytest.approx(found.model.layout.elastic_bodies["wheel"].left_frequency, rel=1e-3)
    more = rg.modal(gear_pair(folder, WHEEL.replace("6 kHz", "9 kHz") % ""), modes=12, elements=1)
    off = np.abs(found.frequency_hz[~found.rigid] / more.frequency_hz[~more.rigid] - 1.0)
    assert 1e-9 < off.max() < 1e-3


@pytest.mark.long
def test_the_error_of_the_mesh_of_a_gear_body_is_as_large_as_said(folder: Path) -> None:
    model = gear_pair(folder)
    found = rg.modal(model, modes=3, elements=1)
    (said,) = numbers(
        sentence(found, "gears.wheel.body: the error of its mesh").partition("up to ")[2].split(" in ")[0]
    )
    settings = wheel_settings("wheel", model.gears["wheel"], model.materials["own"])
    coarse, fine = (
        reduce_wheel(finite_element_body(replace(settings, splits=splits)), settings.modes_to) for splits in (0, 1)
    )
    own = slice(0, min(coarse.modes, fine.modes))
    np.testing.assert_array_equal(coarse.diameters[own], fine.diameters[own])
    off = coarse.frequency[own] / fine.frequency[own] - 1.0
    assert said == pytest.approx(coarse.mesh_error, rel=0.05)
    assert off.min() > 0.0
    assert 0.5 * said < off.max() < said
    assert off.max() > 10.0 * np.nanmax(found.error_estimate)


def test_a_gear_body_that_turns_does_not_grow(folder: Path) -> None:
    model = gear_pair(folder)
    assert "growth by centrifugal forces" in sentence(rg.modal(model, modes=3, elements=1), "all but", "on its bore")
    found = rg.static(model.with_("operation.speed", "6000 rpm"), elements=1)
    rim = found.nodes.of_casing("gears.wheel.body")
    x, y = (found.nodes.position[rim] - [0.15, 0.0, 0.08])[:, :2].T
    radius = np.hypot(x, y)
    outward = np.mean((found.displacement[rim, 0] * x + found.displacement[rim, 1] * y) / radius)
    ring = 7800.0 * (2.0 * np.pi * 100.0) ** 2 * np.mean(radius) ** 3 / 210e9  # what a free ring would grow by
    assert abs(outward) < 0.02 * ring
