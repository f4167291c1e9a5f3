"""The turntable of pages: surfaces and mode shapes packed small enough to travel to a browser.

The same solids as those of ParaView files and rendered pictures, as triangles; coordinates and displacements are whole numbers of
16 bits over their range, which is finer than a pixel. `turntable.js` shows them.
"""

from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np

from rotorgear.export.solids import LIGHT, Solids, build_solids
from rotorgear.results.modal import ModalResult

_MODES = 6
_LARGEST = 900_000  # letters of all shapes together: fewer modes of a large model
_STEPS = 32767
# Colours of parts by their kind.
KIND_COLOURS = {
    "shaft": "#8d99a6",
    "stripe": "#6f7b88",
    "gear": "#c9a25b",
    "disk": "#a7b5a0",
    "point mass": "#a7b5a0",
    "bearing": "#4f7fb5",
    "support": "#7a6fa8",
    "coupling": "#7a6fa8",
    "casing": "#c8cdd3",
}


def scene(result: ModalResult, most: int = _MODES, largest: int = _LARGEST) -> str:
    """The scene of a report as JSON: the solids, and displacements of the first elastic modes, in so many letters at most."""
    solids = build_solids(result.model, result.nodes, LIGHT)
    packed = geometry(solids)
    modes = []
    for k in [k for k in range(len(result)) if not result.rigid[k]]:
        modes.append({"name": mode_name(result, k), **motion(solids, np.real(result.shapes[:, :, k]))})
        if len(modes) == max(1, min(most, largest // len(packed["points"]))):
            break
    # A name must not end the script that holds it.
    return json.dumps({**packed, "modes": modes}).replace("<", "\\u003c")


def mode_name(result: ModalResult, k: int) -> str:
    """Number, frequency and description of a mode."""
    return f"{k + 1}: {result.frequency_hz[k]:.2f} Hz, {result.description[k]}"


def geometry(solids: Solids) -> dict[str, Any]:
    """Points, triangles, of which the first `solid` corners are of what one does not see through, and the part of each point."""
    quads = solids.quads
    halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]], solids.triangles])
    cells = np.concatenate(
        [np.arange(len(quads)), np.arange(len(quads)), len(quads) + np.arange(len(solids.triangles))]
    )
    glass = solids.kind[cells] == solids.kind_names.index("casing")
    owner = np.zeros(len(solids.points), dtype="<u2")
    owner[halves] = solids.part[cells][:, None]
    kind = np.zeros(len(solids.part_names), dtype=int)
    kind[solids.part] = solids.kind
    middle = 0.5 * (solids.points.min(axis=0) + solids.points.max(axis=0))
    points, size = _packed((solids.points - middle) / solids.size)
    return {
        "points": points,
        "size": size,
        "triangles": _text(np.concatenate([halves[~glass], halves[glass]]).astype("<u4")),
        "solid": 3 * int(np.count_nonzero(~glass)),
        "owner": _text(owner),
        "parts": list(solids.part_names),
        "colours": [list(bytes.fromhex(KIND_COLOURS[solids.kind_names[k]][1:])) for k in kind],
    }


def motion(solids: Solids, shape: np.ndarray) -> dict[str, Any]:
    """Displacements of all points in a mode (p, 6): `shape` at phase 0, and `late` a quarter period before, if any."""
    moved, _ = solids.scaled(shape)
    both = np.stack([np.real(moved), np.imag(moved)]) / solids.size
    step = float(np.abs(both).max(initial=0.0)) / _STEPS or 1.0
    now, late = (_text(np.round(one / step).astype("<i2")) for one in both)
    return {"scale": step, "shape": now, **({"late": late} if np.any(both[1]) else {})}


def _packed(values: np.ndarray) -> tuple[str, float]:
    """Values as base64 of 16-bit whole numbers, and what one of them is."""
    step = float(np.abs(values).max(initial=0.0)) / _STEPS or 1.0
    return _text(np.round(values / step).astype("<i2")), step


def _text(values: np.ndarray) -> str:
    return base64.b64encode(values.tobytes()).decode("ascii")
