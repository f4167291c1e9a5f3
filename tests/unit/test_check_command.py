"""The one command: when it makes its environment anew, what it runs, and how it fails."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import check
from tests.paths import ROOT


@pytest.fixture
def clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A clone with a pyproject.toml and an environment that was completed from it."""
    monkeypatch.setattr(check, "ROOT", tmp_path)
    (tmp_path / "pyproject.toml").write_text("one", encoding="utf-8")
    venv = tmp_path / ".venv"
    check.python_of(venv).parent.mkdir(parents=True)
    check.python_of(venv).touch()
    (venv / "pyvenv.cfg").touch()
    (venv / check.STAMP).write_text(check.fingerprint(), encoding="utf-8")
    return tmp_path


def test_an_environment_is_kept_while_nothing_changed(clone: Path) -> None:
    assert check.is_current(clone / ".venv")


def test_a_change_of_pyproject_makes_the_environment_stale(clone: Path) -> None:
    (clone / "pyproject.toml").write_text("two", encoding="utf-8")
    assert not check.is_current(clone / ".venv")


def test_another_python_makes_the_environment_stale(clone: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "version", "3.99.0 (somewhere else)")
    assert not check.is_current(clone / ".venv")


def test_an_environment_without_its_interpreter_or_its_stamp_is_stale(clone: Path) -> None:
    check.python_of(clone / ".venv").unlink()
    assert not check.is_current(clone / ".venv")
    check.python_of(clone / ".venv").touch()
    assert check.is_current(clone / ".venv")
    (clone / ".venv" / check.STAMP).unlink()
    assert not check.is_current(clone / ".venv")


def test_a_failed_install_leaves_no_stamp(clone: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (clone / "pyproject.toml").write_text("two", encoding="utf-8")
    monkeypatch.setattr(subprocess, "run", lambda command, **_: subprocess.CompletedProcess(command, 1))
    with pytest.raises(check.SetupError, match="pip could not install"):
        check.prepare(clone / ".venv")
    assert not (clone / ".venv" / check.STAMP).exists()


def test_a_directory_that_is_no_environment_is_never_cleared(clone: Path) -> None:
    precious = clone / "precious"
    precious.mkdir()
    (precious / "thesis.txt").touch()
    with pytest.raises(check.SetupError, match="no virtual environment"):
        check.prepare(precious)
    assert (precious / "thesis.txt").exists()


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        ([], ["format", "lint", "types", "tests"]),
        (["--fast"], ["format", "lint", "types", "tests"]),
        (["--only", "types"], ["types"]),
        (["--only", "tests", "--only", "lint"], ["lint", "tests"]),
        (["--only", "docs"], ["docs"]),
        (["--long"], ["format", "lint", "types", "tests", "long"]),
        (["--only", "long", "--long"], ["long"]),
    ],
)
def test_the_options_choose_the_steps(arguments: list[str], names: list[str]) -> None:
    assert [step.name for step in check.chosen(check.parse_arguments(arguments))] == names


def test_the_interpreter_is_found_on_every_system() -> None:
    assert check.python_of(Path("e"), windows=False) == Path("e/bin/python")
    assert check.python_of(Path("e"), windows=True) == Path("e/Scripts/python.exe")


@pytest.mark.parametrize(("keep_going", "last"), [(False, "not run"), (True, "passed")])
def test_a_failing_step_fails_the_run(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], keep_going: bool, last: str
) -> None:
    monkeypatch.setattr(check, "python_of", lambda venv: Path(sys.executable))
    steps = tuple(
        check.Step(name, ("-c", f"print('{name} runs'); raise SystemExit({code})"))
        for name, code in [("a", 0), ("b", 4), ("c", 0)]
    )
    assert check.run_steps(steps, Path(), fix=False, keep_going=keep_going) == 1
    summary = capfd.readouterr().out.split("== summary\n")[1].splitlines()
    assert [line.split()[0] for line in summary] == ["a", "b", "c"]
    assert "passed" in summary[0]
    assert "FAILED" in summary[1]
    assert last in summary[2]


def test_every_step_runs_on_one_thread(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(check, "python_of", lambda venv: Path(sys.executable))
    monkeypatch.setenv("OMP_NUM_THREADS", "8")
    code = "import os; print([os.environ[name + '_NUM_THREADS'] for name in ('OMP', 'OPENBLAS', 'MKL')])"
    assert check.run_steps((check.Step("a", ("-c", code)),), Path(), fix=False, keep_going=False) == 0
    assert "['1', '1', '1']" in capfd.readouterr().out


@pytest.mark.skipif(os.name == "nt", reason="a bash script")
def test_ci_runs_the_one_command_in_a_new_environment(tmp_path: Path) -> None:
    fake = tmp_path / "python3"
    fake.write_text(
        '#!/bin/sh\necho "$PWD|$*|$ROTORGEAR_VENV"\nls "$ROTORGEAR_VENV" 2>/dev/null\nexit 7\n', encoding="utf-8"
    )
    fake.chmod(0o755)
    environment = {**os.environ, "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}", "TMPDIR": str(tmp_path)}
    run = subprocess.run(
        ["bash", str(ROOT / ".ci" / "run")], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert run.returncode == 7
    folder, command, venv = run.stdout.strip().split("|")
    assert (folder, command) == (str(ROOT), "check.py")
    assert Path(venv).is_relative_to(tmp_path)
    assert not Path(venv).parent.exists()
