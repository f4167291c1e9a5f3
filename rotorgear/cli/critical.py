"""rotorgear critical: critical speeds, directly, and their map over support stiffness."""

from __future__ import annotations

from typing import Annotated

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
from rotorgear.cli.speed_options import FromOption, ToOption, parse_mesh_orders, parse_orders
from rotorgear.errors import AnalysisError


def critical(
    model: ModelFile,
    start: FromOption = None,
    stop: ToOption = None,
    shaft_orders: Annotated[
        str | None, typer.Option("--shaft-orders", help="Orders of every shaft (default 1).", show_default=False)
    ] = None,
    mesh_orders: Annotated[
        str | None, typer.Option("--mesh-orders", help="Orders of every mesh (default none).", show_default=False)
    ] = None,
    damped: Annotated[
        bool, typer.Option("--damped/--undamped", help="With all damping and circulatory terms, or without them.")
    ] = True,
    fmax: Annotated[
        float | None,
        typer.Option("--fmax", help="Only critical speeds up to this frequency in Hz.", show_default=False),
    ] = None,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    stiffness_map: Annotated[
        bool, typer.Option("--map", help="Also the undamped map over the stiffness of the bearings.")
    ] = False,
    shaft: Annotated[
        str | None,
        typer.Option("--map-shaft", help="Shaft that excites in the map (default: the input).", show_default=False),
    ] = None,
    plot: PlotOption = None,
    json: JsonOption = None,
    save: SaveOption = None,
) -> None:
    """Critical speeds, damped or undamped, of every shaft and mesh order; with --map over support stiffness."""
    import rotorgear as rg
    from rotorgear.analysis.campbell.critical import SHAFT_ORDERS

    if (plot or shaft) and not stiffness_map:
        raise AnalysisError("--plot and --map-shaft belong to --map; rotorgear campbell --plot draws modes over speed")
    built = rg.load(model)
    top = parse_speed(stop, "--to")
    chart = None
    with progress_bar("critical") as progress:
        result = rg.critical(
            built,
            start=parse_speed(start, "--from"),
            stop=top,
            shaft_orders=parse_orders(shaft_orders, "--shaft-orders", SHAFT_ORDERS),
            mesh_orders=parse_mesh_orders(mesh_orders, ()),
            damped=damped,
            fmax=fmax,
            elements=elements,
            accuracy=accuracy,
            progress=progress,
        )
        if stiffness_map:
            chart = rg.critical_map(
                built, shaft=shaft, stop=top, elements=elements, accuracy=accuracy, progress=progress
            )
    out = console()
    out.print(result.table())
    if chart:
        out.print(chart.table())
    data = result.to_dict()
    if chart:
        data["map"] = chart.to_dict()
    write_json(data, json)
    if save:
        rg.save(result, save)
        typer.echo(f"saved {save}")
    if plot and chart:
        typer.echo(f"wrote {rg.plot.save(rg.plot.critical_map(chart), plot)}")
