"""Long work in a process of its own, which stays warm from one job to the next and ends at once when a job is cancelled."""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rotorgear.errors import RotorgearError
from rotorgear.files.own import bytes_of
from rotorgear.model.load import loads
from rotorgear.progress import Progress, listening, silent


class CancelledError(RotorgearError):
    """The job was cancelled."""


class Jobs:
    """A process that does one job after the other: a function of a module, with plain arguments and `progress`."""

    def __init__(self) -> None:
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._turn = asyncio.Lock()
        self._cancelled = False

    async def run(self, work: Callable[..., Any], *given: Any, progress: Progress = silent) -> Any:
        """Do a job when those before it are done, and return what it returns.

        Raises:
            RotorgearError: by the job. CancelledError: by `cancel`.
        """
        async with self._turn:
            self._cancelled = False
            try:
                pipe = self._warm()
                pipe.send((work, given))
                while True:
                    what, value = await asyncio.to_thread(pipe.recv)
                    if what == "progress":
                        progress(*value)
                    elif what == "done":
                        return value
                    else:
                        raise value
            except (EOFError, OSError):
                self.close()
                if self._cancelled:
                    raise CancelledError("cancelled") from None
                raise RotorgearError("the process that computes has ended: it may have lacked memory") from None

    def cancel(self) -> None:
        """End the job that runs, and the process with it; the next job starts another."""
        self._cancelled = True
        self.close()

    def close(self) -> None:
        """End the process."""
        if self._process is not None and self._process.is_alive():
            self._process.terminate()
        self._process = None

    def _warm(self) -> Connection:
        if self._process is None or self._pipe is None or not self._process.is_alive():
            # Started anew rather than forked: the server has threads.
            context = multiprocessing.get_context("spawn")
            self._pipe, theirs = context.Pipe()
            self._process = context.Process(target=_serve, args=(theirs,), daemon=True)
            self._process.start()
            theirs.close()
        return self._pipe


def _serve(pipe: Connection) -> None:
    """Do jobs until nobody sends any."""
    with contextlib.suppress(EOFError, OSError, KeyboardInterrupt):
        while True:
            work, given = pipe.recv()

            def progress(fraction: float, step: str) -> None:
                pipe.send(("progress", (fraction, step)))

            try:
                with listening(progress):
                    answer = ("done", work(*given, progress=progress))
            except RotorgearError as error:
                answer = ("failed", RotorgearError(str(error)))
            except Exception as error:  # a fault of this package: said, and the page lives on
                answer = ("failed", RotorgearError(f"a fault of rotorgear: {type(error).__name__}: {error}"))
            pipe.send(answer)


def sections_of(
    text: str,
    source: tuple[str, str],
    names: Sequence[str],
    rig: str | None,
    modal_damping: float,
    progress: Progress = silent,
) -> list[Any]:
    """Sections of the report about the text of a model file, and last what was left out of them.

    Args:
        text: of the file. source: its name and its folder. names: of sections. rig: file with measured lines.
        modal_damping: of the run-up. progress: is told fraction and step.
    """
    from rotorgear.analysis.rig.rig_file import read_rig_lines
    from rotorgear.page.contents import computed
    from rotorgear.page.report import BALANCE_GRADE
    from rotorgear.page.sections import analysed, left_out

    lines = read_rig_lines(rig) if rig else ()
    asked = {"modal_damping": modal_damping, "fmax": None}
    found = computed(loads(text, *source), lines, BALANCE_GRADE, asked, progress, only=tuple(names))
    progress(0.9, "pictures")
    return [*analysed(found), left_out(found)]


def report_of(text: str, source: tuple[str, str], rig: str | None, progress: Progress = silent) -> bytes:
    """The page of `rotorgear report` about the text of a model file, with its turntable."""
    from rotorgear.page.report import report

    with TemporaryDirectory() as folder:
        made = report(
            loads(text, *source), Path(folder) / "report.html", rig=rig or (), turntable=True, progress=progress
        )
        return bytes_of(made.path)
