"""rotorgear compare: modes of a model or of a saved result against rig frequencies, shapes, responses or order cuts."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    JsonOption,
    ModalDampingOption,
    ModelOrResult,
    PlotOption,
    SpeedOption,
    ToleranceOption,
    console,
    is_saved,
    parse_speed,
    progress_bar,
    write_json,
)
from rotorgear.errors import AnalysisError


def compare(
    source: ModelOrResult,
    lines: Annotated[
        Path | None, typer.Argument(metavar="[RIG]", help="Rig frequencies (CSV).", show_default=False)
    ] = None,
    rig: Annotated[Path | None, typer.Option("--rig", help="The same as an option.", show_default=False)] = None,
    shapes: Annotated[
        Path | None, typer.Option("--shapes", help="Measured mode shapes (UFF, dataset 55).", show_default=False)
    ] = None,
    frf: Annotated[
        Path | None, typer.Option("--frf", help="Measured frequency responses (UFF, dataset 58).", show_default=False)
    ] = None,
    orders: Annotated[
        Path | None, typer.Option("--orders", help="Order cuts of a run-up (CSV, or UFF 58).", show_default=False)
    ] = None,
    points: Annotated[
        Path | None,
        typer.Option("--points", help="Sensors of a UFF file (CSV: point,node,direction).", show_default=False),
    ] = None,
    tolerance: ToleranceOption = 0.05,
    speed: SpeedOption = None,
    modal_damping: ModalDampingOption = 0.0,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    json: JsonOption = None,
    plot: PlotOption = None,
) -> None:
    """Compare modes with rig frequencies, shapes, responses or order cuts, and with what chance gives."""
    import rotorgear as rg

    given = {"lines": rig or lines, "shapes": shapes, "frf": frf, "orders": orders}
    chosen = [name for name, path in given.items() if path is not None]
    if len(chosen) != 1 or (rig is not None and lines is not None):
        raise AnalysisError(
            "give one thing that was measured: rig lines (CSV), --shapes rig.uff, --frf rig.uff or --orders cuts.csv"
        )
    what = chosen[0]
    path = given[what]
    assert path is not None
    if points is not None and what == "lines":
        raise AnalysisError("--points belongs to --shapes, --frf or --orders: lines have no place")
    if is_saved(source) and what in ("frf", "orders"):
        raise AnalysisError(f"--{what} needs a model file: a saved result has its own frequencies and speeds")
    if plot is not None and what != "shapes":
        raise AnalysisError("--plot draws the MAC of --shapes")
    mesh: dict[str, Any] = {"accuracy": accuracy, "elements": elements}
    model: Any = rg.read(source) if is_saved(source) else rg.load(source)
    turning = parse_speed(speed)
    with progress_bar("modal") as progress:
        mesh["progress"] = progress
        result: Any
        if what == "lines":
            result = rg.compare(model, path, tolerance=tolerance, speed=turning, **mesh)
        elif what == "shapes":
            result = rg.compare_shapes(model, path, points=points, tolerance=tolerance, speed=turning, **mesh)
        elif what == "frf":
            result = rg.compare_frf(model, path, points=points, speed=turning, modal_damping=modal_damping, **mesh)
        else:
            result = rg.compare_orders(model, path, points=points, modal_damping=modal_damping, **mesh)
    console().print(result.table())
    write_json({"analysis": "compare", **result.to_dict()} if what == "lines" else result.to_dict(), json)
    if plot:
        typer.echo(f"wrote {rg.plot.save(rg.plot.compare_shapes(result), plot)}")
