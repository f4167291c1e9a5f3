"""rotorgear compare: modes of a model or of a saved result against rig frequencies."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    JsonOption,
    SpeedOption,
    console,
    parse_speed,
    progress_bar,
    write_json,
)
from rotorgear.cli.modal import ToleranceOption, compare_with_rig
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from rotorgear.results.modal import ModalResult

# Endings of saved results; anything else is a model file.
_SAVED = (".h5", ".hdf5")


def compare(
    source: Annotated[
        Path, typer.Argument(help="Model file (TOML), or a result saved by modal --save (HDF5).", show_default=False)
    ],
    rig: Annotated[Path, typer.Argument(help="Rig frequencies (CSV).", show_default=False)],
    tolerance: ToleranceOption = 0.05,
    speed: SpeedOption = None,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    json: JsonOption = None,
) -> None:
    """Compare modes with rig frequencies, and say what chance alone would give."""
    import rotorgear as rg
    from rotorgear.results.tables.comparison import comparison_table

    lines = rg.read_rig_lines(rig)
    fmax = 1.15 * max(line.frequency_hz for line in lines)
    result = _result(source, speed, (accuracy, elements), fmax)
    comparison = compare_with_rig(result, lines, tolerance, None if source.suffix.lower() in _SAVED else fmax)
    console().print(comparison_table(comparison))
    write_json({"analysis": "compare", **comparison.to_dict()}, json)


def _result(source: Path, speed: str | None, mesh: tuple[float | None, int | None], fmax: float) -> ModalResult:
    import rotorgear as rg

    if source.suffix.lower() in _SAVED:
        if speed is not None or any(given is not None for given in mesh):
            raise AnalysisError("--speed, --accuracy and --elements belong to a model file; a saved result has its own")
        return rg.read(source)
    with progress_bar("modal") as progress:
        return rg.modal(
            rg.load(source), speed=parse_speed(speed), fmax=fmax, accuracy=mesh[0], elements=mesh[1], progress=progress
        )
