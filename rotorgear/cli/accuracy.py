"""rotorgear accuracy: convergence study of a model: error against run time over a series of discretisations."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
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
from rotorgear.errors import AnalysisError


def accuracy(
    model: ModelFile,
    analysis: Annotated[
        str,
        typer.Option(
            "--analysis",
            help="What is run: modal, campbell, critical, static, response, frf, mesh (teeth in contact), bearing, "
            "transient, sweep, orbits or casing.",
        ),
    ] = "modal",
    mesh: Annotated[
        str | None, typer.Option("--mesh", help="With --analysis mesh: name of the mesh.", show_default=False)
    ] = None,
    torque: Annotated[
        str | None,
        typer.Option("--torque", help="With --analysis mesh: torque on the pinion.", show_default=False),
    ] = None,
    bearing: Annotated[
        str | None, typer.Option("--bearing", help="With --analysis bearing: name of the bearing.", show_default=False)
    ] = None,
    speed: SpeedOption = None,
    stop: Annotated[
        str | None,
        typer.Option("--to", help="Campbell, critical: highest speed of the range.", show_default=False),
    ] = None,
    fmax: Annotated[
        float | None, typer.Option("--fmax", help="Response, frf: highest frequency in Hz.", show_default=False)
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(
            "--at", help="Frf: where force and response are (default: the first disk or gear).", show_default=False
        ),
    ] = None,
    modes: Annotated[
        int | None,
        typer.Option(
            "--modes",
            min=1,
            help="Modal, campbell, casing: number of modes that are compared (default 24; of a casing 8).",
            show_default=False,
        ),
    ] = None,
    reference: Annotated[
        Path | None,
        typer.Option(
            "--reference",
            help="CSV of frequencies (default: the model's own finest).",
            show_default=False,
        ),
    ] = None,
    time: Annotated[
        str | None, typer.Option("--time", help="Transient: duration (default: 8 mesh periods).", show_default=False)
    ] = None,
    modal_damping: Annotated[
        float | None,
        typer.Option(
            "--modal-damping", help="Response, frf, transient: damping ratio of every elastic mode.", show_default=False
        ),
    ] = None,
    casing: Annotated[
        str | None,
        typer.Option("--casing", help="With --analysis casing: its name, where there are several.", show_default=False),
    ] = None,
    coupled: Annotated[
        bool, typer.Option("--coupled", help="With --analysis casing: modes of the gearbox with it, not its own.")
    ] = False,
    finest: Annotated[
        int | None,
        typer.Option(
            "--finest",
            min=1,
            help="With --analysis casing: most unknowns of the mesh to compare with (default 300000).",
            show_default=False,
        ),
    ] = None,
    excite: Annotated[
        str | None,
        typer.Option("--excite", help="With --analysis orbits: mesh whose stage excites alone.", show_default=False),
    ] = None,
    plot: PlotOption = None,
    json: JsonOption = None,
    save: SaveOption = None,
) -> None:
    """Convergence study: error against run time and dofs over a series of discretisations, with the measured order."""
    import rotorgear as rg

    if analysis == "sweep" and plot:
        raise AnalysisError("--plot: the study of a sweep has no picture; --json writes its numbers")
    given = [line.frequency_hz for line in rg.read_rig_lines(reference)] if reference else None
    with progress_bar("accuracy") as progress:
        study = rg.accuracy(
            rg.load(model),
            analysis,
            speed=parse_speed(speed),
            stop=parse_speed(stop, "--to"),
            fmax=fmax,
            at=at,
            modes=modes,
            reference=given,
            mesh=mesh,
            torque=torque,
            bearing=bearing,
            time=time,
            modal_damping=modal_damping,
            casing=casing,
            coupled=coupled or None,
            finest=finest,
            excite=excite,
            progress=progress,
        )
    console().print(study.table())
    write_json(study.to_dict(), json)
    if save:
        typer.echo(f"saved {rg.save(study, save)}")
    if plot:
        typer.echo(f"wrote {rg.plot.save(study.plot(), plot)}")
