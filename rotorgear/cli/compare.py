"""rotorgear compare: modes of a model or of a saved result against rig frequencies."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    JsonOption,
    ModelOrResult,
    SpeedOption,
    ToleranceOption,
    console,
    is_saved,
    parse_speed,
    progress_bar,
    write_json,
)


def compare(
    source: ModelOrResult,
    rig: Annotated[Path, typer.Argument(help="Rig frequencies (CSV).", show_default=False)],
    tolerance: ToleranceOption = 0.05,
    speed: SpeedOption = None,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    json: JsonOption = None,
) -> None:
    """Compare modes with rig frequencies, and with the matches of random frequencies."""
    import rotorgear as rg

    lines = rg.read_rig_lines(rig)
    with progress_bar("modal") as progress:
        comparison = rg.compare(
            rg.read(source) if is_saved(source) else rg.load(source),
            lines,
            tolerance=tolerance,
            speed=parse_speed(speed),
            accuracy=accuracy,
            elements=elements,
            progress=progress,
        )
    console().print(comparison.table())
    write_json({"analysis": "compare", **comparison.to_dict()}, json)
