"""Shafts and loads along the faces in equilibrium: closed form, linear states about it, and what it says."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.analysis.static.about_equilibrium import along_faces
from rotorgear.analysis.static.along_faces import equilibrate_along_faces
from rotorgear.analysis.static.mean_state import mean_state
from rotorgear.analysis.static.state_at import state_at
from rotorgear.analysis.transient.notes import transient_left_out
from rotorgear.analysis.transient.request import prepare
from rotorgear.errors import ModelError
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, loaded_cycle
from rotorgear.gears.stiffness.face_load import uniform_line
from rotorgear.system.system import System
from tests.models import clamp, lumped_gear, lumped_pair
from tests.paths import MODELS

STIFFNESS = 4e8
WIDTH = 0.03
# From the pinion's bearing to the middle of its face, and what the bearing puts against tilting.
ARM = 0.08
HOLDS = 2e5


def overhung(torque: float = 200.0, **mesh: Any) -> rg.Model:
    """A rigid spur pinion beside a bearing that gives way to tilting only; its wheel stands still."""
    gear: dict[str, Any] = {"kind": "spur", "normal_module": "4 mm", "width": WIDTH}
    return rg.Model(
        operation={"input_shaft": "one", "output_shaft": "two", "speed": 100.0, "torque": torque},
        shafts={
            "one": {"position": [0.0, 0.0], "sections": [{"length": 0.2, "outer_diameter": 0.05, "rigid": True}]},
            "two": {"position": [0.12, 0.0], "sections": [{"length": 0.2, "outer_diameter": 0.05, "rigid": True}]},
        },
        gears={
            "pinion": {"shaft": "one", "at": 0.02 + ARM, "teeth": 24, **gear},
            "wheel": {"shaft": "two", "at": 0.02 + ARM, "teeth": 36, **gear},
        },
        meshes={"pair": {"pinion": "pinion", "gear": "wheel", "stiffness": STIFFNESS, "tilt": True, **mesh}},
        supports={
            "left": {**clamp("x", "y", "z", shaft="one", at=0.02), "stiffness": {"tilt": HOLDS}},
            "wheel": clamp("x", "y", "z", "tilt_x", "tilt_y", shaft="two", at=0.02),
        },
    )


@pytest.mark.parametrize(("torque", "speed"), [(20.0, 100.0), (200.0, 100.0), (200.0, -100.0)])
@pytest.mark.parametrize("given", [0.0, 3e-5, -4e-5])
def test_a_rigid_pinion_on_a_tilting_bearing_stands_where_its_lever_says(
    torque: float, speed: float, given: float
) -> None:
    result = rg.static(overhung(torque, misalignment=given), speed=speed)
    force = torque / (0.5 * 0.004 * 24 * np.cos(np.radians(20.0)))
    assert result.mesh_force[0] == pytest.approx(force, rel=1e-9)

    # The force pushes the pinion back at ARM + M/F from the bearing, which turns by that moment over its stiffness.
    def left_over(f: float) -> float:
        face = uniform_line(STIFFNESS, WIDTH, force, f)
        return given + WIDTH * force * (ARM + face.load_place) / HOLDS - f

    f = brentq(left_over, -1e-2, 1e-2, xtol=1e-16)
    face = uniform_line(STIFFNESS, WIDTH, force, f)
    row = result.faces[0]
    assert row.misalignment_m == pytest.approx(f, rel=1e-6)
    assert row.shaft_misalignment_m == pytest.approx(f - given, rel=1e-6)
    assert row.face_load_factor == pytest.approx(face.load_factor, rel=1e-6)
    assert row.load_place_m == pytest.approx(face.load_place, rel=1e-5)
    assert result.passes <= 10
    assert result.imbalance < 1e-10
    # The bearing takes the force at its lever: the moment against it is what tilts.
    moment = np.linalg.norm(result.support_force["left"][3:5])
    assert moment == pytest.approx(force * (ARM + face.load_place), rel=1e-5)


@pytest.mark.parametrize("holds", [1e3, 1e4, 3e6])
def test_few_passes_suffice_however_soft_the_bearing(holds: float) -> None:
    result = rg.static(overhung().with_("supports.left.stiffness.tilt", holds))
    assert 1 <= result.passes <= 10
    assert result.faces[0].face_load_factor is not None


def cut_on_its_shaft(integral: bool = True) -> rg.Model:
    """Torsion alone: a wide pinion of 60 mm on a shaft of 20 mm, driven from its left end."""
    gear: dict[str, Any] = {"kind": "spur", "normal_module": "2 mm", "at": 0.1, "width": 0.06}
    return rg.Model(
        motions=["torsion"],
        operation={"input_shaft": "one", "output_shaft": "two", "speed": 100.0, "torque": 100.0},
        shafts={
            "one": {"sections": [{"length": 0.2, "outer_diameter": 0.02}], "material": "steel"},
            "two": {"sections": [{"length": 0.2, "outer_diameter": 0.1}], "material": "steel"},
        },
        gears={
            "pinion": {"shaft": "one", "teeth": 20, "integral": integral, **gear},
            "wheel": {"shaft": "two", "teeth": 80, **gear},
        },
        meshes={
            "pair": {"pinion": "pinion", "gear": "wheel", "stiffness": 2e8, "tilt": True, "centre_line_angle": 0.0}
        },
    )


def test_a_pinion_cut_on_its_shaft_winds_up_under_its_teeth() -> None:
    row = rg.static(cut_on_its_shaft()).faces[0]
    # The torque runs through half of the face: f_0 = r_b^2 F b/(2 G J). The moment M of the load along the face takes
    # r_b^2 M/(G J) of that, and is -k b f/12 while the whole face carries.
    r_b = 0.5 * 0.002 * 20 * np.cos(np.radians(20.0))
    twist = r_b**2 / (206e9 / 2.6 * np.pi * 0.02**4 / 32.0)
    f = twist * (100.0 / r_b) * 0.06 / 2.0 / (1.0 + twist * 2e8 * 0.06 / 12.0)
    assert abs(row.shaft_misalignment_m) == pytest.approx(f, rel=1e-6)
    # The driven end winds up against the teeth: there they carry more.
    assert row.peak_place_m == pytest.approx(-0.03)
    assert rg.static(cut_on_its_shaft(integral=False)).faces[0].shaft_misalignment_m == pytest.approx(0.0, abs=1e-12)


def test_a_pinion_cut_on_a_rigid_shaft_tilts_as_its_node_does() -> None:
    apart = rg.static(overhung()).faces[0]
    cut = rg.static(overhung().with_("gears.pinion.integral", True)).faces[0]
    assert cut.misalignment_m == pytest.approx(apart.misalignment_m, rel=1e-9)


def test_teeth_cut_on_a_shaft_that_ends_below_them_are_refused() -> None:
    with pytest.raises(ModelError, match=r"gears\.pinion\.integral.*a shaft under the whole face"):
        overhung().with_({"gears.pinion.integral": True, "gears.pinion.at": 0.19, "gears.wheel.at": 0.19})


def test_the_misalignment_found_as_a_given_one_on_rigid_shafts_is_the_same_state() -> None:
    found = rg.static(overhung()).faces[0]
    rigid = overhung(misalignment=found.misalignment_m).with_("supports.left.stiffness.tilt", 1e15)
    again = rg.static(rigid).faces[0]
    assert again.misalignment_m == pytest.approx(found.misalignment_m, rel=1e-6)
    assert again.face_load_factor == pytest.approx(found.face_load_factor, rel=1e-6)
    assert again.line_load_n_per_m == pytest.approx(found.line_load_n_per_m, rel=1e-6, abs=1.0)


def test_a_linear_model_about_the_state_has_its_forces_and_its_tangent() -> None:
    model = overhung()
    found = rg.static(model)
    state = along_faces(model, [100.0], model.torque_flow())
    assert all(state.faces.values())
    setup = mean_state(System(model, state=state.of_kind("static")), 100.0)
    assert setup.mean_force == pytest.approx(found.mesh_force, rel=1e-6)
    face = uniform_line(STIFFNESS, WIDTH, float(found.mesh_force[0]), found.faces[0].misalignment_m)
    assert setup.lines.stiffness == pytest.approx([face.static.stiffness], rel=1e-6)
    assert setup.lines.tilt_stiffness == pytest.approx([face.static.tilt_stiffness], rel=1e-6)
    # About a state it stays there, however often it is asked.
    assert along_faces(model, [100.0], model.torque_flow()) is state
    assert state_at(model, [100.0]).forces == state.forces


def test_a_mesh_that_feels_no_tilt_is_as_before() -> None:
    model = overhung(tilt=False)
    result = rg.static(model)
    assert result.faces == ()
    assert result.passes == 0
    assert along_faces(model, [None], model.torque_flow()) is model.torque_flow()
    assert rg.static(model, tilt=True).faces[0].face_load_factor is not None


def test_a_transient_starts_from_the_equilibrium_and_says_how_it_takes_the_tilt() -> None:
    model = overhung()
    task = prepare(model, None, None)
    assert task.rest_force == pytest.approx(rg.static(model).mesh_force, rel=1e-6)
    moved = task.local.system.dofs.expand(task.rest.q)
    node = 6 * task.local.system.nodes.at("one", 0.02 + ARM)
    assert moved[node : node + 5] == pytest.approx(rg.static(model).place_displacement["gears.pinion"][:5], rel=1e-6)
    assert any("resist a tilt by the tangent about it" in note for note in transient_left_out(task.local))


def test_a_tilt_without_a_face_is_refused() -> None:
    with pytest.raises(ModelError, match=r"meshes\.pair\.tilt.*a width of both gears"):
        lumped_pair(lumped_gear("one", 0.05), lumped_gear("two", 0.08), {"tilt": True})


def pinion() -> rg.Model:
    """The model of the docs: loaded teeth of slices that don't feel each other."""
    return rg.load(MODELS / "overhung_pinion.toml")


