"""rotorgear response: forced vibration over speed, by order."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    AmplitudeAccuracyOption,
    DeflectionOption,
    ElementsOption,
    JsonOption,
    ModalDampingOption,
    ModelFile,
    PlotOption,
    SaveOption,
    UffOption,
    console,
    parse_speed,
    picture_name,
    progress_bar,
    write_json,
)


def response(
    model: ModelFile,
    start: Annotated[
        str | None,
        typer.Option("--from", help="Lowest speed of the input shaft (default 0.1 of operation).", show_default=False),
    ] = None,
    stop: Annotated[
        str | None, typer.Option("--to", help="Highest speed (default 1.2 times operation).", show_default=False)
    ] = None,
    points: Annotated[int, typer.Option("--points", help="Number of speeds.")] = 221,
    fmax: Annotated[
        float | None,
        typer.Option("--fmax", help="Leave out orders above this frequency in Hz.", show_default=False),
    ] = None,
    modal_damping: ModalDampingOption = 0.0,
    method: Annotated[str, typer.Option("--method", help="modal, direct or auto.")] = "auto",
    elements: ElementsOption = None,
    accuracy: AmplitudeAccuracyOption = None,
    shape_speed: Annotated[
        str | None,
        typer.Option(
            "--shape-speed", help="Speed of the deflection shapes (default: operating speed).", show_default=False
        ),
    ] = None,
    json: JsonOption = None,
    save: SaveOption = None,
    plot: PlotOption = None,
    waterfall: Annotated[
        Path | None,
        typer.Option(
            "--waterfall",
            help="Draw spectra over speed to this PNG, SVG or PDF.",
            show_default=False,
            callback=picture_name,
        ),
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(
            "--at",
            help="Mesh, bearing or point of --waterfall (default: mesh of the largest force).",
            show_default=False,
        ),
    ] = None,
    vtk: DeflectionOption = None,
    uff: UffOption = None,
) -> None:
    """Run-up: response to unbalances, transmission errors and stiffness variation, by order and speed."""
    import rotorgear as rg

    with progress_bar("response") as progress:
        result = rg.response(
            rg.load(model),
            start=parse_speed(start, "--from"),
            stop=parse_speed(stop, "--to"),
            points=points,
            fmax=fmax,
            modal_damping=modal_damping,
            method=method,
            elements=elements,
            accuracy=accuracy,
            shape_speed=parse_speed(shape_speed, "--shape-speed"),
            progress=progress,
        )
    out = console()
    out.print(result.table())
    write_json(result.to_dict(), json)
    if save:
        typer.echo(f"saved {rg.save(result, save)}")
    if plot:
        typer.echo(f"wrote {rg.plot.save(rg.plot.response(result), plot)}")
    if waterfall:
        typer.echo(f"wrote {rg.plot.save(rg.plot.waterfall(result, at=at), waterfall)}")
    if vtk:
        with progress_bar("vtk") as progress:
            paths = rg.write_deflections(result, vtk, progress=progress)
        typer.echo(f"wrote {len(paths)} files to {vtk}")
    if uff:
        typer.echo(f"wrote {rg.write_uff(result, uff)}")
