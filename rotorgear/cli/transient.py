"""rotorgear transient: time response with backlash, varying mesh stiffness and transmission error."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    JsonOption,
    ModelFile,
    console,
    parse_speed,
    plot_folder,
    progress_bar,
    vtk_folder,
    write_json,
)
from rotorgear.errors import AnalysisError
from rotorgear.extras import require


def transient(
    model: ModelFile,
    speed: Annotated[
        str | None,
        typer.Option(
            "--speed", help="Speed of the input shaft, such as '6000 rpm' (default: operation).", show_default=False
        ),
    ] = None,
    speed_to: Annotated[
        str | None,
        typer.Option(
            "--speed-to", help="Run up (or down) to this speed within the time evaluated.", show_default=False
        ),
    ] = None,
    time: Annotated[
        str | None,
        typer.Option("--time", help="Time evaluated, such as '0.2 s' (default: 30 mesh periods).", show_default=False),
    ] = None,
    discard: Annotated[
        str | None,
        typer.Option("--discard", help="Time of the transient before it, which is discarded.", show_default=False),
    ] = None,
    accuracy: Annotated[
        float | None,
        typer.Option(
            "--accuracy", help="Wanted relative accuracy of the statistics (default 0.01).", show_default=False
        ),
    ] = None,
    steps: Annotated[
        int | None,
        typer.Option("--steps", help="Steps in a period of the fastest mesh, instead.", show_default=False),
    ] = None,
    records: Annotated[
        int | None,
        typer.Option("--records", help="Records in a period of the fastest mesh (default 40).", show_default=False),
    ] = None,
    method: Annotated[
        str, typer.Option("--method", help="auto, newmark, hht, generalised-alpha, exponential or explicit.")
    ] = "auto",
    rho_inf: Annotated[
        float | None,
        typer.Option("--rho-inf", help="For hht and generalised-alpha: 1 damps nothing, 0 most.", show_default=False),
    ] = None,
    modes: Annotated[
        int | None,
        typer.Option(
            "--modes",
            help="Exponential: number of modes kept, with residual vectors (default: all).",
            show_default=False,
        ),
    ] = None,
    modal_damping: Annotated[
        float | None,
        typer.Option("--modal-damping", help="Damping ratio of every elastic mode, such as 0.02.", show_default=False),
    ] = None,
    elements: Annotated[
        int | None,
        typer.Option("--elements", help="Basic elements in each shaft segment.", show_default=False),
    ] = None,
    error_estimate: Annotated[
        bool, typer.Option("--error-estimate/--no-error-estimate", help="Compare with a run of twice the step.")
    ] = True,
    spectrum: Annotated[
        str | None,
        typer.Option("--spectrum", help="List the lines in the spectrum of this history.", show_default=False),
    ] = None,
    rig: Annotated[
        Path | None,
        typer.Option("--rig", help="Put the lines of this rig list beside those of --spectrum.", show_default=False),
    ] = None,
    json: JsonOption = None,
    save: Annotated[
        Path | None, typer.Option("--save", help="Save the result (HDF5), in chunks while it runs.", show_default=False)
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with an interrupted run of the same --save.")] = False,
    vtk: Annotated[
        Path | None,
        typer.Option(
            "--vtk",
            help="Write the motion at the end to this folder, for ParaView.",
            show_default=False,
            callback=vtk_folder,
        ),
    ] = None,
    frames: Annotated[int, typer.Option("--frames", min=2, help="Instants that --vtk writes.")] = 120,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot", help="Draw pictures of the result to this folder.", show_default=False, callback=plot_folder
        ),
    ] = None,
) -> None:
    """Time response from the static equilibrium: contact forces, transmission error, bearings, spectra."""
    import rotorgear as rg

    require("numba", "A transient")
    if rig and not spectrum:
        raise AnalysisError("--rig needs --spectrum: the history whose lines are compared")
    if resume and save is None:
        raise AnalysisError("--resume needs the --save of the run that was interrupted")
    stream = rg.stream(save, resume=resume) if save else None
    with progress_bar("transient") as progress:
        result = rg.transient(
            rg.load(model),
            speed=parse_speed(speed),
            speed_to=parse_speed(speed_to, "--speed-to"),
            time=time,
            discard=discard,
            accuracy=accuracy,
            steps=steps,
            records=records,
            method=method,
            rho_inf=rho_inf,
            modes=modes,
            modal_damping=modal_damping,
            elements=elements,
            error_estimate=error_estimate,
            frames=frames if vtk else 0,
            stream=stream,
            progress=progress,
        )
    out = console()
    out.print(result.table())
    data = result.to_dict()
    if spectrum:
        lines = rg.spectral_lines(result, spectrum)
        out.print(lines.table())
        data["spectrum"] = lines.to_dict()
        if rig:
            beside = rg.compare_spectrum(result, lines, rg.read_rig_lines(rig))
            out.print(beside.table())
            data["rig"] = beside.to_dict()
    write_json(data, json)
    if save and not result.ended_early:
        rg.save(result, save)
        rg.stream(save).close()
        typer.echo(f"saved {save}")
    if plot:
        from rotorgear.plots.transient import write_pictures

        paths = write_pictures(result, plot)
        typer.echo(f"wrote {len(paths)} pictures to {plot}")
    if vtk:
        paths = rg.write_motion(result, vtk)
        typer.echo(f"wrote {len(paths)} files to {vtk}; open motion.pvd in ParaView")
    if result.ended_early:
        typer.echo("the run ended early: what it gave so far stands above", err=True)
        raise typer.Exit(1)
