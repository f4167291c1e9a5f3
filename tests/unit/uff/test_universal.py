"""Universal files: written and read again, read by others, and read from others with their known wounds."""

from __future__ import annotations

import re
import struct

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import ModelError
from rotorgear.uff.datasets import ACCELERATION, DISPLACEMENT, FORCE, VELOCITY, Function, Nodes, TraceLine, Units
from rotorgear.uff.read import read_universal
from rotorgear.uff.write import function_set, line_sets, nodes_set, units_set
from tests.paths import MODELS

HEADER = [
    "NONE",
    "NONE",
    "08-Oct-24 10:27:07",
    "NONE",
    "NONE",
    "    4         0    0         0 NONE                7   3 NONE                9  -1",
]
AXES = [
    "        18    0    0    0 NONE                 NONE                ",
    "        12    0    0    0 NONE                 NONE                ",
    "        13    0    0    0 NONE                 NONE                ",
    "         0    0    0    0 NONE                 NONE                ",
]


def form(kind, count, even, first=0.0, step=0.0):
    return f"{kind:10d}{count:10d}{even:10d}{first:13.5E}{step:13.5E}{0.0:13.5E}"


def saved(folder, data):
    file = folder / "rig.uff"
    file.write_bytes(data if isinstance(data, bytes) else data.encode())
    return file


def binary(
    kind, values, *, x=None, order=1, says=None, end="\n", before="", size=None, x_size=None, count=None, single="f4"
):
    """A set 58b as a program might write it: bytes in `order` that the identifier calls `says`."""
    mark = "<" if order == 1 else ">"
    y = np.asarray(values)
    real = np.stack([y.real, y.imag], axis=1) if kind in (5, 6) else y.real[:, None]
    width = "f8" if kind in (4, 6) else single
    rows = [("y", mark + width, (real.shape[1],))]
    if x is not None:
        rows.insert(0, ("x", mark + (x_size or width)))
    table = np.zeros(len(y), dtype=rows)
    table["y"] = real
    if x is not None:
        table["x"] = x
    data = table.tobytes()
    number = size if size is not None else len(data)
    identifier = f"{58:6d}b{says or order:6d}{2:6d}{11:12d}{number:12d}{0:6d}{0:6d}{0:12d}{0:12d}"
    spacing = (0.0, 0.0) if x is not None else (10.0, 0.5)
    header = [*HEADER, form(kind, len(y) if count is None else count, int(x is None), *spacing), *AXES]
    text = end.join(["    -1", identifier, *header]) + end
    return text.encode() + data + f"{before}    -1{end}".encode()


VALUES = np.array([1e-6 - 2e-6j, 3.5e-7 + 1e-8j, -4e-9 + 0.25j, 10.0 - 13.0j, 0.1 + 2.6e-3j])
UNEVEN = np.array([1.0, 2.0, 4.0, 8.0, 16.0])

SHAPE = """    -1
    55
NONE
NONE
NONE
NONE
NONE
         1         2         2         8         2         3
         2         4         1         1
  25.0  1.0  0.01  0.0
         1
  1.0  2.0  3.0
         2
  9.0    2.0  3.0
    -1
"""


@pytest.mark.parametrize("kind", [2, 4, 5, 6])
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("uneven", [False, True])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_binary_functions_of_either_byte_order_and_precision_are_read(tmp_path, kind, order, uneven, end):
    x = UNEVEN if uneven else None
    file = read_universal(saved(tmp_path, binary(kind, VALUES, x=x, order=order, end=end)))
    (found,) = file.functions
    expected = VALUES if kind in (5, 6) else VALUES.real
    np.testing.assert_allclose(found.values, expected, rtol=1e-6 if kind in (2, 5) else 0.0)
    np.testing.assert_allclose(found.x, UNEVEN if uneven else 10.0 + 0.5 * np.arange(5))
    assert (found.response, found.reference) == ((7, 3), (9, -1))


@pytest.mark.parametrize(
    "wound",
    [
        {"before": "\r\n"},
        {"before": "\n"},
        {"size": 0},
        {"size": 20},
        {"size": 10**11},
        {"x": UNEVEN, "x_size": "f4"},
        {"order": 2, "says": 1},
        {"order": 1, "says": 2, "x": UNEVEN},
    ],
    ids=[
        "CR LF before the end",
        "LF before the end",
        "no size",
        "half the size",
        "any size",
        "single abscissa",
        "swapped",
        "swapped back",
    ],
)
def test_binary_functions_with_known_wounds_are_read_right(tmp_path, wound):
    data = binary(6, VALUES, **wound)
    file = read_universal(saved(tmp_path, units_set(Units()) + data + data))
    for found in file.functions:
        np.testing.assert_array_equal(found.values, VALUES)
    assert len(file.functions) == 2
    assert any("byte order" in note for note in file.notes) == ("says" in wound)


