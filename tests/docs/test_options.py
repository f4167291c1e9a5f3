"""Options and pages agree: what a page says of a command, the command has; and what a command has, stands on a page."""

from __future__ import annotations

import re

import pytest
import typer
from machinery.snippets import ROOT
from update import load_generator

from rotorgear.cli.main import app
from rotorgear.cli.old_options import current

COMMANDS = typer.main.get_command(app).commands  # type: ignore[attr-defined]
OPTIONS = {
    name: {
        option
        for parameter in command.params
        for option in (*parameter.opts, *parameter.secondary_opts)
        if option.startswith("-")
    }
    | {"-h", "--help"}
    for name, command in COMMANDS.items()
}
EVERYWHERE = set.union(*OPTIONS.values()) | {"--version", "--install-completion", "--show-completion"}
PAGES = {page.name: page.read_text(encoding="utf-8") for page in [*(ROOT / "docs").glob("*.md"), ROOT / "README.md"]}
# Options of other tools, by the words of the code that they stand in.
OTHER_TOOLS = ("docs/", "python", "pytest", "dask", "check.py", "pip ", "octave", "mkdocs")
# Those of benchmarks of the repository that stand apart from the word python.
OF_BENCHMARKS = {
    "casings.md": {"--large"},
    "response.md": {"--form", "--flank"},
    "accuracy.md": {"--repetitions", "--longest"},
}
# Pages that tell what former options are called now.
OF_FORMER_NAMES = {"conventions.md"}
_CODE = re.compile(r"^```.*?^```|`[^`\n]+`", re.MULTILINE | re.DOTALL)
_OPTION = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*")
_CALL = re.compile(r"rotorgear (?P<command>[a-z-]+)(?P<rest>[^\n`]*)")


@pytest.mark.parametrize("page", PAGES)
def test_every_option_of_a_command_line_on_a_page_is_one_of_that_command(page: str) -> None:
    calls = [call for code in _CODE.findall(PAGES[page]) for call in _CALL.finditer(code) if call["command"] in OPTIONS]
    wrong = [
        f"rotorgear {call['command']} {option}"
        for call in calls
        for option in _OPTION.findall(call["rest"].partition("#")[0])
        if current([call["command"], option])[-1] not in OPTIONS[call["command"]]
    ]
    assert wrong == []


@pytest.mark.parametrize("page", sorted(set(PAGES) - OF_FORMER_NAMES))
def test_an_option_that_a_page_names_exists(page: str) -> None:
    wrong = {
        option
        for line in re.split(r"\n(?=\S)|(?<=\.)\s", PAGES[page])
        if not any(tool in line for tool in OTHER_TOOLS)
        for option in _OPTION.findall(line)
        if option not in EVERYWHERE
    }
    assert wrong - OF_BENCHMARKS.get(page, set()) == set()


def test_every_command_stands_on_the_page_of_commands_and_every_option_on_that_of_the_site() -> None:
    generator = load_generator(ROOT / "docs" / "generate_commands.py")
    assert generator.pages()["docs/commands.md"] == PAGES["commands.md"]
    assert all(f"| `{command}` |" in PAGES["commands.md"] for command in COMMANDS)
    whole = generator.site_pages()["docs/commands.md"]
    for command, options in OPTIONS.items():
        section = whole.partition(f"\n## {command}\n")[2].partition("\n## ")[0]
        assert {option for option in options if f"`{option}`" not in section} <= {"-h", "--help"}
