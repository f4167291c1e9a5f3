"""rotorgear scatter: bands of frequencies, margins and load shares of a model whose numbers scatter."""

from __future__ import annotations

from contextlib import ExitStack
from typing import Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ClusterOption,
    ElementsOption,
    JsonOption,
    ModelFile,
    PlotOption,
    SaveBlocksOption,
    WorkersOption,
    check_workers,
    console,
    kept_blocks,
    progress_bar,
    write_json,
)


def scatter(
    model: ModelFile,
    free: Annotated[
        str | None,
        typer.Option(
            "--free",
            help="Addresses of the numbers that scatter, with commas between; * for all names (default: [scatter]).",
            show_default=False,
        ),
    ] = None,
    sigma: Annotated[
        str | None,
        typer.Option("--sigma", help="Their standard deviation, '10 %' (default) or '0.1 mm'.", show_default=False),
    ] = None,
    tolerance: Annotated[
        str | None,
        typer.Option(
            "--tolerance",
            help="Half width of a tolerance instead: the limits where uniform, else three standard deviations.",
            show_default=False,
        ),
    ] = None,
    distribution: Annotated[str, typer.Option("--distribution", help="normal, lognormal or uniform.")] = "normal",
    samples: Annotated[int, typer.Option("--samples", help="Number of samples.")] = 1024,
    sampling: Annotated[str, typer.Option("--sampling", help="sobol, latin (hypercube) or random.")] = "sobol",
    seed: Annotated[int, typer.Option("--seed", help="Seed of the samples.")] = 1,
    sobol: Annotated[int, typer.Option("--sobol", help="Base points of Sobol indices, such as 512; 0 for none.")] = 0,
    speed: Annotated[
        str | None,
        typer.Option("--speed", help="Speed of the input shaft (default: operating speed).", show_default=False),
    ] = None,
    modes: Annotated[int, typer.Option("--modes", help="Number of elastic modes.")] = 20,
    margin: Annotated[
        str, typer.Option("--margin", help="Least distance of modes from excitations, for the share below it.")
    ] = "15 %",
    participation: Annotated[
        float, typer.Option("--participation", help="Least share of the exciting part in a mode's energy that counts.")
    ] = 0.01,
    sharing: Annotated[
        bool, typer.Option("--sharing", help="Load shares of meshes too; ISO 1328 classes of gears then scatter.")
    ] = False,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    workers: WorkersOption = None,
    cluster: ClusterOption = None,
    json: JsonOption = None,
    save: SaveBlocksOption = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with an interrupted scatter of the same --save.")
    ] = False,
    plot: PlotOption = None,
) -> None:
    """Scatter of uncertain numbers: bands of frequencies, margins and load shares, and which number makes them."""
    import rotorgear as rg

    check_workers(workers, cluster, resume, save)
    with ExitStack() as stack:
        progress = stack.enter_context(progress_bar("scatter"))
        read = rg.load(model)
        elsewhere = stack.enter_context(rg.cluster(cluster)) if cluster is not None else None
        with kept_blocks(save):
            result = rg.scatter(
                read,
                free,
                sigma=sigma,
                tolerance=tolerance,
                distribution=distribution,
                samples=samples,
                sampling=sampling,
                seed=seed,
                sobol=sobol,
                speed=speed,
                modes=modes,
                margin=margin,
                participation=participation,
                sharing=sharing,
                accuracy=accuracy,
                elements=elements,
                workers=workers,
                executor=elsewhere,
                stream=rg.stream(save, resume=resume) if save else None,
                progress=progress,
            )
    console().print(result.table())
    if save:
        rg.save(result, save)
        rg.stream(save).close()
        typer.echo(f"saved {save}")
    write_json(result.to_dict(), json)
    if plot:
        typer.echo(f"wrote {rg.plot.save(rg.plot.scatter(result), plot)}")
