"""C28 to C30 of docs/conventions.md: unbalance, transmission error and the phases of meshes."""

from __future__ import annotations

import cmath
import math
import tomllib
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.paths import ROOT


@pytest.mark.parametrize("speed", [120.0, -120.0])
def test_c28_an_unbalance_turns_with_its_shaft_from_its_own_direction(speed: float) -> None:
    # so stiff that the shaft follows the force
    k = 1e9
    size = 1e-4
    phase = 0.7
    model = rg.Model(
        operation={"input_shaft": "r"},
        motions=["bending"],
        shafts={"r": {}},
        disks={"d": {"shaft": "r", "at": "start", "mass": 1e-3, "polar_inertia": 0.0, "diametral_inertia": 1.0}},
        bearings={"b": {"shaft": "r", "at": "start", "stiffness": {"radial": k, "tilt": 1e9}}},
        unbalances={"u": {"shaft": "r", "at": "start", "magnitude": size, "phase": phase}},
    )
    moved = rg.response(model, speeds=[speed]).displacement[0, 0, 0]
    for t in (0.0, 0.003, 0.01):
        x, y = (float((value * cmath.exp(1j * abs(speed) * t)).real) for value in moved[:2])
        angle = speed * t + phase
        assert [x, y] == pytest.approx(np.array([math.cos(angle), math.sin(angle)]) * size * speed**2 / k, rel=1e-6)


def gearbox(**mesh: Any) -> rg.Model:
    """The split-torque gearbox without the springs and unbalances at its ends: free to turn, as in statics."""
    data = tomllib.loads((ROOT / "models" / "split_torque.toml").read_text(encoding="utf-8"))
    for name, own in data["meshes"].items():
        own["transmission_error"] = ()
        own.update(mesh if name == "stage_2a" else {})
    return rg.Model(**{**data, "supports": {}, "unbalances": {}})


def slow_error(harmonic: int, own: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Contact forces (c,) of a slow error of 1 um in stage 2a, what statics says to an index error of 1 um, phase of the mesh."""
    error = {"harmonic": harmonic, "amplitude": 1e-6, "phase": own}
    result = rg.response(gearbox(transmission_error=[error]), speeds=[1e-3], elements=2)
    static = rg.static(gearbox(), elements=2)
    change = 1e-6 * static.force_derivative[static.parameter.index("meshes.stage_2a.index_error")]
    assert change[static.contacts_of("stage_2a")].sum() < 0.0  # a gap takes load off
    return result.mesh_force[0, 0], change, static.mesh_phase["stage_2a"]


def test_c29_a_slow_transmission_error_is_an_index_error() -> None:
    force, change, phase = slow_error(1, 0.0)
    at_its_crest = force * cmath.exp(-2j * math.pi * phase)
    assert at_its_crest == pytest.approx(change, rel=1e-6, abs=1e-8 * float(np.abs(change).max()))


@pytest.mark.parametrize(("harmonic", "own"), [(1, 0.0), (2, 0.3)])
def test_c30_an_error_stands_in_the_phase_of_its_mesh(harmonic: int, own: float) -> None:
    force, change, phase = slow_error(harmonic, own)
    turn = cmath.exp(1j * (2.0 * math.pi * harmonic * phase + own))
    assert force == pytest.approx(change * turn, rel=1e-6, abs=1e-8 * float(np.abs(change).max()))
