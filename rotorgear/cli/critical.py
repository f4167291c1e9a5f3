"""rotorgear critical: critical speeds, directly, and their map over support stiffness."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

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
from rotorgear.cli.speed_options import ToOption, parse_mesh_orders, parse_orders
from rotorgear.errors import AnalysisError
from rotorgear.results.tables.campbell import plain_table

if TYPE_CHECKING:
    from rotorgear.results.critical import CriticalMap, CriticalResult

_RPM = 30.0 / math.pi


def critical(
    model: ModelFile,
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
    _print(result, chart)
    data = result.to_dict()
    if chart:
        data["map"] = chart.to_dict()
    write_json(data, json)
    if save:
        rg.save(result, save)
        typer.echo(f"saved {save}")
    if plot and chart:
        typer.echo(f"wrote {rg.plot.save(rg.plot.critical_map(chart), plot)}")


def _print(result: CriticalResult, chart: CriticalMap | None) -> None:
    from rich.text import Text

    out = console()
    kind = "damped" if result.damped else "undamped"
    out.print(
        Text(
            f"{result.model.title or 'Critical speeds'}: {kind} critical speeds to {result.top_speed * _RPM:.6g} rpm",
            style="bold",
        )
    )
    out.print(_table(result))
    out.print("")
    out.print(Text(f"{result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}"))
    bound = 10.0 ** math.ceil(math.log10(max(result.worst_residual, 1e-12)))
    out.print(Text(f"substituted back: |w - p W| / (p W) at most {bound:.0e}"))
    for note in result.left_out:
        out.print(Text(f"left out: {note}"))
    for note in result.warnings:
        out.print(Text(f"Warning: {note}"))
    if chart:
        out.print(_map_table(chart))


def _table(result: CriticalResult) -> Any:
    table = plain_table()
    table.add_column("rpm", justify="right")
    table.add_column("Hz", justify="right")
    table.add_column("line", overflow="fold", min_width=14)
    if result.damped:
        table.add_column("zeta %", justify="right")
    table.add_column("whirl")
    table.add_column("part %", justify="right")
    table.add_column("what moves", overflow="fold")
    for item in result.speeds:
        share = f"{100.0 * item.participation:.2f}" if item.excited else "none"
        zeta = [f"{round(100.0 * item.damping_ratio, 3) + 0.0:.3f}"] if result.damped else []
        row = [
            f"{item.speed * _RPM:.2f}",
            f"{item.frequency_hz:.3f}",
            item.line,
            *zeta,
            item.whirl,
            share,
            item.description,
        ]
        table.add_row(*row)
    return table


def _map_table(chart: CriticalMap) -> Any:
    table = plain_table(f"Undamped map: {chart.line}, rpm of the input shaft")
    table.add_column("N/m", justify="right")
    table.add_column("forward", overflow="fold")
    table.add_column("backward", overflow="fold")
    for k in range(0, len(chart.stiffness), max(1, len(chart.stiffness) // 8)):
        rows = [[f"{v * _RPM:.0f}" for v in values[k] if v == v] for values in (chart.forward, chart.backward)]
        table.add_row(f"{chart.stiffness[k]:.2e}", *(", ".join(row) for row in rows))
    return table
