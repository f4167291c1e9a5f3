"""rotorgear view: an interactive window with the gearbox and its mode shapes."""

from __future__ import annotations

from typing import Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    ModelOrResult,
    SpeedOption,
    is_saved,
    parse_speed,
    progress_bar,
)
from rotorgear.extras import require


def view(
    source: ModelOrResult,
    mode: Annotated[int, typer.Option("--mode", min=1, help="Mode to begin with.")] = 1,
    modes: Annotated[int, typer.Option("--modes", min=1, help="Number of modes to find in a model.")] = 24,
    speed: SpeedOption = None,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
) -> None:
    """Open a window that shows the gearbox and animates its modes."""
    import rotorgear as rg

    require("pyvista", "A window")

    if is_saved(source):
        result = rg.read(source)
    else:
        with progress_bar("modal") as progress:
            result = rg.modal(
                rg.load(source),
                speed=parse_speed(speed),
                modes=modes,
                accuracy=accuracy,
                elements=elements,
                progress=progress,
            )
    rg.view(result, mode=mode - 1)
