"""Axes in space: a gearbox written again in other directions says the same of each shaft in that shaft's own frame."""

from __future__ import annotations

import copy
import re
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import rotorgear as rg
from rotorgear.elements.gear_mesh import contact_vector, tilt_vector
from rotorgear.elements.spring import rigid_transfer
from rotorgear.export.solids import build_solids
from rotorgear.model.layout.state import contact_geometry
from tests.bar_casing import write_bar
from tests.paths import MODELS
from tests.turned import PLACE, TURN, far_off, turned

# Statics and response are solved with matrices whose condition eats some digits.
SOLVED = 1e-8


def gearbox(**changes: Any) -> dict[str, Any]:
    """Two helical stages of unequal shafts with all that knows a direction: a coupling, a law, loads, weight, unbalance."""
    section = {"length": 0.26, "outer_diameter": 0.045, "bore": 0.012}
    helical = {"kind": "helical", "normal_module": 0.003, "helix_angle": 0.3, "width": 0.03}
    a = 0.003 * (21 + 44) / 2.0 / np.cos(0.3)
    lower = (a * np.cos(0.4), a * np.sin(0.4))
    tables: dict[str, Any] = {
        "operation": {
            "input_shaft": "motor",
            "speed": 210.0,
            "torque": 90.0,
            "output_shaft": "slow",
            "gravity": [1.5, -9.0, 3.0],
        },
        "damping": {"rayleigh_alpha": 4.0, "rayleigh_beta": 2e-6},
        "shafts": {
            "motor": {"position": (0.0, 0.0), "start": -0.22, "sections": [{"length": 0.2, "outer_diameter": 0.04}]},
            "fast": {"position": (0.0, 0.0), "sections": [section]},
            "slow": {"position": lower, "start": 0.01, "sections": [{**section, "length": 0.24}]},
        },
        "disks": {"fan": {"shaft": "motor", "at": -0.15, "outer_diameter": 0.16, "width": 0.02}},
        "gears": {
            "pinion": {"shaft": "fast", "at": 0.11, "teeth": 21, "hand": "right", **helical},
            "wheel": {"shaft": "slow", "at": 0.113, "teeth": 44, "hand": "left", **helical},
        },
        "meshes": {
            "stage": {
                "pinion": "pinion",
                "gear": "wheel",
                "stiffness": 3e8,
                "tilt": True,
                "damping": 900.0,
                "contact_position": 0.0007,
                "backlash": 6e-5,
                "transmission_error": [{"harmonic": 1, "amplitude": 2e-6, "phase": 0.4}],
            }
        },
        "couplings": {
            "flange": {
                "from_shaft": "motor",
                "to_shaft": "fast",
                "stiffness": {"radial": 5e7, "axial": 2e7, "tilt": 4e4, "torsion": 9e4},
            }
        },
        "bearings": {
            "m": {"shaft": "motor", "at": -0.2, "stiffness": {"x": 9e7, "y": 6e7, "xy": 1e7, "yx": 1e7, "axial": 4e7}},
            "f1": {"shaft": "fast", "at": 0.03, "stiffness": {"x": 2e8, "y": 1.3e8}, "damping": {"radial": 700.0}},
            "f2": {"shaft": "fast", "at": "end", "stiffness": {"radial": 1.7e8}},
            "s1": {"shaft": "slow", "at": "start", "stiffness": {"x": 1e8, "y": 2e8, "axial": 9e7, "tilt": 2e4}},
            "s2": {"shaft": "slow", "at": 0.22, "stiffness": {"radial": 1.1e8}, "damping": {"y": 400.0}},
        },
        "nonlinear_elements": {
            "stop": {
                "law": "plain_spring",
                "shaft": "slow",
                "at": 0.18,
                "directions": ["y"],
                "parameters": {"stiffness": 2e6, "cubic": 1e16},
            }
        },
        "loads": {
            "belt": {"shaft": "motor", "at": -0.18, "force": [130.0, -250.0, 40.0], "moment": [3.0, -2.0, 0.0]},
            "shaker": {"gear": "wheel", "force": [60.0, 20.0, -50.0], "order": 2.0, "phase": 0.3},
        },
        "unbalances": {"u": {"shaft": "motor", "at": -0.15, "magnitude": 2e-4, "phase": 0.7}},
        "points": {"p": {"on": "gears.wheel", "direction": "x"}},
    }
    return tables | changes


