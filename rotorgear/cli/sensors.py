"""rotorgear sensors: where to put the sensors of a modal test."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    JsonOption,
    ModelFile,
    SaveOption,
    progress_bar,
    show_result,
)


def sensors(
    model: ModelFile,
    count: Annotated[int, typer.Option("--count", help="Number of sensors.")] = 12,
    modes: Annotated[
        int | None, typer.Option("--modes", help="Number of elastic modes (default: --count).", show_default=False)
    ] = None,
    fmax: Annotated[
        float | None, typer.Option("--fmax", help="All elastic modes up to this frequency in Hz.", show_default=False)
    ] = None,
    candidates: Annotated[
        str, typer.Option("--candidates", help="Places to choose from, such as 'bearings.*, casings.*'.")
    ] = "*",
    directions: Annotated[str, typer.Option("--directions", help="Directions that sensors look along.")] = "xyz",
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write the table of sensors here (CSV).", show_default=False)
    ] = None,
    json: JsonOption = None,
    save: SaveOption = None,
) -> None:
    """Place the sensors of a modal test: which places tell the modes apart best, before the test is made."""
    import rotorgear as rg

    with progress_bar("sensors") as progress:
        result = rg.sensors(
            rg.load(model),
            count=count,
            modes=modes,
            fmax=fmax,
            candidates=candidates,
            directions=directions,
            accuracy=accuracy,
            elements=elements,
            progress=progress,
        )
    out = show_result(result, json, save)
    if output is not None:
        out.print(f"wrote {rg.write_sensors(result, output)}")
