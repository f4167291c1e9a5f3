"""Former options of the command line are passed on by their present names, with a warning that says them."""

from __future__ import annotations

import pytest
from typer.main import get_command

from rotorgear.cli.main import app
from rotorgear.cli.old_options import OPTIONS, with_current_options


def test_a_former_option_is_passed_on_with_its_value_and_a_warning(capsys: pytest.CaptureFixture[str]) -> None:
    args = ["model.toml", "--settle", "40", "--count=20", "--steps", "80"]
    assert with_current_options("sweep", args) == ["model.toml", "--discard", "40", "--sample=20", "--steps", "80"]
    warned = capsys.readouterr().err
    assert "--settle is now --discard" in warned
    assert "--count is now --sample" in warned


def test_present_options_pass_without_a_word(capsys: pytest.CaptureFixture[str]) -> None:
    args = ["model.toml", "--discard", "40"]
    assert with_current_options("sweep", args) == args
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("command", OPTIONS)
def test_every_former_option_is_gone_and_leads_to_one_that_its_command_has(command: str) -> None:
    parameters = get_command(app).commands[command].params  # type: ignore[attr-defined]
    known = {option for parameter in parameters for option in (*parameter.opts, *parameter.secondary_opts)}
    assert set(OPTIONS[command].values()) <= known
    assert not set(OPTIONS[command]) & known
