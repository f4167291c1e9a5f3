"""rotorgear mesh: stiffness, transmission error and load distribution of one mesh over its cycle."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import JsonOption, ModelFile, console, progress_bar, write_json
from rotorgear.errors import AnalysisError


def mesh(
    model: ModelFile,
    mesh: Annotated[
        str | None, typer.Option("--mesh", help="Name of the mesh; not needed where there is one.", show_default=False)
    ] = None,
    stiffness: Annotated[
        str | None,
        typer.Option(
            "--stiffness",
            help="tooth_fe, iso, contact_line, potential_energy, or given (the numbers of the file). "
            "Default: the model that the file names, else tooth_fe.",
            show_default=False,
        ),
    ] = None,
    torque: Annotated[
        str | None,
        typer.Option(
            "--torque", help="Torque on the pinion, such as '2000 N m', in place of the model's.", show_default=False
        ),
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option("--preset", help="preview, default or fine, in place of the file's.", show_default=False),
    ] = None,
    accuracy: Annotated[
        float | None,
        typer.Option(
            "--accuracy", help="Take the cheapest preset whose estimated error is within this.", show_default=False
        ),
    ] = None,
    body: Annotated[
        str | None, typer.Option("--body", help="Body under the teeth: rim, ring or wheel.", show_default=False)
    ] = None,
    positions: Annotated[int, typer.Option("--positions", help="Positions in one mesh period.")] = 64,
    periods: Annotated[
        int | None,
        typer.Option(
            "--periods", help="Mesh periods; default 1, or until all pitch errors have passed.", show_default=False
        ),
    ] = None,
    load_factors: Annotated[
        str | None,
        typer.Option(
            "--load-factors", help="Also solve at these multiples of the load: '0.1,0.5,2'.", show_default=False
        ),
    ] = None,
    harmonics: Annotated[int, typer.Option("--harmonics", min=0, help="Mesh orders that are listed.")] = 5,
    plot: Annotated[
        Path | None,
        typer.Option("--plot", help="Draw the curves and the contact to this PNG or SVG.", show_default=False),
    ] = None,
    vtk: Annotated[
        Path | None,
        typer.Option(
            "--vtk",
            help="Write both tooth meshes with deflection, stress and pressure into this folder.",
            show_default=False,
        ),
    ] = None,
    at: Annotated[float, typer.Option("--at", help="Position in mesh periods that --vtk writes.")] = 0.0,
    json: JsonOption = None,
) -> None:
    """Print stiffness, transmission error, load sharing and pressure of one mesh over its cycle."""
    import rotorgear as rg

    checked = rg.load(model)
    with progress_bar("mesh") as progress:
        result = rg.mesh(
            checked,
            mesh,
            stiffness=stiffness,
            torque=torque,
            preset=preset,
            body=body,
            accuracy=accuracy,
            positions=positions,
            periods=periods,
            load_factors=parse_factors(load_factors),
            progress=progress,
        )
    console().print(result.table(harmonics=harmonics))
    write_json(result.to_dict(max(harmonics, 8)), json)
    if plot:
        console().print(f"drawn: {rg.plot.save(rg.plot.mesh(result), plot)}")
    if vtk:
        from rotorgear.analysis.teeth.tooth_field import tooth_fields
        from rotorgear.export.tooth_vtk import write_tooth_vtk

        with progress_bar("vtk") as progress:
            fields = tooth_fields(
                checked, result.mesh, torque=torque, preset=result.preset, body=body, at=at, progress=progress
            )
        for path in write_tooth_vtk(fields, vtk):
            console().print(f"wrote {path}")


def parse_factors(text: str | None) -> tuple[float, ...]:
    """Positive factors from a list with commas.

    Raises:
        AnalysisError: something else.
    """
    if text is None:
        return ()
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise AnalysisError(f"--load-factors: got '{text}', expected factors with commas, such as 0.1,0.5,2") from None
