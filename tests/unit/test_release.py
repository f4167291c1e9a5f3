"""What a release says of itself: one version and date in all files, and links that work on the page of the package."""

from __future__ import annotations

import re
import tomllib

import check
from rotorgear.version import VERSION
from tests.paths import ROOT

HOOK = ROOT / "docs" / "machinery" / "package_page.py"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def hook() -> dict[str, object]:
    """The functions of the build hook, without hatchling, which only a build has."""
    source = HOOK.read_text(encoding="utf-8")
    source = source.partition("class CustomMetadataHook")[0].replace("from hatchling", "# from hatchling")
    names: dict[str, object] = {"__file__": str(HOOK)}
    exec(compile(source, HOOK.name, "exec"), names)
    return names


def test_the_version_and_its_date_are_those_of_the_changelog_and_the_citation() -> None:
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    newest = re.search(r"^## \[(\d+\.\d+\.\d+)\] - (\d{4}-\d{2}-\d{2})$", changelog, flags=re.MULTILINE)
    assert newest is not None
    assert newest[1] == VERSION
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"version: {VERSION}\n" in citation
    assert f"date-released: {newest[2]}\n" in citation


def test_links_of_the_package_page_are_absolute_or_words() -> None:
    page = hook()["page"]
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert callable(page)
    linked = page(readme, "https://example.org/rotorgear/")
    targets = re.findall(r"\]\(([^)\s]+)\)", linked)
    assert len(targets) > 20
    assert all(target.startswith(("https://", "#")) for target in targets)
    assert "https://example.org/rotorgear/raw/main/docs/pictures/" in linked
    plain = page(readme, "")
    assert all(target.startswith(("http", "#")) for target in re.findall(r"\]\(([^)\s]+)\)", plain))
    assert "Validation" in plain


def test_errors_and_times_in_the_readme_are_those_of_the_page_of_accuracy() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    told = set(re.findall(r"[\w.+-]+", (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8")))
    table = "\n".join(line for line in readme.splitlines() if line.startswith("| ") and "ratio" not in line)
    numbers = re.findall(r"\b\d+\.\d+(?:e-\d+)?\b", table)
    assert len(numbers) > 15
    assert [number for number in numbers if number not in told and f"{number}," not in told] == []


def test_every_dependency_states_an_oldest_version_that_can_be_installed() -> None:
    project = PROJECT["project"]
    stated = [
        *project["dependencies"],
        *(text for group in project["optional-dependencies"].values() for text in group),
    ]
    pinned = {text.partition("==")[0] for text in check.oldest_versions()}
    assert {re.split(r"[>\[;]", text)[0] for text in stated} - {"rotorgear"} == pinned


def test_the_source_archive_has_what_a_reader_of_it_needs() -> None:
    included = PROJECT["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]
    assert {"CONTRIBUTING.md", "CITATION.cff", "SECURITY.md", "docs"} <= set(included)
    assert all((ROOT / name).exists() for name in included)
