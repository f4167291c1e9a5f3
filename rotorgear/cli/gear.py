"""rotorgear gear: the gear sheet, and a drawing of the mesh."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import JsonOption, ModelFile, console, picture_name, write_json


def gear(
    model: ModelFile,
    mesh: Annotated[
        str | None, typer.Option("--mesh", help="Only this mesh and its two gears.", show_default=False)
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot",
            help="Draw the teeth of --mesh, or of the first mesh, to this PNG, SVG or PDF.",
            show_default=False,
            callback=picture_name,
        ),
    ] = None,
    json: JsonOption = None,
) -> None:
    """Print the gear sheet: geometry, measures, contact ratios, backlash and stiffness of all teeth."""
    import rotorgear as rg

    sheet = rg.gear(rg.load(model), mesh=mesh)
    out = console()
    out.print(sheet.table())
    write_json(sheet.to_dict(), json)
    if plot is not None:
        out.print(f"drawn: {rg.plot.save(rg.plot.gear(sheet, mesh=mesh), plot)}")
