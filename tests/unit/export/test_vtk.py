import os
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.export import vtk
from rotorgear.export.solids import build_solids
from rotorgear.export.vtk import write_vtk
from rotorgear.files.write import WriteError
from tests.unit.export.small_models import CHAIN, PAIR, modes_of

pv = pytest.importorskip("pyvista")
SPEED = 600.0


@pytest.fixture(scope="module")
def undamped(tmp_path_factory):
    folder = tmp_path_factory.mktemp("undamped")
    return folder, write_vtk(modes_of(PAIR), folder, frames=8)


@pytest.fixture(scope="module")
def damped(tmp_path_factory):
    folder = tmp_path_factory.mktemp("damped")
    return folder, write_vtk(modes_of(PAIR, SPEED), folder, modes=[2], frames=8)


def steps(file):
    """(time, path) of every step of a .pvd file."""
    root = ET.parse(file).getroot()
    assert root.get("type") == "Collection"
    return [(float(item.get("timestep")), file.parent / item.get("file")) for item in root.iter("DataSet")]


@pytest.mark.parametrize("which", ["undamped", "damped"])
def test_every_file_that_a_collection_names_is_there_and_readable(which, request):
    folder, written = request.getfixturevalue(which)
    collections = sorted(folder.glob("*.pvd"))
    assert len(collections) >= 2
    for collection in collections:
        times = [time for time, _ in steps(collection)]
        assert times == sorted(set(times))
        for _, path in steps(collection):
            assert path in written
            assert pv.read(path).n_cells > 0
        assert pv.get_reader(collection).time_values == times
    assert {path for path in folder.rglob("*") if path.is_file()} == set(written)


def test_an_animation_goes_round_once_in_degrees(damped):
    folder, _ = damped
    assert [time for time, _ in steps(folder / "mode_03.pvd")] == [45.0 * k for k in range(9)]


@pytest.mark.parametrize("which", ["undamped", "damped"])
def test_frames_show_the_real_shape_at_the_start_and_minus_the_imaginary_one_after_a_quarter(which, request):
    folder, _ = request.getfixturevalue(which)
    mode = pv.read(folder / "mode_03.vtp")
    frames = [pv.read(path) for _, path in steps(folder / "mode_03.pvd")]
    real, imag = (mode.point_data[f"displacement_{part}"].astype(float) for part in ("real", "imag"))
    size = np.linalg.norm(np.ptp(mode.points, axis=0))
    if which == "damped":
        assert np.max(np.abs(imag)) > 1e-3 * size
    for k, frame in enumerate(frames):
        phase = 2.0 * np.pi * k / 8
        expected = real * np.cos(phase) - imag * np.sin(phase)
        assert np.allclose(frame.point_data["displacement"], expected, rtol=0.0, atol=1e-4 * size)
        assert np.allclose(frame.points - mode.points, expected, rtol=0.0, atol=2e-5 * size)
        assert np.array_equal(frame.faces, mode.faces)


def test_a_motion_in_phase_shows_half_of_its_frames_twice(undamped):
    folder, _ = undamped
    assert len(steps(folder / "mode_03.pvd")) == 9
    assert len(list((folder / "mode_03").iterdir())) == 5


def test_a_mode_says_what_it_is_and_how_its_displacements_are_scaled(damped):
    folder, _ = damped
    result = modes_of(PAIR, SPEED)
    mesh = pv.read(folder / "mode_03.vtp")
    data = mesh.field_data
    assert data["mode"][0] == 3
    assert data["frequency_hz"][0] == result.frequency_hz[2]
    assert data["natural_frequency_hz"][0] == result.natural_frequency_hz[2]
    assert data["damping_ratio"][0] == result.damping_ratio[2]
    assert data["description"][0] == result.description[2]
    assert list(data["part_names"])[mesh.cell_data["part_id"][0]] == "shafts.fast"
    assert {"gears.wheel", "bearings.fast_left"} <= set(data["part_names"])
    for part in ("real", "imag"):
        scaled = mesh.point_data[f"displacement_{part}"]
        plain = mesh.point_data[f"mass_normalised_{part}"]
        assert np.allclose(scaled, data["displacement_scale"][0] * plain, rtol=1e-5, atol=1e-12)
    solids = build_solids(result.model, result.nodes)
    assert np.allclose(
        mesh.point_data["mass_normalised_real"], solids.displacement(result.shapes[:, :, 2]).real, rtol=1e-6, atol=1e-9
    )


