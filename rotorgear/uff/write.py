"""Datasets of a universal file as bytes, column by column as their formats say."""

from __future__ import annotations

import sys
from collections.abc import Iterable

import numpy as np

from rotorgear.uff.datasets import Function, Nodes, Shape, TraceLine, Units

# Codes of dataset 55: structural model; normal modes or complex ones of the first order; three or six displacements of a node.
_STRUCTURAL = 1
_NORMAL_MODE = 2
_COMPLEX_MODE = 3
_VECTORS = {3: 2, 6: 3}
_REAL = 2
_COMPLEX = 5
# Dataset 58: double precision.
_REAL_DOUBLE = 4
_COMPLEX_DOUBLE = 6
_IEEE = 2
_ABSCISSA_STEPS = 1e-9
# Numbers in a row of values.
_PER_ROW = 6
# The most nodes of a trace line.
_LONGEST_LINE = 250


def units_set(units: Units) -> bytes:
    """Dataset 164."""
    factors = "".join(_double(x) for x in (units.length, units.force, 1.0))
    return _dataset(164, [f"{units.code:10d}{units.description[:20]:>20s}{2:10d}", factors, _double(0.0)])


def nodes_set(nodes: Nodes) -> bytes:
    """Dataset 15."""
    table = zip(nodes.numbers, nodes.systems, nodes.colours, nodes.positions, strict=True)
    return _dataset(15, [f"{n:10d}{cs:10d}{cs:10d}{colour:10d}{_numbers(xyz)}" for n, cs, colour, xyz in table])


def line_sets(line: TraceLine) -> list[bytes]:
    """Datasets 82, several where the line has more nodes than one holds; the parts share a node."""
    found = []
    for first in range(0, max(len(line.nodes) - 1, 1), _LONGEST_LINE - 1):
        nodes = line.nodes[first : first + _LONGEST_LINE]
        rows = ["".join(f"{node:10d}" for node in nodes[k : k + 8]) for k in range(0, len(nodes), 8)]
        found.append(
            _dataset(82, [f"{line.number:10d}{len(nodes):10d}{0:10d}", f"{line.name or 'NONE':80.80s}", *rows])
        )
    return found


def shape_set(shape: Shape) -> bytes:
    """Dataset 55: a normal mode where the shape has no eigenvalue, else a complex one with modal A and B left 1."""
    each = shape.values.shape[1]
    values = np.asarray(shape.values)
    s = shape.eigenvalue
    if s is None:
        kind = [2, 4, 1, shape.mode]
        facts = [shape.frequency_hz, 1.0, shape.damping_ratio, 0.0]
        rows = values.real
    else:
        kind = [2, 6, 1, shape.mode]
        facts = [s.real, s.imag, 1.0, 0.0, 1.0, 0.0]
        rows = np.stack([values.real, values.imag], axis=2).reshape(len(values), -1)
    codes = [_STRUCTURAL, _NORMAL_MODE if s is None else _COMPLEX_MODE, _VECTORS[each], shape.data_type]
    codes += [_REAL if s is None else _COMPLEX, each]
    lines = [*_names(shape.names), _whole(codes), _whole(kind), _numbers(facts)]
    for node, row in zip(shape.nodes, rows, strict=True):
        lines.append(f"{node:10d}")
        lines += [_numbers(row[first : first + _PER_ROW]) for first in range(0, len(row), _PER_ROW)]
    return _dataset(55, lines)


def function_set(function: Function, *, binary: bool = False) -> bytes:
    """Dataset 58, or 58b with its values as little- or big-endian doubles as this machine has them.

    The format's columns give the abscissa six digits: only where these are exact is it written as first value and step, else
    as a value of its own at each point.
    """
    x = np.asarray(function.x, dtype=float)
    y = np.asarray(function.values)
    is_complex = np.iscomplexobj(y)
    step = (x[-1] - x[0]) / (len(x) - 1) if len(x) > 1 else 1.0
    first, rounded = (float(f"{value:.5E}") for value in (x[0], step))
    even = bool(np.allclose(x, first + rounded * np.arange(len(x)), rtol=_ABSCISSA_STEPS, atol=0.0)) and rounded > 0.0
    parts = [y.real, y.imag] if is_complex else [y]
    table = np.column_stack(parts if even else [x, *parts]).astype(float)
    response = f" {'NONE':10s}{function.response[0]:10d}{function.response[1]:4d}"
    reference = f" {'NONE':10s}{function.reference[0]:10d}{function.reference[1]:4d}"
    kind = _COMPLEX_DOUBLE if is_complex else _REAL_DOUBLE
    spacing = _numbers([first, rounded, function.z] if even else [0.0, 0.0, function.z])
    header = [
        *_names(function.names),
        f"{function.kind:5d}{0:10d}{0:5d}{0:10d}{response}{reference}",
        f"{kind:10d}{len(x):10d}{int(even):10d}{spacing}",
        *(
            f"{code:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {'NONE':20s}"
            for code in (function.x_type, function.numerator, function.denominator, function.z_type)
        ),
    ]
    if not binary:
        if even:
            flat = table.ravel()
            rows = ["".join(f"{v:20.12E}" for v in flat[k : k + 4]) for k in range(0, len(flat), 4)]
        else:
            pairs = [f"{row[0]:13.5E}" + "".join(f"{v:20.12E}" for v in row[1:]) for row in table]
            # Real values are two a row with their abscissa, complex ones alone.
            rows = pairs if is_complex else ["".join(pairs[k : k + 2]) for k in range(0, len(pairs), 2)]
        return _dataset(58, [*header, *rows])
    data = table.tobytes()
    order = 1 if sys.byteorder == "little" else 2
    identifier = f"{58:6d}b{order:6d}{_IEEE:6d}{11:12d}{len(data):12d}{0:6d}{0:6d}{0:12d}{0:12d}"
    text = "\n".join([f"{-1:6d}", identifier, *header]) + "\n"
    return text.encode("ascii", errors="replace") + data + f"{-1:6d}\n".encode()


def _dataset(number: int, lines: Iterable[str]) -> bytes:
    return ("\n".join([f"{-1:6d}", f"{number:6d}", *lines, f"{-1:6d}"]) + "\n").encode("ascii", errors="replace")


def _names(names: tuple[str, ...]) -> list[str]:
    """Five lines of text, none of them blank."""
    return [(name[:80] or "NONE") for name in (*names, *("NONE",) * 5)[:5]]


def _whole(values: Iterable[int]) -> str:
    return "".join(f"{value:10d}" for value in values)


def _numbers(values: Iterable[float]) -> str:
    return "".join(f"{float(x):13.5E}" for x in values)


def _double(x: float) -> str:
    return f"{x:25.16E}".replace("E", "D")