def test_a_closing_line_inside_of_binary_data_closes_nothing(tmp_path):
    values = np.array([*range(1, 12), struct.unpack("<d", b"\n    -1\n")[0], 13.0])
    (found,) = read_universal(saved(tmp_path, binary(4, values))).functions
    np.testing.assert_array_equal(found.values, values)


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (binary(6, VALUES)[:-20], "not closed by -1: the file is cut"),
        (binary(6, VALUES, count=9), "the set is cut"),
        (binary(6, VALUES, count=0), "no values"),
        (binary(2, np.array([np.nan, np.inf, 1.0])), "damaged"),
        (binary(6, VALUES).replace(b"     2          11", b"     1          11"), "DEC VMS"),
        ("    -1\n    58\nNONE\n    -1\n", "eleven header lines"),
        ("    -1\n    15\n    -1\n", "the set has no nodes"),
        ("    -1\n    55\n    -1\n", "eight header lines"),
        ("    -1\n    15\n         1         0         0         1  1.0 2.0\n    -1\n", "6 numbers"),
        ("    -1\n    15\n         1         0         0         1  nan 2.0 3.0\n    -1\n", "numbers"),
        ("    -1\n    82\n         1         3         0\nNONE\n         1         2\n    -1\n", "3 nodes"),
        ("    -1\n    82\n    -1\n", "a trace line"),
        ("    -1\n   164\n    -1\n", "units code"),
        ("    -1\n   164\n         1     SI: Meter        2\n    0.0    1.0    1.0    0.0\n    -1\n", "above 0"),
        ("    -1\n   164\n         1     SI: Meter        2\n    1e3    1e3    1.0    0.0\n    -1\n", "correct one"),
        ("    -1\n    82\n         1         2         0\nNONE\n         1     1e999\n    -1\n", "numbers"),
        ("    -1\n    82\n      1e15         2         0\nNONE\n         1         2\n    -1\n", "2 whole numbers"),
        ("    -1\n    15\n     1e300         0         0         1  1.0 2.0 3.0\n    -1\n", "numbers"),
        (binary(6, VALUES).replace(b"         6         5 ", b"         6       5.5 "), "number of values"),
        (SHAPE.replace("         2\n", "         1\n"), "node 1 again"),
        (SHAPE.replace("  9.0  ", "  1e999"), "numbers"),
        ("hello\n", "a line with -1"),
        ("    -1\nhello\n    -1\n", "number of a dataset"),
        ("    -1\n    15\n         1         0\n", "the file is cut"),
        ("", "it has none"),
        ("    -1\n    -1\n", "it has none"),
    ],
)
def test_what_can_not_be_meant_gets_one_sentence_with_its_line(tmp_path, data, text):
    with pytest.raises(ModelError, match=re.escape(text)):
        read_universal(saved(tmp_path, data))


def test_coordinates_of_minus_one_close_nothing_and_empty_sets_are_passed_over(tmp_path):
    text = (
        "    -1\n    -1\n    15\n"
        "         1         0         0         1 -1.00000E+00-1.00000E+00-1.00000E+00\n"
        "         2         0         0         1           -1           -1    -1\n"
        "    -1       0         0         1           -1           2D0    1.5-001\n"
        "    -1\n"
    )
    nodes = read_universal(saved(tmp_path, text)).nodes
    assert nodes is not None
    np.testing.assert_array_equal(nodes.numbers, [1, 2, -1])
    np.testing.assert_allclose(nodes.positions, [[-1, -1, -1], [-1, -1, -1], [-1, 2, 0.15]])


