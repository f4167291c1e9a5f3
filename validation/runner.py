"""Runs the cases, judges every line, and prints an aligned table. Exit code 1 where a line is out of its tolerance."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

from validation.case import Case, Expectation, read_cases
from validation.measure import Solver
from validation.quantities import FORCED, SHEET, TEETH, words
from validation.table import Row, overview, printed


def run(cases: Sequence[Case]) -> Iterator[Row]:
    """Solve and judge all lines of some cases."""
    for case in cases:
        solver = Solver(case)
        for line in case.expectations:
            yield _judge(case, line, solver)


def _judge(case: Case, line: Expectation, solver: Solver) -> Row:
    found = solver.measure(line)
    error = _error(line, found.got)
    passed = error <= line.allowed() and not found.complaint
    reason = "" if passed else found.complaint or f"off by {error:.1e}, allowed {line.allowed():.1e}"
    return Row(
        case=case.name,
        what=describe(line),
        expected=line.expected,
        got=found.got,
        error=error,
        tolerance=line.tolerance,
        passed=passed,
        dofs=found.dofs,
        seconds=found.seconds,
        reason=reason,
        source=line.source,
        note=line.note,
    )


def _error(line: Expectation, got: float | str) -> float:
    """Relative or absolute error; how far below a bound; for words 0 or 1."""
    if isinstance(got, str):
        return 0.0 if got == line.expected else 1.0
    difference = got - line.number
    if line.is_bound:
        return max(-difference, 0.0)
    return abs(difference) if line.absolute else abs(difference / line.number)


def describe(line: Expectation) -> str:
    """Say in one phrase what a line compares."""
    if line.model.endswith(".py"):
        return ", ".join(part for part in (line.quantity, line.mode) if part)
    if line.quantity.startswith((SHEET, TEETH)):
        return f"{Path(line.model).stem}, {words(line.quantity)}"
    parts = [
        Path(line.model).stem,
        f"{'order' if line.quantity in FORCED else 'mode'} {line.mode}",
        words(line.quantity),
    ]
    if line.speed:
        parts.append(line.speed)
    if line.elements:
        parts.append(f"{' > '.join(map(str, line.elements))} el.")
    if line.accuracy:
        parts.append(f"accuracy {line.accuracy:g}")
    if line.mesh_stiffness:
        parts.append(f"mesh {' > '.join(f'{k:g}'.replace('+', '') for k in line.mesh_stiffness)} N/m")
    return ", ".join(parts)


def main(wanted: Sequence[str] = (), json_file: Path | None = None, *, by_case: bool = False) -> int:
    """Run cases by name (all where none is named), print the table, write JSON on request; 0 where all pass, else 1.

    `by_case`: print a line a case in place of all lines.

    Raises:
        AnalysisError: there is no case of that name.
    """
    start = time.perf_counter()
    cases = read_cases(wanted)
    rows = list(run(cases))
    seconds = time.perf_counter() - start
    sys.stdout.write(overview({case.name: case.title for case in cases}, rows) if by_case else printed(rows))
    judged = [row for row in rows if row.judged]
    failed = [row for row in judged if not row.passed]
    shown = len(rows) - len(judged)
    print(f"\n{len(judged) - len(failed)} of {len(judged)} within tolerance, {shown} shown only, in {seconds:.1f} s")
    if json_file:
        _write_json(json_file, rows, seconds)
    return 1 if failed else 0


def _write_json(file: Path, rows: Sequence[Row], seconds: float) -> None:
    """Write all rows; `passed` is null where a line is not judged."""
    plain = [{**asdict(row), "passed": row.passed if row.judged else None} for row in rows]
    unfinished = file.with_name(file.name + ".new")
    unfinished.write_text(json.dumps({"seconds": seconds, "rows": plain}, indent=1) + "\n", encoding="utf-8")
    os.replace(unfinished, file)
