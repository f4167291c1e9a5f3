"""rotorgear report: one page about a model in one file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import JsonOption, ModelFile, progress_bar, write_json
from rotorgear.extras import require


def report(
    model: ModelFile,
    output: Annotated[Path, typer.Option("-o", "--output", help="The page to write (HTML).")] = Path("report.html"),
    rig: Annotated[
        Path | None, typer.Option("--rig", help="Rig frequencies (CSV) to compare with.", show_default=False)
    ] = None,
    study: Annotated[
        list[Path] | None,
        typer.Option("--study", help="A stored convergence study to show; once or more.", show_default=False),
    ] = None,
    grade: Annotated[float, typer.Option("--grade", help="Balance quality grade G of ISO 21940-11, in mm/s.")] = 2.5,
    turntable: Annotated[
        bool, typer.Option("--turntable", help="Also put the modes into the page as solids that turn and move.")
    ] = False,
    json: JsonOption = None,
) -> None:
    """Write one page about a model: drawing, statics, modes, Campbell, rules of standards, teeth, rig, errors, costs."""
    require("jinja2", "A report")
    require("matplotlib", "A report")
    import rotorgear as rg

    with progress_bar("report") as progress:
        done = rg.report(
            model, output, rig=rig or (), study=study or (), grade=grade, turntable=turntable, progress=progress
        )
    write_json(done.to_dict(), json)
    typer.echo(f"wrote {done.path}, {done.path.stat().st_size / 1e6:.2f} MB")
    for name, reason in done.missing.items():
        typer.echo(f"not there: {name}: {reason}")