def test_every_mode_has_the_same_undeformed_solids_and_names(undamped):
    folder, _ = undamped
    model = pv.read(folder / "model.vtp")
    assert model.n_points == len(build_solids(modes_of(PAIR).model, modes_of(PAIR).nodes).points)
    for number in range(1, 5):
        mesh = pv.read(folder / f"mode_{number:02d}.vtp")
        assert np.array_equal(mesh.points, model.points)
        assert np.array_equal(mesh.faces, model.faces)
        assert list(mesh.field_data["part_names"]) == list(model.field_data["part_names"])
        assert mesh.field_data["mode"][0] == number
    assert "mode" not in model.field_data
    assert set(model.point_data) == set()


def test_the_beam_holds_all_six_dofs_of_all_modes_to_the_last_bit(damped):
    folder, _ = damped
    result = modes_of(PAIR, SPEED)
    mesh = pv.read(folder / "beam.vtp")
    assert np.array_equal(mesh.points, result.nodes.position)
    for mode in range(len(result)):
        for dofs, what in ((slice(0, 3), "translation"), (slice(3, 6), "rotation")):
            name = f"mode_{mode + 1:02d}_{what}"
            both = mesh.point_data[f"{name}_real"] + 1j * mesh.point_data[f"{name}_imag"]
            assert np.array_equal(both, result.shapes[:, dofs, mode])
    assert np.array_equal(mesh.field_data["frequency_hz"], result.frequency_hz)
    assert list(mesh.field_data["description"]) == list(result.description)


def test_each_shaft_of_the_beam_is_one_line_from_left_to_right(damped):
    folder, _ = damped
    result = modes_of(PAIR, SPEED)
    mesh = pv.read(folder / "beam.vtp")
    lines = [list(cell.point_ids) for cell in mesh.cell if cell.n_points > 1]
    assert [mesh.point_data["shaft_id"][line[0]] for line in lines] == [0, 1, 2]
    for line, name in zip(lines, result.model.shafts, strict=True):
        assert line == list(result.nodes.on_shaft(name))
        assert np.all(np.diff(mesh.points[line, 2]) > 0.0)
    assert mesh.n_verts == 1, "the pedestal"
    assert mesh.point_data["outer_diameter"][lines[0][0]] == 0.04


def test_the_index_shows_the_modes_that_were_asked_for(undamped, damped):
    assert [time for time, _ in steps(undamped[0] / "index.pvd")] == [1.0, 2.0, 3.0, 4.0]
    assert [time for time, _ in steps(damped[0] / "index.pvd")] == [3.0]
    text = (damped[0] / "README.txt").read_text(encoding="utf-8")
    assert modes_of(PAIR, SPEED).description[2] in text
    assert "mode_01 " not in text


def test_a_torsion_only_chain_of_rotors_without_shape_can_be_written(tmp_path):
    written = write_vtk(modes_of(CHAIN), tmp_path, modes=[1], frames=4)
    assert {"mode_02.vtp", "mode_02.pvd", "beam.vtp"} <= {path.name for path in written}
    moved = pv.read(tmp_path / "mode_02.vtp").point_data["displacement_real"]
    assert np.max(np.abs(moved)) > 0.0


def test_other_files_in_the_folder_stay_and_old_frames_of_the_same_mode_go(tmp_path):
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    write_vtk(modes_of(PAIR, SPEED), tmp_path, modes=[0, 2], frames=6)
    assert (tmp_path / "mode_03" / "phase_005.vtp").exists()
    (tmp_path / "mode_03" / "notes.txt").write_text("mine", encoding="utf-8")
    write_vtk(modes_of(PAIR, SPEED), tmp_path, modes=[2], frames=4)
    assert (tmp_path / "notes.txt").read_text(encoding="utf-8") == "mine"
    assert sorted(path.name for path in (tmp_path / "mode_03").iterdir()) == [
        "notes.txt",
        "phase_000.vtp",
        "phase_001.vtp",
        "phase_002.vtp",
        "phase_003.vtp",
    ]
    assert (tmp_path / "mode_01.vtp").exists()


