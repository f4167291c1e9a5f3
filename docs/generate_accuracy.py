"""The whole page docs/accuracy.md for the site: every study of error against run time below what the repository keeps.

The page itself is written by hand, with blocks that its commands print.
"""

from __future__ import annotations

import math
import time
from pathlib import Path

import numpy as np

import rotorgear as rg
from validation.benchmarks.estimates import MODES, Study, files, of_analyses, of_models, span

# Minutes: a hundred studies, each with a reference.
LONG = True
PAGE = Path(__file__).with_name("accuracy.md")


def pages() -> dict[str, str]:
    """Nothing: the page of the repository is written by hand."""
    return {}


def site_pages() -> dict[str, str]:
    """The page with every study."""
    parts = [PAGE.read_text(encoding="utf-8"), _savings(), "## Studies of frequencies\n", *map(_section, of_models())]
    parts += ["## Studies of all analyses\n", *map(_section, of_analyses())]
    return {"docs/accuracy.md": "\n".join(parts)}


def _savings() -> str:
    """What solving independent groups of dofs apart saves, for the models that fall into groups."""
    rows = [["model", "dofs", "CPU time apart", "CPU time together", "largest difference"]]
    for name, file in files().items():
        model = rg.load(file)
        apart, first = _timed(model, pruning=True)
        together, second = _timed(model, pruning=False)
        if any("solved apart" in str(note) for note in apart.left_out):
            top = together.natural_frequency_hz.max()
            difference = np.max(np.abs(apart.natural_frequency_hz - together.natural_frequency_hz)) / top
            rows.append([name, str(apart.dofs), _seconds(first), _seconds(second), f"{difference:.0e}"])
    return (
        "## Independent groups of dofs\n\nThe same frequencies with 8 basic elements, solved apart and together "
        f"(`--no-pruning`), best of three:\n\n{_table(rows)}"
    )


def _timed(model: rg.Model, *, pruning: bool) -> tuple[rg.ModalResult, float]:
    """A result and the CPU seconds of the best of three runs."""
    seconds = []
    for _ in range(3):
        start = time.process_time()
        result = rg.modal(model, modes=MODES, elements=8, pruning=pruning)
        seconds.append(time.process_time() - start)
    return result, min(seconds)


def _section(study: Study) -> str:
    if not isinstance(study.result, rg.ConvergenceStudy):
        return f"### {study.name}, {study.analysis}{study.at}\n\n```text\n{study.result.text()}\n```\n"
    rows = [["discretisation", "dofs", "CPU time", "memory", "error", "estimate", "ratio", "order"]]
    for row in study.result.rungs:
        noise = " (noise)" if "time is noise" in row.notes else ""
        rows.append(
            [
                row.method + (", accuracy missed" if "accuracy missed" in row.notes else ""),
                str(row.dofs),
                _seconds(row.seconds) + noise if math.isfinite(row.seconds) else "",
                f"{row.memory / 1e6:.1f} MB",
                f"{row.error:.1e}",
                f"{row.estimate:.1e}",
                "" if row.effectivity is None else f"{row.effectivity:.2f}",
                "" if row.order is None else f"{row.order:.2f}",
            ]
        )
    lines = [
        f"### {study.name}, {study.analysis}{study.at}\n",
        f"{study.result.modes} {study.result.compared}, against {study.result.reference}.\n",
    ]
    if math.isfinite(study.effectivity[0]):
        lines.append(f"Effectivity over all modes: {span(study.effectivity)}.\n")
    return "\n".join([*lines, _table(rows)])


def _seconds(value: float) -> str:
    return f"{value:.3f} s"


def _table(rows: list[list[str]]) -> str:
    head, *body = [f"| {' | '.join(row)} |" for row in rows]
    return "\n".join([head, "|" + "---|" * len(rows[0]), *body]) + "\n"
