"""The console that tables are printed on, and the bar of progress."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING

import typer

from rotorgear.files.shown import shown
from rotorgear.progress import Foretold, Progress, hearing_forecasts, listening, silent
from rotorgear.quantity import in_two_digits

if TYPE_CHECKING:
    from rich.console import Console


# CPU seconds from which on a forecast is worth a line.
_LONG = 10.0


def say(text: str, *, err: bool = False) -> None:
    """Write a line to the terminal; no text of a file is obeyed by it."""
    typer.echo(shown(text), err=err)


def console() -> Console:
    """A console for tables; 80 columns where the output is no terminal."""
    from rich.console import Console

    return Console(highlight=False, width=None if sys.stdout.isatty() else 80)


@contextmanager
def progress_bar(text: str, *, lines: bool = False) -> Iterator[Progress]:
    """Show a bar on stderr while work goes on; where stderr is no terminal, a line for each new step if `lines`, or nothing."""
    if not sys.stderr.isatty():
        with hearing_forecasts(_of(text, partial(say, err=True))):
            yield _in_lines(text) if lines else silent
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(text, total=1.0)

        def report(fraction: float, step: str) -> None:
            bar.update(task, completed=fraction, description=f"{text}: {step}")

        with listening(report), hearing_forecasts(_of(text, partial(bar.console.print, markup=False))):
            yield report


def _of(text: str, write: Callable[[str], None]) -> Foretold:
    """Writes the first forecast of each analysis as a line, where it is long."""
    told: set[str] = set()

    def heard(what: str, seconds: float, more: str) -> None:
        if what not in told and seconds >= _LONG:
            told.add(what)
            write(f"{text}: {'' if what == text else f'{what}, '}about {in_two_digits(seconds)} CPU s {more}")

    return heard


def _in_lines(text: str) -> Progress:
    """A progress that writes each new step to stderr as a line, with the seconds since the first."""
    start = time.monotonic()
    last = ""

    def report(fraction: float, step: str) -> None:
        nonlocal last
        if step != last:
            print(f"{text}: {step}, after {time.monotonic() - start:.1f} s", file=sys.stderr, flush=True)
        last = step

    return report
