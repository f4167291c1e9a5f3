"""The entry point `rotorgear`: the commands, and errors turned into one clear text and exit code 2."""

from __future__ import annotations

import io
import os
import sys
import warnings
from typing import Annotated, Any

import typer

from rotorgear.cli.commands import CommandGroup
from rotorgear.cli.start import start_fast
from rotorgear.errors import RotorgearError
from rotorgear.files.own import nowhere
from rotorgear.files.shown import shown
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


def main() -> None:
    """Run the command line."""
    start_fast()
    # Former names in a model file are the user's to mend: no path and line of this package before the sentence. What libraries
    # warn of is for who works on the package, and asks for it (python -W).
    show = warnings.showwarning

    def sentence(message: Warning | str, category: type[Warning], *place: Any, **rest: Any) -> None:
        if issubclass(category, OldNameWarning):
            sys.stderr.write(f"Warning: {shown(str(message))}\n")
        elif sys.warnoptions:
            show(message, category, *place, **rest)

    warnings.showwarning = sentence
    if sys.stdout is None:  # started with a closed output
        sys.stdout = nowhere()
    # A terminal may lack letters of a title; that is no reason to lose a result.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")
    try:
        try:
            app()
        finally:
            sys.stdout.flush()  # while a failure can still be told
    except RotorgearError as error:
        sys.stderr.write(f"{shown(str(error))}\n")
        raise SystemExit(2) from None
    except MemoryError:
        sys.stderr.write("this takes more memory than there is: ask for less at a time, or for fewer elements\n")
        raise SystemExit(2) from None
    except BrokenPipeError:  # the reader of our output went away: nothing to report to
        sys.stderr.close()
        raise SystemExit(1) from None
    except OSError as error:  # a full disk, most likely
        from rotorgear.files.write import reason_of

        what = f"{error.filename}" if error.filename else "the output can't be written"
        sys.stderr.write(f"{shown(what)}: {reason_of(error)}\n")
        with nowhere() as sink:
            os.dup2(sink.fileno(), 1)  # what waits to be written would fail again at the end
        raise SystemExit(2) from None
