"""rotorgear update: the numbers of a model that a rig's lines and shapes make most probable, and what they taught."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    JsonOption,
    ModalDampingOption,
    ModelFile,
    SaveOption,
    ToleranceOption,
    progress_bar,
    show_result,
)
from rotorgear.extras import require


def update(
    model: ModelFile,
    rig: Annotated[
        Path | None, typer.Option("--rig", help="Measured frequencies (CSV) of the rig at rest.", show_default=False)
    ] = None,
    shapes: Annotated[
        Path | None,
        typer.Option("--shapes", help="Measured mode shapes and frequencies (UFF, dataset 55).", show_default=False),
    ] = None,
    frf: Annotated[
        Path | None,
        typer.Option(
            "--frf", help="Measured frequency responses (UFF, dataset 58), beside these or alone.", show_default=False
        ),
    ] = None,
    points: Annotated[
        Path | None,
        typer.Option(
            "--points", help="Sensors of shapes and responses (CSV: point,node,direction).", show_default=False
        ),
    ] = None,
    free: Annotated[
        str, typer.Option("--free", help="Addresses of the free numbers, with commas between; * for all names.")
    ] = "bearings.*.stiffness, meshes.*.stiffness",
    prior: Annotated[
        str, typer.Option("--prior", help="Relative standard deviation of the free numbers before the test.")
    ] = "30 %",
    shape_noise: Annotated[
        float, typer.Option("--shape-noise", help="Noise of a shape, as a share of its root mean square.")
    ] = 0.02,
    frf_noise: Annotated[
        float, typer.Option("--frf-noise", help="Noise of a frequency response, as a share of its size.")
    ] = 0.05,
    modal_damping: ModalDampingOption = 0.0,
    speed: Annotated[
        str | None,
        typer.Option(
            "--speed", help="Speed of the input shaft while it was measured (default: at rest).", show_default=False
        ),
    ] = None,
    campaigns: Annotated[
        Path | None,
        typer.Option(
            "--campaigns", help="Several campaigns (TOML): files, speeds and states of the gearbox.", show_default=False
        ),
    ] = None,
    tolerance: ToleranceOption = 0.05,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write the updated model file here.", show_default=False)
    ] = None,
    json: JsonOption = None,
    save: SaveOption = None,
) -> None:
    """Update numbers of a model by a rig: most probable values, what the lines teach, and held-out proof."""
    import rotorgear as rg

    if output is not None:
        require("tomlkit", "Writing a changed model file")
    loaded = rg.load(model)
    with progress_bar("update") as progress:
        result = rg.update(
            loaded,
            rig,
            shapes=shapes,
            frf=frf,
            points=points,
            free=free,
            prior=prior,
            shape_noise=shape_noise,
            frf_noise=frf_noise,
            modal_damping=modal_damping,
            speed=speed,
            campaigns=campaigns,
            tolerance=tolerance,
            accuracy=accuracy,
            elements=elements,
            progress=progress,
        )
    out = show_result(result, json, save)
    if output is not None:
        rg.write_updated_model(result, model, output)
        out.print(f"wrote {output}")
