"""rotorgear orbits: periodic motions over a parameter, their stability, folds and period doublings."""

from __future__ import annotations

from typing import Annotated

import typer

from rotorgear.cli.common import JsonOption, ModelFile, PlotOption, SaveOption, console, progress_bar, write_json
from rotorgear.errors import AnalysisError
from rotorgear.extras import require


def orbits(
    model: ModelFile,
    over: Annotated[
        list[str],
        typer.Option(
            "--over",
            help="ADDRESS=FROM:TO, such as 'operation.speed=3000 rpm:6000 rpm'; a second one follows folds and period doublings "
            "over both.",
            show_default=False,
        ),
    ],
    harmonics: Annotated[
        int | None, typer.Option("--harmonics", help="Harmonics of the base period (default 30).", show_default=False)
    ] = None,
    instants: Annotated[
        int | None,
        typer.Option("--instants", help="Instants in a base period (default 16 a harmonic).", show_default=False),
    ] = None,
    method: Annotated[
        str, typer.Option("--method", help="harmonic balance, shooting (small systems) or auto.")
    ] = "auto",
    excite: Annotated[
        str | None,
        typer.Option("--excite", help="Mesh whose stage excites alone, all others at their mean.", show_default=False),
    ] = None,
    from_transient: Annotated[
        bool, typer.Option("--from-transient", help="Begin from what a transient of 400 periods settles on.")
    ] = False,
    switch: Annotated[bool, typer.Option("--switch", help="Follow the branches of twice the period, too.")] = False,
    verify: Annotated[
        bool, typer.Option("--verify", help="Start transients on some motions and tell how they leave them.")
    ] = False,
    accuracy: Annotated[
        float | None,
        typer.Option("--accuracy", help="Double harmonics and instants until it is reached.", show_default=False),
    ] = None,
    step: Annotated[float, typer.Option("--step", help="Longest step along a branch, as a share of the range.")] = 0.04,
    points: Annotated[int, typer.Option("--points", help="Points of a branch, at most.")] = 600,
    elements: Annotated[
        int | None,
        typer.Option(
            "--elements",
            help="Basic elements in each shaft segment (default: one of second order).",
            show_default=False,
        ),
    ] = None,
    json: JsonOption = None,
    save: SaveOption = None,
    plot: PlotOption = None,
) -> None:
    """Periodic motions over a parameter: stable and unstable branches, Floquet multipliers, folds and period doublings."""
    require("numba", "A branch of periodic motions")
    import rotorgear as rg

    ranges: dict[str, str] = {}
    for text in over:
        address, sign, ends = text.partition("=")
        if not sign or not address.strip() or not ends.strip():
            raise AnalysisError(
                f"over: got '{text}', expected ADDRESS=FROM:TO such as 'operation.speed=3000 rpm:6000 rpm'"
            )
        if address.strip() in ranges:
            raise AnalysisError(f"--over: '{address.strip()}' is given twice")
        ranges[address.strip()] = ends.strip()
    with progress_bar("orbits") as progress:
        result = rg.orbits(
            rg.load(model),
            ranges,
            harmonics=harmonics,
            instants=instants,
            method=method,
            excite=excite,
            from_transient=from_transient,
            switch=switch,
            verify=verify,
            accuracy=accuracy,
            step=step,
            points=points,
            elements=elements,
            progress=progress,
        )
    console().print(result.table())
    if save:
        rg.save(result, save)
        typer.echo(f"saved {save}")
    write_json(result.to_dict(), json)
    if plot:
        typer.echo(f"wrote {rg.plot.save(result.plot(), plot)}")
