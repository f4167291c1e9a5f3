"""rotorgear scatter: bands of frequencies, margins and load shares of a model whose numbers scatter."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    JsonOption,
    ModelFile,
    PlotOption,
    console,
    progress_bar,
    write_json,
)
from rotorgear.errors import AnalysisError, RotorgearError


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
    workers: Annotated[
        int | None, typer.Option("--workers", help="Threads (default: all cores).", show_default=False)
    ] = None,
    cluster: Annotated[
        str | None,
        typer.Option(
            "--cluster",
            help="Workers elsewhere: a dask scheduler such as tcp://host:8786, or local:N processes here.",
            show_default=False,
        ),
    ] = None,
    json: JsonOption = None,
    save: Annotated[
        Path | None, typer.Option("--save", help="Save the result (HDF5), in blocks while it runs.", show_default=False)
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with an interrupted scatter of the same --save.")
    ] = False,
    plot: PlotOption = None,
) -> None:
    """Scatter of uncertain numbers: bands of frequencies, margins and load shares, and which number makes them."""
    import rotorgear as rg

    if resume and save is None:
        raise AnalysisError("--resume needs the --save of the scatter that was interrupted")
    if workers is not None and workers < 1:
        raise AnalysisError(f"--workers: got {workers}, expected 1 or more")
    if workers is not None and cluster is not None:
        raise AnalysisError("--workers are threads on this machine, --cluster are workers elsewhere: give one of them")
    with ExitStack() as stack:
        progress = stack.enter_context(progress_bar("scatter"))
        read = rg.load(model)
        elsewhere = stack.enter_context(rg.cluster(cluster)) if cluster is not None else None
        try:
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
        except (KeyboardInterrupt, RotorgearError):
            if save and any(Path(f"{save}.parts").glob("chunk_*")):
                typer.echo(f"the blocks that were done are kept in {save}.parts: go on with --resume", err=True)
            raise
    console().print(result.table())
    if save:
        rg.save(result, save)
        rg.stream(save).close()
        typer.echo(f"saved {save}")
    write_json(result.to_dict(), json)
    if plot:
        typer.echo(f"wrote {rg.plot.save(rg.plot.scatter(result), plot)}")
