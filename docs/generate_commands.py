"""Writes the commands: a table of all of them for docs/commands.md, and for the site every option with its words.

Both come from what the commands are made of (`rotorgear/cli/commands.py`), and that from the verbs.
"""

from __future__ import annotations

import typer

from rotorgear.cli.commands import COMMANDS
from rotorgear.cli.main import app

HEAD = """# Commands

Every command is the Python verb of its name: arguments, defaults and words are those of the verb. `rotorgear --help` lists
the commands, `rotorgear COMMAND --help` the options of one; `rotorgear --install-completion` lets the shell complete both.
An option means the same everywhere: `--from`, `--to` and `--speed` are speeds of the input shaft, `--rig` is a file of
measured frequencies, `--json` and `--save` write the result, `--vtk` a folder for ParaView, and `--plot` draws one picture to a
file that ends in .png, .svg or .pdf, or every picture into a folder. A command ends with exit code 0, or with 2 and one
report where what was asked can't be done ([Troubleshooting](errors.md)).
"""


def pages() -> dict[str, str]:
    """Return the table of commands by the page's path."""
    rows = [f"| `{command.name}` | {command.group} | {_escaped(command.summary)} |" for command in COMMANDS]
    return {"docs/commands.md": "\n".join([HEAD, "| | group | what it does |", "|---|---|---|", *rows]) + "\n"}


def site_pages() -> dict[str, str]:
    """Return the page of the site by its path: every command with its options."""
    made = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    parts = [HEAD]
    for command in COMMANDS:
        parts.append(f"## {command.name}\n\n{_escaped(command.summary)}.\n")
        rows = [_row(parameter) for parameter in made[command.name].params if parameter.name != "help"]
        if rows:
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
