"""Former commands and options are passed on by their present names, with a warning that says them."""

from __future__ import annotations

import pytest
from typer.main import get_command

from rotorgear.cli.main import app
from rotorgear.cli.old_options import OPTIONS, current


def test_a_former_option_is_passed_on_with_its_value_and_a_warning(capsys: pytest.CaptureFixture[str]) -> None:
    args = ["modal", "model.toml", "--compare", "rig.csv", "--modes", "8"]
    assert current(args) == ["modal", "model.toml", "--rig", "rig.csv", "--modes", "8"]
    assert current(["new", "--from=a"]) == ["new", "--source=a"]
    warned = capsys.readouterr().err
    assert "--compare is now --rig" in warned
    assert "--from is now --source" in warned


@pytest.mark.parametrize(
    ("former", "present"),
    [
        (
            ["--over", "torque=1 N m", "--csv", "a.csv"],
            ["mesh-map", "m.toml", "--over", "torque=1 N m", "--csv", "a.csv"],
        ),
        (["--over=torque=1 N m"], ["mesh-map", "m.toml", "--over=torque=1 N m"]),
        (["--root-stress", "--json", "a"], ["root-stress", "m.toml", "--json", "a"]),
        (["--over", "x", "--optimise", "bias"], ["optimise-flanks", "m.toml", "--over", "x", "--variables", "bias"]),
    ],
)
def test_what_was_an_option_of_mesh_is_a_command(
    former: list[str], present: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert current(["mesh", "m.toml", *former]) == present
    assert f"is now the command {present[0]}" in capsys.readouterr().err


def test_present_options_pass_without_a_word(capsys: pytest.CaptureFixture[str]) -> None:
    args = ["sweep", "model.toml", "--discard", "40"]
    assert current(args) == args
    assert current([]) == []
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("command", OPTIONS)
def test_every_former_option_is_gone_and_leads_to_one_that_its_command_has(command: str) -> None:
    parameters = get_command(app).commands[command].params  # type: ignore[attr-defined]
    known = {option for parameter in parameters for option in (*parameter.opts, *parameter.secondary_opts)}
    assert set(OPTIONS[command].values()) <= known
    assert not set(OPTIONS[command]) & known
