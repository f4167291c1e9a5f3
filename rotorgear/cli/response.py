"""rotorgear response: forced vibration over speed, by order."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
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
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from rotorgear.model.model import Model

DampingOption = Annotated[
    float, typer.Option("--damping", help="Damping ratio added to every elastic mode, such as 0.01.")
]
VtkOption = Annotated[
    Path | None, typer.Option("--vtk", help="Write deflection shapes for ParaView to this folder.", show_default=False)
]


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
    damping: DampingOption = 0.0,
    method: Annotated[str, typer.Option("--method", help="modal, direct or auto.")] = "auto",
    elements: ElementsOption = None,
    accuracy: AccuracyOption = None,
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
        typer.Option("--waterfall", help="Draw spectra over speed to this PNG, SVG or PDF.", show_default=False),
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(
            "--at",
            help="Mesh, bearing or point of --waterfall (default: mesh of the largest force).",
            show_default=False,
        ),
    ] = None,
    vtk: VtkOption = None,
) -> None:
    """Run-up: response to unbalances, transmission errors and stiffness variation, by order and speed."""
    import rotorgear as rg
    from rotorgear.results.tables.response import response_tables

    built = rg.load(model)
    with progress_bar("response") as progress:
        result = rg.response(
            built,
            speeds=_speeds(built, start, stop, points),
            fmax=fmax,
            damping_ratio=damping,
            method=method,
            elements=elements,
            accuracy=accuracy,
            shape_speed=parse_speed(shape_speed, "--shape-speed"),
            progress=progress,
        )
    out = console()
    for part in response_tables(result):
        out.print(part)
    write_json(result.to_dict(), json)
    if save:
        typer.echo(f"saved {rg.save(result, save)}")
    if plot:
        from rotorgear.plots.run_up import draw_run_up

        typer.echo(f"wrote {draw_run_up(result, plot)}")
    if waterfall:
        from rotorgear.plots.waterfall import draw_waterfall

        typer.echo(f"wrote {draw_waterfall(result, waterfall, at=at)}")
    if vtk:
        with progress_bar("vtk") as progress:
            paths = rg.write_deflections(result, vtk, progress=progress)
        typer.echo(f"wrote {len(paths)} files to {vtk}")


def _speeds(model: Model, start: str | None, stop: str | None, points: int) -> list[float]:
    """Evenly spaced speeds in rad/s."""
    import numpy as np

    from rotorgear.analysis.response.response import HIGHEST, LOWEST

    operating = model.operation.speed if model.operation else None
    low = parse_speed(start, "--from")
    high = parse_speed(stop, "--to")
    if (low is None or high is None) and not operating:
        raise AnalysisError("--from and --to: give both, since the model has no operating speed")
    if points < 1:
        raise AnalysisError(f"--points: got {points}, expected at least 1")
    low = LOWEST * (operating or 0.0) if low is None else low
    high = HIGHEST * (operating or 0.0) if high is None else high
    return [float(value) for value in np.linspace(low, high, points)]