def test_teeth_of_an_overhung_pinion_rest_with_their_shafts() -> None:
    model = pinion()
    found = equilibrate_along_faces(System(model, state=model.torque_flow().of_kind("static")), 100.0)
    face = found.faces[0]
    assert face is not None
    assert found.passes <= 10
    # The structure puts the force and the moment of the teeth on the shafts.
    assert found.force[0] == pytest.approx(face.force, rel=1e-9)
    assert found.moment[0] == pytest.approx(face.moment - face.static.place * face.force, rel=1e-5)
    # What is found, given to the pair alone, is the same contact.
    alone = rg.mesh(model.with_("meshes.stage.misalignment", face.misalignment), estimate=False)
    assert alone.helix[0].largest_pressure_pa == pytest.approx(face.peak_pressure, rel=1e-6)


def test_models_next_to_each_other_share_the_misalignments_of_their_maps() -> None:
    model = pinion()
    assert model.operation is not None
    speed = model.operation.speed
    about = along_faces(model, [speed], model.torque_flow())
    stiffer = model.with_("bearings.input_left.stiffness.radial", 1.65e8)
    beside = along_faces(stiffer, [speed], replace(stiffer.torque_flow(), mapped_at=about.shared_maps))
    contact = about.forces[0].contact
    shared = about.map_misalignments(contact)
    assert beside.faces["stage"][0].misalignment != about.faces["stage"][0].misalignment
    assert beside.map_misalignments(contact) == shared
    # A state beyond the second outermost of them has a map of its own.
    away = tuple(f + shared[0] - shared[-1] for f in shared)
    assert replace(about, mapped_at={"stage": (away,)}).map_misalignments(contact) == shared


