"""The command `rotorgear mesh`: what it prints, draws and writes, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid
from typer.testing import CliRunner

from rotorgear.cli.main import app
from rotorgear.errors import RotorgearError
from tests.models import pair_file

PREVIEW = 'stiffness = "tooth_fe"\ntooth_fe = { preset = "preview" }'


@pytest.fixture
def spur(tmp_path: Path) -> Path:
    file = tmp_path / "pair.toml"
    file.write_text(pair_file(mesh=PREVIEW), encoding="utf-8")
    return file


def run(*arguments: object) -> str:
    found = CliRunner().invoke(app, [str(argument) for argument in arguments])
    if found.exception is not None and not isinstance(found.exception, SystemExit):
        raise found.exception
    assert found.exit_code == 0, found.output
    return found.output


def test_it_prints_stiffness_load_body_and_errors_in_eighty_columns(spur: Path) -> None:
    text = run("mesh", spur, "--load-factors", "0.1,1")
    for word in (
        "secant",
        "rim: arc of 7 pitches",
        "F_bt",
        "mean stiffness",
        "contact ratio under load",
        "load factor",
    ):
        assert word in text
    assert max(len(line.rstrip()) for line in text.splitlines()) <= 80


def test_it_draws_and_writes_json(spur: Path, tmp_path: Path) -> None:
    for name in ("curves.png", "curves.svg"):
        run("mesh", spur, "--plot", tmp_path / name, "--json", tmp_path / "mesh.json")
        assert (tmp_path / name).stat().st_size > 10_000
    data = json.loads((tmp_path / "mesh.json").read_text(encoding="utf-8"))
    assert data["analysis"] == "mesh"
    # The positions are not evenly spaced: the mean is an integral over the period.
    position, stiffness = np.array(data["position"]), np.array(data["stiffness_n_per_m"])
    mean = trapezoid(np.append(stiffness, stiffness[0]), np.append(position, position[0] + 1.0))
    assert data["mean_stiffness_n_per_m"] == pytest.approx(mean, rel=1e-3)
    assert data["ste_peak_to_peak_m"] == pytest.approx(np.ptp(data["ste_m"]))


def test_other_stiffness_models_answer_too(spur: Path, tmp_path: Path) -> None:
    for name in ("iso", "contact_line", "potential_energy"):
        text = run("mesh", spur, "--stiffness", name, "--plot", tmp_path / "other.png")
        assert f"stiffness model {name}" in text


@pytest.mark.parametrize(
    "helix", [pytest.param(0.0, id="plane"), pytest.param(20.86, id="space", marks=pytest.mark.long)]
)
def test_vtk_files_hold_meshes_that_touch_and_stresses(helix: float, tmp_path: Path) -> None:
    pv = pytest.importorskip("pyvista")
    file = tmp_path / "pair.toml"
    mesh = 'stiffness = "tooth_fe"\ntooth_fe = { pitches = 3 }'
    text = pair_file(helix, "helical" if helix else "spur", mesh=mesh).replace('"54 mm"', '"20 mm"')
    file.write_text(text, encoding="utf-8")
    run("mesh", file, "--torque", "300 N m", "--vtk", tmp_path / "out", "--positions", 8)
    gears = [pv.read(tmp_path / "out" / f"{name}.vtu") for name in ("pinion", "wheel")]
    contact = pv.read(tmp_path / "out" / "contact.vtp")
    for gear in gears:
        sizes = gear.compute_cell_sizes()
        assert min(sizes["Volume" if helix else "Area"]) > 0.0
        assert np.abs(gear["displacement"]).max() < 50e-6
        assert gear["von_mises"].max() > 1e7
    # The contact lines lie on both flanks: no farther from their nodes than the nodes are apart.
    lines = contact.points.reshape(-1, 2, 3).mean(axis=1)
    for gear in gears:
        nodes = np.asarray(gear.points)
        lines_here = lines if helix else lines * [1.0, 1.0, 0.0]
        far = [np.linalg.norm(nodes - point, axis=1).min() for point in lines_here]
        assert max(far) < 2.5e-3
    # Line load times length is the load of the teeth.
    length = np.linalg.norm(np.diff(contact.points.reshape(-1, 2, 3), axis=1), axis=2).ravel()
    normal = float(np.sum(contact["line_load"] * length))
    radius = 0.5 * 5e-3 * 34 / np.cos(np.radians(helix))
    transverse = np.arctan(np.tan(np.radians(20.0)) / np.cos(np.radians(helix)))
    base_helix = np.arcsin(np.sin(np.radians(helix)) * np.cos(np.radians(20.0)))
    assert normal == pytest.approx(300.0 / (radius * np.cos(transverse) * np.cos(base_helix)), rel=1e-6)
    assert "Largest principal stress" in (tmp_path / "out" / "README.txt").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--torque", "5 mm"), "--torque: got '5 mm'"),
        (("--load-factors", "a,b"), "--load-factors: got 'a,b'"),
        (("--preset", "best"), "preset: got 'best'"),
        (("--plot", "curves.jpg"), "a plot is written as PNG, SVG or PDF"),
    ],
)
def test_mistakes_are_one_sentence(spur: Path, arguments: tuple[str, str], said: str) -> None:
    with pytest.raises(RotorgearError, match=said):
        run("mesh", spur, *arguments)


def test_the_preview_of_a_helical_pair_has_no_body_to_write(tmp_path: Path) -> None:
    file = tmp_path / "pair.toml"
    file.write_text(pair_file(20.86, "helical", mesh=PREVIEW), encoding="utf-8")
    with pytest.raises(RotorgearError, match="has no body to show"):
        run("mesh", file, "--vtk", tmp_path / "out", "--positions", 8)
    assert not (tmp_path / "out").exists()


def test_options_of_one_accuracy_analysis_are_refused_by_the_other(spur: Path) -> None:
    with pytest.raises(RotorgearError, match="--mesh belongs to --analysis mesh"):
        run("accuracy", spur, "--mesh", "pair")
    with pytest.raises(RotorgearError, match="--speed belongs to --analysis modal"):
        run("accuracy", spur, "--analysis", "mesh", "--speed", "100 rpm")
