"""The page about a model: what stands in it, that its numbers are those of the JSON output, and that it needs nothing else."""

from __future__ import annotations

import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from rotorgear.errors import MissingExtraError
from rotorgear.page.report import Report
from tests.paths import ROOT

STAGE = ROOT / "models" / "helical_pair.toml"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the page of a helical stage with a rig, and its numbers."""
    place = tmp_path_factory.mktemp("report")
    (place / "rig.csv").write_text("frequency_hz,label\n600,one\n<b>,two\n".replace("<b>", "900"), encoding="utf-8")
    arguments = ["report", str(STAGE), "-o", str(place / "a.html"), "--rig", str(place / "rig.csv")]
    done = CliRunner().invoke(app, [*arguments, "--json", str(place / "a.json"), "--turntable"])
    assert done.exit_code == 0, done.output
    # It tells on stderr which analysis it has come to, and for how long it runs; its stdout holds what it wrote.
    steps = [
        line.removeprefix("report: ").partition(", after ") for line in done.stderr.splitlines() if ", after " in line
    ]
    assert [step for step, _, _ in steps][:3] == ["check", "gear", "static"]
    assert {"modal", "rig", "campbell", "critical map", "page", "done"} <= {step for step, _, _ in steps}
    seconds = [float(after.removesuffix(" s")) for _, _, after in steps]
    assert seconds == sorted(seconds)
    assert done.stdout.startswith("wrote ")
    assert ", after " not in done.stdout
    return place


def test_a_report_shows_as_one_line() -> None:
    found = rg.static(rg.load(STAGE))
    shown = repr(Report(Path("a.html"), {"static": found}, {"rig": "no lines given"}, {}))
    assert shown == "Report('a.html': static, missing: rig)"


@pytest.fixture(scope="module")
def page(folder: Path) -> str:
    return (folder / "a.html").read_text(encoding="utf-8")


def value_at(data: Any, pointer: str) -> Any:
    for step in pointer.split("/")[1:]:
        step = step.replace("~1", "/").replace("~0", "~")
        data = data[int(step)] if isinstance(data, list) else data[step]
    return data


class Numbered(HTMLParser):
    """Collects (pointer, factor, text) of all numbers of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[tuple[str, float, str]] = []
        self._open: dict[str, str | None] = {}

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._open = dict(attrs) if tag == "td" else {}

    def handle_data(self, data: str) -> None:
        if "data-key" in self._open:
            self.found.append((str(self._open["data-key"]), float(self._open["data-factor"] or 1.0), data))
            self._open = {}


def test_every_number_is_that_of_the_json_output_in_its_printed_digits(folder: Path, page: str) -> None:
    data = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    reader = Numbered()
    reader.feed(page)
    assert len(reader.found) > 80
    for pointer, factor, text in reader.found:
        shown = text.replace("−", "-")
        if shown.startswith("<"):  # an error that rounding alone decides
            assert factor * value_at(data, pointer) < float(shown[1:])
            continue
        mantissa, _, power = shown.partition("e")
        digits = len(mantissa.partition(".")[2])
        unit = 10.0 ** (int(power or 0) - digits)
        if not digits and "e" not in shown:  # whole numbers may stand for rounded ones
            unit = max(1.0, 10.0 ** (len(mantissa.lstrip("-")) - 3))
        assert abs(float(shown) - factor * value_at(data, pointer)) <= 0.5001 * unit, pointer


def test_the_page_has_a_section_for_what_the_model_has_and_says_why_others_are_not_there(page: str) -> None:
    there = re.findall(r'<section id="([a-z-]+)">', page)
    assert there == ["model", "statics", "modes", "campbell", "critical", "standards", "rig", "errors", "left-out"]
    assert "nothing excites the model" in page


def test_the_page_takes_nothing_from_elsewhere_and_says_what_it_is_about(page: str) -> None:
    assert not re.findall(r'(?:src|href)="(?!data:|#)[^"]*"', re.sub(r'xmlns(?::xlink)?="[^"]*"', "", page))
    assert "url(http" not in page
    assert "helical_pair.toml" in page
    assert rg.__version__ in page
    assert len(page.encode()) < 3e6
    assert "complies" not in page


def test_ids_of_pictures_are_not_shared_and_each_reference_finds_its_own(page: str) -> None:
    ids = re.findall(r'\bid="([^"]+)"', page)
    assert len(ids) == len(set(ids))
    assert set(re.findall(r'(?:href="|url\()#([^")]+)', page)) <= set(ids)


def test_pictures_say_in_words_what_they_show(page: str) -> None:
    assert all("aria-label=" in tag or "xmlns" not in tag for tag in re.findall(r"<svg [^>]*>", page))
    assert all(re.search(r'alt="[^"]+"', tag) for tag in re.findall(r"<img [^>]*>", page))


def luminance(colour: str) -> float:
    parts = [int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_words_stand_out_from_the_page_as_wcag_aa_asks(page: str) -> None:
    style = page.partition("<style>")[2].partition("</style>")[0]
    colours = set(re.findall(r"[^-]color: (#[0-9a-f]{6})", style))
    assert len(colours) >= 5
    for colour in colours:
        assert 1.05 / (luminance(colour) + 0.05) >= 4.5, colour


def test_what_comes_from_a_model_is_no_markup(tmp_path: Path) -> None:
    text = (ROOT / "models" / "torsion_chain.toml").read_text(encoding="utf-8")
    text = re.sub(r"^title = .*$", 'title = "<script>alert(1)</script>"', text, flags=re.MULTILINE)
    rg.report(rg.loads(text), tmp_path / "a.html", turntable=True)
    assert "<script>alert" not in (tmp_path / "a.html").read_text(encoding="utf-8")


def test_a_report_needs_a_page_s_name_a_folder_and_a_study(tmp_path: Path) -> None:
    with pytest.raises(rg.AnalysisError, match=r"ends in \.html"):
        rg.report(STAGE, tmp_path / "a.pdf")
    with pytest.raises(rg.RotorgearError, match="there is no folder"):
        rg.report(STAGE, tmp_path / "none" / "a.html")
    rg.save(rg.check(rg.load(STAGE)), tmp_path / "a.h5")
    with pytest.raises(rg.AnalysisError, match="a convergence study was expected"):
        rg.report(STAGE, tmp_path / "a.html", study=[tmp_path / "a.h5"])


@pytest.mark.parametrize("package", ["jinja2", "matplotlib"])
def test_what_a_page_needs_is_said_before_the_model_is_read(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(MissingExtraError, match=package):
        rg.report("none.toml", "a.html")
