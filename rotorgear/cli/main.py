"""The entry point `rotorgear`: the commands, and errors turned into one clear text and exit code 2."""

from __future__ import annotations

import atexit
import gc
import os
import sys
import warnings
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import LazyLoader
from typing import Annotated, Any

import typer

from rotorgear.cli.commands import CommandGroup
from rotorgear.errors import RotorgearError
from rotorgear.old_names import OldNameWarning

app = typer.Typer(
    name="rotorgear",
    cls=CommandGroup,
    help="Finite-element rotor-gear analysis: shafts, gears, meshes and bearings from one readable file.",
    no_args_is_help=True,
    rich_markup_mode=None,  # plain help: to import rich's takes longer than all else
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},  # every command inherits it
)


def _version(wanted: bool) -> None:
    if wanted:
        from rotorgear import __version__

        typer.echo(f"rotorgear {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    """Finite-element rotor-gear analysis: shafts, gears, meshes and bearings from one readable file."""


def _show_old_names_as_sentences() -> None:
    """Former names in a model file are the user's to mend: no path and line of this package before the sentence."""
    show = warnings.showwarning

    def sentence(message: Warning | str, category: type[Warning], *place: Any, **rest: Any) -> None:
        if issubclass(category, OldNameWarning):
            sys.stderr.write(f"Warning: {message}\n")
        else:
            show(message, category, *place, **rest)

    warnings.showwarning = sentence


# Power of two of the cycles for which OpenBLAS's threads wait at full load before they sleep, 4 to 30: a thousandth of a second.
_IDLE = "20"


def one_blas_thread() -> None:
    """Have linear algebra run on one thread where the user has not said on how many.

    Matrices of one gearbox are small or sparse: more threads gain nothing on them, and on a busy machine they wait for each
    other. This is read when numpy is loaded, so it comes first. Threads of sweeps and transients are numba's, and stay.

    Where there are more, one that has no work is to sleep soon: by default those of numpy and of scipy wait for work at full
    load when they are made, for a tenth of a second of processor time.
    """
    os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", _IDLE)
    names = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    if not any(name in os.environ for name in (*names, "OMP_NUM_THREADS")):
        for name in names:
            os.environ[name] = "1"


# Objects more than there were before at which rings of them that nothing holds are looked for; Python's own number is 700.
_OBJECTS = 200_000


def collect_less_often() -> None:
    """Have Python look for garbage less often than by default, and not at its end.

    Classes and functions of imported modules stay, and each look goes through all of them: a third of what a small command
    costs. Arrays are no part of it, they go when nothing holds them any more.
    """
    gc.set_threshold(_OBJECTS, *gc.get_threshold()[1:])
    atexit.register(gc.freeze)


class LaterFinder:
    """Finds modules that are run when something of them is first used.

    scipy takes all names of numpy, and with them numpy.f2py, numpy.testing and numpy.ma, of which it uses nothing here: an
    eighth of what a small command costs.
    """

    names = ("numpy.f2py", "numpy.testing", "numpy.ma")

    @classmethod
    def find_spec(cls, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """The module with a loader that waits; None for all others."""
        if name not in cls.names:
            return None
        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and spec.loader is not None:
            spec.loader = LazyLoader(spec.loader)
        return spec


def main() -> None:
    """Run the command line."""
    collect_less_often()
    one_blas_thread()
    sys.meta_path.insert(0, LaterFinder)
    # pydantic would read the metadata of every installed package to look for plugins.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    _show_old_names_as_sentences()
    if sys.stdout is None:  # started with a closed output
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    try:
        try:
            app()
        finally:
            sys.stdout.flush()  # while a failure can still be told
    except RotorgearError as error:
        sys.stderr.write(f"{error}\n")
        raise SystemExit(2) from None
    except BrokenPipeError:  # the reader of our output went away: nothing to report to
        sys.stderr.close()
        raise SystemExit(1) from None
    except OSError as error:  # a full disk, most likely
        from rotorgear.export.files import reason_of

        what = f"{error.filename}" if error.filename else "the output can't be written"
        sys.stderr.write(f"{what}: {reason_of(error)}\n")
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what waits to be written would fail again at the end
        raise SystemExit(2) from None
