"""rotorgear bearing: the sheet of one bearing."""

from __future__ import annotations

from typing import Annotated

import typer

from rotorgear.cli.common import (
    JsonOption,
    ModelFile,
    PlotOption,
    SaveOption,
    SpeedOption,
    console,
    parse_speed,
    progress_bar,
    words_of,
    write_json,
)


def bearing(
    model: ModelFile,
    name: Annotated[
        str | None, typer.Argument(help="Name of the bearing (may be left out where there is one).", show_default=False)
    ] = None,
    speed: SpeedOption = None,
    speeds: Annotated[
        str | None,
        typer.Option(
            "--speeds",
            help="Speeds of the input shaft for stiffness and damping, such as '3000 rpm,6000 rpm' (default: .25 to 1.5 of the "
            "speed).",
            show_default=False,
        ),
    ] = None,
    stability: Annotated[
        bool,
        typer.Option(
            "--stability/--no-stability", help="Damped modes of the gearbox at these speeds: whirl threshold."
        ),
    ] = True,
    json: JsonOption = None,
    save: SaveOption = None,
    plot: PlotOption = None,
) -> None:
    """Sheet of one bearing at the gearbox's own loads: inside, stiffness and damping over speed, whirl threshold."""
    import rotorgear as rg

    with progress_bar("bearing") as progress:
        sheet = rg.bearing(
            rg.load(model),
            name,
            speed=parse_speed(speed),
            speeds=[parse_speed(one, "--speeds") or 0.0 for one in words_of(speeds)] or None,
            stability=stability,
            progress=progress,
        )
    console().print(sheet.table())
    write_json(sheet.to_dict(), json)
    if save:
        typer.echo(f"saved {rg.save(sheet, save)}")
    if plot:
        typer.echo(f"wrote {rg.plot.save(rg.plot.bearing(sheet), plot)}")
