"""Datasets 58 and 58b: functions at degrees of freedom, from text or from bytes.

Programs differ in what the format leaves open, and some in what it settles: byte order, single abscissa beside double values,
line ends before the closing line, values to fill a row. The header says how many values there are; what it can't mean is refused.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from rotorgear.uff.blocks import Block, sizes_of
from rotorgear.uff.datasets import ACCELERATION, DISPLACEMENT, FORCE, FREQUENCY, REACTION, VELOCITY, Function, Units
from rotorgear.uff.rows import Where, columns, is_whole, numbers_in, numbers_of

_REAL_SINGLE = 2
_REAL_DOUBLE = 4
_COMPLEX = (5, 6)
_KINDS = (2, 4, 5, 6)
_LITTLE = 1
# Floating-point formats of 58b that are not IEEE.
_OTHER_FLOATS = {1: "DEC VMS", 3: "IBM 5/370"}
# Sizes that measured quantities in any unit have; bytes in the wrong order give others.
_LEAST = 1e-20
_MOST = 1e20
# Units that ordinates are labelled with: their name in lower case without blanks -> factor to SI.
_LABELS = {
    "m": 1.0,
    "mm": 1e-3,
    "um": 1e-6,
    "µm": 1e-6,
    "m/s": 1.0,
    "mm/s": 1e-3,
    "m/s2": 1.0,
    "mm/s2": 1e-3,
    "g": 9.80665,
    "n": 1.0,
    "kn": 1e3,
    "lbf": 4.4482216152605,
    "in": 0.0254,
    "in/s": 0.0254,
    "in/s2": 0.0254,
}
_LENGTHS = (DISPLACEMENT, VELOCITY, ACCELERATION)
_FORCES = (REACTION, FORCE)


def read_function(block: Block, units: Units, file: str) -> tuple[Function, list[str]]:
    """Return a function in SI, and sentences on what had to be guessed.

    Raises:
        ModelError: a header that makes no sense, fewer values than it says, numbers that are not finite.
    """
    where = Where(file, 58, block.line)
    lines = block.lines
    if len(lines) < 11:
        raise where.problem(0, f"eleven header lines of a function, {len(lines)} are there")
    kind, response, reference = _freedoms(lines[5], where)
    form = numbers_in(lines[6], where, 7)
    if len(form) < 3 or form[0] not in _KINDS or form[1] < 0 or not is_whole(form[1]):
        expected = "ordinate type 2, 4, 5 or 6, number of values and spacing"
        raise where.problem(7, expected, repr(lines[6].strip()[:60]))
    count = int(form[1])
    if count == 0:
        raise where.problem(7, "the function has no values")
    even = form[2] != 0
    first, step, z = ([*form[3:6], 0.0, 0.0, 0.0])[:3]
    notes: list[str] = []
    if block.data is None:
        rows = [(k, text) for k, text in enumerate(lines[11:], start=12) if text.strip()]
        x, values = _parted(numbers_of(rows, where), count, int(form[0]), even, where)
    else:
        x, values, notes = _from_bytes(block, count, int(form[0]), even, where)
    if even and not step > 0.0 and count > 1:
        raise where.problem(7, "a step of the abscissa above 0", f"{step:g}")
    at = first + step * np.arange(len(values), dtype=float) if x is None else x
    if not (np.isfinite(at).all() and np.isfinite(values).all()):
        raise where.problem(12, "finite numbers")
    axes = [_axis(lines[k], where, k + 1) for k in (7, 8, 9, 10)]
    factor, unsure = _to_si(axes[1], axes[2], units)
    found = Function(
        kind,
        response,
        reference,
        at * (1000.0 if axes[0][0] == FREQUENCY and axes[0][1].lower() == "khz" else 1.0),
        values * factor,
        axes[0][0],
        axes[1][0],
        axes[2][0],
        z,
        tuple(text.strip() for text in lines[:5]),
        axes[3][0],
    )
    return found, notes + unsure


# Function type, ids, then name, node and direction of response and of reference, where the names have no blanks.
_FREEDOMS = re.compile(r"\s*(\d+)\s+-?\d+\s+-?\d+\s+-?\d+\s+\S+\s+(\d+)\s+([+-]?\d)\s+\S+\s+(\d+)\s+([+-]?\d)\s*")


def _freedoms(text: str, where: Where) -> tuple[int, tuple[int, int], tuple[int, int]]:
    """Function type, then node and direction of response and reference.

    Many programs miss the columns by one or two, but leave blanks between: only what that does not settle is cut by columns.
    """
    found = _FREEDOMS.fullmatch(text)
    fields = columns(text, (5, 10, 5, 10, 11, 10, 4, 11, 10, 4))
    parts = found.groups() if found else [fields[k] or "0" for k in (0, 5, 6, 8, 9)]
    try:
        kind, node, direction, other, along = (int(part) for part in parts)
    except ValueError:
        raise where.problem(6, "function type, response and reference", repr(text.strip()[:70])) from None
    if abs(direction) > 6 or abs(along) > 6:
        raise where.problem(6, "directions from -6 to 6", repr(text.strip()[:70]))
    return kind, (node, direction), (other, along)


def _axis(text: str, where: Where, row: int) -> tuple[int, str]:
    """Specific data type and unit label of an axis."""
    code = re.match(r"\s*(-?\d+)?(?:\s|\Z)", text)
    if code is None:
        raise where.problem(row, "the specific data type of an axis", repr(text.strip()[:40]))
    label = columns(text, (25, 21, 21))[2]
    return int(code[1] or 0), "" if label.upper() == "NONE" else label


def _to_si(numerator: tuple[int, str], denominator: tuple[int, str], units: Units) -> tuple[float, list[str]]:
    """Factor to SI: by the labels where they are known, else by the units of the file."""
    factor = 1.0
    unsure = []
    for (kind, label), power in ((numerator, 1), (denominator, -1)):
        plain = re.sub(r"[\s()^*\[\]]|²", lambda m: "2" if m[0] == "²" else "", label).lower()
        of_file = 1.0 / units.length if kind in _LENGTHS else 1.0 / units.force if kind in _FORCES else 1.0
        known = _LABELS.get(plain)
        if label and known is None and kind in (*_LENGTHS, *_FORCES):
            unsure.append(
                f"the unit '{label}' of a function is not known: its values are taken in the units of the file"
            )
        factor *= (of_file if known is None else known) ** power
    return factor, unsure


def _parted(
    numbers: NDArray[np.float64], count: int, kind: int, even: bool, where: Where
) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | NDArray[np.complex128]]:
    """Abscissa (None where even) and ordinates of `count` values that stand one after the other."""
    parts = 2 if kind in _COMPLEX else 1
    each = parts + (0 if even else 1)
    rest = numbers[count * each :]
    # Some programs count real and imaginary parts apart; others fill the last row with zeros.
    if parts == 2 and even and len(numbers) == count:
        count //= 2
        rest = numbers[:0]
    if len(numbers) < count * each:
        raise where.problem(
            12, f"the header says {count} values, but only {len(numbers) // each} are there: the set is cut"
        )
    if len(rest) > 6 or rest.any():
        raise where.problem(12, f"the header says {count} values, but {len(numbers) / each:g} are there")
    table = numbers[: count * each].reshape(count, each)
    values = table[:, -2] + 1j * table[:, -1] if parts == 2 else table[:, -1]
    return (None if even else table[:, 0].copy()), values


def _from_bytes(
    block: Block, count: int, kind: int, even: bool, where: Where
) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | NDArray[np.complex128], list[str]]:
    """The same from binary data, with sentences on what had to be guessed."""
    data = block.data or b""
    fields = block.identifier[block.identifier.lower().index("b") + 1 :].split()
    order, form = ([int(field) if field.isdigit() else 0 for field in fields[:2]] + [0, 0])[:2]
    if form in _OTHER_FLOATS:
        raise where.problem(0, f"IEEE numbers (format 2); the file has those of {_OTHER_FLOATS[form]}")
    size = "f8" if kind in (4, 6) else "f4"
    parts = 2 if kind in _COMPLEX else 1
    each = parts * int(size[1])
    sizes = sizes_of(block.lines)
    length = next((size_ for size_ in sizes if len(data.rstrip(b"\r\n")) <= size_ <= len(data)), None)
    length = length or next((size_ for size_ in sizes if size_ <= len(data)), None)
    if length is None:
        if not sizes:
            raise where.problem(7, "ordinate type, number of values and spacing as whole numbers")
        raise where.problem(11, f"{min(sizes)} bytes by the header, but only {len(data)} are there: the set is cut")
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
        raise where.problem(11, "the bytes are no numbers of a measured size in either order: the set is damaged")
    return x, (y[:, 0] + 1j * y[:, 1] if parts == 2 else y[:, 0]), notes


def _sane(values: NDArray[np.float64]) -> float:
    """Share of numbers of a size that something measured may have."""
    with np.errstate(invalid="ignore", over="ignore"):
        size = np.abs(values)
        return float(np.mean((size == 0.0) | ((size > _LEAST) & (size < _MOST))))
