"""Former names of commands and options: still read for one version, with a warning that says the new one."""

from __future__ import annotations

# Command -> former option -> option.
OPTIONS: dict[str, dict[str, str]] = {
    "new": {"--from": "--source"},
    "modal": {"--compare": "--rig"},
    "optimise-flanks": {"--optimise": "--variables"},
}
# Options of mesh that are commands of their own now; the first of them that is given says which.
_OF_MESH = {"--root-stress": "root-stress", "--optimise": "optimise-flanks", "--over": "mesh-map"}


def current(args: list[str]) -> list[str]:
    """Return a command and its arguments by their present names, and warn of each former one on stderr."""
    if not args:
        return args
    command, *rest = args
    if command == "mesh":
        for option, name in _OF_MESH.items():
            if any(arg.partition("=")[0] == option for arg in rest):
                _warn(f"mesh {option}", f"the command {name}")
                command = name
                rest = [arg for arg in rest if arg != "--root-stress"]
                break
    renamed = OPTIONS.get(command, {})
    for place, arg in enumerate(rest):
        option, sign, value = arg.partition("=")
        if option in renamed:
            _warn(option, renamed[option])
            rest[place] = renamed[option] + sign + value
    return [command, *rest]


def _warn(old: str, new: str) -> None:
    from rotorgear.cli.console import say  # here: help, which comes this way too, needs no bars of progress

    say(f"Warning: {old} is now {new}; the old name is read for the last time in this version", err=True)
