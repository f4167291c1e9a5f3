"""The site: every page has a place in its menu, formulas become MathML and code stays code, and it builds without warnings."""

from __future__ import annotations

import html
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import build_site
import pytest

from tests.paths import ROOT

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
# Pages that go into others yet count for one more each, as long as they stand by themselves.
OWN = [name for name in ("extreme", "seeds") if (ROOT / "docs" / f"{name}.md").exists()]
MOST_PAGES = 28 + len(OWN)


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
        "[a](../models/jeffcott.toml) [b](../CONTRIBUTING.md#style) [c](../README.md#use) [d](modal.md) [e](../models)"
    )
    shown = "[a](files/models/jeffcott.toml.txt) [b](CONTRIBUTING.md#style) [c](files/README.md.txt) [d](modal.md)"
    assert made == f"{shown} [e](files/models.txt)"


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The built site."""
    pytest.importorskip("mkdocstrings")
    folder = tmp_path_factory.mktemp("built") / "site"
    command = [sys.executable, str(ROOT / "docs" / "build_site.py"), str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "WARNING" not in done.stderr
    return folder


@pytest.mark.long
def test_the_site_has_few_pages(site: Path) -> None:
    pages = [page for page in site.rglob("*.html") if page.name != "404.html"]
    assert len(pages) <= MOST_PAGES, sorted(page.name for page in pages)


@pytest.mark.long
def test_no_page_and_no_style_loads_anything_from_elsewhere(site: Path) -> None:
    loads = re.compile(
        r"<(?:script|img|iframe|source)\b[^>]*\bsrc=[\"']?(?:https?:)?//|<link\b(?![^>]*canonical)[^>]*href=[\"']?(?:https?:)?//"
    )
    styles = re.compile(r"(?:@import\s+[\"']?|url\([\"']?)(?:https?:)?//")
    assert not [page.name for page in site.rglob("*.html") if loads.search(page.read_text(encoding="utf-8"))]
    assert not [style.name for style in site.rglob("*.css") if styles.search(style.read_text(encoding="utf-8"))]
    assert loads.search('<script src="https://unpkg.com/iframe-worker/shim"></script>')


@pytest.mark.long
def test_the_search_has_its_index_as_a_script_and_its_worker_beside_it(site: Path) -> None:
    assert (site / "search" / "search_index.js").read_text(encoding="utf-8").startswith("var __index = {")
    assert (site / "iframe-worker.js").exists()
    assert '<script src="iframe-worker.js"></script>' in (site / "index.html").read_text(encoding="utf-8")


@pytest.mark.long
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_a_page_that_is_opened_from_a_disk_searches(site: Path, tmp_path: Path) -> None:
    options = ["--headless", "--no-sandbox", f"--user-data-dir={tmp_path}", "--virtual-time-budget=10000", "--dump-dom"]
    address = f"{(site / 'index.html').as_uri()}?q=designation"
    done = subprocess.run([str(CHROMIUM), *options, address], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    found = re.findall(
        r'class="md-search-result__link"[^>]*href="([^"?#]*)|href="([^"?#]*)[^"]*"[^>]*md-search-result__link',
        done.stdout,
    )
    assert any("bearings.html" in link for pair in found for link in pair)


@pytest.mark.long
def test_the_page_of_names_shows_types_units_fields_and_errors(site: Path) -> None:
    page = (site / "api.html").read_text(encoding="utf-8")
    modal = page.partition('id="rotorgear.modal"')[2].partition('id="rotorgear.campbell"')[0]
    assert 'href="#rotorgear.ModalResult"' in modal
    assert "AnalysisError" in modal
    result = page.partition('id="rotorgear.ModalResult"')[2].partition('id="rotorgear.CampbellResult"')[0]
    for row in (("frequency_hz", "np.ndarray", "Hz", "mode"), ("speed", "float | None", "rad/s")):
        cells = [re.sub(r"<[^>]+>", "", html.unescape(cell)) for cell in _cells(result, row[0])]
        assert cells[: len(row)] == list(row)
    part = page.partition('id="rotorgear.Section"')[2].partition('id="rotorgear.Disk"')[0]
    cells = [re.sub(r"<[^>]+>", "", html.unescape(cell)) for cell in _cells(part, "length")]
    assert cells[:5] == ["length", "float", "m", "> 0", "required"]


def _cells(text: str, name: str) -> list[str]:
    """The cells of the row of a field."""
    row = next(row for row in text.split("<tr>") if row.lstrip().startswith(f"<td><code>{name}</code>"))
    return re.findall(r"<td>(.*?)</td>", row, flags=re.DOTALL)


@pytest.mark.parametrize("script", sorted((ROOT / "docs").glob("draw_*.py")), ids=lambda script: script.stem)
def test_a_script_of_pictures_finds_all_that_it_imports(script: Path) -> None:
    pytest.importorskip("matplotlib")
    pytest.importorskip("skfem")
    runpy.run_path(str(script), run_name="drawing")