@cache
def both(folder: Path | None = None) -> tuple[rg.Model, rg.Model]:
    """The gearbox, and the same one turned in space."""
    model = rg.Model(**gearbox())
    return model, turned(model)


def test_frequencies_of_a_gearbox_stay_where_it_is_turned_in_space() -> None:
    plain, inclined = (rg.modal(model, modes=14, speed=210.0, elements=1) for model in both())
    assert inclined.eigenvalues == pytest.approx(plain.eigenvalues, rel=1e-9)
    assert far_off(plain.point_amplitudes["p"].__abs__(), inclined.point_amplitudes["p"].__abs__()) < SOLVED
    assert inclined.whirl == plain.whirl


def test_statics_say_the_same_in_the_frames_of_the_shafts_and_say_that_they_do() -> None:
    plain, inclined = (rg.static(model, elements=1) for model in both())
    for name in ("mesh_force", "mesh_force_on_gear", "bearing_force", "place_displacement", "load_force", "mesh_phase"):
        assert far_off(getattr(plain, name), getattr(inclined, name)) < SOLVED, name
    assert [face.shaft_misalignment_m for face in inclined.faces] == pytest.approx(
        [face.shaft_misalignment_m for face in plain.faces], rel=SOLVED
    )
    assert "frame of their shaft" in str(inclined)
    assert "frame of their shaft" not in str(plain)


def test_shares_and_sensitivities_of_a_loop_stay_where_it_is_turned_in_space() -> None:
    model = rg.load(MODELS / "split_torque.toml")
    plain, inclined = (rg.static(one, elements=1) for one in (model, turned(model)))
    assert [row.share for row in inclined.shares] == pytest.approx([row.share for row in plain.shares], rel=SOLVED)
    assert far_off(plain.force_derivative, inclined.force_derivative) < SOLVED
    assert [loop.rest_pitches for loop in inclined.assembly] == pytest.approx(
        [loop.rest_pitches for loop in plain.assembly], abs=1e-9
    )


def test_a_response_stays_where_a_gearbox_is_turned_in_space() -> None:
    plain, inclined = (rg.response(model, speeds=[150.0, 210.0], elements=1) for model in both())
    assert inclined.orders == plain.orders
    assert far_off(plain.bearing_force, inclined.bearing_force) < SOLVED
    assert far_off(plain.acceleration, inclined.acceleration) < SOLVED


def test_a_transient_stays_where_a_gearbox_is_turned_in_space() -> None:
    plain, inclined = (rg.transient(model, time=0.004, steps=200, error_estimate=False) for model in both())
    assert far_off(plain.mesh_force, inclined.mesh_force) < SOLVED
    assert far_off(plain.values, inclined.values) < SOLVED


def test_histories_and_moments_from_outside_act_along_the_axes_of_the_model(tmp_path: Path) -> None:
    file = tmp_path / "cutting.csv"
    file.write_text("angle_deg,force_x_N,moment_z_Nm\n0,100,0\n90,300,5\n200,-50,-2\n")
    given = gearbox(loads={"cut": {"shaft": "slow", "at": 0.2, "history": str(file)}})
    given["operation"] = {"input_shaft": "motor", "speed": 210.0}
    given["loads"]["drive"] = {"shaft": "motor", "kind": "input"}
    model = rg.Model(**given)
    plain, inclined = (rg.static(one, elements=1) for one in (model, turned(model)))
    assert far_off(plain.torque, inclined.torque) < SOLVED
    assert far_off(plain.bearing_force, inclined.bearing_force) < SOLVED
    plain_response, response = (rg.response(one, speeds=[210.0], elements=1) for one in (model, turned(model)))
    assert far_off(plain_response.bearing_force, response.bearing_force) < SOLVED
    times = [rg.transient(one, time=0.003, steps=200, error_estimate=False) for one in (model, turned(model))]
    assert far_off(times[0].values, times[1].values) < SOLVED


