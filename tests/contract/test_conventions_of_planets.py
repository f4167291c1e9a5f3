"""C37 to C39 of docs/conventions.md: places of planets, meshes on carriers, and motions of a carrier that turns."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.elements.spring import rigid_transfer
from rotorgear.system.system import flow_system
from tests.planetary import helical_stage

UNEQUAL = helical_stage(4, teeth=(26, 36, 98))


def test_c37_planets_stand_on_their_arms_and_rigid_motions_in_space_strain_no_pin_and_no_mesh() -> None:
    model = rg.loads(UNEQUAL)
    for k, direction in enumerate(np.deg2rad([0.0, 90.0, 180.0, 270.0]), 1):
        frame = model.shafts[f"planet#{k}"].frame
        outwards = np.array([np.cos(direction), np.sin(direction), 0.0])
        assert frame.origin == pytest.approx(model.layout.planets[0].radius * outwards, abs=1e-15)
        assert frame.axes[:, 0] == pytest.approx(outwards, abs=1e-15)
        assert frame.axes[:, 2] == pytest.approx([0.0, 0.0, 1.0], abs=1e-15)
    axis = "axis = [0.48, -0.6, 0.64]"
    inclined = UNEQUAL
    for name in ("sun", "carrier", "ring"):
        inclined = inclined.replace(f"[shafts.{name}]", f"[shafts.{name}]\nposition = [0.3, -0.2, 0.1]\n{axis}")
    system = flow_system(rg.loads(inclined))
    motions = np.zeros((6 * len(system.nodes), 6))
    for node, (name, z) in enumerate(zip(system.nodes.shaft, system.nodes.z, strict=True)):
        frame = system.model.shafts[name].frame
        motions[6 * node : 6 * node + 6] = frame.six.T @ rigid_transfer(frame.at(z))
    for group in system.groups:
        if group.part.startswith(("meshes.", "bearings.")):
            strain = group.matrices.strain
            assert strain is not None
            assert np.abs(strain[0] @ motions[group.dofs[0]]).max() < 1e-12 * np.abs(motions).max()


def test_c38_a_mesh_on_a_carrier_is_told_by_the_speeds_against_it() -> None:
    model = rg.loads(UNEQUAL.replace("[operation]", '[operation]\ntorque = 50\noutput_shaft = "carrier"'))
    ratios = model.layout.train.ratios
    for mesh in model.layout.meshes:
        speeds = [ratios[gear.shaft] - ratios["carrier"] for gear in mesh.gears]
        teeth = [gear.part.teeth * (-1 if gear.part.internal else 1) for gear in mesh.gears]
        assert teeth[0] * speeds[0] + teeth[1] * speeds[1] == 0
        assert mesh.order == pytest.approx(teeth[0] * abs(float(speeds[0])), rel=1e-15)
        # The sun drives its planets, and these drive against the ring, which stands still in space and not against the carrier.
        driver = model.torque_flow().of_mesh(mesh.name)[0]
        assert driver.pinion_drives
        assert driver.torque_sense == (1 if mesh.gear.name.startswith("planet") else -1)


def test_c39_a_motion_of_the_first_class_is_seen_from_the_carrier_at_another_frequency() -> None:
    """Planets between members that hardly move: alike in axes that go round, so each motion is there for all classes."""
    rigid = dict.fromkeys(("x", "y", "axial", "tilt_x", "tilt_y", "torsion"), 1e15)
    text = helical_stage(4, teeth=(26, 36, 98), ground=dict.fromkeys(("sun", "ring", "carrier"), rigid))
    speed = 12000.0
    found = rg.modal(rg.loads(text), speed=f"{speed} rpm", fmax=4000.0).frequency_hz
    W = speed / 60.0 * 26 / 124
    own = found[1::4]
    assert len(found) % 4 == 0
    assert len(own) >= 4
    # Sorted: less the speed of the carrier, twice the same, more by it, where motions lie further apart than that.
    groups = sorted(f for f in found if np.count_nonzero(np.abs(found - f) < 1e-3) == 2)[::2]
    for f in groups:
        assert np.abs(found - (f - W)).min() < 1e-3
        assert np.abs(found - (f + W)).min() < 1e-3
    assert 4 * len(groups) == len(found)
