"""rotorgear new: a model file of one's own, begun as a copy of a shipped one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def new(
    path: Annotated[Path, typer.Argument(help="File to write, such as gearbox.toml.", show_default=False)],
    source: Annotated[
        str | None,
        typer.Option(
            "--from",
            help="Model to copy, see rotorgear models (default: that of the file's name, or helical_pair).",
            show_default=False,
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite files that are there.")] = False,
) -> None:
    """Write a model file with comments, as a copy of one that comes with rotorgear, to change freely."""
    import rotorgear as rg

    for written in rg.new(path, source, force):
        typer.echo(f"wrote {written}")
    typer.echo(f"Next:  rotorgear check {path}")
