"""Mode shapes as a universal file (UFF, ASCII), which modal-test programs read: datasets 164 (units), 15 (nodes) and 55 (shapes).

Rows and columns are those of the Structural Dynamics Research Laboratory, University of Cincinnati, "Universal File Formats".
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.files import replacing
from rotorgear.results.modal import ModalResult

# Codes of dataset 55: structural model; normal modes or complex ones of the first order; six displacements of a node.
_STRUCTURAL = 1
_NORMAL_MODE = 2
_COMPLEX_MODE = 3
_SIX_DOFS = 3
_DISPLACEMENT = 8
_REAL = 2
_COMPLEX = 5
# Numbers in a row of values.
_PER_ROW = 6


def write_uff(result: ModalResult, path: str | Path, *, modes: Sequence[int] | None = None) -> Path:
    """Write nodes and mode shapes to a universal file.

    Undamped modes are real, those at a speed complex; displacements in m and rotations in rad, scaled as in the result.

    Args:
        result: of `modal`.
        path: of the file, such as "modes.unv".
        modes: numbers of the modes, from 0; None: all.

    Raises:
        AnalysisError: a mode that the result has not.
        WriteError: the file can't be written.
    """
    count = len(result.eigenvalues)
    chosen = list(range(count)) if modes is None else list(modes)
    wrong = [k for k in chosen if not 0 <= k < count]
    if wrong:
        raise AnalysisError(f"modes: got {wrong[0]}, expected numbers from 0 to {count - 1}")
    with replacing(path) as scratch:
        ones = "".join(f"{x:25.16E}".replace("E", "D") for x in (1.0, 1.0, 1.0))
        zero = f"{0.0:25.16E}".replace("E", "D")
        units = _dataset(164, [f"{1:10d}{'SI: Meter (newton)':>20s}{2:10d}", ones, zero])
        lines = [*units, *_nodes(result), *(line for k in chosen for line in _shape(result, k))]
        scratch.write_text("\n".join(lines) + "\n", encoding="ascii", errors="replace")
    return Path(path)


def _dataset(number: int, lines: Iterable[str]) -> list[str]:
    return [f"{-1:6d}", f"{number:6d}", *lines, f"{-1:6d}"]


def _nodes(result: ModalResult) -> list[str]:
    # Both coordinate systems of a node are the global one, 0; colours tell the shafts apart.
    shafts = list(dict.fromkeys(result.nodes.shaft))
    rows = zip(result.nodes.shaft, result.nodes.position, strict=True)
    return _dataset(
        15, [f"{k:10d}{0:10d}{0:10d}{shafts.index(s) + 1:10d}{_numbers(xyz)}" for k, (s, xyz) in enumerate(rows, 1)]
    )


def _shape(result: ModalResult, k: int) -> list[str]:
    s = complex(result.eigenvalues[k])
    shape = np.asarray(result.shapes[:, :, k])
    is_complex = result.speed is not None
    damping_ratio = -s.real / abs(s) if abs(s) else 0.0
    if is_complex:
        # Poles as they are; modal A and B are left 1, as shapes are scaled by their own modal mass.
        kind = [2, 6, 1, k + 1]
        facts = [s.real, s.imag, 1.0, 0.0, 1.0, 0.0]
        values = np.stack([shape.real, shape.imag], axis=2).reshape(len(shape), -1)
    else:
        kind = [2, 4, 1, k + 1]
        facts = [abs(s) / (2.0 * np.pi), 1.0, damping_ratio, 0.0]
        values = shape.real
    codes = [_STRUCTURAL, _COMPLEX_MODE if is_complex else _NORMAL_MODE, _SIX_DOFS, _DISPLACEMENT]
    codes += [_COMPLEX if is_complex else _REAL, 6]
    lines = [
        (result.model.title or "rotorgear")[:80],
        f"mode {k + 1}, {abs(s) / (2.0 * np.pi):.6g} Hz, damping ratio {damping_ratio:.6g}",
        result.description[k][:80],
        "rotorgear",
        "NONE",
        "".join(f"{code:10d}" for code in codes),
        "".join(f"{number:10d}" for number in kind),
        _numbers(facts),
    ]
    for node, row in enumerate(values, 1):
        lines.append(f"{node:10d}")
        lines += [_numbers(row[first : first + _PER_ROW]) for first in range(0, len(row), _PER_ROW)]
    return _dataset(55, lines)


def _numbers(values: Iterable[float]) -> str:
    return "".join(f"{float(x):13.5E}" for x in values)