def test_a_casing_turns_with_its_gearbox(tmp_path: Path) -> None:
    z = np.array([0.0, 0.06, 0.13, 0.22])
    write_bar(tmp_path / "bar.npz", z=z, diameter=0.12, seats=[1, 3], held=[0])
    given = gearbox(casings={"bar": {"matrices": str(tmp_path / "bar.npz"), "seats": {"f1": "seat_1", "f2": "seat_3"}}})
    for name, at in (("f1", 0.065), ("f2", 0.215)):
        given["bearings"][name] |= {"casing": "bar", "at": at}
    given["nonlinear_elements"] = {}
    model = rg.Model(**given)
    inclined = turned(model, folder=tmp_path)
    plain_modes, modes = (rg.modal(one, modes=12, elements=1) for one in (model, inclined))
    assert modes.eigenvalues == pytest.approx(plain_modes.eigenvalues, rel=1e-9, abs=1e-3)


def test_a_shaft_whose_own_axes_are_turned_and_shifted_moves_in_them() -> None:
    """x of the slow shaft is turned by 40 deg about its axis, its z = 0 lies 70 mm up; all else is as it was."""
    phi, up = np.radians(40.0), 0.07
    other = gearbox()
    slow = other["shafts"]["slow"]
    slow |= {"position": (*slow["position"], up), "x_axis": (np.cos(phi), np.sin(phi), 0.0), "start": 0.01 - up}
    other["gears"]["wheel"]["at"] -= up
    for table, name in (("bearings", "s2"), ("nonlinear_elements", "stop")):
        other[table][name]["at"] -= up
    turn = Rotation.from_rotvec([0.0, 0.0, phi]).as_matrix()
    given = gearbox()
    for tables, R in ((given, np.eye(3)), (other, turn)):
        # A bearing is the same one in the turned frame, and the law may go.
        tables["nonlinear_elements"] = {}
        for name in ("s1", "s2"):
            K = np.zeros((6, 6))
            K[:3, :3] = R.T @ np.diag([1e8, 2.3e8, 9e7]) @ R
            tables["bearings"][name] |= {"stiffness": {"matrix": K.tolist()}, "damping": {"radial": 200.0}}
        tables["meshes"]["stage"]["tilt"] = False
    plain, inclined = (rg.static(rg.Model(**tables), elements=1) for tables in (given, other))
    for name in ("f1", "m"):
        assert far_off(plain.bearing_force[name], inclined.bearing_force[name]) < SOLVED
    for place in ("gears.wheel", "bearings.s1"):
        own = inclined.place_displacement[place].reshape(2, 3) @ turn.T
        assert far_off(plain.place_displacement[place].reshape(2, 3), own) < SOLVED
    assert far_off(plain.mesh_force_on_gear, inclined.mesh_force_on_gear @ turn.T) < SOLVED
    plain_modes, modes = (rg.modal(rg.Model(**tables), modes=12, speed=210.0, elements=1) for tables in (given, other))
    assert modes.eigenvalues == pytest.approx(plain_modes.eigenvalues, rel=1e-9)


def test_rigid_motions_strain_no_contact_wherever_its_shafts_point() -> None:
    """v meets all six rigid motions of both gears with 0."""
    model = both()[1]
    force = model.torque_flow(1).forces[0]
    v = contact_vector(contact_geometry(force))
    motions = []
    for place in (force.contact.pinion_place, force.contact.gear_place):
        frame = model.shafts[place.shaft].frame
        motions.append(frame.six.T @ rigid_transfer(frame.at(place.z)))
    assert np.abs(v @ np.vstack(motions)).max() < 1e-12
    # Of a tilt only rotations matter, the same ones of both.
    v_t = tilt_vector(contact_geometry(force))
    assert np.abs(v_t @ np.vstack(motions)).max() < 1e-12


