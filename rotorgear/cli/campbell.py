"""rotorgear campbell: modes over speed, excitation lines, crossings, margins, stability."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    JsonOption,
    ModelFile,
    OnlyOption,
    PlotOption,
    SaveOption,
    console,
    parse_speed,
    progress_bar,
    vtk_folder,
    words_of,
    write_json,
)
from rotorgear.cli.speed_options import (
    FromOption,
    ToOption,
    parse_mesh_orders,
    parse_orders,
)


def campbell(
    model: ModelFile,
    start: FromOption = None,
    stop: ToOption = None,
    points: Annotated[int, typer.Option("--points", help="Number of speeds.")] = 51,
    modes: Annotated[
        int | None,
        typer.Option(
            "--modes",
            help="Number of lowest modes to follow (default: 24, or up to the mesh orders).",
            show_default=False,
        ),
    ] = None,
    fmax: Annotated[
        float | None, typer.Option("--fmax", help="Follow all modes up to this frequency in Hz.", show_default=False)
    ] = None,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    only: OnlyOption = None,
    shaft_orders: Annotated[
        str | None, typer.Option("--shaft-orders", help="Orders of every shaft (default 1,2).", show_default=False)
    ] = None,
    mesh_orders: Annotated[
        str | None, typer.Option("--mesh-orders", help="Orders of every mesh (default 1,2,3).", show_default=False)
    ] = None,
    sidebands: Annotated[
        int, typer.Option("--sidebands", min=0, help="Shaft-speed sidebands on each side of a mesh order.")
    ] = 0,
    crossings: Annotated[bool, typer.Option("--crossings", help="Also list all crossings with the lines.")] = False,
    plot: PlotOption = None,
    colour: Annotated[str, typer.Option("--colour", help="Colour of branches: motion, mesh or damping.")] = "motion",
    json: JsonOption = None,
    save: SaveOption = None,
    vtk: Annotated[
        Path | None,
        typer.Option(
            "--vtk",
            help="Write a branch over speed for ParaView to this folder.",
            show_default=False,
            callback=vtk_folder,
        ),
    ] = None,
    branch: Annotated[int, typer.Option("--branch", min=1, help="The branch that --vtk writes.")] = 1,
) -> None:
    """Campbell diagram: modes over speed, excitation lines, crossings, margins, whirl and stability."""
    import rotorgear as rg
    from rotorgear.analysis.common.excitation import MESH_ORDERS, SHAFT_ORDERS

    with progress_bar("campbell") as progress:
        result = rg.campbell(
            rg.load(model),
            start=parse_speed(start, "--from"),
            stop=parse_speed(stop, "--to"),
            points=points,
            modes=modes,
            fmax=fmax,
            elements=elements,
            accuracy=accuracy,
            only=words_of(only),
            shaft_orders=parse_orders(shaft_orders, "--shaft-orders", SHAFT_ORDERS),
            mesh_orders=parse_mesh_orders(mesh_orders, MESH_ORDERS),
            sidebands=sidebands,
            progress=progress,
        )
    console().print(result.table(crossings=crossings))
    write_json(result.to_dict(), json)
    if save:
        rg.save(result, save)
        typer.echo(f"saved {save}")
    if plot:
        typer.echo(f"wrote {rg.plot.save(rg.plot.campbell(result, colour=colour), plot)}")
    if vtk:
        from rotorgear.export.vtk_branch import write_branch

        with progress_bar("vtk") as progress:
            paths = write_branch(result, vtk, branch - 1, progress=progress)
        typer.echo(f"wrote {len(paths)} files to {vtk} for branch {branch}; --branch chooses another")
