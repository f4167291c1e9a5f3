"""A verb is declared once: its command has the names, types, defaults and words of its signature and docstring, and no others."""

from __future__ import annotations

import inspect
import re

import pytest
import typer
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli import verb as reader
from rotorgear.cli.command import Command
from rotorgear.cli.commands import COMMANDS as DECLARED
from rotorgear.cli.main import app
from rotorgear.cli.options import kind_of

COMMANDS = typer.main.get_command(app).commands  # type: ignore[attr-defined]
VERBS = sorted({name for command in DECLARED if command.name != "validate" for name in command.verbs})
# Arguments that are no options: objects of Python, and what stands as --save, --resume, --cluster and a bar on the terminal.
OF_PYTHON = re.compile(r"Progress|Stream|Pool|Callable|Wanted|tuple|Model|System")


@pytest.mark.parametrize("name", VERBS)
def test_what_is_read_of_a_verb_is_what_python_says_of_it(name: str) -> None:
    signature = inspect.signature(getattr(rg, name)).parameters
    read = reader.arguments_of(name)
    assert list(read) == list(signature)
    for argument, said in read.items():
        assert said.annotation.replace('"', "'") == str(signature[argument].annotation).replace('"', "'")
        default = signature[argument].default
        if default is inspect.Parameter.empty:
            assert said.default is reader.REQUIRED
        else:
            assert said.default == (None if callable(default) else default)


@pytest.mark.parametrize("name", VERBS)
def test_every_argument_of_a_verb_is_explained(name: str) -> None:
    for argument, said in reader.arguments_of(name).items():
        assert said.help.endswith("."), f"{name}: {argument} has no sentence in the section Args"
        assert not re.search(r"as (in|for) `", said.help)


@pytest.mark.parametrize("command", DECLARED, ids=lambda command: command.name)
def test_every_argument_of_a_verb_is_an_option_or_hidden_by_name(command: Command) -> None:
    for argument, said in (command.arguments if command.name != "validate" else {}).items():
        known = argument in command.choices or argument in command.hidden
        assert known or (OF_PYTHON.search(said.annotation) and not kind_of(said.annotation)), argument


def test_another_docstring_and_another_default_are_another_help(monkeypatch: pytest.MonkeyPatch) -> None:
    text = reader.source_of("rotorgear.analysis.campbell.campbell")
    changed = text.replace("points: number of speeds", "points: a count of speeds").replace(
        "points: int = DEFAULT_SPEEDS", "points: int = 77"
    )
    assert changed.count("a count of speeds") == changed.count("= 77") == 1
    real = reader.source_of
    monkeypatch.setattr(
        reader,
        "source_of",
        lambda module: changed if module == "rotorgear.analysis.campbell.campbell" else real(module),
    )
    reader.arguments_of.cache_clear()
    reader.parsed.cache_clear()
    (campbell,) = (command for command in DECLARED if command.name == "campbell")
    try:
        # A copy, for a command keeps what it has read.
        fresh = type(campbell)(**{name: getattr(campbell, name) for name in campbell.__dataclass_fields__})
        help_text = " ".join(CliRunner().invoke(_alone(fresh), ["--help"]).output.split())
    finally:
        reader.arguments_of.cache_clear()
        reader.parsed.cache_clear()
    assert "A count of speeds between them, evenly spaced. [default: 77]" in help_text


def _alone(command: Command) -> typer.Typer:
    """A command as a program of its own."""
    program = typer.Typer(add_completion=False, rich_markup_mode=None)
    program.command()(command.function(lambda command, given: None))
    return program


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_every_command_answers_a_short_call_for_help_in_eighty_columns(command: str) -> None:
    done = CliRunner(env={"COLUMNS": "80"}).invoke(app, [command, "-h"])
    assert done.exit_code == 0
    assert "Usage" in done.output
    assert max(map(len, done.output.splitlines())) <= 80


@pytest.mark.parametrize(
    ("option", "meaning"),
    [
        ("--from", "Lowest speed"),
        ("--to", "highest speed"),
        ("--speed", "Speed of the input shaft"),
        ("--rig", "rig|Measured frequencies"),
    ],
)
def test_an_option_means_the_same_in_all_commands(option: str, meaning: str) -> None:
    for name, command in COMMANDS.items():
        for parameter in command.params:
            if option in parameter.opts:
                assert re.search(meaning, parameter.help, re.IGNORECASE), name


def test_an_option_that_says_nothing_of_what_was_measured_is_refused() -> None:
    asked = ["compare", "models/jeffcott.toml", "rig.csv", "--modal-damping", "0.01"]
    assert "--modal-damping does not go with rig lines" in str(CliRunner().invoke(app, asked).exception)


def test_a_rig_is_compared_with_a_result_or_a_model() -> None:
    model = rg.load("models/jeffcott.toml")
    rig = [20.0, rg.RigLine(60.0)]
    result = rg.modal(model, fmax=1.15 * 60.0)
    of_result = rg.compare(result, rig, known_to_hz=1.15 * 60.0)
    first, second = of_result.to_dict(), rg.compare(model, rig).to_dict()
    for cost in ("seconds", "seconds_by_step", "settings"):
        first.pop(cost, None)
        second.pop(cost, None)
    assert first == second
    with pytest.raises(rg.AnalysisError, match="a result has its own"):
        rg.compare(result, rig, elements=2)
