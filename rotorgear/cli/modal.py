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
    SpeedOption,
    console,
    parse_speed,
    progress_bar,
    write_json,
)
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from rotorgear.results.comparison import Comparison, RigLine
    from rotorgear.results.modal import ModalResult

# With a rig list and no other wish, modes are found up to this much above its highest line.
_ABOVE_RIG = 1.15
# Shapes of so many modes are written unless --shapes says otherwise.
_DEFAULT_SHAPES = 24

ModesOption = Annotated[int | None, typer.Option("--modes", help="Number of modes (default 24).", show_default=False)]
FmaxOption = Annotated[
    float | None, typer.Option("--fmax", help="All modes up to this frequency in Hz.", show_default=False)
]
ToleranceOption = Annotated[
    float, typer.Option("--tolerance", help="Largest relative difference of a match with the rig.")
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
    only: Annotated[
        str | None,
        typer.Option("--only", help="Only modes reached by bending, axial or torsion.", show_default=False),
    ] = None,
    pruning: Annotated[
        bool, typer.Option("--pruning/--no-pruning", help="Solve independent groups of dofs apart.")
    ] = True,
    json: JsonOption = None,
    save: Annotated[Path | None, typer.Option("--save", help="Save the result (HDF5).", show_default=False)] = None,
    vtk: Annotated[
        Path | None, typer.Option("--vtk", help="Write mode shapes for ParaView to this folder.", show_default=False)
    ] = None,
    picture: Annotated[
        Path | None, typer.Option("--picture", help="Render PNGs of the modes to this folder.", show_default=False)
    ] = None,
    shapes: Annotated[
        str | None,
        typer.Option(
            "--shapes", help="Modes for --vtk and --picture, such as 1,6,9-12 (default 1-24).", show_default=False
        ),
    ] = None,
) -> None:
    """Natural frequencies and mode shapes; undamped at standstill, or damped and gyroscopic at a --speed."""
    import rotorgear as rg
    from rotorgear.results.tables.modal import modal_table

    rig = rg.read_rig_lines(compare) if compare else ()
    chosen = _numbers(shapes)
    built = rg.load(model)
    if rig and modes is None and fmax is None:
        fmax = _ABOVE_RIG * max(line.frequency_hz for line in rig)
    with progress_bar("modal") as progress:
        result = rg.modal(
            built,
            speed=parse_speed(speed),
            modes=modes,
            fmax=fmax,
            elements=elements,
            accuracy=accuracy,
            only=[word.strip() for word in only.split(",")] if only else (),
            pruning=pruning,
            progress=progress,
        )
    out = console()
    out.print(modal_table(result, energies=energies))
    comparison = compare_with_rig(result, rig, tolerance, None if modes else fmax) if rig else None
    if comparison:
        from rotorgear.results.tables.comparison import comparison_table

        out.print(comparison_table(comparison))
    data = result.to_dict()
    if comparison:
        data["comparison"] = comparison.to_dict()
    write_json(data, json)
    _write(result, save, vtk, picture, _within(chosen, len(result)))


def compare_with_rig(
    result: ModalResult, rig: tuple[RigLine, ...], tolerance: float, known_to_hz: float | None = None
) -> Comparison:
    """Compare modes with rig lines; excitation lines are those at the analysis' speed, else at the operating point."""
    from rotorgear.analysis.common.excitation import excitation_lines
    from rotorgear.analysis.rig.compare import compare

    operation = result.model.operation
    speed = result.speed if result.speed is not None else (operation.speed if operation else None)
    return compare(
        result.frequency_hz,
        result.description,
        rig,
        rigid=result.rigid,
        damping_ratio=result.damping_ratio if result.speed is not None else None,
        excitations=excitation_lines(result.model, speed) if speed else (),
        tolerance=tolerance,
        known_to_hz=known_to_hz,
    )


def _write(result: ModalResult, save: Path | None, vtk: Path | None, picture: Path | None, chosen: list[int]) -> None:
    """Write the files that were asked for and say where they are."""
    import rotorgear as rg

    if save:
        rg.save(result, save)
        typer.echo(f"saved {save}")
    for folder, what in ((vtk, "vtk"), (picture, "picture")):
        if folder is None:
            continue
        with progress_bar(what) as progress:
            if what == "vtk":
                paths = rg.write_vtk(result, folder, modes=chosen, progress=progress)
            else:
                from rotorgear.plots.mode_pictures import draw_modes

                paths = draw_modes(result, folder, modes=chosen, progress=progress)
        which = (
            "" if len(chosen) == len(result) else f" for {len(chosen)} of {len(result)} modes; --shapes chooses them"
        )
        typer.echo(f"wrote {len(paths)} file{'s'[: len(paths) != 1]} to {folder}{which}")


def _numbers(text: str | None) -> list[int] | None:
    """Mode numbers, counted from 1 in the text and from 0 in the result."""
    if text is None:
        return None
    found: list[int] = []
    for part in text.split(","):
        first, _, last = part.strip().partition("-")
        if not first.isdigit() or (last and not last.isdigit()) or int(first) < 1:
            raise AnalysisError(f"--shapes: got '{text}', expected numbers of modes such as 1,6,9-12")
        found += range(int(first) - 1, int(last or first))
    return found


def _within(chosen: list[int] | None, count: int) -> list[int]:
    if chosen is None:
        return list(range(min(count, _DEFAULT_SHAPES)))
    beyond = [number + 1 for number in chosen if number >= count]
    if beyond:
        raise AnalysisError(f"--shapes: there is no mode {beyond[0]}, the result has {count}")
    return chosen