def test_lengths_and_forces_of_the_file_become_metres_and_newtons(tmp_path):
    units = Units(1e3, 1e3, "MM", 5)
    nodes = Nodes(np.array([1]), np.array([[250.0, 0.0, -12.5]]), np.zeros(1, int), np.zeros(1, int))
    function = Function(4, (1, 1), (1, 1), np.array([1.0, 2.0]), np.array([2.0 + 1j, 1.0]), 18, 8, 13)
    file = read_universal(saved(tmp_path, units_set(units) + nodes_set(nodes) + function_set(function)))
    np.testing.assert_allclose(file.nodes.positions, [[0.25, 0.0, -0.0125]])
    np.testing.assert_allclose(file.functions[0].values, function.values)  # mm/mN is m/N
    plain = read_universal(saved(tmp_path, function_set(function)))
    assert any("states no units" in note for note in plain.notes)
    labelled = function_set(Function(4, (1, 1), (1, 1), np.array([1.0, 2.0]), np.array([2.0, 1.0]), 18, 12, 13))
    labelled = labelled.replace(
        b"        12    0    0    0 NONE                 NONE ", b"        12    0    0    0 Acceleration         g    "
    )
    np.testing.assert_allclose(read_universal(saved(tmp_path, labelled)).functions[0].values, [2 * 9.80665, 9.80665])


def test_rows_that_are_filled_up_with_zeros_end_where_the_header_says(tmp_path):
    rows = "  5.00000e+00  9.93003e-01 -1.08420e-19  5.03501e+00  1.00135e+00  0.00000e+00\n" + "".join(
        ["  1.00000e+02  8.03837e-01  0.00000e+00  0.00000e+00  0.00000e+00  0.00000e+00\n"]
    )
    text = "\n".join(["    -1", "    58", *HEADER, form(5, 3, 0), *AXES]) + "\n" + rows + "    -1\n"
    (found,) = read_universal(saved(tmp_path, text)).functions
    np.testing.assert_allclose(found.x, [5.0, 5.03501, 100.0])
    np.testing.assert_allclose(found.values.real, [0.993003, 1.00135, 0.803837])


def test_what_is_written_reads_the_same_here_and_in_pyuff(tmp_path):
    pyuff = pytest.importorskip("pyuff")
    line = TraceLine(3, "shaft", np.arange(1, 301))
    sets = [units_set(Units()), *line_sets(line)]
    for x in (np.linspace(3.0, 30.0, 10), np.geomspace(1.0, 77.0, 10)):
        for y in (np.sin(x), np.exp(1j * x) * 1e-9):
            sets += [function_set(Function(4, (1, 2), (3, -1), x, y), binary=binary) for binary in (False, True)]
    file = saved(tmp_path, b"".join(sets))
    mine = read_universal(file)
    theirs = pyuff.UFF(str(file)).read_sets()
    assert [part["type"] for part in theirs] == [164, 82, 82] + [58] * 8
    joined = np.concatenate([mine.lines[0].nodes, mine.lines[1].nodes[1:]])
    np.testing.assert_array_equal(joined, line.nodes)
    np.testing.assert_array_equal(theirs[1]["nodes"], mine.lines[0].nodes)
    for own, other in zip(mine.functions, theirs[3:], strict=True):
        np.testing.assert_allclose(own.values, other["data"], rtol=1e-12)
        np.testing.assert_allclose(own.x, other["x"], rtol=1e-12)
        assert own.response == (other["rsp_node"], other["rsp_dir"])
        assert own.reference == (other["ref_node"], other["ref_dir"])


def published_58b(data: bytes) -> list[tuple[np.ndarray, np.ndarray]]:
    """Abscissa and ordinates of the sets 58b, by nothing but the published records: eleven lines, then so many bytes."""
    found = []
    at = 0
    while (start := data.find(b"\n    58b", at)) >= 0:
        lines = data[start + 1 :].split(b"\n", 12)[:12]
        order, form_, ascii_lines, size = (int(lines[0][a:b]) for a, b in ((7, 13), (13, 19), (19, 31), (31, 43)))
        assert (form_, ascii_lines) == (2, 11)
        kind, count, even = (int(lines[7][10 * k : 10 * k + 10]) for k in range(3))
        first, step = (float(lines[7][30 + 13 * k : 43 + 13 * k]) for k in range(2))
        body = start + 1 + sum(len(line) + 1 for line in lines)
        mark = "<" if order == 1 else ">"
        values = np.array(struct.unpack(f"{mark}{size // 8}d", data[body : body + size]))
        assert data[body + size : body + size + 7] == b"    -1\n"
        table = values.reshape(count, -1)
        x = first + step * np.arange(count) if even else table[:, 0]
        found.append((x, table[:, -2] + 1j * table[:, -1] if kind == 6 else table[:, -1]))
        at = body + size
    return found


