"""Results as a universal file (UFF), which modal-test programs read: units, nodes, lines of the shafts, and what was computed.

Modes become shapes (dataset 55), frequency responses functions (58), run-ups order functions (58) of the named points.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rotorgear.analysis.common.points import coordinates, located, point_node
from rotorgear.errors import AnalysisError
from rotorgear.export.attachment import in_space
from rotorgear.files.write import written
from rotorgear.model.model import Model
from rotorgear.model.parts.shaft import Place
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.frequency_response import FrequencyResponse
from rotorgear.results.modal import ModalResult, NodeTable
from rotorgear.results.response import ResponseResult
from rotorgear.uff import datasets
from rotorgear.uff.write import function_set, line_sets, nodes_set, shape_set, units_set

_TRANSLATIONS = 3


def write_uff(
    result: ModalResult | FrequencyResponse | ResponseResult,
    path: str | Path,
    *,
    modes: Sequence[int] | None = None,
    rotations: bool | None = None,
    binary: bool = False,
) -> Path:
    """Write nodes and shapes, frequency responses or order functions to a universal file, in SI.

    Undamped modes are real, those at a speed complex; displacements in m and rotations in rad, scaled as in the result. Nodes
    have their number in the result, from 1; those of a frequency response are its places in their order.

    Args:
        result: of `modal`, `frf` or `response`.
        path: of the file, such as "modes.unv".
        modes: numbers of the modes, from 0; None: all.
        rotations: whether shapes have rotations beside displacements; None: normal modes do, complex ones do not, since many
            programs read three complex displacements only.
        binary: functions as bytes (dataset 58b) in place of text.

    Raises:
        AnalysisError: a mode that the result has not; modes of a result without.
        WriteError: the file can't be written.
    """
    if isinstance(result, ModalResult):
        sets = _modes(result, modes, rotations)
    elif modes is not None or rotations is not None:
        raise AnalysisError("modes and rotations belong to shapes: the result has none")
    elif isinstance(result, FrequencyResponse):
        sets = _responses(result, binary)
    else:
        sets = _order_functions(result, binary)
    with written(path) as scratch:
        scratch.write_bytes(b"".join([units_set(datasets.Units()), *sets]))
    return Path(path)


def _modes(result: ModalResult, modes: Sequence[int] | None, rotations: bool | None) -> list[bytes]:
    result.nodes.require()
    count = len(result.eigenvalues)
    is_complex = result.speed is not None
    six = not is_complex if rotations is None else rotations
    numbers = np.arange(1, len(result.nodes.shaft) + 1)
    sets = _geometry(result.nodes)
    for k in range(count) if modes is None else modes:
        if not 0 <= k < count:
            raise AnalysisError(f"modes: got {k}, expected numbers from 0 to {count - 1}")
        s = complex(result.eigenvalues[k])
        hz = abs(s) / (2.0 * np.pi)
        damping = -s.real / abs(s) if abs(s) else 0.0
        values = in_space(result.model, result.nodes, result.shapes[:, :, k])[:, : 6 if six else _TRANSLATIONS]
        title = f"mode {k + 1}, {hz:.6g} Hz, damping ratio {damping:.6g}"
        names = (result.model.title or "rotorgear", title, result.description[k], "rotorgear")
        shape = values if is_complex else np.real(values)
        sets.append(shape_set(datasets.Shape(hz, damping, s if is_complex else None, numbers, shape, names, k + 1)))
    return sets


def _geometry(nodes: NodeTable) -> list[bytes]:
    """Nodes, and a line along each shaft. Both coordinate systems of a node are the global one; colours tell shafts apart."""
    shafts = list(dict.fromkeys(nodes.shaft))
    count = len(nodes.shaft)
    colours = np.array([shafts.index(name) + 1 for name in nodes.shaft])
    sets = [nodes_set(datasets.Nodes(np.arange(1, count + 1), nodes.position, np.zeros(count, dtype=int), colours))]
    for number, name in enumerate((name for name in shafts if name), start=1):
        along = nodes.on_shaft(name) + 1
        if len(along) > 1:
            sets += line_sets(datasets.TraceLine(number, name, along))
    return sets


def _responses(result: FrequencyResponse, binary: bool) -> list[bytes]:
    texts = list(dict.fromkeys((*result.inputs, *result.outputs)))
    _require_plain_axes(result.model, texts)
    places = [(tuple(place.tolist()), dof) for place, dof in (coordinates(result.model, text) for text in texts)]
    # Several directions of one place are one node.
    spots = list(dict.fromkeys(place for place, _ in places))
    freedom = {text: (spots.index(place) + 1, dof + 1) for text, (place, dof) in zip(texts, places, strict=True)}
    zeros = np.zeros(len(spots), dtype=int)
    sets = [nodes_set(datasets.Nodes(np.arange(1, len(spots) + 1), np.array(spots), zeros, zeros + 1))]
    title = result.model.title or "rotorgear"
    axes = (datasets.FREQUENCY, datasets.DISPLACEMENT, datasets.FORCE)
    for i, reference in enumerate(result.inputs):
        for o, response in enumerate(result.outputs):
            ends = (freedom[response], freedom[reference])
            names = (f"{response} over {reference}", title, "rotorgear")
            values = result.receptance[:, o, i]
            kind = datasets.FREQUENCY_RESPONSE
            function = datasets.Function(kind, *ends, result.frequency_hz, values, *axes, names=names)
            sets.append(function_set(function, binary=binary))
    return sets


def _order_functions(result: ResponseResult, binary: bool) -> list[bytes]:
    if not result.points:
        raise AnalysisError("order functions are those of named points, and the model has none: give it [points]")
    _require_plain_axes(result.model, result.points)
    sets = _geometry(result.nodes)
    x = result.speeds * RPM_PER_RAD_S
    for k, name in enumerate(result.points):
        node, direction = point_node(result.model, result.nodes, name)
        for at, (order, ratio) in enumerate(zip(result.orders, result.ratio, strict=True)):
            y = result.acceleration[at, :, k]
            names = (f"{name}, {order}", result.model.title or "rotorgear", "rotorgear")
            # Over rpm, with the number of the order on the third axis.
            axes = (datasets.RPM, datasets.ACCELERATION, 0, float(ratio), names, datasets.ORDER)
            function = datasets.Function(datasets.ORDER_FUNCTION, (node + 1, direction + 1), (0, 0), x, y, *axes)
            sets.append(function_set(function, binary=binary))
    return sets


def _require_plain_axes(model: Model, places: Sequence[str]) -> None:
    """AnalysisError where the direction of a place is not along an axis of the model, as those of a universal file are."""
    for text in places:
        _, where, _ = located(model, text)
        if isinstance(where, Place) and model.shafts[where.shaft].frame.is_turned:
            raise AnalysisError(
                f"'{text}' looks along the axes of shaft '{where.shaft}', and functions of a universal file along those of the "
                "model: leave that place out, or save the result as CSV or HDF5"
            )
