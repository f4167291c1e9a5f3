"""rotorgear static: deflections, forces and load sharing."""

from __future__ import annotations

from typing import Annotated

import typer

from rotorgear.cli.common import (
    DeflectionOption,
    ElementsOption,
    JsonOption,
    ModelFile,
    PlotOption,
    SaveOption,
    console,
    parse_speed,
    progress_bar,
    write_json,
)


def static(
    model: ModelFile,
    speed: Annotated[
        str | None,
        typer.Option(
            "--speed",
            help="Speed of the input shaft; its sign chooses the flanks (default: operating speed).",
            show_default=False,
        ),
    ] = None,
    elements: ElementsOption = None,
    accuracy: Annotated[
        float | None,
        typer.Option("--accuracy", help="Halve elements until the forces are within this error.", show_default=False),
    ] = None,
    sensitivity: Annotated[
        bool, typer.Option("--sensitivity", help="Also list the sensitivities of the load shares of the branches.")
    ] = False,
    tilt: Annotated[
        bool,
        typer.Option("--tilt", help="All meshes feel the tilt of their shafts: misalignment and load along the faces."),
    ] = False,
    json: JsonOption = None,
    save: SaveOption = None,
    plot: PlotOption = None,
    vtk: DeflectionOption = None,
) -> None:
    """Deflections, bearing and mesh forces, load sharing of branches and helices, assembly condition of loops."""
    import rotorgear as rg

    with progress_bar("static") as progress:
        result = rg.static(
            rg.load(model),
            speed=parse_speed(speed),
            elements=elements,
            accuracy=accuracy,
            tilt=tilt,
            progress=progress,
        )
    out = console()
    out.print(result.table(sensitivity=sensitivity))
    write_json(result.to_dict(), json)
    if save:
        typer.echo(f"saved {rg.save(result, save)}")
    if plot:
        typer.echo(f"wrote {rg.plot.save(rg.plot.static(result), plot)}")
    if vtk:
        rg.write_deflections(result, vtk)
        typer.echo(f"wrote {vtk / 'static.vtp'}")
