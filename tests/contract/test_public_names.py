"""The face of the package: the stub lists every public name once, and what it lists is there."""

from __future__ import annotations

import importlib

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
