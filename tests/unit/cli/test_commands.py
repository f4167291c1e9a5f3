"""The table of commands says what the commands say, and none of them is imported for it."""

from __future__ import annotations

import sys

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from rotorgear.cli.commands import HELP, function_of
from rotorgear.cli.main import app
from tests.paths import ROOT

# Files of cli/ beside the commands.
SHARED = {"mesh_tasks", "mesh_texts", "__init__", "commands", "common", "main", "old_options", "speed_options"}


@pytest.mark.parametrize("name", HELP)
def test_the_help_of_all_commands_says_what_each_says_of_itself(name: str) -> None:
    function = function_of(name)
    assert function.__doc__.partition("\n")[0] == HELP[name]


def test_every_file_of_the_command_line_is_a_command_or_shared() -> None:
    files = {file.stem for file in (ROOT / "rotorgear" / "cli").glob("*.py")} - SHARED
    assert {name.rstrip("_") for name in files} == set(HELP)


def test_help_imports_no_command_and_lists_all(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in HELP:
        monkeypatch.delitem(sys.modules, f"rotorgear.cli.{name}", raising=False)
    said = CliRunner().invoke(app, ["--help"]).output
    assert not {f"rotorgear.cli.{name}" for name in HELP} & set(sys.modules)
    listed = said.partition("Commands:")[2].splitlines()
    assert [line.split()[0] for line in listed if line.startswith("  ") and line[2:3].isalpha()] == list(HELP)


def test_a_slip_in_a_command_is_answered_with_its_name_and_an_unknown_one_with_a_refusal() -> None:
    slip = CliRunner().invoke(app, ["modla"])
    assert slip.exit_code == 2
    assert "Did you mean 'modal', 'models'?" in slip.output
    with pytest.raises(KeyError):
        get_command(app).commands["modla"]  # type: ignore[attr-defined]
