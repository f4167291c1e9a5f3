"""C28 to C30 of docs/conventions.md: unbalance, transmission error and the phases of meshes."""

from __future__ import annotations

import cmath
import math
import tomllib
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.system.contacts import contact_lines
from rotorgear.system.system import System
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
        assert [x, y] == pytest.approx(
            np.array([math.cos(angle), math.sin(angle)]) * size * speed**2 / k, rel=1e-6, abs=0
        )


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


def pair_of_one_kind(kind: str, clocking: float, **own: Any) -> rg.Model:
    """Two gears in torsion; the one that the mesh calls the pinion sits on the shaft that turns against the input."""
    helix = {"kind": kind, "helix_angle": 0.4, "normal_module": 0.004, "width": 0.03, "body": {"bore": 0.0}}
    return rg.Model(
        motions=["torsion"],
        operation={"input_shaft": "in"},
        shafts={"in": {"position": [0.0, 0.0]}, "out": {"position": [0.07, 0.09943]}},
        gears={
            "big": {**helix, "shaft": "in", "at": "start", "teeth": 31, "hand": "right", "clocking": clocking, **own},
            "small": {**helix, "shaft": "out", "at": "start", "teeth": 25, "hand": "left", **own},
        },
        meshes={"m": {"pinion": "small", "gear": "big", "stiffness": 1e8, **({"stagger": 0.2} if own else {})}},
    )


@pytest.mark.parametrize("direction", [1, -1])
def test_c31_the_helix_at_larger_z_is_ahead_as_a_gear_that_is_turned_on_its_shaft(direction: int) -> None:
    both = pair_of_one_kind("herringbone", 0.0, nodes=1).torque_flow(direction)
    first, second = (both.phase(state.contact) for state in both.forces)
    # Both gears have their teeth ahead at larger z. The big one turns with the input, so that its teeth lie towards +z.
    apart, turned = (
        pair_of_one_kind("helical", angle).torque_flow(direction) for angle in (0.0, 0.2 * 2.0 * math.pi / 31)
    )
    lead = turned.phases["m"] - apart.phases["m"]  # type: ignore[operator]
    assert cmath.exp(1j * (second - first)) == pytest.approx(cmath.exp(1j * lead), rel=1e-12)  # type: ignore[operator]
    assert cmath.exp(1j * lead) == pytest.approx(cmath.exp(0.4j * math.pi * direction), rel=1e-9)


def test_c32_transmission_error_is_rotation_and_approach_has_all_motion_in_it() -> None:
    helix = {"kind": "helical", "helix_angle": 0.4, "normal_module": 0.004, "width": 0.03, "body": {"bore": 0.0}}
    model = rg.Model(
        operation={"input_shaft": "in"},
        shafts={"in": {"position": [0.0, 0.0]}, "out": {"position": [0.07, 0.09943]}},
        gears={
            "a": {**helix, "shaft": "in", "at": "start", "teeth": 25, "hand": "right"},
            "b": {**helix, "shaft": "out", "at": "start", "teeth": 31, "hand": "left"},
        },
        meshes={"m": {"pinion": "a", "gear": "b", "stiffness": 1e8}},
    )
    system = System(model)
    lines = contact_lines(system)
    contact = lines.states[0].contact
    sense = lines.states[0].torque_sense
    moved = system.dofs.transform.T.toarray()
    turned, shifted = (moved[:, 6 * system.nodes.at("in", 0.0) + dof] for dof in (5, 0))
    error = lines.rotation[:, 0]
    approach = lines.vectors[:, 0] / math.cos(contact.base_helix_angle)
    assert error @ turned == pytest.approx(sense * contact.pinion_base_radius)
    assert approach @ turned == pytest.approx(error @ turned)
    assert error @ shifted == 0.0
    assert abs(approach @ shifted) > 0.1
