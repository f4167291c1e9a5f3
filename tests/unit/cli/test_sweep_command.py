"""The command `rotorgear sweep`: tables, files, pictures, refusals, and a sweep that is killed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from rotorgear.errors import RotorgearError
from tests.paths import ROOT

PAIR = str(ROOT / "models" / "backlash_pair.toml")
_DRAWN = ("bifurcation_1.png", "sections.png", "portraits_1.png", "spectra_1.png")
QUICK = ["--discard", "40", "--sample", "40"]


def run(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(app, ["sweep", *arguments])
    if isinstance(done.exception, RotorgearError):
        return 2, str(done.exception)
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return done.exit_code, done.output


def test_one_parameter_gives_route_table_files_and_pictures(tmp_path: Path) -> None:
    files = [str(tmp_path / name) for name in ("s.json", "s.h5", "pictures")]
    # Periodic and chaotic points in turn.
    speeds = ",".join(f"{2300 + i} rpm,{3800 + 3 * i} rpm" for i in range(35))
    code, text = run(
        PAIR, "--over", f"operation.speed={speeds}", *QUICK, "--json", files[0], "--save", files[1], "--plot", files[2]
    )
    assert code == 0
    assert max(len(line) for line in text.splitlines() if str(tmp_path) not in line) <= 80
    for words in ("route (rpm): ", "more lines: see --json", "more changes", "speed rpm", "LE", "wrote 4 pictures"):
        assert words in text.replace("\n", " ")
    data = json.loads(Path(files[0]).read_text(encoding="utf-8"))
    read = rg.read(files[1])
    assert len(data["points"]) == 70 == len(read.values)
    assert [r["motion"] for p in data["points"] for r in p["runs"]] == list(read.motion)
    assert not Path(f"{files[1]}.parts").exists()
    assert all((Path(files[2]) / name).stat().st_size > 8000 for name in _DRAWN)
    assert read.portraits.point.tolist() == [0, 9, 17, 26, 34, 43, 52, 60, 69]


def test_up_and_down_have_a_route_each() -> None:
    code, text = run(PAIR, "--over", "operation.speed=7000 rpm:9000 rpm:3", "--direction", "both", *QUICK)
    assert code == 0
    assert "route (up) (rpm): " in text
    assert "route (down) (rpm): " in text


def test_two_parameters_give_a_map(tmp_path: Path) -> None:
    over = ["--over", "operation.torque=5 N m,10 N m,20 N m", "--over", "operation.speed=5000 rpm:9000 rpm:4"]
    code, text = run(PAIR, *over, *QUICK, "--exponents", "0", "--plot", str(tmp_path / "p"))
    assert code == 0
    assert "torque N m" in text
    assert "LE" not in text.split("T is")[0].replace("p-p", "")
    assert all((tmp_path / "p" / f"{name}.png").stat().st_size > 8000 for name in ("map", "portraits_1", "spectra_1"))


def test_portraits_of_chosen_points_are_listed_by_their_lines(tmp_path: Path) -> None:
    over = ["--over", "operation.speed=3000 rpm:4000 rpm:5", "--discard", "300", "--sample", "60", "--steps", "400"]
    code, text = run(PAIR, *over, "--portraits", "3250", "--portraits", "3490 rpm", "--json", str(tmp_path / "s.json"))
    assert code == 0
    table = text.split("Strongest lines")[1]
    assert max(len(line) for line in text.splitlines()) <= 80
    assert [line.split()[:3] for line in table.splitlines()[2:4]] == [["3250", "2T", "0.5:"], ["3500", "4T", "0.5:"]]
    data = json.loads((tmp_path / "s.json").read_text(encoding="utf-8"))
    assert [p["values"] for p in data["portraits"]] == [[3250.0], [3500.0]]
    assert data["portraits"][0]["contacts"][0]["lines"][0]["order"] == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--over", "operation.speed"], "expected ADDRESS="),
        (["--over", "operation.speed=1 rpm,2 rpm", "--over", "operation.speed=3 rpm"], "given twice"),
        (["--over", "meshes.pear.backlash=1 um"], "did you mean 'pair'"),
        (["--over", "operation.speed=6000 rpm", "--resume"], "--resume needs the --save"),
        (["--over", "operation.speed=6000 rpm", "--workers", "0"], "--workers"),
        (["--over", "operation.speed=6000 rpm", "--sample", "0"], "sample: got 0"),
        (["--over", "operation.speed=6000 mm"], "rotational speed"),
        (["--over", "operation.speed=1 rpm:9 rpm:3", "--portraits", "10"], "from 1 to 9 rpm"),
        (
            ["--over", "operation.speed=1 rpm:9 rpm:3", "--portraits", "x"],
            "portrait: got 'x', expected a number in rpm",
        ),
        (["--over", "operation.speed=1 rpm:9 rpm:3", "--portraits", "3,4"], "expected a value of operation.speed"),
    ],
)
def test_mistakes_are_named_in_a_sentence(arguments: list[str], words: str) -> None:
    code, text = run(PAIR, *arguments)
    assert (code, words in text) == (2, True), text


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_a_killed_sweep_goes_on_to_the_same_file(tmp_path: Path) -> None:
    files = [tmp_path / "whole.h5", tmp_path / "killed.h5"]
    command = [
        sys.executable,
        "-m",
        "rotorgear",
        "sweep",
        PAIR,
        "--over",
        "operation.speed=3000 rpm:9000 rpm:64",
        "--discard",
        "200",
        "--sample",
        "100",
        "--workers",
        "1",
    ]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    child = subprocess.Popen([*command, "--save", str(files[1])], env=environment, stdout=subprocess.DEVNULL)
    for _ in range(600):
        if len(list(Path(f"{files[1]}.parts").glob("chunk_*"))) >= 2 or child.poll() is not None:
            break
        time.sleep(0.02)
    child.send_signal(signal.SIGKILL)
    assert child.wait() == -signal.SIGKILL
    arguments = command[4:]
    assert run(*arguments, "--save", str(files[1]), "--resume")[0] == 0
    assert run(*arguments, "--save", str(files[0]))[0] == 0
    whole, killed = (rg.read(file) for file in files)
    assert np.array_equal(whole.section, killed.section)
    assert np.array_equal(whole.lyapunov, killed.lyapunov)
    assert whole.motion == killed.motion


def test_a_large_model_says_what_it_was_reduced_to_and_keeps_that_in_files(tmp_path: Path) -> None:
    flexible = str(ROOT / "models" / "flexible_pair.toml")
    files = [str(tmp_path / name) for name in ("s.json", "s.h5")]
    few = ["--over", "operation.speed=5000 rpm,6000 rpm", "--discard", "9", "--sample", "9"]
    code, text = run(flexible, *few, "--modes", "12", "--elements", "2", "--json", files[0], "--save", files[1])
    assert code == 0
    words = " ".join(text.split())
    assert "156 dofs reduced to 15 (12 modes up to" in words
    assert "1 rigid, 2 static shapes): FRF error at the contacts" in words
    read = rg.read(files[1])
    assert isinstance(read, rg.SweepResult)
    assert read.reduction is not None
    assert read.reduction.to_dict() == json.loads(Path(files[0]).read_text(encoding="utf-8"))["reduction"]
    assert read.reduction.modes == 12
    code, text = run(flexible, *few, "--elements", "6", "--reduction-error", "1e-13")
    assert code == 2
    assert "444 dofs can't be reduced" in text
    assert run(flexible, *few, "--reduction-error", "2") == (
        2,
        "reduction_error: got 2, expected a number between 0 and 1",
    )
