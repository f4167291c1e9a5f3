"""The notebooks: every name in them is public, their links lead somewhere, and they show what they would show today."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path

import pytest
from build_site import NAVIGATION
from machinery.comparison import difference
from machinery.notebooks import code_cells, code_of, notebooks, run_notebook, stored_picture, write_page
from machinery.snippets import ROOT, SnippetError

import rotorgear as rg

BOOKS = [pytest.param(file, id=file.stem) for file in notebooks()]


def used_names(code: str) -> set[str]:
    """Names after `rg.`, and `plot.NAME` for those after `rg.plot.`."""
    found = set()
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.Attribute) and ast.unparse(node.value) in ("rg", "rg.plot"):
            found.add(ast.unparse(node).removeprefix("rg."))
    return found


def write_notebook(file: Path, *codes: str) -> Path:
    """A notebook of these cells of code, below one sentence."""
    cells = [{"cell_type": "markdown", "metadata": {}, "source": ["# Title\n", "\n", "See [Modes](../modal.md)."]}]
    cells += [{"cell_type": "code", "metadata": {}, "source": code.splitlines(True), "outputs": []} for code in codes]
    file.write_text(json.dumps({"cells": cells}), encoding="utf-8")
    return file


@pytest.mark.parametrize("file", BOOKS)
def test_every_name_in_a_notebook_is_public(file: Path) -> None:
    names = set().union(*(used_names(code_of(cell)) for cell in code_cells(json.loads(file.read_text("utf-8")))))
    assert names
    for name in names:
        place, _, last = name.rpartition(".")
        assert last in dir(rg.plot if place else rg), f"{file.name}: rotorgear has no {name}"


@pytest.mark.parametrize("file", BOOKS)
def test_a_notebook_is_small_on_the_site_and_its_links_lead_to_files(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    assert len(text) < 500_000
    assert any(file.stem in names for names in NAVIGATION.values())
    for target in re.findall(r"\]\(((?!https?:)[^)#\s]+)", text):
        assert (file.parent / target).resolve().is_relative_to(ROOT)
        assert (file.parent / target).exists(), f"{file.name}: {target}"


@pytest.mark.parametrize("file", BOOKS)
def test_a_notebook_has_the_parts_that_jupyter_asks_for(file: Path) -> None:
    notebook = json.loads(file.read_text(encoding="utf-8"))
    assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
    assert len({cell["id"] for cell in notebook["cells"]}) == len(notebook["cells"])
    assert [cell["execution_count"] for cell in code_cells(notebook)] == [
        k + 1 for k in range(len(code_cells(notebook)))
    ]


def test_a_cell_shows_what_it_prints_its_last_expression_and_its_figure(tmp_path: Path) -> None:
    figure = "from matplotlib.figure import Figure\nFigure((1, 1))"
    file = write_notebook(tmp_path / "book.ipynb", "%matplotlib inline\nx = 2", "print(x)\nx + 1", figure, "None")
    ran = json.loads(run_notebook(file, tmp_path / "run"))
    shown = [[sorted(output["data"]) for output in cell["outputs"]] for cell in code_cells(ran)]
    assert shown == [[], [["text/plain"]], [["image/png"]], []]
    assert code_cells(ran)[1]["outputs"][0]["data"]["text/plain"] == ["2\n", "3"]
    assert stored_picture(code_cells(ran)[2]).startswith(b"\x89PNG")


def test_what_a_notebook_shows_stays_where_only_seconds_differ(tmp_path: Path) -> None:
    file = write_notebook(tmp_path / "book.ipynb", "print('5.25 mm in 0.1 s')")
    stale = json.loads(run_notebook(file, tmp_path / "one"))
    stale["cells"][1]["outputs"][0]["data"]["text/plain"] = ["5.25 mm in 9.9 s"]
    file.write_text(json.dumps(stale), encoding="utf-8")
    assert "9.9 s" in run_notebook(file, tmp_path / "two")
    stale["cells"][1]["outputs"][0]["data"]["text/plain"] = ["5.35 mm in 9.9 s"]
    file.write_text(json.dumps(stale), encoding="utf-8")
    assert "5.35" not in run_notebook(file, tmp_path / "three")


def test_a_cell_that_fails_is_named(tmp_path: Path) -> None:
    file = write_notebook(tmp_path / "book.ipynb", "x = 1", "1 / 0")
    with pytest.raises(SnippetError, match=r"book.ipynb, code cell 2[\s\S]*ZeroDivisionError"):
        run_notebook(file, tmp_path / "run")


def test_the_page_of_a_notebook_has_its_text_code_and_outputs(tmp_path: Path) -> None:
    file = write_notebook(tmp_path / "book.ipynb", "6 * 7", "from matplotlib.figure import Figure\nFigure((1, 1))")
    file.write_text(run_notebook(file, tmp_path / "run"), encoding="utf-8")
    (tmp_path / "site" / "pictures").mkdir(parents=True)
    page = write_page(file, tmp_path / "site")
    assert page.startswith(
        "# Title\n\nSee [Modes](modal.md).\n\nThis page is a notebook: [book.ipynb](files/book.ipynb)"
    )
    assert "```python\n6 * 7\n```\n\n```text\n42\n```" in page
    assert "](pictures/book_2.png)" in page
    assert (tmp_path / "site" / "pictures" / "book_2.png").exists()
    assert (tmp_path / "site" / "files" / "book.ipynb").exists()


@pytest.mark.long
@pytest.mark.parametrize("file", BOOKS)
def test_a_notebook_runs_and_shows_what_it_would_show_today(file: Path, tmp_path: Path) -> None:
    now = run_notebook(file, tmp_path)
    old = file.read_text(encoding="utf-8")
    assert now == old, f"run  python docs/update.py {file.stem}\n{difference(old, now)[:4000]}"
