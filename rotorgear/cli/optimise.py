"""rotorgear optimise: numbers of a model, within bounds, that keep excitations away from the modes that they excite."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    ElementsOption,
    JsonOption,
    ModelFile,
    PlotOption,
    SaveOption,
    progress_bar,
    show_result,
    words_of,
)
from rotorgear.errors import AnalysisError
from rotorgear.extras import require


def optimise(
    model: ModelFile,
    free: Annotated[
        str,
        typer.Option(
            "--free", help="Addresses of the free numbers, with commas between; * for all names.", show_default=False
        ),
    ],
    margin: Annotated[
        str, typer.Option("--margin", help="Least distance of excitations from modes that they excite.")
    ] = "15 %",
    bounds: Annotated[
        list[str] | None,
        typer.Option(
            "--bounds",
            help="ADDRESS=LOW:HIGH, shares added to the value (default '-20 %:20 %') or values with units; once or more.",
            show_default=False,
        ),
    ] = None,
    objective: Annotated[
        str,
        typer.Option(
            "--objective", help="change (the least), mass (the least) or scatter (the least sensitive to [scatter])."
        ),
    ] = "change",
    speeds: Annotated[
        str | None,
        typer.Option(
            "--speeds", help="Speeds of the input shaft, with commas (default: operating speed).", show_default=False
        ),
    ] = None,
    mesh_orders: Annotated[str, typer.Option("--mesh-orders", help="Orders of every mesh that count.")] = "1",
    shaft_orders: Annotated[str, typer.Option("--shaft-orders", help="Orders of every shaft that count.")] = "1",
    participation: Annotated[
        float, typer.Option("--participation", help="Least share of the exciting part in a mode's energy that counts.")
    ] = 0.01,
    searches: Annotated[
        int, typer.Option("--searches", help="Searches: one from the file, the others within bounds.")
    ] = 4,
    seed: Annotated[int, typer.Option("--seed", help="Seed of the searches.")] = 1,
    elements: ElementsOption = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write the model file found here.", show_default=False)
    ] = None,
    json: JsonOption = None,
    save: SaveOption = None,
    plot: PlotOption = None,
) -> None:
    """Keep excitations away from modes that they excite: numbers of a model within bounds, gradients exact."""
    import rotorgear as rg
    from rotorgear.cli.speed_options import parse_mesh_orders, parse_orders

    if output is not None:
        require("tomlkit", "Writing a changed model file")
    given = {}
    for text in bounds or []:
        address, sign, ends = text.partition("=")
        if not sign or not address.strip():
            raise AnalysisError(
                f"--bounds: got '{text}', expected ADDRESS=LOW:HIGH such as 'bearings.*.at=-160 mm:-120 mm'"
            )
        given[address.strip()] = ends.strip()
    loaded = rg.load(model)
    with progress_bar("optimise") as progress:
        result = rg.optimise(
            loaded,
            free,
            margin=margin,
            bounds=given,
            objective=objective,
            speeds=words_of(speeds) or None,
            mesh_orders=parse_mesh_orders(mesh_orders, (1,)),
            shaft_orders=parse_orders(shaft_orders, "--shaft-orders", (1,)),
            participation=participation,
            searches=searches,
            seed=seed,
            elements=elements,
            progress=progress,
        )
    out = show_result(result, json, save)
    if output is not None:
        rg.write_optimised_model(result, model, output)
        out.print(f"wrote {output}")
    if plot is not None:
        out.print(f"wrote {rg.plot.save(rg.plot.optimise(result), plot)}")
