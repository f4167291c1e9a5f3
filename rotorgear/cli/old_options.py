"""Former names of the command line's options: still read for one version, with a warning that says the new one."""

from __future__ import annotations

import typer

# Command -> former option -> option.
OPTIONS: dict[str, dict[str, str]] = {
    "modal": {"--picture": "--plot"},
    "gear": {"--picture": "--plot"},
    "response": {"--damping": "--modal-damping"},
    "frf": {"--damping": "--modal-damping", "--from": "--inputs", "--to": "--outputs"},
    "mesh": {"--loads": "--load-factors"},
    "sweep": {
        "--starts": "--initial-conditions",
        "--settle": "--discard",
        "--count": "--sample",
        "--portrait": "--portraits",
    },
    "transient": {"--settle": "--discard"},
}


def with_current_options(command: str, args: list[str]) -> list[str]:
    """Return the arguments of a command with former options replaced, and warn of each on stderr."""
    renamed = OPTIONS.get(command, {})
    current = []
    for arg in args:
        option, sign, value = arg.partition("=")
        if option in renamed:
            typer.echo(
                f"Warning: {option} is now {renamed[option]}; the old name is read for the last time in this version",
                err=True,
            )
            option = renamed[option]
        current.append(option + sign + value)
    return current
