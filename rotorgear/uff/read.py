"""Read a universal file: nodes, trace lines, shapes and functions in SI, by the units of the file itself.

Functions at degrees of freedom (datasets 58 and 58b) are text or bytes. Programs differ in what the format leaves open, and some
in what it settles: byte order, single abscissa beside double values, line ends before the closing line, values to fill a row. The
header says how many values there are; what it can't mean is refused. This reader takes what the library pyuff refuses or misreads
of these, so that files are read here and not there.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.errors import ModelError, Problem
from rotorgear.files.bounds import UNIVERSAL
from rotorgear.files.numbers import is_count
from rotorgear.files.read import UnreadableError, read_named
from rotorgear.quantity import GRAVITY
from rotorgear.uff import datasets
from rotorgear.uff.blocks import Block, binary_fields, blocks_of, columns, is_whole, sizes_of

_COMPLEX = (5, 6)
_KINDS = (2, 4, 5, 6)
_LITTLE = 1
# Floating-point formats of 58b that are not IEEE.
_OTHER_FLOATS = {1: "DEC VMS", 3: "IBM 5/370"}
# Sizes that measured quantities in any unit have; bytes in the wrong order give others.
_LEAST = 1e-20
_MOST = 1e20
# Units that ordinates are labelled with: their name in lower case without blanks -> what is measured in them, factor to SI.
_LABELS = {
    "m": (datasets.DISPLACEMENT, 1.0),
    "mm": (datasets.DISPLACEMENT, 1e-3),
    "um": (datasets.DISPLACEMENT, 1e-6),
    "µm": (datasets.DISPLACEMENT, 1e-6),
    "in": (datasets.DISPLACEMENT, 0.0254),
    "m/s": (datasets.VELOCITY, 1.0),
    "mm/s": (datasets.VELOCITY, 1e-3),
    "in/s": (datasets.VELOCITY, 0.0254),
    "m/s2": (datasets.ACCELERATION, 1.0),
    "m/s/s": (datasets.ACCELERATION, 1.0),
    "mm/s2": (datasets.ACCELERATION, 1e-3),
    "in/s2": (datasets.ACCELERATION, 0.0254),
    "g": (datasets.ACCELERATION, GRAVITY),
    "n": (datasets.FORCE, 1.0),
    "kn": (datasets.FORCE, 1e3),
    "lbf": (datasets.FORCE, 4.4482216152605),
}
_LENGTHS = (datasets.DISPLACEMENT, datasets.VELOCITY, datasets.ACCELERATION)
_FORCES = (datasets.REACTION, datasets.FORCE)
_WORDS = {quantity: word for word, quantity in datasets.MOTIONS.items()} | {datasets.FORCE: "force"}


def read_function(
    block: Block, units: datasets.Units, motion: int | None = None
) -> tuple[datasets.Function, list[str]]:
    """Return a function in SI, and sentences on assumptions.

    Args:
        block: the dataset. units: of the file.
        motion: data type of numerators that neither their own type nor a unit names; None leaves these as they are.

    Raises:
        ModelError: a header that makes no sense, fewer values than it says, numbers that are not finite.
    """
    lines = block.lines
    if len(lines) < 11:
        raise block.problem(0, f"eleven header lines of a function, {len(lines)} are there")
    kind, place, reference = _freedoms(lines[5], block)
    form = block.numbers(7)
    if len(form) < 3 or form[0] not in _KINDS or form[1] < 0 or not is_whole(form[1]):
        expected = "ordinate type 2, 4, 5 or 6, number of values and spacing"
        raise block.problem(7, expected, repr(lines[6].strip()[:60]))
    count = int(form[1])
    if count == 0:
        raise block.problem(7, "the function has no values")
    even = form[2] != 0
    first, step, z = ([*form[3:6], 0.0, 0.0, 0.0])[:3]
    notes: list[str] = []
    if block.data is None:
        x, values = _parted(block.numbers_from(12), count, int(form[0]), even, block)
    else:
        x, values, notes = _from_bytes(block, count, int(form[0]), even)
    if even and not step > 0.0 and count > 1:
        raise block.problem(7, "a step of the abscissa above 0", f"{step:g}")
    at = first + step * np.arange(len(values), dtype=float) if x is None else x
    if not (np.isfinite(at).all() and np.isfinite(values).all()):
        raise block.problem(12, "finite numbers")
    axes = [_axis(lines[k], block, k + 1) for k in (7, 8, 9, 10)]
    x_type, z_type = axes[0][0], axes[3][0]
    (numerator, over), (denominator, under) = axes[1], axes[2]
    if not under and (written := re.fullmatch(r"(.+)/\s*(\w+)", over)) and _label(written[2])[0] == datasets.FORCE:
        over, under = written.groups()  # the unit of the whole ratio, such as (m/s^2)/N, stands at the numerator
    response = kind == datasets.FREQUENCY_RESPONSE
    numerator, above, unsure = _in_si(numerator, over, units, motion if response else None)
    denominator, below, more = _in_si(denominator, under, units, datasets.FORCE if response else None)
    notes += [*unsure, *more]
    if x_type == datasets.FREQUENCY and axes[0][1].lower() == "khz":
        at = 1000.0 * at
    names = tuple(text.strip() for text in lines[:5])
    y = values * (above / below)
    return datasets.Function(kind, place, reference, at, y, x_type, numerator, denominator, z, names, z_type), notes


def _label(text: str) -> tuple[int, float] | tuple[None, None]:
    """What is measured in the unit of a label, and the factor of its values to SI; None of one that is not known."""
    # UTF-8 that was read a byte a letter has a letter before the square and the micro.
    plain = re.sub(r"[\s()^*\[\]Â]|²", lambda m: "2" if m[0] == "²" else "", text).lower()
    return _LABELS.get(plain.replace("sec", "s"), (None, None))


def _in_si(quantity: int, label: str, units: datasets.Units, meant: int | None) -> tuple[int, float, list[str]]:
    """Data type of an ordinate, the factor of its values to SI, and sentences on assumptions.

    By the label where its unit is known, else by the units of the file. A type that says nothing is that of the label, else the
    one that is `meant`.
    """
    said, known = _label(label)
    notes = []
    if quantity in datasets.SAYS_NOTHING and said:
        notes.append(f"a function does not say what it is (type {quantity}): its unit '{label}' says {_WORDS[said]}")
        quantity = said
    elif quantity in datasets.SAYS_NOTHING and meant:
        notes.append(
            f"a function does not say what it is (type {quantity}): taken as {_WORDS[meant]} in the file's units"
        )
        quantity = meant
    elif label and known is None and quantity in (*_LENGTHS, *_FORCES):
        notes.append(f"the unit '{label}' of a function is not known: its values are taken in the file's units")
    if known is not None:
        return quantity, known, notes
    return (
        quantity,
        1.0 / units.length if quantity in _LENGTHS else 1.0 / units.force if quantity in _FORCES else 1.0,
        notes,
    )


# Function type, ids, then name, node and direction of response and of reference, where the names have no blanks.
_FREEDOMS = re.compile(r"\s*(\d+)\s+-?\d+\s+-?\d+\s+-?\d+\s+\S+\s+(\d+)\s+([+-]?\d)\s+\S+\s+(\d+)\s+([+-]?\d)\s*")


def _freedoms(text: str, block: Block) -> tuple[int, tuple[int, int], tuple[int, int]]:
    """Function type, then node and direction of response and reference.

    Many programs miss the columns by one or two, but leave blanks between: only what that does not settle is cut by columns.
    """
    found = _FREEDOMS.fullmatch(text)
    fields = columns(text, (5, 10, 5, 10, 11, 10, 4, 11, 10, 4))
    parts = found.groups() if found else [fields[k] or "0" for k in (0, 5, 6, 8, 9)]
    try:
        kind, node, direction, other, along = (int(part) for part in parts)
    except ValueError:
        raise block.problem(6, "function type, response and reference", repr(text.strip()[:70])) from None
    if abs(direction) > 6 or abs(along) > 6:
        raise block.problem(6, "directions from -6 to 6", repr(text.strip()[:70]))
    return kind, (node, direction), (other, along)


def _axis(text: str, block: Block, row: int) -> tuple[int, str]:
    """Specific data type and unit label of an axis."""
    code = re.match(r"\s*(-?\d+)?(?:\s|\Z)", text)
    if code is None:
        raise block.problem(row, "the specific data type of an axis", repr(text.strip()[:40]))
    label = columns(text, (25, 21, 21))[2]
    return int(code[1] or 0), "" if label.upper() == "NONE" else label


def _parted(
    numbers: NDArray[np.float64], count: int, kind: int, even: bool, block: Block
) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | NDArray[np.complex128]]:
    """Abscissa (None where even) and ordinates of `count` values that follow one another."""
    parts = 2 if kind in _COMPLEX else 1
    each = parts + (0 if even else 1)
    rest = numbers[count * each :]
    # Some programs count real and imaginary parts apart; others fill the last row with zeros.
    if parts == 2 and even and len(numbers) == count:
        count //= 2
        rest = numbers[:0]
    said = f"the header says {count} values, but"
    if len(numbers) < count * each:
        raise block.problem(12, f"{said} only {len(numbers) // each} are there: the set is cut")
    if len(rest) > 6 or rest.any():
        raise block.problem(12, f"{said} {len(numbers) / each:g} are there")
    table = numbers[: count * each].reshape(count, each)
    values = table[:, -2] + 1j * table[:, -1] if parts == 2 else table[:, -1]
    return (None if even else table[:, 0].copy()), values


def _from_bytes(
    block: Block, count: int, kind: int, even: bool
) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | NDArray[np.complex128], list[str]]:
    """The same from binary data, with sentences on assumptions."""
    data = block.data or b""
    order, form, *_ = binary_fields(block.identifier)
    if form in _OTHER_FLOATS:
        raise block.problem(0, f"IEEE numbers (format 2); the file has those of {_OTHER_FLOATS[form]}")
    size = "f8" if kind in (4, 6) else "f4"
    parts = 2 if kind in _COMPLEX else 1
    each = parts * int(size[1])
    sizes = sizes_of(block.lines)
    if not sizes:
        raise block.problem(7, "ordinate type, number of values and spacing as whole numbers")
    # The size that fills the data, but for line ends, before one that leaves a rest.
    least = len(data.rstrip(b"\r\n"))
    fitting = sorted((size_ for size_ in sizes if size_ <= len(data)), key=lambda size_: size_ < least)
    if not fitting:
        raise block.problem(11, f"{min(sizes)} bytes by the header, but only {len(data)} are there: the set is cut")
    length = fitting[0]
    found = []
    for mark in ("<", ">") if order == _LITTLE else (">", "<"):
        layout = np.dtype([("y", mark + size, (parts,))])
        if not even:
            layout = np.dtype([("x", mark + ("f8" if length == count * (each + 8) else "f4")), *layout.descr])
        table = np.frombuffer(data[:length], dtype=layout)
        y = table["y"].astype(float)
        x = None if even else table["x"].astype(float)
        found.append((_sane(y) * (1.0 if x is None else _sane(x) * bool(np.all(np.diff(x) > 0.0))), x, y))
    (declared, x, y), other = found
    notes = []
    if other[0] > 0.99 and declared < 0.9:
        _, x, y = other
        notes.append("binary functions (58b) have another byte order than they say: read in the order that makes sense")
    elif declared < 0.5:
        raise block.problem(11, "the bytes are no numbers of a measured size in either order: the set is damaged")
    return x, (y[:, 0] + 1j * y[:, 1] if parts == 2 else y[:, 0]), notes


def _sane(values: NDArray[np.float64]) -> float:
    """Share of numbers that have the size of a measured quantity."""
    with np.errstate(invalid="ignore", over="ignore"):
        size = np.abs(values)
        return float(np.mean((size == 0.0) | ((size > _LEAST) & (size < _MOST))))


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


def read_universal(path: str | Path, motion: int | None = None) -> datasets.UniversalFile:
    """Return what a universal file holds.

    Args:
        path: of the file; ASCII, or with functions in binary (58b).
        motion: data type of responses that neither their own type nor a unit names; None leaves these as they are.

    Returns:
        Its contents in SI. Without dataset 164 it is taken to be in SI, which a note says.

    Raises:
        ModelError: a file that can't be read, is cut or empty, or numbers that make no sense, with line and dataset.
    """
    file = Path(path)
    try:
        data = read_named(file, UNIVERSAL.most_bytes)
    except UnreadableError as error:
        raise ModelError([Problem(str(file), "", "a universal file (UFF)", error.reason)], str(file)) from None
    blocks = blocks_of(data, file.name)
    if not blocks:
        raise ModelError([Problem(str(file), "", "a universal file (UFF) with datasets", "it has none")], str(file))
    stated = [_units(block) for block in blocks if block.number == 164]
    units = stated[0] if stated else datasets.Units()
    notes = [] if stated else [f"{file.name} states no units (dataset 164): taken as m and N"]
    nodes: list[datasets.Nodes] = []
    lines: list[datasets.TraceLine] = []
    shapes: list[datasets.Shape] = []
    functions: list[datasets.Function] = []
    others: Counter[int] = Counter()
    for block in blocks:
        match block.number:
            case 164:
                units = stated.pop(0)
            case 15 | 2411:
                nodes.append(_nodes(block, units))
            case 82:
                lines.append(_line(block))
            case 55:
                shapes.append(_shape(block))
            case 58:
                found, unsure = read_function(block, units, motion)
                functions.append(found)
                notes += unsure
            case number:
                others[number] += 1
    whole = _joined(nodes, file.name)
    told = tuple(dict.fromkeys(notes))
    return datasets.UniversalFile(units, whole, tuple(lines), tuple(shapes), tuple(functions), dict(others), told)


def _units(block: Block) -> datasets.Units:
    if len(block.lines) < 2:
        raise block.problem(0, "a units code, and factors of length and force")
    code, description = columns(block.lines[0], (10, 20))
    factors = block.numbers_from(2)
    if not is_count(code) or len(factors) < 2 or not (factors[:2] > 0.0).all():
        raise block.problem(2, "a units code, and factors of length and force above 0", " ".join(block.lines)[:70])
    given = (float(factors[0]), float(factors[1]))
    known = _CODES.get(int(code))
    if known and not np.allclose(given, known, rtol=0.01):
        # One of the two is wrong, and which one cannot be known here: a factor of a thousand is not guessed.
        meant = f"the factors {known[0]:g} and {known[1]:g} that units code {code} means"
        remedy = "correct one of the two, or make it 9 (the user's own)"
        raise block.problem(2, f"{meant}; {remedy}", f"{given[0]:g} and {given[1]:g}")
    return datasets.Units(*given, description, int(code))


def _nodes(block: Block, units: datasets.Units) -> datasets.Nodes:
    """Datasets 15, a line a node, and 2411, two lines a node."""
    rows = [block.numbers(row) for row in block.filled(1)]
    if block.number == 2411:
        if len(rows) % 2 or any(len(row) < 4 for row in rows[::2]) or any(len(row) != 3 for row in rows[1::2]):
            raise block.problem(0, "two lines a node: four whole numbers, then x, y and z")
        rows = [[*head[:4], *xyz] for head, xyz in zip(rows[::2], rows[1::2], strict=True)]
    for k, row in enumerate(rows, start=1):
        if len(row) != 7:
            expected = "number, two coordinate systems, colour, x, y and z of a node"
            raise block.problem(k, expected, f"{len(row)} numbers")
    table = np.array(rows).reshape(-1, 7)[:, [0, 2, 3, 4, 5, 6]]
    if not len(table):
        raise block.problem(0, "the set has no nodes")
    if not np.isfinite(table).all():
        raise block.problem(0, "finite coordinates of nodes")
    if not all(map(is_whole, table[:, :3].ravel())):
        raise block.problem(0, "whole numbers of nodes, coordinate systems and colours")
    whole = table[:, :3].astype(int)
    return datasets.Nodes(whole[:, 0], table[:, 3:] / units.length, whole[:, 1], whole[:, 2])


def _joined(nodes: list[datasets.Nodes], file: str) -> datasets.Nodes | None:
    if not nodes:
        return None
    found = datasets.Nodes(*map(np.concatenate, zip(*(vars(part).values() for part in nodes), strict=True)))
    _, first, which = np.unique(found.numbers, return_index=True, return_inverse=True)
    elsewhere = np.flatnonzero((found.positions != found.positions[first[which]]).any(axis=1))
    if len(elsewhere):
        number = found.numbers[elsewhere].min()
        raise ModelError([Problem(f"{file}: node {number}", "", "one place; it has several")], file)
    keep = np.sort(first)
    return datasets.Nodes(*(column[keep] for column in vars(found).values()))


def _line(block: Block) -> datasets.TraceLine:
    if len(block.lines) < 2:
        raise block.problem(0, "number and name of a trace line, and its nodes")
    number, count = block.whole(1, 2)[:2]
    numbers = block.numbers_from(3)
    if not all(map(is_whole, numbers)):
        raise block.problem(3, "numbers of nodes")
    nodes = numbers.astype(int)
    if len(nodes) < count:
        raise block.problem(3, f"{count} nodes of the trace line, {len(nodes)} are there: the set is cut")
    return datasets.TraceLine(number, block.lines[1].strip(), nodes[:count])


def _shape(block: Block) -> datasets.Shape:
    lines = block.lines
    if len(lines) < 8:
        raise block.problem(0, "eight header lines of a shape, and rows of nodes: the set is cut")
    _, analysis, _, data_type, kind, each = block.whole(6, 6)[:6]
    if kind not in (2, 5) or each < 1:
        raise block.problem(6, "data type 2 (real) or 5 (complex), and numbers a node", repr(lines[5].strip()))
    mode = [*block.whole(7, 3), 1][3]
    facts = block.numbers(8)
    eigenvalue = None
    if analysis == _NORMAL:
        frequency, _, damping = [*facts[:3], *(math.nan, 0.0, 0.0)[len(facts) :]]
    elif analysis in _COMPLEX_MODES and len(facts) > 1:
        eigenvalue = complex(*facts[:2])
        frequency = abs(eigenvalue) / (2.0 * math.pi)
        damping = -eigenvalue.real / abs(eigenvalue) if eigenvalue else 0.0
    else:
        raise block.problem(6, "a normal (2) or complex (3, 7) mode", f"analysis type {analysis}")
    nodes, values = _node_values(each * (2 if kind == 5 else 1), block)
    if kind == 5:
        values = values[:, 0::2] + 1j * values[:, 1::2]
    names = tuple(text.strip() for text in lines[:5])
    motions = values[:, : 6 if each >= 6 else 3]
    return datasets.Shape(frequency, damping, eigenvalue, nodes, motions, names, mode, data_type)


def _node_values(each: int, block: Block) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of nodes (n,), and `each` numbers at every one (n, each)."""
    rows = [(row, block.numbers(row)) for row in block.filled(9)]
    if not rows:
        raise block.problem(9, "the shape has no nodes")
    nodes: list[int] = []
    values: list[list[float]] = []
    rest = iter(rows)
    for row, head in rest:
        if len(head) != 1 or not is_whole(head[0]):
            raise block.problem(row, "the number of a node in a line of its own", f"{len(head)} numbers")
        node = int(head[0])
        last = row
        found: list[float] = []
        while len(found) < each and (following := next(rest, None)):
            last = following[0]
            found += following[1]
        if len(found) != each:
            raise block.problem(last, f"{each} values at node {node}", str(len(found)))
        if node in nodes and found != values[nodes.index(node)]:
            raise block.problem(row, "every node once", f"node {node} again, with other values")
        nodes.append(node)
        values.append(found)
    return np.array(nodes), np.array(values)
