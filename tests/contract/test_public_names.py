"""The face of the package: the stub lists every public name once, and what it lists is there."""

from __future__ import annotations

import importlib
import inspect
import re

import pytest

import rotorgear as rg
from tests.paths import ROOT

STUB = (ROOT / "rotorgear" / "__init__.pyi").read_text(encoding="utf-8").splitlines()
NAMES = [name for name in rg.__all__ if not name.startswith("_")]


def test_every_import_of_the_stub_is_a_line_that_the_loader_reads() -> None:
    # Several names in a line, or a list in brackets, would be seen by type checkers and missed by the loader.
    imports = [line.split() for line in STUB if "import" in line.split()]
    assert all(len(words) == 6 and words[4] == "as" for words in imports)
    assert [words[5] for words in imports] == NAMES
    assert len(set(NAMES)) == len(NAMES) > 50


@pytest.mark.parametrize("name", NAMES)
def test_a_public_name_is_what_the_stub_says(name: str) -> None:
    words = next(line.split() for line in STUB if line.endswith(f" as {name}"))
    assert getattr(rg, name) is getattr(importlib.import_module(words[1]), words[3])


def test_an_unknown_name_is_refused_like_that_of_any_module() -> None:
    with pytest.raises(AttributeError, match="module 'rotorgear' has no attribute 'nothing'"):
        _ = rg.nothing  # type: ignore[attr-defined]


def test_the_package_lists_its_names_for_completion() -> None:
    assert set(NAMES) <= set(dir(rg))


def test_the_stub_and_the_mark_of_types_lie_in_the_package() -> None:
    assert (ROOT / "rotorgear" / "py.typed").exists()


PAGES = {page: page.read_text(encoding="utf-8") for page in [*(ROOT / "docs").glob("*.md"), ROOT / "README.md"]}
EXAMPLES = "\n".join(
    block
    for text in PAGES.values()
    for block in re.findall(r"<!-- run(?: long)? -->\n```python\n(.*?)```", text, flags=re.DOTALL)
)
FUNCTIONS = [name for name in NAMES if inspect.isfunction(getattr(rg, name))]
# A window, and machines elsewhere: pages show their use, and no test of the docs runs it.
NOT_RUN = {"view", "cluster"}
SHOWN = "\n".join(
    block for text in PAGES.values() for block in re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
)


@pytest.mark.parametrize("name", [name for name in NAMES if name != "plot"])
def test_a_public_name_has_a_docstring_and_stands_on_the_page_of_names(name: str) -> None:
    assert inspect.getdoc(getattr(rg, name))
    assert f"`{name}`" in PAGES[ROOT / "docs" / "api.md"].partition("\n## Pictures")[0]


@pytest.mark.parametrize("name", sorted(rg.plot.__all__))
def test_a_picture_stands_on_the_page_of_names(name: str) -> None:
    assert f"`{name}`" in PAGES[ROOT / "docs" / "api.md"].partition("\n## Pictures")[2]


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name != "no_schedule"])
def test_a_public_function_says_what_it_takes(name: str) -> None:
    function = getattr(rg, name)
    if inspect.signature(function).parameters:
        assert "Args:" in (inspect.getdoc(function) or "")


@pytest.mark.parametrize("name", sorted(NOT_RUN))
def test_a_public_function_that_no_test_of_the_docs_can_run_is_used_in_an_example(name: str) -> None:
    assert re.search(rf"\brg\.{name}\(", SHOWN)


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name not in NOT_RUN])
def test_a_public_function_is_used_in_an_example_that_the_tests_of_the_docs_run(name: str) -> None:
    assert re.search(rf"\brg\.{name}\(|^@rg\.{name}$", EXAMPLES, flags=re.MULTILINE)
