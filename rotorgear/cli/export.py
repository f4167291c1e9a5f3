"""rotorgear export: the linear system as files of other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import (
    ElementsOption,
    JsonOption,
    ModalDampingOption,
    ModelFile,
    SpeedOption,
    console,
    parse_speed,
    progress_bar,
    words_of,
    write_json,
)
from rotorgear.errors import AnalysisError


def export(
    model: ModelFile,
    state_space: Annotated[
        Path | None,
        typer.Option("--state-space", help="Write A B C D and M D K to this .mat or .npz.", show_default=False),
    ] = None,
    matrices: Annotated[
        Path | None, typer.Option("--matrices", help="Write sparse M C G K to this .npz.", show_default=False)
    ] = None,
    uff: Annotated[
        Path | None, typer.Option("--uff", help="Write geometry and modes to this universal file.", show_default=False)
    ] = None,
    inputs: Annotated[
        str | None,
        typer.Option("--inputs", help="Where forces act, as of frf; several with commas.", show_default=False),
    ] = None,
    outputs: Annotated[
        str | None, typer.Option("--outputs", help="Where displacements are read, as --inputs.", show_default=False)
    ] = None,
    fmax: Annotated[
        float | None, typer.Option("--fmax", help="Highest frequency in Hz that counts.", show_default=False)
    ] = None,
    speed: SpeedOption = None,
    modal_damping: ModalDampingOption = 0.0,
    elements: ElementsOption = None,
    accuracy: Annotated[
        float | None,
        typer.Option(
            "--accuracy",
            help="Error of a reduced state space, over its largest response (default 1e-4), and of the frequencies "
            "that its mesh is refined for (default 1e-3).",
            show_default=False,
        ),
    ] = None,
    full: Annotated[bool, typer.Option("--full", help="State space with all degrees of freedom.")] = False,
    modes: Annotated[
        int | None,
        typer.Option("--modes", help="Modes of the universal file (default: 12, or to --fmax).", show_default=False),
    ] = None,
    json: JsonOption = None,
) -> None:
    """Write the linear system for other programs: state space (.mat, .npz), sparse matrices, geometry and modes (UFF)."""
    import rotorgear as rg
    from rotorgear.export.state_space import require_matrix_name

    if not (state_space or matrices or uff):
        raise AnalysisError("nothing to write: give --state-space, --matrices or --uff")
    if state_space:
        require_matrix_name(state_space)
        if not inputs or not outputs or fmax is None:
            raise AnalysisError("a state space needs --inputs, --outputs and --fmax")
    if matrices:
        require_matrix_name(matrices, (".npz",))
    read = rg.load(model)
    turns = parse_speed(speed)
    out = console()
    if state_space and fmax is not None:
        with progress_bar("state space") as progress:
            system = rg.state_space(
                read,
                inputs=words_of(inputs),
                outputs=words_of(outputs),
                fmax=fmax,
                speed=turns,
                modal_damping=modal_damping,
                elements=elements,
                accuracy=accuracy,
                full=full,
                progress=progress,
            )
        written = rg.write_state_space(system, state_space)
        out.print(system.table())
        write_json(system.to_dict(), json)
        typer.echo(f"wrote {written}")
    if matrices:
        typer.echo(f"wrote {rg.write_matrices(read, matrices, fmax=fmax, speed=turns, elements=elements)}")
    if uff:
        by = {"fmax": fmax} if fmax is not None and modes is None else {"modes": modes or 12}
        with progress_bar("modes") as progress:
            found = rg.modal(read, **by, speed=turns, elements=elements, progress=progress)
        typer.echo(f"wrote {rg.write_uff(found, uff)}")
