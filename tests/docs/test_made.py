"""Pictures and long tables are no older than what they show, and each has its command beside it."""

from __future__ import annotations

import datetime
import re
import subprocess
import tomllib
from pathlib import Path

import numpy as np
import pytest
from machinery import made
from machinery.snippets import ROOT, marked_blocks

import rotorgear as rg
from validation.benchmarks import estimates
from validation.case import read_case
from validation.runner import run

DOCS = ROOT / "docs"
TODAY = datetime.date.today().toordinal()
# What takes about a second; one of them is tried each day.
QUICK_MODELS = ("geared_pair", "jeffcott", "split_torque", *(name for name in estimates.SHOWN if "/" in name))
QUICK_CASES = ("iso6336_stiffness", "jeffcott_rotor", "three_disk_rotor")


def test_pictures_and_long_tables_are_no_older_than_what_they_show() -> None:
    assert made.stale() == []


def test_every_picture_is_shown_where_its_command_stands() -> None:
    sources = [*DOCS.glob("*.md"), *DOCS.glob("generate_*.py")]
    texts = [re.sub(r"\s+", " ", re.sub(r"\\+\n", " ", source.read_text(encoding="utf-8"))) for source in sources]
    wrong = []
    for one in filter(lambda one: one.is_picture, made.pictures()):
        if not any(f"pictures/{one.name}" in text for text in texts):
            wrong.append(f"{one.name}: no page shows it")
        elif not any(f"pictures/{one.name}" in text and one.command in text for text in texts):
            wrong.append(f"{one.name}: no page that shows it says  {one.command}")
    assert wrong == []


def test_every_picture_has_a_command_and_every_command_its_pictures() -> None:
    drawn = {one.name for one in made.pictures() if one.is_picture}
    assert drawn == {file.name for file in (DOCS / "pictures").iterdir() if file.suffix in (".png", ".svg")}


def _table(page: str, command: str) -> list[str]:
    """The lines that a command prints on a page, below the command itself."""
    return next(block.text for block in marked_blocks(DOCS / page) if block.argument == command).splitlines()[1:]


@pytest.mark.parametrize("name", [QUICK_MODELS[TODAY % len(QUICK_MODELS)]])
def test_a_model_has_the_error_that_the_page_on_accuracy_shows(name: str) -> None:
    """Another model every day: a wrong table is found, whatever made it wrong."""
    lines = _table("accuracy.md", "python -m validation.benchmarks.estimates models")
    shown = next(line for line in lines if line.startswith(f"{name} ")).split()
    model = rg.load(estimates.files()[name])
    usual = rg.modal(model, modes=estimates.MODES)
    truth = rg.modal(model, modes=estimates.MODES, accuracy=estimates.REFERENCE)
    elastic = ~usual.rigid
    error = np.abs(usual.natural_frequency_hz[elastic] / truth.natural_frequency_hz[elastic] - 1.0).max()
    assert str(usual.dofs) == shown[1]
    # Two digits are printed, and the last may round either way.
    assert error == pytest.approx(float(shown[4]), rel=0.101)
    assert usual.error_estimate[elastic].max() == pytest.approx(float(shown[5]), rel=0.101)


@pytest.mark.parametrize("name", [QUICK_CASES[TODAY % len(QUICK_CASES)]])
def test_a_case_has_the_lines_that_the_page_on_validation_shows(name: str) -> None:
    line = next(line for line in _table("validation.md", "python -m validation --cases") if line.startswith(f"{name} "))
    rows = list(run([read_case(name)]))
    judged = [row for row in rows if row.judged]
    found = [len(judged), sum(row.passed for row in judged), len(rows) - len(judged)]
    assert [int(word) for word in line.split()[-3:]] == found