@pytest.mark.long
def test_statics_and_response_of_an_overhung_pinion_are_about_one_state() -> None:
    result = rg.static(pinion())
    row = result.faces[0]
    assert result.imbalance < 1e-9
    alone = rg.mesh(pinion().with_("meshes.stage.misalignment", row.misalignment_m), estimate=False)
    assert result.mesh_deflection[0] == pytest.approx(alone.mean_transmission_error, rel=1e-3)

    crawl = rg.response(pinion(), start="5 rpm", stop="6 rpm", points=2)
    assert crawl.mean_force == pytest.approx(result.mesh_force, rel=1e-6)
    assert crawl.mesh_stiffness == pytest.approx(
        result.mesh_stiffness, rel=0.02
    )  # of the mean load, and of small motions


@pytest.mark.long
def test_shafts_and_teeth_rest_at_every_position_of_the_cycle() -> None:
    """The moment of the teeth and the tilt of the shafts: each position solved by itself, with the misaligned pair alone."""
    setup = mean_state(System(pinion(), state=pinion().torque_flow().of_kind("static")), 100.0)
    joint = setup.joint
    assert joint is not None
    (cycle,) = joint.cycles
    force = float(cycle.force.mean())
    assert cycle.force == pytest.approx(np.full_like(cycle.force, force), rel=1e-6)  # the torque alone decides
    # The shafts are linear: tilt = tilt_0 + a M at one force.
    a, tilt_0 = np.polyfit(cycle.moment[:, 0], cycle.tilt[:, 0], 1)
    teeth = pinion().layout.mesh("stage").teeth

    def alone(f: float, p: int) -> MeshCycle:
        u = np.mod(joint.on_map(0, cycle.position[[p]]), 1.0)
        return loaded_cycle(replace(teeth, misalignment=f), force, u)[1]

    approach = []
    places = range(0, len(cycle.position), 16)
    for p in places:
        about = -teeth.width * float(cycle.tilt[p, 0])
        f = brentq(
            lambda f, p=p: f + teeth.width * (tilt_0 + a * float(alone(f, p).moment[0])),
            0.9 * about,
            1.1 * about,
            xtol=1e-10,
        )
        assert about == pytest.approx(f, rel=2e-3)
        approach.append(float(alone(f, p).deflection[0]))
    assert cycle.approach[list(places), 0] == pytest.approx(approach, abs=5e-3 * np.ptp(approach))
    # At a crawl the response runs through it.
    crawl = rg.response(pinion(), start="5 rpm", stop="6 rpm", points=2)
    orders = np.abs(np.fft.rfft(cycle.approach[:, 0])[1:6]) * 2.0 / len(cycle.position)
    assert np.abs(crawl.approach[:5, 0, 0]) == pytest.approx(orders, rel=1e-2, abs=5e-3 * orders[0])


