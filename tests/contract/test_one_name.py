"""One name for one thing: a command is called as the Python verb behind it, and so are its options."""

from __future__ import annotations

import inspect

import pytest
import typer
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app

COMMANDS = typer.main.get_command(app).commands  # type: ignore[attr-defined]
# `validate` runs the cases of a checkout of the repository, which are no part of the package.
WITHOUT_VERB = {"validate"}
# What becomes of a result: tables, files, pictures and their settings.
SHOWN = {"json", "save", "resume", "vtk", "plot", "csv", "output", "uff"}
OF_A_PICTURE_OR_TABLE = {
    "modal": {"shapes", "energies", "compare", "tolerance"},
    "campbell": {"crossings", "colour", "branch"},
    "critical": {"stiffness_map", "shaft"},
    "static": {"sensitivity"},
    "response": {"waterfall", "at"},
    "frf": {"quantity"},
    "transient": {"spectrum", "rig"},
    "mesh": {"harmonics", "at"},
    "import": {"force"},
    # Files of three verbs.
    "export": {"state_space", "matrices", "uff"},
    # A window opens on a result; of a model the modes are found first.
    "view": {"modes", "speed", "accuracy", "elements"},
}
# A command that serves several verbs: options that choose among them, and the verbs whose arguments the others are.
CHOOSES = {"mesh": {"optimise", "root_stress"}}
VERBS = {
    "mesh": ("mesh", "mesh_map", "optimise_flanks", "root_stress"),
    "import": ("import_rexs",),
    "export": ("state_space", "write_matrices", "modal"),
    "compare": ("compare", "compare_shapes", "compare_frf", "compare_orders"),
}
# Names that Python has no use for: `cluster` is an address in a command and an open pool (`executor`) in Python.
OTHERWISE = {("sweep", "cluster"), ("scatter", "cluster")}
# `--from` and `--to` are start and stop: `from` is a word of the language.
OPTION_OF = {"start": "from", "stop": "to", "stiffness_map": "map", "shaft": "map-shaft", "source": "from"}


def verb_of(command: str) -> inspect.Signature:
    return inspect.signature(getattr(rg, command))


@pytest.mark.parametrize("command", sorted(set(COMMANDS) - WITHOUT_VERB))
def test_every_command_is_a_verb_with_the_same_arguments(command: str) -> None:
    known = {name for verb in VERBS.get(command, (command,)) for name in verb_of(verb).parameters}
    own = OF_A_PICTURE_OR_TABLE.get(command, set()) | CHOOSES.get(command, set())
    for parameter in COMMANDS[command].params:
        if parameter.param_type_name == "argument" or parameter.name in SHOWN | own | {"help"}:
            continue
        if (command, parameter.name) not in OTHERWISE:
            assert parameter.name in known, f"rg.{command} has no argument '{parameter.name}'"


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_an_option_is_spelt_as_its_argument(command: str) -> None:
    for parameter in COMMANDS[command].params:
        if parameter.param_type_name == "option" and parameter.name != "help":
            name = OPTION_OF.get(parameter.name, parameter.name.replace("_", "-"))
            assert f"--{name}" in parameter.opts


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_every_command_answers_a_short_call_for_help(command: str) -> None:
    done = CliRunner().invoke(app, [command, "-h"])
    assert done.exit_code == 0
    assert "Usage" in done.output


@pytest.mark.parametrize("spelling", [["--picture", "tooth.jpg"], ["--picture=tooth.jpg"]])
def test_an_old_option_works_and_names_the_new_one(spelling: list[str]) -> None:
    done = CliRunner().invoke(app, ["gear", "models/helical_pair.toml", *spelling])
    assert "--picture is now --plot" in done.output
    assert "got 'tooth.jpg'" in str(done.exception)  # the value has arrived, and its ending is refused


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("describe_model", "check"),
        ("critical_speeds", "critical"),
        ("frequency_response", "frf"),
        ("gear_sheet", "gear"),
    ],
)
def test_an_old_name_of_a_verb_works_and_names_the_new_one(old: str, new: str) -> None:
    with pytest.warns(FutureWarning, match=f"'{old}' is now '{new}'"):
        assert getattr(rg, old) is getattr(rg, new)
    assert old not in dir(rg)


def test_an_old_name_of_an_argument_works_and_names_the_new_one() -> None:
    model = rg.load("models/jeffcott.toml")
    with pytest.warns(FutureWarning, match="'top_speed' is now 'stop'"):
        old = rg.critical(model, top_speed="8000 rpm", elements=1)
    assert (
        old.critical_speed_rpm.tolist() == rg.critical(model, stop="8000 rpm", elements=1).critical_speed_rpm.tolist()
    )
    with pytest.raises(TypeError, match="top_speed"):
        rg.critical(model, stop=100.0, top_speed=100.0)


def test_a_rig_is_compared_with_a_result_a_model_or_as_before_with_lists() -> None:
    model = rg.load("models/jeffcott.toml")
    rig = [20.0, rg.RigLine(60.0)]
    result = rg.modal(model, fmax=1.15 * 60.0)
    of_result = rg.compare(result, rig, known_to_hz=1.15 * 60.0)
    first, second = of_result.to_dict(), rg.compare(model, rig).to_dict()
    for cost in ("seconds", "seconds_by_step", "settings"):
        first.pop(cost, None)
        second.pop(cost, None)
    assert first == second
    with pytest.warns(FutureWarning, match=r"is now 'compare\(result, rig\)'"):
        of_lists = rg.compare(
            result.frequency_hz, result.description, [rg.RigLine(20.0), rg.RigLine(60.0)], rigid=result.rigid
        )
    pairs = [[(m.rig.frequency_hz, m.mode_number) for m in found.matches] for found in (of_lists, of_result)]
    assert pairs[0] == pairs[1] != []
    with pytest.raises(rg.AnalysisError, match="a result has its own"):
        rg.compare(result, rig, elements=2)
