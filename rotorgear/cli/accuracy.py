"""rotorgear accuracy: convergence study of a model: error against run time over a series of discretisations."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rotorgear.cli.common import JsonOption, ModelFile, SpeedOption, console, parse_speed, progress_bar, write_json
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from rotorgear.results.convergence import ConvergenceStudy


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
    """Convergence study: error against run time and dofs over a series of discretisations, with the measured order."""
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
            study = rg.transient_convergence_study(
                rg.load(model), speed=parse_speed(speed), time=time, modal_damping=modal_damping, progress=progress
            )
        else:
            study = rg.convergence_study(
                rg.load(model), speed=parse_speed(speed), modes=modes, reference=given, progress=progress
            )
    for part in table(study):
        console().print(part)
    write_json(study.to_dict(), json)
    if plot:
        from rotorgear.plots.convergence import draw_convergence

        typer.echo(f"wrote {draw_convergence(study, plot)}")


def _refuse_modal_options(speed: str | None, reference: Path | None) -> None:
    if speed is not None or reference is not None:
        raise AnalysisError("--speed and --reference belong to --analysis modal.")


def _mesh(model: Path, mesh: str | None, torque: str | None, plot: Path | None, json: Path | None) -> None:
    """The convergence study of a mesh."""
    import rotorgear as rg
    from rotorgear.cli.mesh import parse_torque
    from rotorgear.results.tables.mesh import convergence_parts

    pinion_torque = parse_torque(torque)
    with progress_bar("accuracy") as progress:
        study = rg.mesh_convergence_study(rg.load(model), mesh, torque=pinion_torque, progress=progress)
    for part in convergence_parts(study):
        console().print(part)
    write_json(study.to_dict(), json)
    if plot:
        from rotorgear.plots.mesh_convergence import draw_mesh_convergence

        typer.echo(f"wrote {draw_mesh_convergence(study, plot)}")


def _refuse_others(time: str | None, modal_damping: float | None, reference: Path | None, plot: Path | None) -> None:
    if time or modal_damping is not None or reference or plot:
        raise AnalysisError("--analysis sweep takes --speed and --json, and no other option")


def _sweep(model: Path, speed: str | None, json: Path | None) -> None:
    """The convergence study of one point of a sweep."""
    import rotorgear as rg
    from rotorgear.results.tables.sweep import convergence_table

    with progress_bar("accuracy") as progress:
        study = rg.sweep_convergence_study(rg.load(model), speed=parse_speed(speed), progress=progress)
    console().print(convergence_table(study))
    write_json(study.to_dict(), json)


def table(study: ConvergenceStudy) -> list[Any]:
    """The study as rich renderables that fit 80 columns."""
    from rich.table import Table

    rows = Table(box=None, pad_edge=False, header_style="bold")
    for name in ("discretisation", "dofs", "seconds", "error", "estimate", "order"):
        rows.add_column(name, justify="left" if name == "discretisation" else "right")
    for rung in study.rungs:
        order = "" if rung.order is None else f"{rung.order:.2f}"
        rows.add_row(
            rung.method, str(rung.dofs), f"{rung.seconds:.3f} s", f"{rung.error:.1e}", f"{rung.estimate:.1e}", order
        )
    what = f"largest relative error of {study.modes} frequencies"
    if study.analysis == "transient":
        what = f"rms error of {study.modes} contact forces over their change"
    head = f"[bold]{study.title}[/bold]: {what}"
    return [head, f"against {study.reference}", "", rows, ""]