@pytest.mark.long
def test_teeth_that_do_not_feel_their_shafts_say_so() -> None:
    felt = rg.static(pinion()).faces[0]
    apart = rg.static(pinion().with_("meshes.stage.tilt", False))
    assert any("its teeth do not feel" in note for note in apart.warnings)
    assert any("the teeth do not feel it" in note for note in apart.left_out)
    assert not apart.faces[0].fed_back
    # As on shafts that only the force in the middle of the face bends: an upper bound.
    assert abs(apart.faces[0].shaft_misalignment_m) > abs(felt.shaft_misalignment_m)


@pytest.mark.long
def test_teeth_on_rigid_shafts_carry_as_the_pair_alone() -> None:
    model = rg.load(MODELS / "overhung_pinion.toml").with_("meshes.stage.misalignment", "15 um")
    rigid: dict[str, Any] = {f"bearings.{name}.stiffness.tilt": 1e12 for name in model.bearings}
    rigid |= {f"bearings.{name}.stiffness.radial": 1e14 for name in model.bearings}
    rigid |= {f"shafts.{name}.sections[*].rigid": True for name in model.shafts}
    row = rg.static(model.with_(rigid)).faces[0]
    assert row.shaft_misalignment_m == pytest.approx(0.0, abs=1e-9)
    alone = rg.mesh(model, estimate=False)
    assert row.peak_pressure_pa == pytest.approx(alone.helix[0].largest_pressure_pa, rel=1e-4)


@pytest.mark.long
def test_a_transient_of_loaded_teeth_rests_on_their_map_at_the_misalignment_of_the_equilibrium() -> None:
    task = prepare(pinion(), None, None)
    system = task.local.system
    force = system.state.forces[0]
    assert force.face is not None
    moved = system.dofs.expand(task.rest.q)
    approach, tilt = task.local.parts[0].columns.T @ moved
    teeth = pinion().layout.mesh("stage").teeth
    u = np.array([(system.state.phase(force.contact) or 0.0) / (2.0 * np.pi)])
    taken = loaded_cycle(replace(teeth, misalignment=-teeth.width * float(tilt)), force.normal_force, u)[1]
    assert approach == pytest.approx(float(taken.deflection[0]), rel=2e-3)
    assert task.rest.force[1] == pytest.approx(float(taken.moment[0]), rel=2e-3)
    at_rest = rg.static(pinion()).place_displacement["gears.pinion"]
    node = 6 * system.nodes.at("input", 0.0)
    assert moved[node : node + 5] == pytest.approx(
        at_rest[:5], rel=1e-2, abs=1e-12
    )  # there of the mean of the cycle, here of one position


@pytest.mark.long
def test_helical_teeth_of_the_other_hand_turned_backwards_carry_alike() -> None:
    model = rg.load(MODELS / "helical_pair.toml").with_(
        {
            "meshes.stage.tilt": True,
            "meshes.stage.stiffness": "tooth_fe",
            "meshes.stage.tooth_fe.preset": "preview",
            "bearings.input_right.at": "-100 mm",
        }
    )
    mirror = model.with_({"gears.pinion.hand": "left", "gears.wheel.hand": "right"})
    found = []
    for one, direction in ((model, 1), (mirror, -1)):
        system = System(one, state=one.torque_flow(direction).of_kind("static"))
        face = equilibrate_along_faces(system, direction * 311.0).faces[0]
        assert face is not None
        # The overhang bends away from the mesh: the end of the face towards the bearings carries more, whatever the hand.
        assert face.misalignment > 0.0
        assert face.load_place < 0.0
        found.append((face.misalignment, face.load_place, face.load_factor, face.approach))
    assert found[0] == pytest.approx(found[1], rel=1e-6)