def test_pictures_and_shapes_turn_with_the_gearbox(tmp_path: Path) -> None:
    from rotorgear.uff.read import read_universal

    plain, inclined = (rg.static(model, elements=1) for model in both())
    solids, other = (build_solids(result.model, result.nodes) for result in (plain, inclined))
    assert other.points == pytest.approx(solids.points @ TURN.T + PLACE, abs=1e-12)
    assert other.node_positions == pytest.approx(solids.node_positions @ TURN.T + PLACE, abs=1e-12)
    moved = solids.displacement(plain.displacement) @ TURN.T
    assert far_off(moved, other.displacement(inclined.displacement)) < SOLVED
    shapes = []
    for number, model in enumerate(both()):
        rg.write_uff(rg.modal(model, modes=4, elements=1), tmp_path / f"{number}.unv")
        shapes.append(read_universal(tmp_path / f"{number}.unv").shapes[3].values)
    signs = [-1.0, 1.0]
    straight = (shapes[0].reshape(-1, 2, 3) @ TURN.T).reshape(shapes[1].shape)
    assert min(far_off(sign * straight, shapes[1]) for sign in signs) < 1e-4  # the file has some digits
    with pytest.raises(rg.RotorgearError, match="axes of shaft 'slow'"):
        rg.write_uff(rg.frf(both()[1], inputs=["p"], outputs=["p"], fmax=100.0, points=3), tmp_path / "frf.unv")


def refused(tables: dict[str, Any]) -> str:
    """What a model of some tables is refused with."""
    with pytest.raises(rg.ModelError) as error:
        rg.Model(**copy.deepcopy(tables))
    return re.sub(r"\s+", " ", str(error.value))


def test_axes_that_no_pair_of_parts_can_have_are_refused_with_their_address() -> None:
    tables = gearbox()
    shafts = tables["shafts"]
    shafts["slow"]["axis"] = (0.0, 0.01, 1.0)
    assert "meshes.stage: got shafts whose axes are 0.57" in refused(tables)
    shafts["slow"]["axis"] = (1e-6, 0.0, 1.0)
    assert "meshes.stage: got shafts whose axes are 5.72957795e-05 deg apart" in refused(tables)
    shafts["slow"]["axis"] = (0.0, 0.0, -1.0)
    assert "opposite sides" in refused(tables)
    shafts["slow"]["axis"] = (0.0, 0.0, 0.0)
    assert "shafts.slow.axis" in refused(tables)
    shafts["slow"] |= {"axis": (0.0, 0.0, 2.0), "x_axis": (0.0, 0.0, 1.0)}
    assert "an x_axis that is not along the axis" in refused(tables)
    del shafts["slow"]["x_axis"]
    shafts["motor"]["axis"] = (1.0, 0.0, 0.0)
    assert "couplings.flange: got shafts whose axes are 90 deg apart" in refused(tables)
    shafts["motor"] |= {"axis": (0.0, 0.0, 1.0), "position": (0.0, 0.001, 0.5)}
    assert "couplings.flange: got shafts whose axes are 1 mm apart" in refused(tables)
    shafts["motor"] |= {"axis": (0.0, 0.0, 1.0), "position": (0.0,)}
    assert "shafts.motor.position" in refused(tables)
    shafts["motor"] |= {"axis": (0.0, 1.0, 1.0)}
    del shafts["motor"]["position"]
    assert "shafts.motor.position: missing" in refused(tables)


def test_a_shaft_along_x_has_y_for_its_x_and_any_length_will_do() -> None:
    frame = rg.Model(shafts={"s": {"position": [1, 2, 3], "axis": [7.0, 0, 0]}}).shafts["s"].frame
    assert frame.axes == pytest.approx(np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]))
    assert frame.at(0.5) == pytest.approx([1.5, 2.0, 3.0])
