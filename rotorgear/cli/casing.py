"""rotorgear casing: the casings of a model by themselves."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import JsonOption, ModelFile, console, progress_bar, vtk_folder, write_json


def casing(
    model: ModelFile,
    name: Annotated[str | None, typer.Option("--name", help="Only this casing.", show_default=False)] = None,
    modes: Annotated[int, typer.Option("--modes", min=1, help="Elastic modes of the mesh, free and held.")] = 10,
    fmax: Annotated[
        str | None,
        typer.Option(
            "--fmax",
            help="Highest frequency that the reduced casing is to serve, such as '2 kHz', where the file has no modes_to.",
            show_default=False,
        ),
    ] = None,
    vtk: Annotated[
        Path | None,
        typer.Option(
            "--vtk",
            help="Write the surface and its modes for ParaView to this folder.",
            show_default=False,
            callback=vtk_folder,
        ),
    ] = None,
    json: JsonOption = None,
) -> None:
    """Read the meshes of casings: mass, free and held modes, seats, errors of mesh and reduction, cost."""
    import rotorgear as rg

    with progress_bar("casing") as progress:
        survey = rg.casing(rg.load(model), name, modes=modes, fmax=fmax, progress=progress)
    out = console()
    out.print(survey.table())
    write_json(survey.to_dict(), json)
    if vtk is not None:
        for path in rg.write_casing_vtk(survey, vtk):
            out.print(f"wrote {path}")
