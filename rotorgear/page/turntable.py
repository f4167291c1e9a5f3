"""The turntable of the page: surfaces and mode shapes packed small enough to travel inside it.

The same solids as those of ParaView files and rendered pictures, as triangles; coordinates and displacements are whole numbers of
16 bits over their range, which is finer than a pixel.
"""

from __future__ import annotations

import base64
import json

import numpy as np

from rotorgear.export.solids import LIGHT, build_solids
from rotorgear.results.modal import ModalResult

_MODES = 6
_LARGEST = 900_000  # letters of all shapes together: fewer modes of a large model
_STEPS = 32767


def scene(result: ModalResult) -> str:
    """The scene as JSON: points, triangles, and real displacements of the first elastic modes at phase 0."""
    solids = build_solids(result.model, result.nodes, LIGHT)
    quads = solids.quads
    halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]], solids.triangles])
    middle = 0.5 * (solids.points.min(axis=0) + solids.points.max(axis=0))
    points, size = _packed((solids.points - middle) / solids.size)
    modes = []
    for k in [k for k in range(len(result)) if not result.rigid[k]][: max(1, min(_MODES, _LARGEST // len(points)))]:
        moved, _ = solids.scaled(np.real(result.shapes[:, :, k]))
        shape, scale = _packed(np.real(moved) / solids.size)
        name = f"{k + 1}: {result.frequency_hz[k]:.2f} Hz, {result.description[k]}"
        modes.append({"name": name, "scale": scale, "shape": shape})
    triangles = base64.b64encode(halves.astype("<u4").tobytes()).decode("ascii")
    data = {"points": points, "size": size, "triangles": triangles, "modes": modes}
    return json.dumps(data).replace("<", "\\u003c")  # a name must not end the script that holds it


def _packed(values: np.ndarray) -> tuple[str, float]:
    """Values as base64 of 16-bit whole numbers, and what one of them is."""
    step = float(np.abs(values).max(initial=0.0)) / _STEPS or 1.0
    return base64.b64encode(np.round(values / step).astype("<i2").tobytes()).decode("ascii"), step
