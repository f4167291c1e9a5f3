"""Read a universal file: nodes, trace lines, shapes and functions in SI, by the units of the file itself."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path

import numpy as np

from rotorgear.errors import ModelError, Problem
from rotorgear.uff.blocks import Block, blocks_of
from rotorgear.uff.datasets import Function, Nodes, Shape, TraceLine, Units, UniversalFile
from rotorgear.uff.functions import read_function
from rotorgear.uff.rows import Where, columns, is_whole, numbers_in, numbers_of, whole_in

_NORMAL = 2
_COMPLEX_MODES = (3, 7)
# Units by their code in dataset 164: factors of length and force. Code 9 is the user's own.
_CODES = {
    1: (1.0, 1.0),
    2: (3.280839895, 0.2248089431),
    3: (1.0, 0.101971621),
    4: (3.280839895, 7.233013852),
    5: (1e3, 1e3),
    6: (1e2, 1e2),
    7: (39.37007874, 0.2248089431),
    8: (1e3, 0.101971621),
}


def read_universal(path: str | Path) -> UniversalFile:
    """Return what a universal file holds.

    Args:
        path: of the file; ASCII, or with functions in binary (58b).

    Returns:
        Its contents in SI. Without dataset 164 it is taken to be in SI, which a note says.

    Raises:
        ModelError: a file that can't be read, is cut or empty, or numbers that make no sense, with line and dataset.
    """
    file = Path(path)
    try:
        data = file.read_bytes()
    except OSError as error:
        reason = "there is no such file" if not file.exists() else (error.strerror or str(error))
        raise ModelError([Problem(str(file), "", "a universal file (UFF)", reason)], str(file)) from None
    blocks = blocks_of(data, file.name)
    if not blocks:
        raise ModelError([Problem(str(file), "", "a universal file (UFF) with datasets", "it has none")], str(file))
    stated = [_units(block, file.name) for block in blocks if block.number == 164]
    units = stated[0] if stated else Units()
    notes = [] if stated else [f"{file.name} states no units (dataset 164): taken as m and N"]
    nodes: list[Nodes] = []
    lines: list[TraceLine] = []
    shapes: list[Shape] = []
    functions: list[Function] = []
    others: Counter[int] = Counter()
    for block in blocks:
        match block.number:
            case 164:
                units = stated.pop(0)
            case 15:
                nodes.append(_nodes_15(block, units, file.name))
            case 2411:
                nodes.append(_nodes_2411(block, units, file.name))
            case 82:
                lines.append(_line(block, file.name))
            case 55:
                shapes.append(_shape(block, file.name))
            case 58:
                found, unsure = read_function(block, units, file.name)
                functions.append(found)
                notes += unsure
            case number:
                others[number] += 1
    return UniversalFile(
        units,
        _joined(nodes, file.name),
        tuple(lines),
        tuple(shapes),
        tuple(functions),
        dict(others),
        tuple(dict.fromkeys(notes)),
    )


def _units(block: Block, file: str) -> Units:
    where = Where(file, 164, block.line)
    if len(block.lines) < 2:
        raise where.problem(0, "a units code, and factors of length and force")
    code, description = columns(block.lines[0], (10, 20))
    rows = [(k, text) for k, text in enumerate(block.lines[1:], start=2) if text.strip()]
    factors = numbers_of(rows, where)
    if not code.isdigit() or len(factors) < 2 or not (factors[:2] > 0.0).all():
        raise where.problem(2, "a units code, and factors of length and force above 0", " ".join(block.lines)[:70])
    given = (float(factors[0]), float(factors[1]))
    known = _CODES.get(int(code))
    if known and not np.allclose(given, known, rtol=0.01):
        # One of the two is wrong, and nobody here can tell which: a thousand times is not to be guessed.
        raise where.problem(
            2,
            f"the factors {known[0]:g} and {known[1]:g} that units code {code} means; correct one of the two, or make it 9 "
            "(the user's own)",
            f"{given[0]:g} and {given[1]:g}",
        )
    return Units(*given, description, int(code))


def _nodes_15(block: Block, units: Units, file: str) -> Nodes:
    where = Where(file, 15, block.line)
    rows = [numbers_in(text, where, k) for k, text in enumerate(block.lines, start=1) if text.strip()]
    for k, row in enumerate(rows, start=1):
        if len(row) != 7:
            raise where.problem(
                k, "number, two coordinate systems, colour, x, y and z of a node", f"{len(row)} numbers"
            )
    return _table(np.array(rows).reshape(-1, 7)[:, [0, 2, 3, 4, 5, 6]], units, where)


def _nodes_2411(block: Block, units: Units, file: str) -> Nodes:
    where = Where(file, 2411, block.line)
    rows = [numbers_in(text, where, k) for k, text in enumerate(block.lines, start=1) if text.strip()]
    if len(rows) % 2 or any(len(row) < 4 for row in rows[::2]) or any(len(row) != 3 for row in rows[1::2]):
        raise where.problem(0, "two lines a node: four whole numbers, then x, y and z")
    table = [[head[0], head[2], head[3], *xyz] for head, xyz in zip(rows[::2], rows[1::2], strict=True)]
    return _table(np.array(table).reshape(-1, 6), units, where)


def _table(rows: np.ndarray, units: Units, where: Where) -> Nodes:
    if not len(rows):
        raise where.problem(0, "the set has no nodes")
    if not np.isfinite(rows).all():
        raise where.problem(0, "finite coordinates of nodes")
    if not all(map(is_whole, rows[:, :3].ravel())):
        raise where.problem(0, "whole numbers of nodes, coordinate systems and colours")
    whole = rows[:, :3].astype(int)
    return Nodes(whole[:, 0], rows[:, 3:] / units.length, whole[:, 1], whole[:, 2])


def _joined(nodes: list[Nodes], file: str) -> Nodes | None:
    if not nodes:
        return None
    found = Nodes(
        np.concatenate([part.numbers for part in nodes]),
        np.concatenate([part.positions for part in nodes]),
        np.concatenate([part.systems for part in nodes]),
        np.concatenate([part.colours for part in nodes]),
    )
    numbers, first = np.unique(found.numbers, return_index=True)
    for number in numbers:
        places = found.positions[found.numbers == number]
        if np.ptp(places, axis=0).max() > 0.0:
            raise ModelError([Problem(f"{file}: node {number}", "", "one place; it has several")], file)
    keep = np.sort(first)
    return Nodes(found.numbers[keep], found.positions[keep], found.systems[keep], found.colours[keep])


def _line(block: Block, file: str) -> TraceLine:
    where = Where(file, 82, block.line)
    if len(block.lines) < 2:
        raise where.problem(0, "number and name of a trace line, and its nodes")
    number, count = whole_in(block.lines[0], where, 1, 2)[:2]
    rows = [(k, text) for k, text in enumerate(block.lines[2:], start=3) if text.strip()]
    numbers = numbers_of(rows, where)
    if not all(map(is_whole, numbers)):
        raise where.problem(3, "numbers of nodes")
    nodes = numbers.astype(int)
    if len(nodes) < count:
        raise where.problem(3, f"{count} nodes of the trace line, {len(nodes)} are there: the set is cut")
    return TraceLine(number, block.lines[1].strip(), nodes[:count])


def _shape(block: Block, file: str) -> Shape:
    where = Where(file, 55, block.line)
    lines = block.lines
    if len(lines) < 8:
        raise where.problem(0, "eight header lines of a shape, and rows of nodes: the set is cut")
    _, analysis, _, data_type, kind, each = whole_in(lines[5], where, 6, 6)[:6]
    if kind not in (2, 5) or each < 1:
        raise where.problem(6, "data type 2 (real) or 5 (complex), and numbers a node", repr(lines[5].strip()))
    mode = [*whole_in(lines[6], where, 7, 3), 1][3]
    facts = numbers_in(lines[7], where, 8)
    eigenvalue = None
    if analysis == _NORMAL:
        frequency = facts[0] if facts else math.nan
        damping = facts[2] if len(facts) > 2 else 0.0
    elif analysis in _COMPLEX_MODES and len(facts) > 1:
        eigenvalue = complex(facts[0], facts[1])
        size = abs(eigenvalue)
        frequency = size / (2.0 * math.pi)
        damping = -eigenvalue.real / size if size > 0.0 else 0.0
    else:
        raise where.problem(6, "a normal (2) or complex (3, 7) mode", f"analysis type {analysis}")
    nodes, values = _node_values(lines[8:], each * (2 if kind == 5 else 1), where)
    if kind == 5:
        values = values[:, 0::2] + 1j * values[:, 1::2]
    return Shape(
        frequency,
        damping,
        eigenvalue,
        nodes,
        values[:, :6] if each >= 6 else values[:, :3],
        tuple(text.strip() for text in lines[:5]),
        mode,
        data_type,
    )


def _node_values(lines: tuple[str, ...], each: int, where: Where) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of nodes (n,), and `each` numbers at every one (n, each)."""
    rows = [(k, numbers_in(text, where, k)) for k, text in enumerate(lines, start=9) if text.strip()]
    if not rows:
        raise where.problem(9, "the shape has no nodes")
    nodes: list[int] = []
    values: list[list[float]] = []
    at = 0
    while at < len(rows):
        row, head = rows[at]
        if len(head) != 1 or not is_whole(head[0]):
            raise where.problem(row, "the number of a node in a line of its own", f"{len(head)} numbers")
        at += 1
        found: list[float] = []
        while len(found) < each and at < len(rows):
            found += rows[at][1]
            at += 1
        if len(found) != each:
            raise where.problem(rows[at - 1][0], f"{each} values at node {int(head[0])}", str(len(found)))
        if int(head[0]) in nodes and found != values[nodes.index(int(head[0]))]:
            raise where.problem(row, "every node once", f"node {int(head[0])} again, with other values")
        nodes.append(int(head[0]))
        values.append(found)
    return np.array(nodes), np.array(values)
