"""rotorgear accuracy: error against run time of a model over a ladder of discretisations."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rotorgear.cli.common import JsonOption, ModelFile, SpeedOption, console, parse_speed, progress_bar, write_json
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from rotorgear.results.accuracy import AccuracyLadder


def accuracy(
    model: ModelFile,
    analysis: Annotated[
        str, typer.Option("--analysis", help="What is run: modal, mesh (teeth in contact), transient or sweep.")
    ] = "modal",
    mesh: Annotated[
        str | None, typer.Option("--mesh", help="With --analysis mesh: name of the mesh.", show_default=False)
    ] = None,
    torque: Annotated[
        str | None,
        typer.Option("--torque", help="With --analysis mesh: torque on the pinion.", show_default=False),
    ] = None,
    speed: SpeedOption = None,
    modes: Annotated[int, typer.Option("--modes", min=1, help="Number of modes that are compared.")] = 24,
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
        typer.Option("--modal-damping", help="Transient: damping ratio of every elastic mode.", show_default=False),
    ] = None,
    plot: Annotated[Path | None, typer.Option("--plot", help="Draw it to this PNG or SVG.", show_default=False)] = None,
    json: JsonOption = None,
) -> None:
    """Error against run time and dofs over a ladder of discretisations, with the measured order."""
    import rotorgear as rg

    if analysis == "mesh":
        _refuse_modal_options(speed, reference)
        _mesh(model, mesh, torque, plot, json)
        return
    if analysis not in ("modal", "transient", "sweep"):
        raise AnalysisError(f"--analysis: got '{analysis}', expected modal, mesh, transient or sweep")
    if mesh is not None or torque is not None:
        raise AnalysisError("--mesh and --torque belong to --analysis mesh.")
    if analysis == "sweep":
        _refuse_others(time, modal_damping, reference, plot)
        _sweep(model, speed, json)
        return
    if analysis == "modal" and (time or modal_damping is not None):
        raise AnalysisError("--time and --modal-damping belong to --analysis transient")
    if analysis == "transient" and reference:
        raise AnalysisError("--reference belongs to --analysis modal: a transient is compared with its own finest run")
    given = [line.frequency_hz for line in rg.read_rig_lines(reference)] if reference else None
    with progress_bar("accuracy") as progress:
        if analysis == "transient":
            ladder = rg.transient_ladder(
                rg.load(model), speed=parse_speed(speed), time=time, modal_damping=modal_damping, progress=progress
            )
        else:
            ladder = rg.accuracy_ladder(
                rg.load(model), speed=parse_speed(speed), modes=modes, reference=given, progress=progress
            )
    for part in table(ladder):
        console().print(part)
    write_json(ladder.to_dict(), json)
    if plot:
        from rotorgear.plots.accuracy import draw_accuracy

        typer.echo(f"wrote {draw_accuracy(ladder, plot)}")


def _refuse_modal_options(speed: str | None, reference: Path | None) -> None:
    if speed is not None or reference is not None:
        raise AnalysisError("--speed and --reference belong to --analysis modal.")


def _mesh(model: Path, mesh: str | None, torque: str | None, plot: Path | None, json: Path | None) -> None:
    """The ladder of a mesh."""
    import rotorgear as rg
    from rotorgear.cli.mesh import parse_torque
    from rotorgear.results.tables.mesh import ladder_parts

    pinion_torque = parse_torque(torque)
    with progress_bar("accuracy") as progress:
        ladder = rg.mesh_ladder(rg.load(model), mesh, torque=pinion_torque, progress=progress)
    for part in ladder_parts(ladder):
        console().print(part)
    write_json(ladder.to_dict(), json)
    if plot:
        from rotorgear.plots.mesh_ladder import draw_mesh_ladder

        typer.echo(f"wrote {draw_mesh_ladder(ladder, plot)}")


def _refuse_others(time: str | None, modal_damping: float | None, reference: Path | None, plot: Path | None) -> None:
    if time or modal_damping is not None or reference or plot:
        raise AnalysisError("--analysis sweep takes --speed and --json, and no other option")


def _sweep(model: Path, speed: str | None, json: Path | None) -> None:
    """The ladder of a point of a sweep."""
    import rotorgear as rg
    from rotorgear.results.tables.sweep import ladder_table

    with progress_bar("accuracy") as progress:
        ladder = rg.sweep_ladder(rg.load(model), speed=parse_speed(speed), progress=progress)
    console().print(ladder_table(ladder))
    write_json(ladder.to_dict(), json)


def table(ladder: AccuracyLadder) -> list[Any]:
    """The ladder as rich renderables that fit 80 columns."""
    from rich.table import Table

    rows = Table(box=None, pad_edge=False, header_style="bold")
    for name in ("discretisation", "dofs", "seconds", "error", "estimate", "order"):
        rows.add_column(name, justify="left" if name == "discretisation" else "right")
    for rung in ladder.rungs:
        order = "" if rung.order is None else f"{rung.order:.2f}"
        rows.add_row(
            rung.method, str(rung.dofs), f"{rung.seconds:.3f} s", f"{rung.error:.1e}", f"{rung.estimate:.1e}", order
        )
    what = f"largest relative error of {ladder.modes} frequencies"
    if ladder.analysis == "transient":
        what = f"rms error of {ladder.modes} contact forces over their change"
    head = f"[bold]{ladder.title}[/bold]: {what}"
    return [head, f"against {ladder.reference}", "", rows, ""]
