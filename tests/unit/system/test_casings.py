"""Shafts in a casing: a bar whose matrices are those of the package's own beam, against the same bar as a shaft at rest."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.elements.spring import rigid_transfer
from rotorgear.errors import AnalysisError
from rotorgear.model.model import model_hash
from rotorgear.system.system import System
from tests.bar_casing import STEEL, cube, write_bar
from tests.paths import ROOT

PLACES = np.linspace(0.0, 0.6, 9)
DIAMETER = 0.03
SPRINGS = {"radial": 2e7, "axial": 1e7, "tilt": 300.0}
CROSS = {**SPRINGS, "xy": 1e5, "yx": -2e5}
FLEXIBLE = {"sections": [{"length": 0.6, "outer_diameter": 0.02, "elements": 3}]}


def rotor(**parts: dict[str, Any]) -> rg.Model:
    """A shaft of 20 mm with a disk, turning at 300 rad/s."""
    E, _, nu, rho = STEEL
    tables: dict[str, Any] = {
        "materials": {"bar_steel": {"youngs_modulus": E, "poisson_ratio": nu, "density": rho}},
        "shafts": {"rotor": {"position": [0.0, 0.0], "start": 0.0, "material": "bar_steel", **FLEXIBLE}},
        "disks": {"disk": {"shaft": "rotor", "at": 0.2, "mass": 2.0, "polar_inertia": 3e-3, "diametral_inertia": 2e-3}},
        "operation": {"input_shaft": "rotor", "speed": 300.0},
    }
    return rg.Model(**{key: {**tables.get(key, {}), **parts.get(key, {})} for key in {*tables, *parts}})


def in_casing(path: Path, springs: dict[str, float] = SPRINGS, **more: dict[str, Any]) -> rg.Model:
    """The rotor on two bearings in the bar of a file."""
    return rotor(
        casings={
            "bar": {"matrices": str(path), "seats": {"left": "seat_0", "right": "seat_8"}, **more.pop("casing", {})}
        },
        bearings={
            name: {"shaft": "rotor", "at": at, "casing": "bar", "stiffness": springs, "damping": {"radial": 50.0}}
            for name, at in (("left", "start"), ("right", "end"))
        },
        **more,
    )


def beside_a_shaft(held: bool, springs: dict[str, float] = SPRINGS, **more: dict[str, Any]) -> rg.Model:
    """The same rotor, coupled to a shaft that does not turn, one basic element between two places of the bar."""
    sections = [{"length": float(length), "outer_diameter": DIAMETER, "elements": 1} for length in np.diff(PLACES)]
    bar = {"position": [0.0, 0.0], "start": 0.0, "material": "bar_steel", "sections": sections, "speed_ratio": 0.0}
    parts: dict[str, dict[str, Any]] = {
        "shafts": {"bar": bar},
        "couplings": {
            at: {"from_shaft": "bar", "from_at": at, "to_shaft": "rotor", "to_at": at, "stiffness": springs}
            | {"damping": {"radial": 50.0}}
            for at in ("start", "end")
        },
    }
    if held:
        parts["supports"] = {"ground": {"shaft": "bar", "at": 0.3, "fixed": ["all"]}}
    return rotor(**parts, **more)


@pytest.mark.parametrize("springs", [SPRINGS, CROSS], ids=["springs", "cross terms"])
@pytest.mark.parametrize("speed", [None, 300.0], ids=["standstill", "turning"])
@pytest.mark.parametrize("held", [True, False], ids=["held", "free"])
def test_a_bar_as_casing_has_the_modes_of_the_bar_as_a_shaft(
    tmp_path: Path, held: bool, speed: float | None, springs: dict[str, float]
) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4] if held else [])
    casing = rg.modal(System(in_casing(path, springs)), speed=speed, modes=20, error_estimate=False)
    shaft = rg.modal(System(beside_a_shaft(held, springs)), speed=speed, modes=20, error_estimate=False)
    assert casing.rigid.sum() == shaft.rigid.sum() == (1 if held else 7)
    elastic = ~casing.rigid
    assert casing.natural_frequency_hz[elastic] == pytest.approx(shaft.natural_frequency_hz[elastic], rel=1e-9)
    # Equal pairs may stand in either order.
    decay = np.sort(casing.eigenvalues.real[elastic])
    assert decay == pytest.approx(np.sort(shaft.eigenvalues.real[elastic]), abs=1e-7 * abs(casing.eigenvalues[-1]))


def test_energies_of_a_casing_are_those_of_the_bar_as_a_shaft(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    casing = rg.modal(System(in_casing(path)), modes=9, error_estimate=False)
    shaft = rg.modal(System(beside_a_shaft(True)), modes=9, error_estimate=False)
    assert casing.kinetic_energy["casings.bar"] == pytest.approx(shaft.kinetic_energy["shafts.bar"], abs=1e-9)
    assert casing.strain_energy["casings.bar"] == pytest.approx(shaft.strain_energy["shafts.bar"], abs=1e-9)
    assert sum(casing.kinetic_by_motion.values()) == pytest.approx(np.ones(9))
    assert any(line.startswith("casing bar: ") for line in casing.description)


def test_a_rigid_casing_is_the_ground(tmp_path: Path) -> None:
    # E x 1e6, held at every second node: what is left of its flexibility is below 1e-6 of the bearings'.
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=0.2, seats=[0, 8], held=[1, 4, 7], stiffer=1e6)
    inside = rg.modal(System(in_casing(path)), speed=300.0, modes=12, error_estimate=False)
    bearings = {
        name: {"shaft": "rotor", "at": at, "stiffness": SPRINGS, "damping": {"radial": 50.0}}
        for name, at in (("left", "start"), ("right", "end"))
    }
    ground = rg.modal(System(rotor(bearings=bearings)), speed=300.0, modes=12, error_estimate=False)
    assert inside.natural_frequency_hz == pytest.approx(ground.natural_frequency_hz, rel=1e-5, abs=1e-9)


@pytest.mark.parametrize("held", [True, False], ids=["held", "free"])
def test_its_damping_ratio_is_that_of_its_modes(tmp_path: Path, held: bool) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4] if held else [])
    soft = {"radial": 1e-3, "axial": 1e-3, "tilt": 1e-6}
    model = in_casing(path, soft, casing={"damping_ratio": 0.03}).with_(
        {f"bearings.{n}.damping": None for n in ("left", "right")}
    )
    modes = rg.modal(System(model), speed=0.0, fmax=3000.0, error_estimate=False)
    of_casing = (modes.kinetic_energy["casings.bar"] > 0.99) & (modes.natural_frequency_hz > 1.0)
    assert of_casing.sum() >= 6
    assert modes.damping_ratio[of_casing] == pytest.approx(0.03, rel=1e-6)


def test_its_weight_bends_it_as_a_shaft(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    gravity = {"operation": {"gravity": [0.0, -9.81, 0.0]}}
    casing = rg.static(in_casing(path, **gravity), elements=3)
    shaft = rg.static(beside_a_shaft(True, **gravity), elements=3)
    moved = casing.place_displacement["disks.disk"]
    assert moved == pytest.approx(shaft.place_displacement["disks.disk"], rel=1e-8, abs=1e-14)
    assert moved[1] < -8e-5
    for name, at in (("left", 0.0), ("right", 0.6)):
        node = casing.nodes.nearest("rotor", at)
        other = shaft.nodes.nearest("rotor", at)
        assert casing.displacement[node] == pytest.approx(shaft.displacement[other], rel=1e-8, abs=1e-13), name


def test_a_response_is_that_of_the_bar_as_a_shaft(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    more = {
        "unbalances": {"u": {"shaft": "rotor", "at": 0.2, "magnitude": 1e-5}},
        "points": {"disk": {"on": "disks.disk", "direction": "y"}},
    }
    speeds = ["3000 rpm", "9000 rpm", "14000 rpm"]
    casing = rg.response(in_casing(path, **more), speeds=speeds, elements=3)
    shaft = rg.response(beside_a_shaft(True, **more), speeds=speeds, elements=3)
    assert casing.acceleration == pytest.approx(shaft.acceleration, rel=1e-7)


def test_laws_stand_in_seats_as_springs_do(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    linear = in_casing(path)
    law = {
        "law": "plain_spring",
        "shaft": "rotor",
        "at": "start",
        "casing": "bar",
        "parameters": {"stiffness": "2e7 N/m"},
    }
    given = linear.model_dump(exclude_none=True, exclude_defaults=True)
    given["casings"]["bar"]["seats"] |= {f"law_{along}": {"set": "seat_0"} for along in "xy"}
    given["bearings"]["left"]["stiffness"] = {"axial": 1e7, "tilt": 300.0}
    given["nonlinear_elements"] = {f"law_{along}": {**law, "directions": [along]} for along in "xy"}
    one = rg.modal(System(linear), modes=10, error_estimate=False)
    other = rg.modal(System(rg.Model(**given)), modes=10, error_estimate=False)
    assert other.natural_frequency_hz == pytest.approx(one.natural_frequency_hz, rel=1e-9, abs=1e-9)


def test_a_bearing_beside_the_point_of_its_seat_is_carried_rigidly(tmp_path: Path) -> None:
    # The same rigid body seen from another point: nothing moves but the point.
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    arrays = dict(np.load(path))
    shift = np.eye(len(arrays["mass"]))
    # Motion of the point at z = 0 from that of a point 10 mm further along z: u_x - theta_y a, u_y + theta_x a.
    shift[0, 4] = -0.01
    shift[1, 3] = 0.01
    for name in ("mass", "stiffness"):
        arrays[name] = shift.T @ arrays[name] @ shift
    arrays["weight"] = shift.T @ arrays["weight"]
    arrays["positions"][0, 2] += 0.01
    np.savez(tmp_path / "moved.npz", **arrays)
    one = rg.modal(System(in_casing(path)), modes=10, error_estimate=False)
    other = rg.modal(System(in_casing(tmp_path / "moved.npz")), modes=10, error_estimate=False)
    assert other.natural_frequency_hz == pytest.approx(one.natural_frequency_hz, rel=1e-9, abs=1e-9)
    assert any("carries it rigidly" in note for note in other.left_out)
    assert not any("carries it rigidly" in note for note in one.left_out)


def test_a_shaft_beside_its_seat_is_refused(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    aside = in_casing(path).with_("shafts.rotor.position", [0.0, 0.02])
    with pytest.raises(
        AnalysisError, match=r"bearings.left.casing: the axis of shaft 'rotor' misses seat 'seat_0'.* 20 mm"
    ):
        rg.modal(aside)


def test_a_seat_that_is_not_there_is_named(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    wrong = in_casing(path).with_("casings.bar.seats.left", "seat_1")
    with pytest.raises(AnalysisError, match=r"casing 'bar' has no seat 'seat_1': did you mean 'seat_8'\?"):
        rg.modal(wrong)


def test_what_was_left_out_of_a_casing_is_said(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    found = rg.modal(System(in_casing(path)), modes=4, error_estimate=False).left_out
    assert any(note.startswith("casings.bar: all but the motions of its 2 seats and 36 modes to ") for note in found)


def test_the_hash_of_a_model_follows_what_its_file_holds(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    copy = tmp_path / "elsewhere.npz"
    copy.write_bytes(path.read_bytes())
    assert model_hash(in_casing(copy)) == model_hash(in_casing(path))
    before = model_hash(in_casing(path))
    write_bar(path, z=PLACES, diameter=1.1 * DIAMETER, seats=[0, 8], held=[4])
    assert model_hash(in_casing(path)) != before


def test_a_seat_off_the_axis_holds_a_shaft_that_turns(tmp_path: Path) -> None:
    # Statics leave the torsion to ground of what turns out; a seat beside the axis has a lever, but no torsion.
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    model = in_casing(path, operation={"gravity": [0.0, -9.81, 0.0]})
    aside = model.with_("shafts.rotor.position", [0.001, 0.0])
    weight = 9.81 * (2.0 + STEEL[3] * np.pi * 0.01**2 * 0.6)
    for one in (model, aside):
        forces = rg.static(one, elements=3).bearing_force
        assert sum(force[1] for force in forces.values()) == pytest.approx(weight, rel=1e-9)
        moved = rg.static(one, elements=3).place_displacement["disks.disk"]
        assert moved[1] == pytest.approx(-9.3e-5, rel=0.1)


def with_a_cube(path: Path, side: float) -> Path:
    """Add a cube to the file of a bar that rides rigidly on its first seat."""
    arrays = dict(np.load(path))
    points, triangles = cube(side)
    basis = np.zeros((8, 3, len(arrays["mass"])))
    for k, point in enumerate(points):
        basis[k, :, :6] = rigid_transfer(point)[:3]
    np.savez(path, **arrays, surface_points=points, surface_triangles=triangles, surface_basis=basis)
    return path


def test_the_power_of_a_surface_is_that_of_its_normal_velocity(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    model = in_casing(with_a_cube(path, 0.2), unbalances={"u": {"shaft": "rotor", "at": 0.2, "magnitude": 1e-5}})
    result = rg.response(model, speeds=["6000 rpm"], shape_speed="6000 rpm", elements=2)
    # The shapes hold the motion of the points: a rigid cube that moves and turns sends air off its faces.
    points = result.nodes.of_casing("bar")
    moved = result.shapes[points, :3, 0]
    w = 2.0 * np.pi * 100.0
    surface = model.layout.casing("bar").surface
    assert surface is not None
    normals, areas = surface.normals_and_areas()
    middle = moved[surface.triangles].mean(axis=1)
    squares = np.abs(w * np.sum(normals * middle, axis=1)) ** 2
    assert result.surface_area == pytest.approx([6.0 * 0.2**2])
    assert result.normal_velocity[0, 0, 0] == pytest.approx(np.sqrt(squares @ areas / areas.sum()))
    assert result.radiated_power[0, 0, 0] == pytest.approx(0.5 * 1.204 * 343.2 * squares @ areas)
    assert result.radiated_power[0, 0, 0] > 0.0
    assert f"{result.radiated_power[0, 0, 0]:.3g} W" in " ".join(result.text().split())


def test_results_and_files_hold_the_surface_behind_the_nodes(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    model = in_casing(with_a_cube(path, 0.2))
    result = rg.modal(model, modes=6)
    assert result.nodes.casing[-8:] == ("bar",) * 8
    assert len(result.nodes.shaft) == len(result.shapes)
    assert not result.shapes[result.nodes.of_casing("bar"), 3:].any()
    written = rg.write_vtk(result, tmp_path / "vtk", modes=[2], frames=4)
    pyvista = pytest.importorskip("pyvista")
    solids = pyvista.read(next(file for file in written if file.name == "mode_03.vtp"))
    of_casing = np.flatnonzero(solids.cell_data["shaft_id"] == -1)
    assert len(of_casing) == 12
    assert "shaft_id" in pyvista.read(tmp_path / "vtk" / "beam.vtp").point_data
    numbers = np.unique(np.concatenate([solids.get_cell(int(k)).point_ids for k in of_casing]))
    shown = solids.point_data["mass_normalised_real"][numbers]
    expected = result.shapes[result.nodes.of_casing("bar"), :3, 2].real
    assert np.sort(shown.ravel()) == pytest.approx(np.sort(expected.ravel()), rel=1e-5, abs=1e-7)


def test_frequency_responses_reach_seats_and_points_of_a_casing(tmp_path: Path) -> None:
    path = with_a_cube(write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4]), 0.2)
    seat = "casings.bar.seat_0:y"
    corner = "casings.bar(90 mm; 110 mm; -90 mm):y"
    disk = "disks.disk:y"
    hz = [20.0, 90.0, 200.0]
    there = rg.frf(in_casing(path), hz, inputs=[disk], outputs=[seat, corner], elements=3).receptance[:, :, 0]
    back = rg.frf(in_casing(path), hz, inputs=[seat, corner], outputs=[disk], elements=3).receptance[:, 0, :]
    assert there == pytest.approx(back, rel=1e-8)
    # The cube rides on the seat: u_y = v + theta_z x - theta_x z at its corner (0.1, 0.1, -0.1).
    tilts = [f"casings.bar.seat_0:{name}" for name in ("tilt_x", "torsion")]
    turned = rg.frf(in_casing(path), hz, inputs=[disk], outputs=tilts, elements=3).receptance[:, :, 0]
    assert there[:, 1] == pytest.approx(there[:, 0] + 0.1 * turned[:, 0] + 0.1 * turned[:, 1], rel=1e-8)
    # The same seat as the end of the bar as a shaft at rest.
    points = {"end": {"shaft": "bar", "at": "start", "direction": "y"}}
    shaft = rg.frf(beside_a_shaft(True, points=points), hz, inputs=[disk], outputs=["end"], elements=3).receptance
    assert there[:, 0] == pytest.approx(shaft[:, 0, 0], rel=1e-7)
    for wrong in (
        "casings.box.seat_0:y",
        "casings.bar.seat_7:y",
        "casings.bar(1 mm; 2 mm):y",
        "casings.bar(0 mm; 0 mm; 0 mm):torsion",
    ):
        with pytest.raises(AnalysisError, match=r"^'casings\."):
            rg.frf(in_casing(path), hz, inputs=[disk], outputs=[wrong], elements=3)


def test_a_model_without_casings_loads_no_reader_of_meshes() -> None:
    program = (
        "import sys, rotorgear as rg; rg.modal(rg.load('models/jeffcott.toml'), modes=2);"
        "loaded = {'meshio', 'skfem', 'pymetis', 'scipy.spatial', 'rotorgear.casings.fe_body'} & set(sys.modules);"
        "assert not loaded, loaded"
    )
    subprocess.run([sys.executable, "-c", program], cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, check=True)


def test_the_ground_holds_a_casing_as_it_holds_the_bar_as_a_shaft(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4])
    gravity = {"operation": {"gravity": [1.0, -9.81, 0.5]}}
    model = in_casing(path, **gravity)
    assert (
        rg.static(model, elements=3).casing_force == {}
    )  # the weight of matrices that are held is not known as a whole
    mass = STEEL[3] * np.pi * 0.25 * DIAMETER**2 * 0.6
    model.layout._casings["bar"] = replace(model.layout.casing("bar"), body_mass=mass, centre=np.array([0.0, 0.0, 0.3]))
    found = rg.static(model, elements=3).casing_force["bar"]
    ground = rg.static(beside_a_shaft(True, **gravity), elements=3).support_force["ground"]
    about_origin = ground[3:] + np.cross([0.0, 0.0, 0.3], ground[:3])
    assert found[:3] == pytest.approx(ground[:3], rel=1e-9)
    assert found[3:] == pytest.approx(about_origin, rel=1e-7, abs=1e-7)
    assert found[1] == pytest.approx(9.81 * (mass + 2.0 + STEEL[3] * np.pi * 0.01**2 * 0.6), rel=1e-9)


def test_a_named_point_on_a_casing_is_seen_by_every_analysis(tmp_path: Path) -> None:
    path = with_a_cube(write_bar(tmp_path / "bar.npz", z=PLACES, diameter=DIAMETER, seats=[0, 8], held=[4]), 0.2)
    corner = {"on": "casings.bar", "place": [0.09, 0.11, -0.09], "direction": "y"}
    more: dict[str, Any] = {
        "points": {"corner": corner},
        "unbalances": {"one": {"shaft": "rotor", "at": 0.2, "magnitude": 1e-4}},
        "operation": {"gravity": [0.0, -9.81, 0.0]},
    }
    model = in_casing(path, **more)
    place = "casings.bar(90 mm; 110 mm; -90 mm):y"
    hz = [20.0, 90.0]
    disk = "disks.disk:y"
    by_name = rg.frf(model, hz, inputs=[disk, "corner"], outputs=["corner", disk], elements=2)
    by_place = rg.frf(model, hz, inputs=[disk, place], outputs=[place, disk], elements=2)
    np.testing.assert_array_equal(by_name.receptance, by_place.receptance)
    assert by_name.input_units == ("N", "N")
    # The unbalance as forces of the frequency response: u = H_x F + H_y (-i F), F = m e w^2.
    found = rg.response(model, speeds=[2.0 * np.pi * f for f in hz], elements=2)
    for s, f in enumerate(hz):
        w = 2.0 * np.pi * f
        seen = rg.frf(model, [f], inputs=["disks.disk:x", disk], outputs=["corner"], elements=2, speed=w).receptance[
            0, 0
        ]
        expected = -(w**2) * (1e-4 * w**2) * (seen[0] - 1j * seen[1])
        assert found.acceleration[0, s, 0] == pytest.approx(expected, rel=1e-8)
    modes = rg.modal(model, modes=4, elements=2)
    surface = modes.nodes.of_casing("bar")
    at = modes.nodes.position[surface]
    there = surface[np.argmin(np.linalg.norm(at - [0.09, 0.11, -0.09], axis=1))]
    np.testing.assert_array_equal(modes.point_amplitudes["corner"], modes.shapes[there, 1])
    assert rg.static(model, elements=2).point_displacement["corner"] < 0.0
    for wrong, words in (
        ({"place": None}, "points.corner.place"),
        ({"direction": "torsion"}, "points.corner.direction"),
        ({"shaft": "rotor", "at": 0.1}, "points.corner"),
        ({"on": "casings.box"}, "points.corner.on"),
    ):
        with pytest.raises(rg.ModelError, match=words):
            in_casing(path, **(more | {"points": {"corner": {**corner, **wrong}}}))
