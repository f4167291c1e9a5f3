"""The command `rotorgear transient`: tables, files, refusals."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from rotorgear.errors import RotorgearError
from tests.paths import MODELS

MODEL = MODELS / "helical_pair.toml"
QUICK = ["--time", "5 ms", "--steps", "40"]


def run(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(app, ["transient", *arguments])
    if isinstance(done.exception, RotorgearError):
        return 2, str(done.exception)
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return done.exit_code, done.output


@pytest.fixture
def shaken(tmp_path: Path) -> str:
    """The helical pair with a transmission error."""
    text = MODEL.read_text(encoding="utf-8")
    start = text.index("[meshes.")
    end = text.index("\n", start) + 1
    line = 'transmission_error = [{ harmonic = 1, amplitude = "2 um" }]\nbacklash = "0.1 mm"\n'
    file = tmp_path / "pair.toml"
    file.write_text(text[:end] + line + text[end:], encoding="utf-8")
    return str(file)


def test_the_tables_fit_80_columns_and_name_error_method_and_energy(shaken: str) -> None:
    code, text = run(shaken, *QUICK)
    assert code == 0
    assert max(map(len, text.splitlines())) <= 80
    for words in ("K_dyn", "error: statistics within", "energy error", "steps of"):
        assert words in text


def test_a_result_is_saved_read_again_and_drawn(shaken: str, tmp_path: Path) -> None:
    code, text = run(
        shaken,
        *QUICK,
        "--save",
        str(tmp_path / "run.h5"),
        "--plot",
        str(tmp_path / "pictures"),
        "--json",
        str(tmp_path / "run.json"),
    )
    assert code == 0, text
    assert not (tmp_path / "run.h5.parts").exists()
    result = rg.read(tmp_path / "run.h5")
    data = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    assert data["records"] == len(result.time)
    assert result.mesh_force.shape == (len(result.time), len(data["contacts"]))
    names = {path.name for path in (tmp_path / "pictures").iterdir()}
    assert names >= {"mesh_forces.png", "transmission_error.png", "spectra.png", "energy.png", "shaft_orbits.png"}


@pytest.mark.long
def test_a_run_up_draws_a_spectrogram(shaken: str, tmp_path: Path) -> None:
    code, text = run(
        shaken,
        "--speed",
        "600 rpm",
        "--speed-to",
        "1200 rpm",
        "--time",
        "0.05 s",
        "--steps",
        "40",
        "--plot",
        str(tmp_path / "p"),
    )
    assert code == 0, text
    assert "to 1200 rpm" in " ".join(text.split())
    assert (tmp_path / "p" / "spectrogram.png").is_file()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--resume"], "--resume needs the --save"),
        (["--speed-to", "100 rpm"], "needs a speed to start from"),
        (["--rig", "rig.csv"], "--rig needs --spectrum"),
        (["--method", "magic"], "method: got 'magic'"),
        (["--time", "3 kg"], "a time"),
        (["--spectrum", "points.none acceleration", *QUICK], "there is no history"),
    ],
)
def test_a_mistake_is_answered_with_one_sentence(shaken: str, options: list[str], words: str) -> None:
    code, text = run(shaken, *options)
    assert code == 2
    assert words in text
    assert "Traceback" not in text


@pytest.mark.long
def test_the_convergence_study_of_a_transient_shows_second_order(tmp_path: Path) -> None:
    # Statistics of a pair whose teeth stay in contact: errors and estimates of the same quantities.
    model = rg.load(MODEL.parent / "flexible_pair.toml")
    study = rg.transient_convergence_study(model, steps=(80, 160), accuracies=(), repeat=0)
    for family in ("newmark", "exponential"):
        last = [rung for rung in study.rungs if rung.family == family][-1]
        assert last.order == pytest.approx(2.0, abs=0.15)
        assert last.effectivity == pytest.approx(1.0, abs=0.3)
        assert last.error < 0.01
    picture = rg.plot.save(study.plot(), tmp_path / "study.png")
    assert picture.stat().st_size > 10_000


def test_an_accuracy_that_is_missed_is_a_warning_and_a_status(shaken: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # The step is chosen from the beginning of the run: here it is not allowed to get finer.
    monkeypatch.setattr(
        "rotorgear.analysis.transient.transient.fine_enough", lambda task, integrator, grid, *rest: (grid, 0.25)
    )
    result = rg.transient(rg.load(shaken), time="4 ms", discard=0.0, accuracy=1e-7)
    assert result.error_estimate > 1e-7
    assert result.status.startswith("accuracy 1e-07 not reached: the error is estimated at")
    # With second order an error so many times as large takes as many steps as its root tells.
    steps = 1.0 / (result.step * max(result.mesh_frequency.values()))
    needed = float(result.status.split("; about ")[1].split(" steps")[0])
    assert needed == pytest.approx(steps * np.sqrt(result.error_estimate / 1e-7), rel=0.05)
    assert result.status in result.warnings
    assert not result.ended_early


def test_the_motion_at_the_end_is_written_for_paraview_with_its_times(shaken: str, tmp_path: Path) -> None:
    pv = pytest.importorskip("pyvista")
    code, text = run(
        shaken, *QUICK, "--vtk", str(tmp_path / "motion"), "--frames", "12", "--save", str(tmp_path / "run.h5")
    )
    assert code == 0, text
    result = rg.read(tmp_path / "run.h5")
    assert result.motion_time == pytest.approx(result.time[-12:])
    folder = tmp_path / "motion"
    reader = pv.PVDReader(folder / "motion.pvd")
    assert reader.time_values == pytest.approx(result.motion_time)
    mesh = pv.read(folder / "motion" / "instant_0012.vtp")
    true = mesh.point_data["displacement_m"]
    scaled = mesh.point_data["displacement"]
    assert scaled == pytest.approx(true * mesh.field_data["displacement_scale"][0], rel=1e-4, abs=1e-9)
    node = 0  # the left end of the input shaft moves as its node does
    about = result.motion[node, :3, -1] - result.motion[node, :3].mean(axis=1)
    assert abs(true).max() >= abs(about).max() * 0.999
