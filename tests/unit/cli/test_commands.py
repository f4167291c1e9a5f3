"""The list of commands needs none of them; each is found by its name."""

from __future__ import annotations

import sys

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from rotorgear.cli.commands import COMMANDS
from rotorgear.cli.main import app
from tests.paths import MODELS


def test_help_lists_all_commands_in_their_groups_and_reads_no_verb(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("run", "show", "bodies"):
        monkeypatch.delitem(sys.modules, f"rotorgear.cli.{name}", raising=False)
    monkeypatch.setattr("rotorgear.cli.verb.source_of", lambda module: pytest.fail(f"{module} was read"))
    said = CliRunner(env={"COLUMNS": "80"}).invoke(app, ["--help"]).output
    assert not {"rotorgear.cli.run", "rotorgear.cli.show", "rotorgear.cli.bodies"} & set(sys.modules)
    assert max(map(len, said.splitlines())) <= 80
    place = 0
    for group in dict.fromkeys(command.group for command in COMMANDS):
        place = said.index(f"\n{group}:\n", place)
        for command in COMMANDS:
            if command.group == group:
                place = said.index(f"\n  {command.name} ", place)


def test_what_the_list_says_of_a_command_fits_its_line() -> None:
    widest = max(len(command.name) for command in COMMANDS)
    assert {command.name for command in COMMANDS if len(command.summary) > 80 - 2 - widest - 2} == set()


def test_a_slip_in_a_command_is_answered_with_its_name_and_an_unknown_one_with_a_refusal() -> None:
    slip = CliRunner().invoke(app, ["modla"])
    assert slip.exit_code == 2
    assert "Did you mean 'modal', 'models'?" in slip.output
    with pytest.raises(KeyError):
        get_command(app).commands["modla"]  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("words", "found"),
    [("", {command.name for command in COMMANDS}), ("mo", {"modal", "models"}), ("root", {"root-stress"})],
)
def test_a_shell_completes_commands(words: str, found: set[str]) -> None:
    environment = {"_ROTORGEAR_COMPLETE": "complete_bash", "COMP_WORDS": f"rotorgear {words}", "COMP_CWORD": "1"}
    said = CliRunner(env=environment).invoke(app, [], prog_name="rotorgear").output
    assert set(said.split()) == found


def test_a_shell_completes_options() -> None:
    environment = {"_ROTORGEAR_COMPLETE": "complete_bash", "COMP_WORDS": "rotorgear modal --sp", "COMP_CWORD": "2"}
    assert CliRunner(env=environment).invoke(app, [], prog_name="rotorgear").output.split() == ["--speed"]


def test_what_was_compiled_ahead_is_not_announced_again() -> None:
    done = CliRunner().invoke(app, ["compile"])
    assert done.exit_code == 0, done.output
    assert done.stdout.startswith("all machine code is ready, after ")
    steps = [line.partition(": ")[2].partition(", after")[0] for line in done.stderr.splitlines()]
    methods = ("exponential steps", "Newmark's steps")
    motions = [f"{of}, {method}" for of in ("transient", "planets that go round") for method in methods]
    assert steps == ["force laws", *motions, "sweep", "orbits"]
    model = str(MODELS / "helical_pair.toml")
    assert (
        "compiling" not in CliRunner().invoke(app, ["transient", model, "--time", "1 ms", "--discard", "0 ms"]).output
    )
