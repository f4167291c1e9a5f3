"""A Python process that runs blocks of code one after another in one namespace, and returns what each prints."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from types import TracebackType

_WORKER = r"""
import contextlib, io, json, os, sys, traceback
answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
os.dup2(2, 1)  # what compiled code prints past Python doesn't get between the answers
names = {"__name__": "__main__"}
for line in sys.stdin:
    said, ok = io.StringIO(), True
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            exec(compile(json.loads(line), "<block>", "exec"), names)
        except BaseException:
            traceback.print_exc()
            ok = False
    print(json.dumps([ok, said.getvalue()]), file=answers, flush=True)
"""


class PythonSession:
    """The process, started when the first block comes and ended with the `with`."""

    def __init__(self, directory: Path, environment: dict[str, str]) -> None:
        self._directory = directory
        self._environment = environment
        self._process: subprocess.Popen[str] | None = None

    def __enter__(self) -> PythonSession:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._process:
            self._process.communicate()

    def run(self, code: str) -> tuple[bool, str]:
        """Return whether the code ran to its end, and what it printed (with the traceback if it didn't)."""
        if self._process is None:
            self._process = subprocess.Popen(
                [sys.executable, "-c", _WORKER],
                cwd=self._directory,
                env=self._environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                encoding="utf-8",
            )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(code) + "\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline()
        if not answer:
            return False, "the Python process ended"
        ok, printed = json.loads(answer)
        return ok, printed.rstrip()
