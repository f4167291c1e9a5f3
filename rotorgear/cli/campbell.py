"""rotorgear campbell: modes over speed, excitation lines, crossings, margins, stability."""

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
    progress_bar,
    write_json,
)
from rotorgear.cli.speed_options import (
    FromOption,
    ToOption,
    parse_orders,
    speeds_between,
)
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from rotorgear.results.campbell import CampbellResult


def campbell(
    model: ModelFile,
    start: FromOption = "0 rpm",
    stop: ToOption = None,
    points: Annotated[int, typer.Option("--points", help="Number of speeds.")] = 51,
    modes: Annotated[
        int | None, typer.Option("--modes", help="Follow the lowest so many modes (default 24).", show_default=False)
    ] = None,
    fmax: Annotated[
        float | None, typer.Option("--fmax", help="Follow all modes up to this frequency in Hz.", show_default=False)
    ] = None,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    only: Annotated[
        str | None, typer.Option("--only", help="Only modes reached by bending, axial or torsion.", show_default=False)
    ] = None,
    shaft_orders: Annotated[
        str | None, typer.Option("--shaft-orders", help="Orders of every shaft (default 1,2).", show_default=False)
    ] = None,
    mesh_orders: Annotated[
        str | None, typer.Option("--mesh-orders", help="Orders of every mesh (default 1,2,3).", show_default=False)
    ] = None,
    sidebands: Annotated[
        int, typer.Option("--sidebands", min=0, help="So many shaft-speed sidebands at each side of a mesh order.")
    ] = 0,
    crossings: Annotated[bool, typer.Option("--crossings", help="Also list all crossings with the lines.")] = False,
    plot: PlotOption = None,
    colour: Annotated[str, typer.Option("--colour", help="Colour of branches: motion, mesh or damping.")] = "motion",
    json: JsonOption = None,
    save: SaveOption = None,
    vtk: Annotated[
        Path | None, typer.Option("--vtk", help="Write a branch over speed for ParaView here.", show_default=False)
    ] = None,
    branch: Annotated[int, typer.Option("--branch", min=1, help="The branch that --vtk writes.")] = 1,
) -> None:
    """Campbell diagram: modes over speed, excitation lines, crossings, margins, whirl and stability."""
    import rotorgear as rg
    from rotorgear.analysis.common.excitation import MESH_ORDERS, SHAFT_ORDERS
    from rotorgear.results.tables.campbell import campbell_table

    built = rg.load(model)
    whole = parse_orders(mesh_orders, "--mesh-orders", MESH_ORDERS)
    if any(order != int(order) for order in whole):
        raise AnalysisError(f"--mesh-orders: got '{mesh_orders}', expected whole numbers such as 1,2,3")
    with progress_bar("campbell") as progress:
        result = rg.campbell(
            built,
            speeds=speeds_between(built, start, stop, points).tolist(),
            modes=modes,
            fmax=fmax,
            elements=elements,
            accuracy=accuracy,
            only=[word.strip() for word in only.split(",")] if only else (),
            shaft_orders=parse_orders(shaft_orders, "--shaft-orders", SHAFT_ORDERS),
            mesh_orders=[int(v) for v in whole],
            sidebands=sidebands,
            progress=progress,
        )
    console().print(campbell_table(result, crossings=crossings))
    write_json(result.to_dict(), json)
    _write(result, save, plot, colour, vtk, branch)


def _write(
    result: CampbellResult, save: Path | None, plot: Path | None, colour: str, vtk: Path | None, branch: int
) -> None:
    import rotorgear as rg

    if save:
        rg.save(result, save)
        typer.echo(f"saved {save}")
    if plot:
        from rotorgear.plots.campbell import draw_campbell

        typer.echo(f"wrote {draw_campbell(result, plot, colour=colour)}")
    if vtk:
        from rotorgear.export.vtk_branch import write_branch

        with progress_bar("vtk") as progress:
            paths = write_branch(result, vtk, branch - 1, progress=progress)
        typer.echo(f"wrote {len(paths)} files to {vtk} for branch {branch}; --branch chooses another")