MODEL = 'title = "a"\n[bearings.left]\nstiffness = 1e8\nmesh = "box.msh"\n'
MODULE = 'from tool.rules import LIMIT\n\nNAMES = ("one",)\nINPUTS = ("cases/*.csv",)\n'
PAGE = "<!-- made -->\n```console\n$ python -m tool.rows\n1\n```\n\n<!-- file: own.toml -->\n```toml\nteeth = 20\n```\n"


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    files = {
        "models/one.toml": MODEL,
        "models/other.toml": MODEL,
        "models/box.msh": "nodes",
        "docs/page.md": PAGE,
        "docs/made.toml": '[page]\n"rotorgear static own.toml --plot a.png" = { "a.png" = "a.png" }\n'
        '"rotorgear gear models/one.toml --plot b.png" = { "b.png" = "b.png" }\n',
        "tool/rows.py": MODULE,
        "tool/rules.py": '"""Rules."""\n\nLIMIT = 3.0  # of the field\n',
        "cases/a.csv": "a,1",
        "rotorgear/solve.py": "ONE = 1\n",
        "rotorgear/plots/static.py": "from rotorgear.plots.figure import BLUE\nfrom rotorgear.solve import ONE\n",
        "rotorgear/plots/gear_mesh.py": "from rotorgear.plots.figure import BLUE\n",
        "rotorgear/plots/figure.py": "BLUE = 1\n\n\ndef save():\n    return 5\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    for words in (
        ["init", "-q"],
        ["add", "."],
        ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "-qm", "first"],
    ):
        subprocess.run(["git", "-C", str(tmp_path), *words], check=True)
    made.record([one.name for one in (*made.pictures(tmp_path), *made.tables(tmp_path))], tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("file", "old", "new", "stale"),
    [
        ("models/one.toml", "1e8", "2e8", ["b.png", "page"]),
        ("models/one.toml", "1e8", "1.0e8  # the same", []),
        ("models/other.toml", "1e8", "2e8", []),
        ("models/box.msh", "nodes", "others", ["b.png", "page"]),
        ("tool/rows.py", "LIMIT\n", "LIMIT as MOST\n", ["page"]),
        ("tool/rules.py", "3.0", "4.0", ["page"]),
        ("tool/rules.py", "of the field", "of ours", ["page"]),
        ("tool/rules.py", '"""Rules."""', '"""Other words."""\n# and a comment', []),
        ("cases/a.csv", "1", "2", ["page"]),
        ("docs/page.md", "teeth = 20", "teeth = 21", ["a.png"]),
        ("docs/page.md", "<!-- made -->", "Other words.\n\n<!-- made -->", []),
        ("docs/made.toml", "static own.toml", "static own.toml --sensitivity", ["a.png"]),
        ("rotorgear/solve.py", "1", "2", []),
        ("rotorgear/plots/static.py", "BLUE", "BLUE as COLOUR", ["a.png"]),
        ("rotorgear/plots/figure.py", "1", "2", ["a.png", "b.png"]),
        ("rotorgear/plots/figure.py", "5", "6", []),
    ],
)
def test_what_is_shown_makes_a_picture_or_table_old_and_nothing_else_does(
    clone: Path, file: str, old: str, new: str, stale: list[str]
) -> None:
    assert made.stale(clone) == []
    text = (clone / file).read_text(encoding="utf-8")
    assert old in text
    (clone / file).write_text(text.replace(old, new, 1), encoding="utf-8")
    if file == "docs/page.md" and not stale:  # words between a mark and its block would be a mistake of the page
        (clone / file).write_text("Other words.\n\n" + text, encoding="utf-8")
    found = made.stale(clone)
    assert sorted(sentence.split()[0].rstrip(":") for sentence in found) == stale
    for sentence in found:
        assert "python docs/update.py" in sentence
        if (clone / file).suffix != ".md" and file != made.COMMANDS:
            assert f"from other {file}:" in sentence


def test_a_picture_without_a_record_is_old_and_one_that_is_gone_leaves_none(clone: Path) -> None:
    commands = clone / made.COMMANDS
    text = commands.read_text(encoding="utf-8")
    commands.write_text(
        text + '"rotorgear static models/one.toml --plot c.png" = { "c.png" = "c.png" }\n', encoding="utf-8"
    )
    (sentence,) = made.stale(clone)
    assert sentence.startswith("c.png has no record")
    made.record(["c.png"], clone)
    assert made.stale(clone) == []
    commands.write_text("\n".join(text.splitlines()[:2]) + "\n", encoding="utf-8")
    made.record([], clone)
    assert set(made._record(clone)) == {"a.png", "page: tool.rows"}


def test_the_record_of_the_repository_stays_small() -> None:
    assert (ROOT / made.RECORD).stat().st_size < 5120
    assert tomllib.loads((ROOT / made.COMMANDS).read_text(encoding="utf-8"))
