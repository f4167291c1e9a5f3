"""The wheel in an empty environment: what a newcomer types works without a clone.

Builds and installs with pip, which takes packages from the index: a long test.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import venv
from pathlib import Path

import pytest

from tests.paths import ROOT

pytestmark = pytest.mark.long


def run(*command: object, cwd: Path) -> str:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(
        [str(word) for word in command],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the programs of an environment that has the wheel, with the extra of reports, and nothing of this clone."""
    folder = tmp_path_factory.mktemp("wheel")
    run(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", folder, ROOT, cwd=folder)
    wheel = next(folder.glob("rotorgear-*.whl"))
    # This environment's pip fills the empty one: a pip of its own and byte code of all packages would cost a minute for nothing.
    venv.create(folder / "venv", with_pip=False)
    where = folder / "venv" / ("Scripts" if os.name == "nt" else "bin")
    pip = (sys.executable, "-m", "pip", "--python", where / "python")
    run(*pip, "install", "--quiet", "--no-compile", f"{wheel}[report]", cwd=folder)
    return where


def test_the_main_command_of_the_readme_works_from_the_wheel_alone(programs: Path, tmp_path: Path) -> None:
    assert "split_torque" in run(programs / "rotorgear", "models", cwd=tmp_path)
    run(programs / "rotorgear", "new", "split_torque.toml", cwd=tmp_path)
    said = run(
        programs / "rotorgear",
        *("modal", "split_torque.toml", "--fmax", "5000", "--compare", "split_torque_rig.csv", "--json", "a.json"),
        cwd=tmp_path,
    )
    assert "4 of 4 rig lines are within 5 %" in said
    run(
        programs / "rotorgear",
        "report",
        "split_torque.toml",
        "--rig",
        "split_torque_rig.csv",
        "-o",
        "a.html",
        cwd=tmp_path,
    )
    assert "</html>" in (tmp_path / "a.html").read_text(encoding="utf-8")
    assert len(json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))["frequency_hz"]) == 63
