"""rotorgear modal: natural frequencies, mode shapes, rig comparison, VTK, pictures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rotorgear.cli.common import (
    AccuracyOption,
    ElementsOption,
    JsonOption,
    ModelFile,
    OnlyOption,
    SaveOption,
    SpeedOption,
    ToleranceOption,
    UffOption,
    console,
    parse_speed,
    progress_bar,
    render_folder,
    vtk_folder,
    words_of,
    write_json,
)
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from rotorgear.results.modal import ModalResult

# Shapes of so many modes are written unless --shapes says otherwise.
_DEFAULT_SHAPES = 24

ModesOption = Annotated[int | None, typer.Option("--modes", help="Number of modes (default 24).", show_default=False)]
FmaxOption = Annotated[
    float | None, typer.Option("--fmax", help="All modes up to this frequency in Hz.", show_default=False)
]


def modal(
    model: ModelFile,
    speed: SpeedOption = None,
    modes: ModesOption = None,
    fmax: FmaxOption = None,
    accuracy: AccuracyOption = None,
    elements: ElementsOption = None,
    compare: Annotated[
        Path | None, typer.Option("--compare", help="Rig frequencies (CSV) to compare with.", show_default=False)
    ] = None,
    tolerance: ToleranceOption = 0.05,
    energies: Annotated[
        bool, typer.Option("--energies", help="Also list the energy shares of each mode by part.")
    ] = False,
    only: OnlyOption = None,
    pruning: Annotated[
        bool, typer.Option("--pruning/--no-pruning", help="Solve independent groups of dofs apart.")
    ] = True,
    json: JsonOption = None,
    save: SaveOption = None,
    vtk: Annotated[
        Path | None,
        typer.Option(
            "--vtk", help="Write mode shapes for ParaView to this folder.", show_default=False, callback=vtk_folder
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot", help="Render PNGs of the modes to this folder.", show_default=False, callback=render_folder
        ),
    ] = None,
    shapes: Annotated[
        str | None,
        typer.Option(
            "--shapes",
            help="Modes for --vtk, --plot and --uff, such as 1,6,9-12 (default 1-24).",
            show_default=False,
        ),
    ] = None,
    uff: UffOption = None,
) -> None:
    """Natural frequencies and mode shapes; undamped at standstill, or damped and gyroscopic at a --speed."""
    import rotorgear as rg

    rig = rg.read_rig_lines(compare) if compare else ()
    chosen = _numbers(shapes)
    built = rg.load(model)
    if rig and modes is None and fmax is None:
        from rotorgear.analysis.rig.compare_result import ABOVE_RIG

        fmax = ABOVE_RIG * max(line.frequency_hz for line in rig)
    with progress_bar("modal") as progress:
        result = rg.modal(
            built,
            speed=parse_speed(speed),
            modes=modes,
            fmax=fmax,
            elements=elements,
            accuracy=accuracy,
            only=words_of(only),
            pruning=pruning,
            progress=progress,
        )
    out = console()
    out.print(result.table(energies=energies))
    # So many modes say nothing of where the next one lies; a highest frequency does.
    known_to_hz = None if modes else fmax
    comparison = rg.compare(result, rig, tolerance=tolerance, known_to_hz=known_to_hz) if rig else None
    if comparison:
        out.print(comparison.table())
    data = result.to_dict()
    if comparison:
        data["comparison"] = comparison.to_dict()
    write_json(data, json)
    # Only the result knows how many modes there are, so the numbers of --shapes are held against it here.
    if chosen is None:
        chosen = list(range(min(len(result), _DEFAULT_SHAPES)))
    beyond = [number + 1 for number in chosen if number >= len(result)]
    if beyond:
        raise AnalysisError(f"--shapes: there is no mode {beyond[0]}, the result has {len(result)}")
    _write(result, save, vtk, plot, chosen)
    if uff:
        typer.echo(f"wrote {rg.write_uff(result, uff, modes=chosen)}")


def _write(result: ModalResult, save: Path | None, vtk: Path | None, plot: Path | None, chosen: list[int]) -> None:
    """Write the files that were asked for and say where they are."""
    import rotorgear as rg

    if save:
        rg.save(result, save)
        typer.echo(f"saved {save}")
    for folder, what in ((vtk, "vtk"), (plot, "plot")):
        if folder is None:
            continue
        with progress_bar(what) as progress:
            if what == "vtk":
                paths = rg.write_vtk(result, folder, modes=chosen, progress=progress)
            else:
                from rotorgear.plots.mode_pictures import write_modes

                paths = write_modes(result, folder, modes=chosen, progress=progress)
        which = (
            "" if len(chosen) == len(result) else f" for {len(chosen)} of {len(result)} modes; --shapes chooses them"
        )
        typer.echo(f"wrote {len(paths)} file{'s'[: len(paths) != 1]} to {folder}{which}")


def _numbers(text: str | None) -> list[int] | None:
    """Mode numbers, counted from 1 in the text and from 0 in the result."""
    if text is None:
        return None
    chosen: list[int] = []
    for part in text.split(","):
        first, _, last = part.strip().partition("-")
        if not first.isdigit() or (last and not last.isdigit()) or int(first) < 1:
            raise AnalysisError(f"--shapes: got '{text}', expected numbers of modes such as 1,6,9-12")
        chosen += range(int(first) - 1, int(last or first))
    return chosen
