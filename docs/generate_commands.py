"""Writes docs/commands.md: a table of all commands and the rules of their JSON; for the site every option and every key.

Commands come from what they are made of (`rotorgear/cli/commands.py`), and that from the verbs; keys from the results.
"""

from __future__ import annotations

import contextlib
import io
from pathlib import Path

import typer
from machinery.json_keys import common_keys, outputs_of

from rotorgear.cli.commands import COMMANDS
from rotorgear.cli.main import app

ROOT = Path(__file__).resolve().parents[1]
HEAD = """# Commands and their JSON

Every command is the Python verb of its name: arguments, defaults and words are those of the verb. `rotorgear --help` lists
the commands, `rotorgear COMMAND --help` the options of one; `rotorgear --install-completion` lets the shell complete both.
An option means the same everywhere: `--from`, `--to` and `--speed` are speeds of the input shaft, `--rig` is a file of
measured frequencies, `--json` and `--save` write the result, `--vtk` a folder for ParaView, and `--plot` draws one picture to a
file that ends in .png, .svg or .pdf, or every picture into a folder. A command ends with exit code 0, or with 2 and one
report where what was asked can't be done ([Troubleshooting](errors.md)).
"""
JSON = """## JSON output

`--json FILE` writes the result of a command as one JSON object; `result.to_dict()` is the same in Python.

* **A field has one name.** A key is the name of the field in Python, in tables of `result.rows()` and in the HDF5 file of
  `--save`, with its unit behind it where it has one: `largest_pressure` in Pa is `largest_pressure_pa`. Some keys keep the
  shorter name that they have had since version 0.1, such as `ste_m` of a transmission error.
* **Numbers are in the unit that their key names**, SI but for `_rpm`, `_deg`, `_hz` and `_percent`; a key without a unit is a
  share, a ratio, a count, or says its unit in its meaning. What is stored as rad/s and rad is written as rpm and degrees.
* **A number that is not known is `null`**, and so is one that is not finite.
* **Lists go along axes.** `[]` stands for the entries of a list, and a word in capitals for names of your model, which are the
  keys of an object. Modes are counted from 1 in `mode_number`; lists over modes begin with mode 1.
"""
_EXAMPLE = """import rotorgear as rg

written = rg.modal(rg.load("models/jeffcott.toml"), modes=4).to_dict()
print(list(written)[:8])
print([round(frequency, 2) for frequency in written["frequency_hz"]], written["whirl"])
"""
_KEYS = """Every key of each command, with unit and meaning, is on the site, which `python docs/build_site.py` builds from the
declarations in `rotorgear/results/`. `help(rg.ModalResult)` lists the fields
of a result in Python.
"""
_COMMON = "These keys stand in the JSON of every command that analyses a model:\n"


def pages() -> dict[str, str]:
    """Return the summary by its path: the table of commands and the rules of their JSON."""
    parts = [HEAD, _commands(), JSON, _example(), _COMMON, common_keys(), _KEYS]
    return {"docs/commands.md": "\n".join(parts)}


def site_pages() -> dict[str, str]:
    """Return the page of the site by its path: every command with its options and the keys that it writes."""
    made = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    parts = [HEAD, _commands(), JSON, _example(), _COMMON, common_keys()]
    for command in COMMANDS:
        parts.append(f"## {command.name}\n\n{_escaped(command.summary)}.\n")
        rows = [_row(parameter) for parameter in made[command.name].params if parameter.name != "help"]
        if rows:
            parts.append("\n".join(["| option | default | meaning |", "|---|---|---|", *rows]) + "\n")
        parts += outputs_of(command.name)
    return {"docs/commands.md": "\n".join(parts)}


def _commands() -> str:
    rows = [f"| `{command.name}` | {command.group} | {_escaped(command.summary)} |" for command in COMMANDS]
    return "\n".join(["| command | group | what it does |", "|---|---|---|", *rows]) + "\n"


def _example() -> str:
    printed = io.StringIO()
    with contextlib.chdir(ROOT), contextlib.redirect_stdout(printed):
        exec(_EXAMPLE, {})
    return f"<!-- run -->\n```python\n{_EXAMPLE}```\n\n<!-- output -->\n```text\n{printed.getvalue()}```\n"


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
