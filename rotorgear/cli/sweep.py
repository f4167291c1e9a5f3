"""rotorgear sweep: Poincare sections, Lyapunov exponents and response types over one or two parameters."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    ClusterOption,
    JsonOption,
    ModelFile,
    SaveBlocksOption,
    WorkersOption,
    check_workers,
    console,
    kept_blocks,
    plot_folder,
    progress_bar,
    write_json,
)
from rotorgear.errors import AnalysisError
from rotorgear.extras import require

# Points that --plot draws portraits and spectra of.
_PORTRAITS = 9


def sweep(
    model: ModelFile,
    over: Annotated[
        list[str],
        typer.Option(
            "--over", help="ADDRESS=FROM:TO:COUNT or ADDRESS=VALUE,VALUE,...; once or twice.", show_default=False
        ),
    ],
    direction: Annotated[
        str, typer.Option("--direction", help="each (from its static state), up, down or both.")
    ] = "each",
    initial_conditions: Annotated[
        int,
        typer.Option("--initial-conditions", help="Runs at each point: one from rest, the others from random states."),
    ] = 1,
    discard: Annotated[
        int, typer.Option("--discard", help="Transient periods discarded (least common periods).")
    ] = 300,
    sample: Annotated[int, typer.Option("--sample", help="Periods sampled after them.")] = 200,
    exponents: Annotated[int, typer.Option("--exponents", help="Lyapunov exponents; 0 for none.")] = 1,
    steps: Annotated[
        int | None, typer.Option("--steps", help="Steps in a period of the fastest mesh.", show_default=False)
    ] = None,
    tolerance: Annotated[
        float, typer.Option("--tolerance", help="Share of the peak-to-peak value within which a response repeats.")
    ] = 0.02,
    chaos: Annotated[
        float, typer.Option("--chaos", help="Lyapunov exponent per mesh period above which a response is chaotic.")
    ] = 0.02,
    seed: Annotated[int, typer.Option("--seed", help="Seed of the random states of --initial-conditions.")] = 1,
    modes: Annotated[
        int | None, typer.Option("--modes", help="Number of modes to reduce the model to.", show_default=False)
    ] = None,
    reduction_error: Annotated[
        float, typer.Option("--reduction-error", help="Largest FRF error of the reduction of a large model.")
    ] = 0.01,
    elements: Annotated[
        int | None,
        typer.Option(
            "--elements",
            help="Basic elements in each shaft segment (default: one of second order).",
            show_default=False,
        ),
    ] = None,
    portraits: Annotated[
        list[str] | None,
        typer.Option(
            "--portraits",
            help="Keep the trajectory of the point next to this VALUE (VALUE,VALUE of two parameters); once or more. "
            "With --plot nine points where not given.",
            show_default=False,
        ),
    ] = None,
    workers: WorkersOption = None,
    cluster: ClusterOption = None,
    json: JsonOption = None,
    save: SaveBlocksOption = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with an interrupted sweep of the same --save.")
    ] = False,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot", help="Draw pictures of the result to this folder.", show_default=False, callback=plot_folder
        ),
    ] = None,
) -> None:
    """Bifurcation diagram, Lyapunov exponents and response types of a model over its parameters."""
    require("numba", "A sweep")
    import rotorgear as rg
    from rotorgear.analysis.sweep.axes import axis_of_option

    check_workers(workers, cluster, resume, save)
    axes = [axis_of_option(text) for text in over]
    if len({axis.address for axis in axes}) < len(axes):
        raise AnalysisError(f"--over: '{axes[0].address}' is given twice")
    with ExitStack() as stack:
        progress = stack.enter_context(progress_bar("sweep"))
        read = rg.load(model)
        elsewhere = stack.enter_context(rg.cluster(cluster)) if cluster is not None else None
        with kept_blocks(save):
            result = rg.sweep(
                read,
                {axis.address: [axis.text(value) for value in axis.values] for axis in axes},
                direction=direction,
                initial_conditions=initial_conditions,
                discard=discard,
                sample=sample,
                exponents=exponents,
                steps=steps,
                tolerance=tolerance,
                chaos=chaos,
                seed=seed,
                modes=modes,
                reduction_error=reduction_error,
                elements=elements,
                portraits=portraits or (_PORTRAITS if plot else 0),
                workers=workers,
                executor=elsewhere,
                stream=rg.stream(save, resume=resume) if save else None,
                progress=progress,
            )
    console().print(result.table())
    # First the file that holds everything.
    if save:
        rg.save(result, save)
        rg.stream(save).close()
        typer.echo(f"saved {save}")
    write_json(result.to_dict(), json)
    if plot:
        from rotorgear.plots.sweep import write_pictures

        paths = write_pictures(result, plot)
        typer.echo(f"wrote {len(paths)} picture{'s' if len(paths) > 1 else ''} to {plot}")
