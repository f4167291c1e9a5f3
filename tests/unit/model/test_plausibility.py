"""Slips of units are warned about, and no shipped model is."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.model.checks.plausibility import implausible
from rotorgear.note import sentences
from tests.models import spur_pair

MODELS = Path(__file__).parents[3] / "models"
# Address, the value that slipped, and what the warning asks.
SLIPS: list[tuple[dict[str, Any], str, str]] = [
    ({"gears.pinion.width": 44.0, "gears.wheel.width": 44.0}, "gears.pinion.width", "mm meant"),
    (
        {"materials.steel_2": {"youngs_modulus": 206000.0, "density": 7850.0, "poisson_ratio": 0.3}},
        "materials.steel_2",
        "MPa meant",
    ),
    (
        {"materials.steel_2": {"youngs_modulus": 206.0, "density": 7850.0, "poisson_ratio": 0.3}},
        "materials.steel_2",
        "GPa meant",
    ),
    (
        {"materials.steel_2": {"youngs_modulus": 206e9, "density": 7.85, "poisson_ratio": 0.3}},
        "materials.steel_2.density",
        "g/cm\\^3 meant",
    ),
    ({"meshes.stage.stiffness": 896.0}, "meshes.stage.stiffness", "N/um"),
    ({"meshes.stage.stiffness": 14.0}, "meshes.stage.stiffness", "N/\\(mm um\\)"),
    ({"bearings.input_left.stiffness": {"radial": 0.0}}, "bearings.input_left.stiffness", "holds nothing"),
    ({"bearings.input_left.stiffness": {"radial": 200.0}}, "bearings.input_left.stiffness", "N/um meant"),
    ({"bearings.input_left.stiffness": {"radial": 2e14}}, "bearings.input_left.stiffness", "unit right"),
    ({"shafts.input.sections[0].outer_diameter": 40.0}, "shafts.input", "in mm"),
    (
        {
            "disks.extra": {
                "shaft": "input",
                "at": "start",
                "mass": 3.0,
                "polar_inertia": 5400.0,
                "diametral_inertia": 2700.0,
            }
        },
        "disks.extra.polar_inertia",
        "kg mm\\^2",
    ),
    ({"operation.gravity": [0.0, -9810.0, 0.0]}, "operation.gravity", "mm/s\\^2"),
    ({"damping.modal_ratio": 2.0}, "damping.modal_ratio", "percent"),
    (
        {"unbalances.u": {"shaft": "input", "at": "start", "magnitude": 20.0}},
        "unbalances.u.magnitude",
        "g mm meant",
    ),
    ({"operation.speed": 30000.0}, "operation.speed", "rpm meant"),
    ({"operation.power": 5e9}, "operation.power", "W meant"),
    (
        {"meshes.stage.transmission_error": [{"harmonic": 1, "amplitude": 2.0}]},
        "meshes.stage.transmission_error",
        "um meant",
    ),
    ({"meshes.stage.backlash": 0.2}, "meshes.stage.backlash", "mm meant"),
]
FILM = {"diameter": 0.06, "length": 0.03, "clearance": 60e-6, "viscosity": 0.02}
COLLAR = {"inner_diameter": 0.08, "outer_diameter": 0.14, "clearance": 1e-4, "viscosity": 0.02, "pivot": 0.6}
AT = {"shaft": "input", "at": "start"}
SLIPS += [
    ({"bearings.film": {**AT, "journal": {**FILM, "viscosity": 20.0}}}, "bearings.film.journal.viscosity", "cP"),
    ({"bearings.film": {**AT, "journal": {**FILM, "density": 0.87}}}, "bearings.film.journal.density", "g/cm\\^3"),
    (
        {"bearings.film": {**AT, "journal": {**FILM, "clearance": 60e-9}}},
        "bearings.film.journal.clearance",
        "unit right",
    ),
    (
        {"bearings.film": {**AT, "journal": {**FILM, "diameter": 60.0, "clearance": 0.06}}},
        "bearings.film.journal.diameter",
        "mm meant",
    ),
    ({"bearings.collar": {**AT, "thrust": {**COLLAR, "viscosity": 20.0}}}, "bearings.collar.thrust.viscosity", "cP"),
    (
        {"bearings.collar": {**AT, "thrust": {**COLLAR, "clearance": 5e-3}}},
        "bearings.collar.thrust.clearance",
        "um meant",
    ),
    (
        {
            "bearings.ball": {
                **AT,
                "rolling": {"kind": "ball", "elements": 9, "element_diameter": 11.5, "pitch_diameter": 43.5},
            }
        },
        "bearings.ball.rolling.pitch_diameter",
        "mm meant",
    ),
    (
        {"bearings.held": {**AT, "stiffness": {"radial": 2e8}, "damping": {"radial": 5e9}}},
        "bearings.held.damping",
        "unit right",
    ),
    (
        {"bearings.collar": {**AT, "thrust": {**COLLAR, "pivot": None, "taper": 0.04}}},
        "bearings.collar.thrust.taper",
        "um",
    ),
    ({"bearings.film": {**AT, "journal": {**FILM, "diameter": 0.6}}}, "bearings.film.journal.diameter", "mm meant"),
    ({"damping.rayleigh_beta": 2.0}, "damping.rayleigh_beta", "us meant"),
    (
        {"loads.pull": {"shaft": "input", "at": "start", "force": [0.0, 5e9, 0.0]}},
        "loads.pull.force",
        "unit right",
    ),
]
BALLS = {"kind": "ball", "elements": 9, "element_diameter": 8e-3, "pitch_diameter": 46e-3, "contact_angle": 0.4}
SLIPS += [
    ({"operation.power": None, "operation.torque": 0.12}, "operation.torque", "kN m or kW"),
    ({"operation.speed": 12000.0}, "operation.speed", "rpm meant"),
    ({"operation.gravity": [0.0, -1.0, 0.0]}, "operation.gravity", "in g"),
    ({"damping.rayleigh_alpha": 2e5}, "damping.rayleigh_alpha", "unit right"),
    ({"unbalances.u": {**AT, "magnitude": 2e-5, "phase": 90.0}}, "unbalances.u.phase", "deg meant"),
    ({"meshes.stage.phase": 180.0}, "meshes.stage.phase", "deg meant"),
    ({"gears.pinion.flank": {"crowning": 4e-4}}, "gears.pinion.flank.crowning", "um meant"),
    ({"meshes.stage.friction_coefficient": 5.0}, "meshes.stage.friction_coefficient", "percent"),
    ({"meshes.stage.lubricant_viscosity": 20.0}, "meshes.stage.lubricant_viscosity", "cP"),
    ({"meshes.stage.index_error": 0.02}, "meshes.stage.index_error", "um or mm"),
    (
        {"loads.brake": {"shaft": "output", "kind": "output", "torque": 1e-4, "ripple": 5.0}},
        "loads.brake.ripple",
        "percent",
    ),
    ({"disks.d": {**AT, "mass": 3e5, "polar_inertia": 3e3, "diametral_inertia": 2e3}}, "shafts.input", "mass in g"),
    (
        {"bearings.ball": {**AT, "rolling": {**BALLS, "element_diameter": 8e-6}}},
        "bearings.ball.rolling.element_diameter",
        "unit right",
    ),
    (
        {"bearings.ball": {**AT, "rolling": {**BALLS, "preload_displacement": 5e-3}}},
        "bearings.ball.rolling.preload_displacement",
        "um meant",
    ),
    (
        {"bearings.ball": {**AT, "rolling": {**BALLS, "preload_force": 4e5}}},
        "bearings.ball.rolling.preload_force",
        "unit right",
    ),
    (
        {"bearings.b": {**AT, "stiffness": {"radial": 2e8}, "pedestal": {"mass": 2.0, "stiffness": {"radial": 400.0}}}},
        "bearings.b.pedestal.stiffness",
        "N/um meant",
    ),
    (
        {"bearings.film": {**AT, "journal": {**FILM, "viscosity": None, "oil": "VG 46", "inlet_temperature": 45.0}}},
        "bearings.film.journal.inlet_temperature",
        "degC meant",
    ),
    (
        {"bearings.film": {**AT, "journal": {**FILM, "pads": 5, "pad_at": 270.0}}},
        "bearings.film.journal.pad_at",
        "deg meant",
    ),
]


@pytest.mark.parametrize(("change", "address", "slip"), SLIPS)
def test_a_slip_of_a_unit_is_named_with_its_remedy(change, address, slip):
    model = rg.load(MODELS / "helical_pair.toml").with_(change)
    found = list(implausible(model.layout))
    assert any(sentence.startswith(address) for sentence in found), found
    assert any(re.search(slip, sentence) and "usual is" in sentence for sentence in found), found


def test_one_slip_at_several_bearings_is_one_sentence():
    model = rg.load(MODELS / "split_torque.toml")
    slip = {f"bearings.{name}.stiffness": {"radial": 1e3 + k} for k, name in enumerate(model.bearings)}
    (sentence,) = sentences(implausible(model.with_(slip).layout), 3)
    assert f"and {len(slip) - 1} more: usual is 1e6 to 1e10 N/m; N/mm or N/um meant?" in sentence


@pytest.mark.parametrize("file", sorted(MODELS.glob("*.toml")), ids=lambda file: file.stem)
def test_no_shipped_model_is_warned_about(file):
    assert list(implausible(rg.load(file).layout)) == []


def test_every_analysis_and_check_say_it():
    model = rg.load(MODELS / "jeffcott.toml").with_("damping.modal_ratio", 2.0)
    for result in (rg.check(model), rg.modal(model)):
        assert sum(sentence.startswith("damping.modal_ratio") for sentence in result.warnings) == 1


def test_a_train_in_torsion_alone_may_stand_anywhere_along_z():
    gear = (
        "kind = 'spur'\nteeth = {}\nnormal_module = '2 mm'\nwidth = '20 mm'\n"
        "mass = 1.0\npolar_inertia = 0.01\ndiametral_inertia = 0.01\n"
    )
    text = (
        "[shafts.a]\n[shafts.b]\nstart = '300 mm'\n"
        f"[gears.one]\nshaft = 'a'\nat = 'start'\n{gear.format(20)}[gears.two]\nshaft = 'b'\nat = 'start'\n{gear.format(40)}"
        "[meshes.m]\npinion = 'one'\ngear = 'two'\nstiffness = 1e8\n"
    )
    modes = rg.modal(rg.loads('motions = ["torsion"]\n' + text))
    # m_e = J_1 J_2 / (J_1 r_2^2 + J_2 r_1^2) on the base radii.
    r = 0.02 * np.cos(np.radians(20.0))
    mass = 0.01 * 0.01 / (0.01 * (2.0 * r) ** 2 + 0.01 * r**2)
    assert modes.frequency_hz[-1] == pytest.approx(np.sqrt(1e8 / mass) / 2.0 / np.pi, rel=1e-9)
    with pytest.raises(rg.RotorgearError, match="faces that overlap"):
        rg.loads('motions = ["bending", "torsion"]\n' + text)


SHORT = {"time": 1e-3, "steps": 50, "error_estimate": False}
FEW = {"discard": 2, "sample": 2, "modes": 2}


@pytest.mark.parametrize(
    ("ask", "argument"),
    [
        (lambda model, speed: rg.modal(model, speed=speed, modes=2), "speed"),
        (lambda model, speed: rg.static(model, speed=-speed), "speed"),
        (lambda model, speed: rg.campbell(model, stop=speed, points=3, modes=2), "stop"),
        (lambda model, speed: rg.response(model, speeds=[100.0, speed], modal_damping=0.02), "speeds"),
        (lambda model, speed: rg.transient(model, speed=[(0.0, 100.0), (1e-3, speed)], **SHORT), "speed"),
        (lambda model, speed: rg.sweep(model, {"operation.speed": [speed]}, **FEW), "operation.speed"),
    ],
    ids=["modal", "static", "campbell", "response", "transient", "sweep"],
)
def test_a_bare_number_as_a_speed_is_asked_about_and_a_text_is_not(ask, argument) -> None:
    model = spur_pair()
    doubts = [text for text in ask(model, 9000.0).warnings if "rpm meant?" in text]
    assert len(doubts) == 1
    assert doubts[0].startswith(f"{argument} (8.594e+04 rpm of shaft 'one'")
    assert not any("rpm meant?" in text for text in ask(model, 150.0).warnings)


def test_a_speed_with_its_unit_is_meant() -> None:
    assert not any("rpm meant?" in text for text in rg.modal(spur_pair(), speed="90000 rpm", modes=2).warnings)
