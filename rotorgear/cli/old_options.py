"""Former names of the command line's options: still read for one version, with a warning that says the new one."""

from __future__ import annotations

import sys
from typing import Any

import typer
from typer.core import TyperGroup

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


class Commands(TyperGroup):
    """The commands, told former options by their present names."""

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[Any, Any, list[str]]:
        name, command, rest = super().resolve_command(ctx, args)
        return name, command, with_current_options(name or "", rest)

    def invoke(self, ctx: Any) -> Any:
        # Here and not in main(): typer makes an exit without a word of an interrupt.
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            sys.stderr.write("interrupted; nothing half-written is left behind\n")
            raise SystemExit(130) from None


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
