"""Public names, the help of the command line and the pages say the field's words: docs/glossary.md lists what was said before."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.main import get_command

import rotorgear as rg
from rotorgear.cli.main import app
from tests.paths import ROOT

GLOSSARY = ROOT / "docs" / "glossary.md"
# What stands for itself: recorded names of other people's cases, and texts about the change of words.
_TOLD = {"glossary.md"}
_CODE = re.compile(r"`[^`\n]*`")
_PATH = re.compile(r"`[^`\n]*/[^`\n]*`")


def former_words(text: str | None = None) -> list[tuple[str, str]]:
    """Pairs (said before, say) of the glossary's last table."""
    page = GLOSSARY.read_text(encoding="utf-8") if text is None else text
    rows = page.partition("## Former words")[2].splitlines()
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows if row.startswith("| ")]
    return [(old, new) for old, new in cells[1:]]


def pattern_of(word: str) -> re.Pattern[str]:
    """A former word in any number, across lines, with blanks, hyphens or underscores, unless it is part of the new one."""
    if word.startswith("--"):
        return re.compile(rf"(?<![\w-]){re.escape(word)}(?![\w-])")
    first, *rest = word.split()
    plural = {"loss": "loss(?:es)?", "share": "shares?", "piece": "pieces?", "kind": "kinds?"}
    words = [plural.get(part, re.escape(part)) for part in (first, *rest)]
    last = "" if word in ("made or lost", "unclamped", "share without contact") else "s?"
    before = "(?<!least )(?<!least\n)" if word == "common period" else ""
    return re.compile(
        before + r"(?<![A-Za-z])" + r"(?:[\s_-]+|[\s]*\n[\s#>*]*)".join(words) + last + r"(?![A-Za-z])", re.I
    )


def found_in(text: str) -> list[str]:
    """Former words in a text, each with what to say."""
    return [
        f"'{match[0]}' (say: {new})"
        for old, new in former_words()
        for match in pattern_of(old).finditer(text)
        if "least " + old not in text[max(0, match.start() - 6) : match.end()].replace("\n", " ")
    ]


def public_texts() -> Iterator[tuple[str, str]]:
    """Every public name, with its arguments and what its docstring says."""
    for name in rg.__all__:
        item = getattr(rg, name)
        yield f"rotorgear.{name}", name
        if inspect.isroutine(item) or inspect.isclass(item):
            yield f"docstring of rotorgear.{name}", inspect.getdoc(item) or ""
        if inspect.isroutine(item):
            yield f"arguments of rotorgear.{name}", " ".join(inspect.signature(item).parameters)


def helps() -> Iterator[tuple[str, str]]:
    """Every command's help, with the names and the help of its options."""
    for name, command in get_command(app).commands.items():  # type: ignore[attr-defined]
        yield f"rotorgear {name}", f"{name} {command.help}"
        for parameter in command.params:
            yield (
                f"rotorgear {name} {parameter.opts[0]}",
                f"{' '.join(parameter.opts)} {getattr(parameter, 'help', '')}",
            )


def pages() -> list[Path]:
    """The pages of the docs, and the README."""
    return [ROOT / "README.md", *(page for page in sorted((ROOT / "docs").glob("*.md")) if page.name not in _TOLD)]


def test_the_table_of_former_words_is_read() -> None:
    words = dict(former_words())
    assert words["ladder"] == "convergence study"
    assert len(words) >= 15


def test_a_former_word_is_found_in_any_form() -> None:
    assert found_in("an accuracy_ladder, over Ladders")
    assert found_in("three losses of\ncontact")
    assert found_in("each common period")
    assert found_in("give --settle")


@pytest.mark.parametrize(
    "text", ["each least common period", "the least\ncommon period", "it settles", "a bladder", "planes"]
)
def test_what_only_looks_like_a_former_word_is_left_alone(text: str) -> None:
    assert not found_in(text)


def test_public_names_and_their_docstrings_say_the_words_of_the_field() -> None:
    wrong = [f"{place}: {words}" for place, text in public_texts() if (words := found_in(text))]
    assert not wrong, "\n".join(wrong)


def test_the_help_of_every_command_says_the_words_of_the_field() -> None:
    wrong = [f"{place}: {words}" for place, text in helps() if (words := found_in(text))]
    assert not wrong, "\n".join(wrong)


def test_the_keys_of_the_model_file_say_the_words_of_the_field() -> None:
    schema = str(rg.schema())
    assert not found_in(schema)


@pytest.mark.parametrize("page", pages(), ids=lambda page: page.name)
def test_the_pages_say_the_words_of_the_field(page: Path) -> None:
    text = (_CODE if page.name == "json.md" else _PATH).sub("", page.read_text(encoding="utf-8"))
    assert not found_in(text)
