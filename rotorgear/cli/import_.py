"""rotorgear import: a gearbox of another program as a model file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import JsonOption, console, write_json
from rotorgear.errors import AnalysisError


def import_(
    file: Annotated[Path, typer.Argument(help="REXS file, 1.0 to 1.6: XML, JSON or zip.", show_default=False)],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Model file to write, such as model.toml.", show_default=False)
    ],
    load_case: Annotated[
        str | None,
        typer.Option("--load-case", help="Number of a load case (default: the first).", show_default=False),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite the model file if it is there.")] = False,
    json: JsonOption = None,
) -> None:
    """Read a gearbox from a REXS file (XML, JSON or zip) into a model file, with a comment for every assumption."""
    import rotorgear as rg

    if output.is_file() and not force:
        raise AnalysisError(f"{output} is there already; give another name, or --force to overwrite it")
    result = rg.import_rexs(file, load_case=load_case)
    written = rg.write_model_file(result, output)
    out = console()
    out.print(result.table())
    write_json(result.to_dict(), json)
    typer.echo(f"wrote {written}")
    typer.echo(f"Next:  rotorgear check {written}")