def test_an_independent_reader_of_the_published_layout_reads_frequency_responses(tmp_path):
    model = rg.load(MODELS / "geared_pair.toml")
    for fmax, even in ((40.0, True), (39.87654321, False)):
        result = rg.frf(
            model, inputs=["gears.pinion:x"], outputs=["gears.wheel:y", "gears.pinion:x"], fmax=fmax, points=8, elements=1,
            modal_damping=0.01,
        )  # fmt: skip
        file = rg.write_uff(result, tmp_path / "rig.uff", binary=True)
        functions = published_58b(file.read_bytes())
        for o, (x, values) in enumerate(functions):
            np.testing.assert_allclose(x, result.frequency_hz, rtol=1e-12 if even else 1e-15)
            np.testing.assert_array_equal(values, result.receptance[:, o, 0])
        back = read_universal(file)
        assert [function.response for function in back.functions] == [(2, 2), (1, 1)]


def test_order_functions_of_a_run_up_stand_at_the_nodes_of_its_points(tmp_path):
    model = rg.load(MODELS / "split_torque.toml")
    result = rg.response(model, points=5, start="1000 rpm", stop="3000 rpm", elements=1, modal_damping=0.02)
    if not result.points:
        with pytest.raises(rg.AnalysisError, match="points"):
            rg.write_uff(result, tmp_path / "orders.uff")
        model = model.with_("points", {"left": {"on": "bearings.input_left", "direction": "y"}})
        result = rg.response(model, points=5, start="1000 rpm", stop="3000 rpm", elements=1, modal_damping=0.02)
    file = read_universal(rg.write_uff(result, tmp_path / "orders.uff"))
    assert len(file.functions) == len(result.orders) * len(result.points)
    for k, function in enumerate(file.functions[: len(result.orders)]):
        assert (function.kind, function.x_type, function.numerator) == (27, 19, 12)
        assert function.z == pytest.approx(result.ratio[k], rel=1e-5)
        np.testing.assert_allclose(function.x, result.speed_rpm, rtol=1e-5)
        np.testing.assert_allclose(function.values, result.acceleration[k, :, 0], rtol=1e-11)


def labelled(kind, label, reference=0, under="NONE"):
    """A frequency response of ones whose axes have these types and units."""
    axes = list(AXES)
    axes[1] = f"{kind:10d}    0    0    0 {'NONE':20s} {label:20s}"
    axes[2] = f"{reference:10d}    0    0    0 {'NONE':20s} {under:20s}"
    return "\n".join(
        ["    -1", "    58", *HEADER, form(5, 2, 1, 10.0, 0.5), *axes, "  1.0  0.0  1.0  0.0", "    -1", ""]
    )


@pytest.mark.parametrize("kind", [0, 1])
@pytest.mark.parametrize(
    ("label", "under", "read", "factor"),
    [
        ("m/s2", "N", ACCELERATION, 1.0),
        ("m/s^2", "NONE", ACCELERATION, 1.0),
        ("m/s**2", "kN", ACCELERATION, 1e-3),
        ("m/sec2", "N", ACCELERATION, 1.0),
        ("g", "N", ACCELERATION, 9.80665),
        ("(m/s²)/N", "NONE", ACCELERATION, 1.0),
        ("g/lbf", "NONE", ACCELERATION, 9.80665 / 4.4482216152605),
        ("mm/s", "N", VELOCITY, 1e-3),
        ("um / N", "NONE", DISPLACEMENT, 1e-6),
    ],
)
def test_a_function_of_unknown_type_is_what_its_unit_says(tmp_path, kind, label, under, read, factor):
    file = read_universal(saved(tmp_path, labelled(kind, label, kind, under).encode()))
    (function,) = file.functions
    assert (function.numerator, function.denominator) == (read, FORCE)
    np.testing.assert_allclose(function.values, factor, rtol=1e-12)
    assert any(f"type {kind}" in note and "says" in note for note in file.notes)


def test_a_function_that_nothing_names_is_what_the_caller_says_in_the_units_of_the_file(tmp_path):
    units = units_set(Units(1e3, 1.0, "mm, N", 9)).decode()
    path = saved(tmp_path, (units + labelled(0, "NONE")).encode())
    assert read_universal(path).functions[0].numerator == 0
    (function,) = read_universal(path, VELOCITY).functions
    assert function.numerator == VELOCITY
    np.testing.assert_allclose(function.values, 1e-3, rtol=1e-12)
    # What the file says is not overruled.
    (said,) = read_universal(saved(tmp_path, (units + labelled(1, "g")).encode()), VELOCITY).functions
    assert said.numerator == ACCELERATION
