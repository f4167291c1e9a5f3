"""Mean mesh forces against statics, driving flanks, and how a loop splits its torque."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from rotorgear.errors import ModelError
from rotorgear.gears.stiffness.face_load import FaceLoad, FaceSpring
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.load import Load
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.operation import Operation
from rotorgear.model.parts.shaft import Section, Shaft
from rotorgear.model.parts.supports import Coupling, StiffnessMatrix

Data = dict[str, Any]


def flow_of(model: Model, direction: int = 1) -> State:
    return model.torque_flow(direction)


def lumped(shaft: str, at: float, radius: float) -> Gear:
    return Gear(shaft=shaft, at=at, kind="spur", base_radius=radius, mass=1, polar_inertia=1, diametral_inertia=1)


def torque_balance(model: Model, flow: State) -> dict[str, float]:
    """Sum of the torques on each shaft about +z: applied ones, and those of its meshes."""
    total = dict.fromkeys(model.shafts, 0.0)
    for item in flow.applied:
        total[item.shaft] += item.torque
    for force in flow.forces:
        contact = force.contact
        pull = force.torque_sense * force.normal_force * math.cos(contact.base_helix_angle)
        total[model.gears[contact.pinion].shaft] -= pull * contact.pinion_base_radius
        total[model.gears[contact.gear].shaft] -= pull * contact.gear_base_radius
    return total


def test_the_force_of_a_single_mesh_is_the_torque_over_the_base_radius_along_the_flank_normal(pair: Data) -> None:
    model = Model(**pair)
    (force,) = flow_of(model).forces
    contact = force.contact
    torque = 20e3 / (1500 * math.pi / 30)
    along_line = torque / contact.pinion_base_radius
    assert force.normal_force == pytest.approx(along_line / math.cos(contact.base_helix_angle), rel=1e-9)
    assert (force.torque_sense, force.pinion_drives, force.assumed) == (1, True, False)


def test_naming_the_wheel_the_pinion_changes_who_drives_and_not_the_force(pair: Data) -> None:
    before = flow_of(Model(**pair)).forces[0]
    mesh = pair["meshes"]["stage"]
    mesh["pinion"], mesh["gear"] = mesh["gear"], mesh["pinion"]
    after = flow_of(Model(**pair)).forces[0]
    assert after.normal_force == pytest.approx(before.normal_force, rel=1e-12)
    # The wheel turns negatively and is driven: its shaft holds it back with a positive torque.
    assert (after.torque_sense, after.pinion_drives) == (1, False)


def test_a_train_that_turns_the_other_way_drives_on_the_other_flanks(split: Data) -> None:
    model = Model(**split)
    forwards = flow_of(model)
    backwards = flow_of(model, -1)
    for one, other in zip(forwards.forces, backwards.forces, strict=True):
        assert other.torque_sense == -one.torque_sense
        assert other.pinion_drives == one.pinion_drives
        assert other.normal_force == pytest.approx(one.normal_force, rel=1e-12)


def test_equal_branches_share_the_torque_equally_and_every_shaft_is_in_balance(split: Data) -> None:
    model = Model(**split)
    flow = flow_of(model)
    for stage in ("first", "second"):
        a, b = (sum(force.normal_force for force in flow.of_mesh(f"{stage}_{branch}")) for branch in "ab")
        assert a == pytest.approx(b, rel=1e-9)
    torque = 2.5e6 / (16350 * math.pi / 30)
    assert all(abs(rest) < 1e-9 * torque for rest in torque_balance(model, flow).values())
    assert all(force.pinion_drives and not force.assumed for force in flow.forces)
    assert {force.torque_sense for force in flow.of_mesh("second_a")} == {-1}


def test_unequal_branches_still_balance(split: Data) -> None:
    split["meshes"]["first_a"]["stiffness"] = "2e8 N/m"
    model = Model(**split)
    flow = flow_of(model)
    torque = 2.5e6 / (16350 * math.pi / 30)
    assert all(abs(rest) < 1e-9 * torque for rest in torque_balance(model, flow).values())
    assert flow.of_mesh("second_a")[0].normal_force < 0.9 * flow.of_mesh("second_b")[0].normal_force


def two_meshes_between_two_shafts(section: Section, k1: float, k2: float) -> Model:
    """Input and output shaft with a mesh at each end; the torque enters and leaves at the left one."""
    return Model(
        motions=("torsion",),
        operation=Operation(input_shaft="in"),
        shafts={"in": Shaft(sections=(section,)), "out": Shaft(sections=(section,))},
        gears={
            "p1": lumped("in", 0, 0.05),
            "p2": lumped("in", section.length, 0.05),
            "w1": lumped("out", 0, 0.1),
            "w2": lumped("out", section.length, 0.1),
        },
        meshes={"1": Mesh(pinion="p1", gear="w1", stiffness=k1), "2": Mesh(pinion="p2", gear="w2", stiffness=k2)},
        loads={
            "motor": Load(shaft="in", kind="input", torque=100.0, at="start"),
            "mill": Load(shaft="out", kind="output", at="start"),
        },
    )


def test_between_rigid_shafts_a_loop_splits_by_the_mesh_stiffnesses() -> None:
    rigid = Section(length=0.5, outer_diameter=0.05, rigid=True)
    flow = flow_of(two_meshes_between_two_shafts(rigid, 3e8, 1e8))
    first, second = (force.normal_force for force in flow.forces)
    assert (first, second) == pytest.approx((0.75 * 100 / 0.05, 0.25 * 100 / 0.05), rel=1e-12)


def test_a_long_way_through_shafts_takes_its_share_from_a_loop() -> None:
    section = Section(length=0.5, outer_diameter=0.05)
    flow = flow_of(two_meshes_between_two_shafts(section, 1e8, 1e8))
    twist = 0.5 / (206e9 / 2.6 * math.pi / 32 * 0.05**4)  # L / GJ in rad/(N m)
    # Gives in m/N along the line of action: of mesh 1, and of mesh 2 behind both shafts.
    short = 1e-8
    long = 1e-8 + twist * (0.05**2 + 0.1**2)
    share = long / (short + long)
    assert flow.forces[0].normal_force == pytest.approx(share * 100 / 0.05, rel=1e-9)
    assert flow.forces[1].normal_force == pytest.approx((1 - share) * 100 / 0.05, rel=1e-9)


@pytest.mark.parametrize("torsion", [1e-2, 1.0, 1e3, 1e9])
@pytest.mark.parametrize("rigid", [True, False])
def test_a_coupling_carries_the_whole_torque_however_soft_it_is(torsion: float, rigid: bool) -> None:
    section = Section(length=0.2, outer_diameter=0.05, rigid=rigid)
    model = Model(
        motions=("torsion",),
        operation=Operation(input_shaft="motor", torque=100, output_shaft="out"),
        shafts={name: Shaft(sections=(section,)) for name in ("motor", "in", "out")},
        couplings={"c": Coupling(from_shaft="motor", to_shaft="in", stiffness=StiffnessMatrix(torsion=torsion))},
        gears={"p": lumped("in", 0.1, 0.05), "w": lumped("out", 0.1, 0.1)},
        meshes={"m": Mesh(pinion="p", gear="w", stiffness=5e8)},
    )
    assert flow_of(model).forces[0].normal_force == pytest.approx(100 / 0.05, rel=1e-5 if torsion < 1 else 1e-7)


def test_an_idler_passes_the_force_on_and_takes_no_torque() -> None:
    model = Model(
        motions=("torsion",),
        operation=Operation(input_shaft="a", torque=10, output_shaft="c"),
        shafts={name: Shaft() for name in "abc"},
        gears={"p": lumped("a", 0, 0.05), "idler": lumped("b", 0, 0.08), "w": lumped("c", 0, 0.1)},
        meshes={"1": Mesh(pinion="p", gear="idler", stiffness=1e8), "2": Mesh(pinion="idler", gear="w", stiffness=2e8)},
    )
    first, second = flow_of(model).forces
    assert first.normal_force == pytest.approx(second.normal_force, rel=1e-12)
    assert first.normal_force == pytest.approx(200.0, rel=1e-12)
    assert (first.torque_sense, second.torque_sense) == (1, -1)
    assert first.pinion_drives
    assert second.pinion_drives


def test_a_branch_without_load_is_unloaded_and_its_flank_is_assumed(pair: Data) -> None:
    pair["shafts"]["fan"] = {"position": ["0 mm", "102.161 mm"], "sections": pair["shafts"]["output"]["sections"]}
    pair["gears"]["fan_wheel"] = {**pair["gears"]["wheel"], "shaft": "fan"}
    pair["meshes"]["fan"] = {"pinion": "fan_wheel", "gear": "pinion", "stiffness": 1e8}
    loaded, idle = flow_of(Model(**pair)).forces
    assert not loaded.assumed
    assert idle.assumed
    assert idle.normal_force == 0.0
    # The fan is nearer to nothing: the input drives it, so that its wheel, called pinion, holds back.
    assert (idle.pinion_drives, idle.torque_sense) == (False, 1)


def test_without_loads_every_flank_is_assumed_from_the_walk(pair: Data) -> None:
    pair["operation"] = {"input_shaft": "input", "speed": "1500 rpm"}
    flow = flow_of(Model(**pair))
    assert flow.applied == ()
    assert [(force.assumed, force.normal_force, force.torque_sense) for force in flow.forces] == [(True, 0.0, 1)]


def test_power_is_torque_at_the_speed_of_its_own_shaft(pair: Data) -> None:
    pair["operation"] = {"input_shaft": "input", "speed": "-1500 rpm"}
    pair["loads"] = {
        "mill": {"shaft": "output", "kind": "output", "power": "20 kW"},
        "motor": {"shaft": "input", "kind": "input"},
    }
    torques = {item.name: item.torque for item in flow_of(Model(**pair)).applied}
    at_input = 20e3 / (1500 * math.pi / 30)
    # The output turns negatively and is held back: its torque is positive.
    assert torques == pytest.approx({"loads.mill": 3 * at_input, "loads.motor": at_input}, rel=1e-12)


def test_several_inputs_drive_one_output(split: Data) -> None:
    split["operation"] = {"input_shaft": "input", "speed": "16350 rpm"}
    split["loads"] = {
        "turbine": {"shaft": "input", "kind": "input", "power": "2 MW"},
        "starter": {"shaft": "branch_a", "kind": "input", "power": "0.5 MW"},
        "rotor": {"shaft": "output", "kind": "output"},
    }
    model = Model(**split)
    flow = flow_of(model)
    train = model.layout.train
    speed = 16350 * math.pi / 30
    assert sum(item.torque * train.ratio(item.shaft) for item in flow.applied) * speed == pytest.approx(0.0, abs=1e-3)
    assert {item.name: item.torque for item in flow.applied}["loads.rotor"] == pytest.approx(
        -2.5e6 / speed / train.ratio("output")
    )
    assert all(abs(rest) < 1e-6 for rest in torque_balance(model, flow).values())


def test_two_loads_without_a_torque_are_refused(pair: Data) -> None:
    pair["loads"] = {"mill": {"shaft": "output", "kind": "output"}}
    with pytest.raises(
        ModelError,
        match=r"loads: got loads\.mill, operation\.output_shaft without torque or power, expected at most one",
    ):
        Model(**pair)


@pytest.mark.parametrize("kind", ["static", "dynamic"])
def test_a_contact_about_a_loaded_face_has_its_force_and_moment_there(kind: str, pair: Data) -> None:
    """F = start + k (delta + e t - e t_0) and M = e F + couple + k_t t at the approach and the tilt t_0 of the state."""
    force = flow_of(Model(**pair)).forces[0]
    springs = {"static": FaceSpring(3e8, 2e-3, 4e4), "dynamic": FaceSpring(5e8, -1e-3, 7e4)}
    face = FaceLoad(
        width=0.03,
        misalignment=12e-6,
        force=2400.0,
        moment=7.0,
        approach=9e-6,
        **springs,
        z=np.zeros(1),
        line_load=np.zeros(1),
        load_factor=1.0,
        peak_place=0.0,
        peak_pressure=0.0,
    )
    about = force.about_face(face, 5e-6, kind)  # type: ignore[arg-type]
    spring = springs[kind]
    assert about.face is not None
    assert about.start is not None
    tilt = (5e-6 - 12e-6) / 0.03
    assert about.contact.stiffness == spring.stiffness
    closed = face.approach + about.face.place * tilt - about.face.shift
    found = about.start + about.contact.stiffness * closed
    assert found == pytest.approx(2400.0, rel=1e-12)
    assert about.face.place * found + about.face.couple + about.face.tilt_stiffness * tilt == pytest.approx(7.0)
    assert (about.face.place, about.face.tilt_stiffness) == (spring.place, spring.tilt_stiffness)
