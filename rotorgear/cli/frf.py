"""rotorgear frf: frequency responses between places."""

from __future__ import annotations

from typing import Annotated

import typer

from rotorgear.cli.common import (
    AmplitudeAccuracyOption,
    ElementsOption,
    JsonOption,
    ModalDampingOption,
    ModelFile,
    PlotOption,
    SaveOption,
    SpeedOption,
    UffOption,
    console,
    parse_speed,
    progress_bar,
    words_of,
    write_json,
)
from rotorgear.errors import AnalysisError

_PLACES = "points, or part and direction such as bearings.left:x; several with commas"


def frf(
    model: ModelFile,
    inputs: Annotated[str, typer.Option("--inputs", help=f"Where unit forces act: {_PLACES}.", show_default=False)],
    outputs: Annotated[
        str, typer.Option("--outputs", help="Where the response is read, as --inputs.", show_default=False)
    ],
    fmax: Annotated[float, typer.Option("--fmax", help="Highest frequency in Hz.", show_default=False)],
    fmin: Annotated[
        float | None, typer.Option("--fmin", help="Lowest frequency in Hz (default: one step).", show_default=False)
    ] = None,
    points: Annotated[int, typer.Option("--points", help="Number of frequencies.")] = 1000,
    quantity: Annotated[str, typer.Option("--quantity", help="receptance, mobility or accelerance.")] = "receptance",
    speed: SpeedOption = None,
    modal_damping: ModalDampingOption = 0.0,
    elements: ElementsOption = None,
    accuracy: AmplitudeAccuracyOption = None,
    json: JsonOption = None,
    save: SaveOption = None,
    plot: PlotOption = None,
    uff: UffOption = None,
) -> None:
    """Frequency responses between points or parts: unit force in, displacement, velocity or acceleration out."""
    import rotorgear as rg
    from rotorgear.results.frequency_response import QUANTITIES

    if quantity not in QUANTITIES:
        raise AnalysisError(f"--quantity: got '{quantity}', expected one of {', '.join(QUANTITIES)}")
    with progress_bar("frf") as progress:
        result = rg.frf(
            rg.load(model),
            inputs=words_of(inputs),
            outputs=words_of(outputs),
            fmax=fmax,
            fmin=fmin,
            points=points,
            speed=parse_speed(speed),
            modal_damping=modal_damping,
            elements=elements,
            accuracy=accuracy,
            progress=progress,
        )
    out = console()
    out.print(result.table(quantity=quantity))
    write_json(result.to_dict(), json)
    if save:
        typer.echo(f"saved {rg.save(result, save)}")
    if plot:
        typer.echo(f"wrote {rg.plot.save(rg.plot.frf(result, quantity=quantity), plot)}")
    if uff:
        typer.echo(f"wrote {rg.write_uff(result, uff)}")
