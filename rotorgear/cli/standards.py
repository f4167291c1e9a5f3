"""rotorgear standards: rules of rotor standards, with values, limits and verdicts."""

from __future__ import annotations

from typing import Annotated

import typer

from rotorgear.cli.common import JsonOption, ModelFile, SaveOption, console, parse_speed, progress_bar, write_json
from rotorgear.cli.speed_options import FromOption


def standards(
    model: ModelFile,
    start: FromOption = None,
    stop: Annotated[
        str | None,
        typer.Option(
            "--to",
            help="Highest speed at which peaks are looked for (default 1.5 times operation).",
            show_default=False,
        ),
    ] = None,
    grade: Annotated[float, typer.Option("--grade", help="Balance quality grade G of ISO 21940-11, in mm/s.")] = 2.5,
    json: JsonOption = None,
    save: SaveOption = None,
) -> None:
    """Amplification, separation margins, vibration, stability, torsion and balance against rules of standards."""
    import rotorgear as rg

    with progress_bar("standards") as progress:
        result = rg.standards(
            rg.load(model),
            start=parse_speed(start, "--from"),
            stop=parse_speed(stop, "--to"),
            grade=grade,
            progress=progress,
        )
    console().print(result.table())
    write_json(result.to_dict(), json)
    if save:
        typer.echo(f"saved {rg.save(result, save)}")
