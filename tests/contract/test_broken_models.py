"""Every file in tests/broken gives its one report: the text beside it, word for word, and nothing else happens.

Each report has a line for every mistake: address, value, what was expected, and the nearest name or the remedy.
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

from rotorgear.errors import ModelError
from rotorgear.model.load import load
from tests.paths import ROOT

BROKEN = ROOT / "tests" / "broken"
FILES = sorted(path.name for path in BROKEN.glob("*.toml"))


def expected(name: str) -> str:
    return (BROKEN / name).with_suffix(".txt").read_text(encoding="utf-8").rstrip("\n")


def test_there_are_many_broken_files_and_each_has_its_report() -> None:
    assert len(FILES) >= 24
    assert sorted(path.name for path in BROKEN.glob("*.txt")) == [Path(name).with_suffix(".txt").name for name in FILES]


@pytest.mark.parametrize("name", FILES)
def test_a_broken_file_gives_its_report_word_for_word(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(BROKEN)
    with pytest.raises(ModelError) as caught:
        load(name)
    assert str(caught.value) == expected(name)


@pytest.mark.parametrize("name", FILES)
def test_a_report_has_one_line_for_each_problem_and_none_twice(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(BROKEN)
    with pytest.raises(ModelError) as caught:
        load(name)
    problems = caught.value.problems
    assert len(str(caught.value).splitlines()) == 1 + len(problems)
    assert len(set(problems)) == len(problems) > 0


def test_a_file_that_is_not_there_is_named_with_its_nearest_neighbour(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(BROKEN)
    with pytest.raises(ModelError) as caught:
        load("unknwon_key.toml")
    assert str(caught.value) == (
        "unknwon_key.toml: 1 problem\n  unknwon_key.toml: there is no such file (did you mean 'unknown_key.toml'?)"
    )


def test_a_folder_and_a_name_that_no_file_can_have_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="can't be read: it is a folder"):
        load(tmp_path)
    with pytest.raises(ModelError, match="can't be read: embedded null byte"):
        load("a\0b.toml")


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "PYTHONDONTWRITEBYTECODE": "1",
        "COLUMNS": "80",
        "NO_COLOR": "1",
    }
    command = [sys.executable, "-m", "rotorgear", *arguments]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=60, check=False)


@pytest.mark.skipif(importlib.util.find_spec("rotorgear.cli.main") is None, reason="there is no command line yet")
@pytest.mark.parametrize(
    "name", ["several_at_once.toml", "unknown_key.toml", "table_twice.toml", "binary.toml", "empty.toml", "gone.toml"]
)
def test_the_command_line_reports_on_stderr_with_exit_code_2_and_writes_nothing(name: str, tmp_path: Path) -> None:
    if (BROKEN / name).exists():
        (tmp_path / name).write_bytes((BROKEN / name).read_bytes())
        report = expected(name)
    else:
        report = f"{name}: 1 problem\n  {name}: there is no such file"
    before = sorted(tmp_path.iterdir())
    done = run(tmp_path, "check", name)
    assert (done.returncode, done.stdout) == (2, "")
    assert report in done.stderr
    assert "Traceback" not in done.stderr
    assert sorted(tmp_path.iterdir()) == before
