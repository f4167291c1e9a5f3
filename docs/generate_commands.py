"""Writes docs/commands.md from the commands themselves: every argument and option, with what its help says of it."""

from __future__ import annotations

import typer

from rotorgear.cli.commands import HELP
from rotorgear.cli.main import app

HEAD = """# Commands

Every command with its arguments and options, in the words of `rotorgear COMMAND --help`. This page is written by
`docs/generate_commands.py`; the other pages show the commands at work. `rotorgear --version` prints the version, `-h` help.
A command ends with exit code 0, or with 2 and one report where what was asked can't be done ([errors](errors.md)).
"""


def pages() -> dict[str, str]:
    """Return the page by its path."""
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    parts = [HEAD]
    for name, sentence in HELP.items():
        parts.append(f"## {name}\n\n{_escaped(sentence)}\n")
        rows = [_row(parameter) for parameter in commands[name].params if parameter.name != "help"]
        if not rows:
            continue
        parts.append("\n".join(["| | default | meaning |", "|---|---|---|", *rows]) + "\n")
    return {"docs/commands.md": "\n".join(parts).rstrip() + "\n"}


def _row(parameter: typer.core.TyperArgument | typer.core.TyperOption) -> str:
    if parameter.param_type_name == "argument":
        shown = f"`{(parameter.metavar or parameter.name or '').upper()}`"
        return f"| {shown} | {'' if parameter.required else '-'} | {_escaped(getattr(parameter, 'help', '') or '')} |"
    names = " ".join(f"`{option}`" for option in (*parameter.opts, *parameter.secondary_opts))
    plain = parameter.default is None or parameter.default is False or callable(parameter.default)
    default = "" if plain or parameter.required else f"`{parameter.default}`"
    if parameter.multiple or parameter.default == ():
        default = ""
    return f"| {names} | {default} | {_escaped(getattr(parameter, 'help', '') or '')} |"


def _escaped(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*")
