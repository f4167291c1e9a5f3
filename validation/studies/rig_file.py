"""The measurement of docs/rig.md, models/split_torque_shapes.uff: computed shapes of a gearbox whose stiffnesses are known.

    rotorgear sensors models/split_torque.toml --count 12 --candidates "bearings.*" --output sensors.csv
    python -m validation.studies.rig_file sensors.csv models/split_torque_shapes.uff

Stiffnesses of split_torque.toml times exp(0.15 N(0, 1)), frequencies with an error of 0.3 %, shapes with one of 2 % of their root
mean square, and the fifth sensor mounted the wrong way round.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np

import rotorgear as rg
from rotorgear.model.numbers import free_numbers
from rotorgear.uff.datasets import Nodes, Shape, Units
from rotorgear.uff.write import nodes_set, shape_set, units_set

TURNED = 4


def measurement(sensors: Path) -> bytes:
    """Return a universal file with the elastic modes up to 560 Hz at the places of a table of sensors."""
    random = np.random.default_rng(12)
    numbers = free_numbers(rg.load("models/split_torque.toml"), "bearings.*.stiffness, meshes.*.stiffness")
    modes = rg.modal(numbers.at(0.15 * random.standard_normal(len(numbers.addresses))), fmax=560.0)
    with sensors.open(encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    nodes = {int(row["node"]): row for row in table}
    places = np.array([[float(row[f"{axis}_mm"]) / 1e3 for axis in "xyz"] for row in nodes.values()])
    ids, zero = np.array(list(nodes)), np.zeros(len(nodes), int)
    sets = [units_set(Units()), nodes_set(Nodes(ids, places, zero, zero))]
    for k in np.flatnonzero(~modes.rigid):
        values = np.zeros((len(nodes), 3))
        for i, row in enumerate(table):
            at = modes.nodes.nearest(*modes.model.layout.place(row["point"]))
            axis = "xyz".index(row["direction"])
            values[int(row["node"]) - 1, axis] = modes.shapes[at, axis, k].real * (-1.0 if i == TURNED else 1.0)
        size = np.sqrt(np.sum(values**2) / len(table))
        values += (values != 0.0) * 0.02 * size * random.standard_normal(values.shape)
        hz = modes.frequency_hz[k] * np.exp(0.003 * random.standard_normal())
        sets.append(shape_set(Shape(float(hz), 0.01, None, ids, values)))
    return b"".join(sets)


if __name__ == "__main__":
    Path(sys.argv[2]).write_bytes(measurement(Path(sys.argv[1])))
