"""The site: every page has a place in its menu, formulas become MathML and code stays code, and it builds without warnings."""

from __future__ import annotations

import runpy
import subprocess
import sys
from pathlib import Path

import build_site
import pytest

from tests.paths import ROOT


def test_every_page_has_a_place_in_the_menu() -> None:
    assert build_site.unlisted() == []


def test_formulas_become_mathml_and_code_keeps_its_dollars() -> None:
    pytest.importorskip("latex2mathml")
    text = "With $\\alpha_t$:\n\n$$K = k\\, v\\, v^T$$\n\n`$x$`\n\n```console\n$ rotorgear modal $FILE$\n```\n"
    made = build_site.with_formulas(text)
    assert made.count("<math") == 2
    assert "`$x$`" in made
    assert "$ rotorgear modal $FILE$" in made


def test_links_out_of_the_docs_lead_to_copies() -> None:
    pytest.importorskip("latex2mathml")
    made = build_site.staged(
        "[a](../models/jeffcott.toml) [b](../CONTRIBUTING.md#style) [c](../README.md) [d](modal.md)"
    )
    assert made == "[a](files/models/jeffcott.toml.txt) [b](CONTRIBUTING.md#style) [c](about.md) [d](modal.md)"


@pytest.mark.long
def test_the_site_builds_without_warnings_and_asks_nothing_of_the_network(tmp_path: Path) -> None:
    pytest.importorskip("mkdocs")
    command = [sys.executable, str(ROOT / "docs" / "build_site.py"), str(tmp_path / "site")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "WARNING" not in done.stderr
    for page in ("index", "theory_parts", "api", "gallery"):
        shown = (tmp_path / "site" / f"{page}.html").read_text(encoding="utf-8")
        loads = [tag for tag in shown.split("<") if tag.startswith(("script", "link", "img"))]
        assert not [tag for tag in loads if 'src="http' in tag or 'rel="stylesheet" href="http' in tag]


@pytest.mark.parametrize("script", sorted((ROOT / "docs").glob("draw_*.py")), ids=lambda script: script.stem)
def test_a_script_of_pictures_finds_all_that_it_imports(script: Path) -> None:
    pytest.importorskip("matplotlib")
    pytest.importorskip("skfem")
    runpy.run_path(str(script), run_name="drawing")
