"""What the commands share: options, the console, the progress bar, JSON output."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rotorgear.errors import AnalysisError, RotorgearError
from rotorgear.extras import require
from rotorgear.progress import Progress, listening, silent

if TYPE_CHECKING:
    from rich.console import Console

ModelFile = Annotated[Path, typer.Argument(help="Model file (TOML).", show_default=False)]
ModelOrResult = Annotated[
    Path, typer.Argument(help="Model file (TOML), or a result saved by modal --save (HDF5).", show_default=False)
]
JsonOption = Annotated[
    Path | None, typer.Option("--json", help="Write the result as JSON to this file.", show_default=False)
]
SaveOption = Annotated[Path | None, typer.Option("--save", help="Save the result (HDF5).", show_default=False)]


def picture_name(path: Path | None) -> Path | None:
    """A name that no picture can be written to, and matplotlib missing, are refused before anything is computed."""
    if path is not None:
        from rotorgear.plots.figure import require_picture_name

        require_picture_name(path)
        require("matplotlib", "A plot")
    return path


def plot_folder(path: Path | None) -> Path | None:
    """A folder of plots: matplotlib missing is said before anything is computed."""
    if path is not None:
        require("matplotlib", "A plot")
    return path


def render_folder(path: Path | None) -> Path | None:
    """A folder of rendered pictures: pyvista missing is said before anything is computed."""
    if path is not None:
        require("pyvista", "A picture of a mode")
    return path


def vtk_folder(path: Path | None) -> Path | None:
    """A folder for ParaView: pyvista missing is said before anything is computed."""
    if path is not None:
        require("pyvista", "VTK output")
    return path


PlotOption = Annotated[
    Path | None,
    typer.Option("--plot", help="Draw it to this PNG, SVG or PDF.", show_default=False, callback=picture_name),
]
ElementsOption = Annotated[
    int | None,
    typer.Option(
        "--elements", help="Basic elements in each shaft segment, instead of an accuracy.", show_default=False
    ),
]
AccuracyOption = Annotated[
    float | None,
    typer.Option(
        "--accuracy", help="Refine to this relative error of every frequency (default 1e-3).", show_default=False
    ),
]
AmplitudeAccuracyOption = Annotated[
    float | None,
    typer.Option(
        "--accuracy",
        help="Refine until amplitudes are within this share of the largest (default: frequencies within 1e-3).",
        show_default=False,
    ),
]
SpeedOption = Annotated[
    str | None,
    typer.Option(
        "--speed", help="Speed of the input shaft, such as '16350 rpm': damped and gyroscopic.", show_default=False
    ),
]
ModalDampingOption = Annotated[
    float, typer.Option("--modal-damping", help="Damping ratio added to every elastic mode, such as 0.01.")
]
DeflectionOption = Annotated[
    Path | None,
    typer.Option(
        "--vtk", help="Write deflection shapes for ParaView to this folder.", show_default=False, callback=vtk_folder
    ),
]
UffOption = Annotated[
    Path | None, typer.Option("--uff", help="Write a universal file (UFF) for modal-test programs.", show_default=False)
]
ToleranceOption = Annotated[
    float, typer.Option("--tolerance", help="Largest relative difference of a match with the rig.")
]
OnlyOption = Annotated[
    str | None, typer.Option("--only", help="Only modes reached by bending, axial or torsion.", show_default=False)
]

WorkersOption = Annotated[
    int | None, typer.Option("--workers", help="Threads (default: all cores).", show_default=False)
]
ClusterOption = Annotated[
    str | None,
    typer.Option(
        "--cluster",
        help="Workers elsewhere: a dask scheduler such as tcp://host:8786, or local:N processes here.",
        show_default=False,
    ),
]
SaveBlocksOption = Annotated[
    Path | None, typer.Option("--save", help="Save the result (HDF5), in blocks while it runs.", show_default=False)
]


def is_saved(path: Path) -> bool:
    """Whether a path names a saved result; anything else is a model file."""
    return path.suffix.lower() in (".h5", ".hdf5")


def console() -> Console:
    """Return a console for tables; 80 columns where the output is no terminal."""
    from rich.console import Console

    return Console(highlight=False, width=None if sys.stdout.isatty() else 80)


def parse_speed(text: str | None, option: str = "--speed") -> float | None:
    """Speed in rad/s from an option of the command line.

    Raises:
        AnalysisError: not a rotational speed.
    """
    from rotorgear.quantity import QuantityError, parse_quantity

    if text is None:
        return None
    if text.strip() == "0":
        return 0.0
    try:
        return parse_quantity(text, "speed")
    except QuantityError as error:
        raise AnalysisError(f"{option}: got '{text}', expected {error}") from None


def words_of(text: str | None) -> list[str]:
    """The words of a list with commas."""
    return [word.strip() for word in text.split(",") if word.strip()] if text else []


def write_json(data: dict[str, Any], path: Path | None) -> None:
    """Write a result's plain values where a file was asked for."""
    if path is not None:
        from rotorgear.export.json_file import write_json as write

        write(data, path)


def show_result(result: Any, json: Path | None, save: Path | None) -> Console:
    """Print a result as a table, write it where files were asked for, and return the console for what else there is to say."""
    out = console()
    out.print(result.table())
    write_json(result.to_dict(), json)
    if save is not None:
        import rotorgear as rg

        out.print(f"saved {rg.save(result, save)}")
    return out


def check_workers(workers: int | None, cluster: str | None, resume: bool, save: Path | None) -> None:
    """Refuse options of a long run that say nothing together.

    Raises:
        AnalysisError: --resume without --save, workers below 1, threads and a cluster at once.
    """
    if resume and save is None:
        raise AnalysisError("--resume needs the --save of the run that was interrupted")
    if workers is not None and workers < 1:
        raise AnalysisError(f"--workers: got {workers}, expected 1 or more")
    if workers is not None and cluster is not None:
        raise AnalysisError("--workers are threads on this machine, --cluster are workers elsewhere: give one of them")


@contextmanager
def kept_blocks(save: Path | None) -> Iterator[None]:
    """Say, where a run that saves blocks is interrupted, that those which were done are kept."""
    try:
        yield
    except (KeyboardInterrupt, RotorgearError):
        if save and any(Path(f"{save}.parts").glob("chunk_*")):
            typer.echo(f"the blocks that were done are kept in {save}.parts: go on with --resume", err=True)
        raise


@contextmanager
def progress_bar(text: str) -> Iterator[Progress]:
    """Show a bar on stderr while work goes on; silent where stderr is no terminal."""
    if not sys.stderr.isatty():
        yield silent
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(text, total=1.0)

        def report(fraction: float, step: str) -> None:
            bar.update(task, completed=fraction, description=f"{text}: {step}")

        with listening(report):
            yield report