def test_an_interrupted_run_leaves_nothing_behind(tmp_path):
    def stop(fraction, text):
        if fraction > 0.0:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_vtk(modes_of(PAIR), tmp_path / "out", frames=2, progress=stop)
    assert not (tmp_path / "out").exists()


def test_progress_rises_from_nothing_to_all(tmp_path):
    told = []
    write_vtk(modes_of(PAIR), tmp_path, modes=[0, 1], frames=2, progress=lambda fraction, text: told.append(fraction))
    assert told == [0.0, 0.5, 1.0]


def test_the_amplitude_is_a_share_of_the_size(tmp_path):
    write_vtk(modes_of(PAIR), tmp_path, modes=[2], frames=2, amplitude=0.11)
    mesh = pv.read(tmp_path / "mode_03.vtp")
    largest = np.max(np.linalg.norm(mesh.point_data["displacement_real"], axis=1))
    assert largest == pytest.approx(0.11 * np.linalg.norm(np.ptp(mesh.points, axis=0)), rel=1e-5)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"modes": [4]}, "there is no mode 5: the result has 4"),
        ({"modes": [-1]}, "there is no mode 0: the result has 4"),
        ({"frames": 1}, "at least 2 frames, got 1"),
        ({"amplitude": 0.0}, "a positive share of the model's size, such as 0.05, got 0"),
        ({"amplitude": float("nan")}, "a positive share"),
    ],
)
def test_what_makes_no_sense_is_said_before_anything_is_written(tmp_path, options, message):
    with pytest.raises(AnalysisError, match=re.escape(message)):
        write_vtk(modes_of(PAIR), tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("place", ["", "deeper/still"])
def test_a_file_in_the_way_of_the_folder_is_reported(tmp_path, place):
    (tmp_path / "taken").write_text("mine", encoding="utf-8")
    with pytest.raises(WriteError, match=r"taken.* can't be written: a file stands in the way"):
        write_vtk(modes_of(PAIR), tmp_path / "taken" / place, modes=[0], frames=2)
    assert (tmp_path / "taken").read_text(encoding="utf-8") == "mine"


def test_a_folder_in_the_way_of_a_file_is_reported(tmp_path):
    (tmp_path / "beam.vtp").mkdir()
    with pytest.raises(WriteError, match=r"beam\.vtp can't be written: a folder of that name stands in the way"):
        write_vtk(modes_of(PAIR), tmp_path, modes=[0], frames=2)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_reported(tmp_path):
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(WriteError, match="permission denied"):
            write_vtk(modes_of(PAIR), tmp_path / "out", modes=[0], frames=2)
    finally:
        tmp_path.chmod(0o700)


def test_a_disk_that_refuses_is_reported_and_nothing_is_left(tmp_path, monkeypatch):
    def refuse(mesh, path):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(vtk, "save_mesh", refuse)
    with pytest.raises(WriteError, match="no space left on device"):
        write_vtk(modes_of(PAIR), tmp_path, modes=[0], frames=2)
    assert list(tmp_path.iterdir()) == []


def test_without_pyvista_the_extra_to_install_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pyvista", None)
    with pytest.raises(MissingExtraError, match=r"VTK output needs the package pyvista.*rotorgear\[vtk\]"):
        write_vtk(modes_of(PAIR), tmp_path)


def test_names_in_other_scripts_and_marks_survive(tmp_path):
    result = modes_of(PAIR)
    lines = ('Welle "ä" <1> & 二, 71 %', *result.description[1:])
    write_vtk(replace(result, description=lines), tmp_path, modes=[0], frames=2)
    assert pv.read(tmp_path / "mode_01.vtp").field_data["description"][0] == lines[0]
    assert lines[0] in (tmp_path / "README.txt").read_text(encoding="utf-8")
