"""rotorgear frf: frequency responses between places."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    JsonOption,
    ModelFile,
    PlotOption,
    SaveOption,
    SpeedOption,
    console,
    parse_speed,
    progress_bar,
    write_json,
)
from rotorgear.cli.response import DampingOption
from rotorgear.errors import AnalysisError

_PLACES = "points, or part and direction such as bearings.left:x; several with commas"


def frf(
    model: ModelFile,
    inputs: Annotated[str, typer.Option("--from", help=f"Where unit forces act: {_PLACES}.", show_default=False)],
    outputs: Annotated[str, typer.Option("--to", help="Where the response is read, as --from.", show_default=False)],
    fmax: Annotated[float, typer.Option("--fmax", help="Highest frequency in Hz.", show_default=False)],
    fmin: Annotated[
        float | None, typer.Option("--fmin", help="Lowest frequency in Hz (default: one step).", show_default=False)
    ] = None,
    points: Annotated[int, typer.Option("--points", help="Number of frequencies.")] = 1000,
    quantity: Annotated[str, typer.Option("--quantity", help="receptance, mobility or accelerance.")] = "receptance",
    speed: SpeedOption = None,
    damping: DampingOption = 0.0,
    elements: ElementsOption = None,
    accuracy: AccuracyOption = None,
    json: JsonOption = None,
    save: SaveOption = None,
    plot: PlotOption = None,
) -> None:
    """Frequency responses between points or parts: unit force in, displacement, velocity or acceleration out."""
    import numpy as np

    import rotorgear as rg
    from rotorgear.results.frequency_response import QUANTITIES
    from rotorgear.results.tables.response import frf_tables

    if quantity not in QUANTITIES:
        raise AnalysisError(f"--quantity: got '{quantity}', expected one of {', '.join(QUANTITIES)}")
    if points < 2:
        raise AnalysisError(f"--points: got {points}, expected at least 2")
    low = fmax / points if fmin is None else fmin
    if not 0.0 < low < fmax < float("inf"):
        raise AnalysisError(f"--fmin and --fmax: got {low:g} and {fmax:g} Hz, expected 0 < fmin < fmax")
    with progress_bar("frf") as progress:
        result = rg.frequency_response(
            rg.load(model),
            np.linspace(low, fmax, points),
            inputs=_names(inputs),
            outputs=_names(outputs),
            speed=parse_speed(speed),
            damping_ratio=damping,
            elements=elements,
            accuracy=accuracy,
            progress=progress,
        )
    out = console()
    for part in frf_tables(result, quantity):
        out.print(part)
    write_json(result.to_dict(), json)
    if save:
        typer.echo(f"saved {rg.save(result, Path(save))}")
    if plot:
        from rotorgear.plots.frf import draw_frf

        typer.echo(f"wrote {draw_frf(result, plot, quantity=quantity)}")


def _names(text: str) -> list[str]:
    return [word.strip() for word in text.split(",") if word.strip()]
