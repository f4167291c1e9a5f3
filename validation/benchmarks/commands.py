"""Processor and elapsed time of commands, one against another in alternation, each run a process of its own."""

from __future__ import annotations

import os
import re
import shlex
import statistics
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
_ONE_BLAS = {"OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}


def timed(
    arguments: Sequence[str], checkout: Path, environment: Mapping[str, str] | None = None, folder: Path | None = None
) -> tuple[float, float]:
    """Processor seconds and elapsed seconds of one `rotorgear` of a checkout, run in a folder, by default at its top."""
    before = os.times()
    start = time.perf_counter()
    subprocess.run(
        [sys.executable, "-m", "rotorgear", *arguments],
        cwd=folder or checkout,
        env={**os.environ, "PYTHONPATH": str(checkout), "PYTHONDONTWRITEBYTECODE": "", **(environment or _ONE_BLAS)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    wall = time.perf_counter() - start
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system, wall


def of_the_docs() -> list[list[str]]:
    """The commands of the pages that take a model of `models/`: each once."""
    found = {}
    for page in sorted((ROOT / "docs").glob("*.md")):
        text = page.read_text(encoding="utf-8").replace("\\\n", " ")
        for line in re.findall(r"^\$ rotorgear (.*)$", text, re.MULTILINE):
            words = shlex.split(line, comments=True)
            if any(word.startswith("models/") for word in words) and "--cluster" not in words:
                found[tuple(words)] = words
    return list(found.values())


def medians(rows: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Median of processor and of elapsed seconds."""
    return statistics.median(row[0] for row in rows), statistics.median(row[1] for row in rows)
