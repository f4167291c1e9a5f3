"""The page of a report in a browser without a window, where Chromium is: no message in its console, and paper of A4."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

import rotorgear as rg
from tests.browser.chromium import CHROMIUM, DRAWING, QUIET
from tests.paths import ROOT

pytestmark = [pytest.mark.long, pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")]


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("page")
    return rg.report(ROOT / "models" / "jeffcott.toml", folder / "a.html", turntable=True).path


def chromium(page: Path, *options: str) -> str:
    command = [str(CHROMIUM), "--headless", *QUIET, *DRAWING, f"--user-data-dir={page.parent / 'profile'}", *options]
    run = subprocess.run([*command, page.as_uri()], capture_output=True, text=True, timeout=120, check=False)
    assert run.returncode == 0, run.stderr
    return run.stdout + run.stderr


def test_the_console_says_nothing_and_the_turntable_comes_up(page: Path) -> None:
    said = chromium(page, "--enable-logging=stderr", "--virtual-time-budget=2000", "--dump-dom")
    assert not re.findall(r".*CONSOLE.*", said)
    assert re.search(r'<div id="turntable">', said), "the turntable stayed hidden"
    assert '<option value="0">' in said


def test_an_error_in_a_script_would_be_seen(page: Path) -> None:
    broken = page.with_name("broken.html")
    broken.write_text(
        page.read_text(encoding="utf-8").replace("function turntable(", "none();function turntable("), encoding="utf-8"
    )
    assert re.search(r"CONSOLE.*none is not defined", chromium(broken, "--enable-logging=stderr", "--dump-dom"))


def test_the_page_is_whole_without_script(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert '<div id="turntable" hidden>' in text
    assert text.count("<svg") >= 3
    assert text.index("</main>") < text.index("<script")


def test_the_page_prints_on_a4(page: Path) -> None:
    paper = page.with_suffix(".pdf")
    chromium(page, "--no-pdf-header-footer", f"--print-to-pdf={paper}")
    sizes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", paper.read_bytes())
    assert sizes
    assert all(abs(float(w) - 595.0) < 2.0 and abs(float(h) - 842.0) < 2.0 for w, h in sizes)
