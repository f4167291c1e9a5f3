"""The gearbox as solids: every part's surface as plain arrays, and how its points follow the nodes (see attachment.py)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.export.attachment import Attachment, Skeleton, join_attachments
from rotorgear.export.layout import display_frames
from rotorgear.export.parts import FINE, LIGHT, Detail, part_surfaces
from rotorgear.export.surface import join
from rotorgear.model.model import Model
from rotorgear.results.modal import NodeTable

KINDS = ("shaft", "stripe", "gear", "disk", "point mass", "bearing", "support", "coupling", "casing")
# Largest displacement shown, as a share of the size of the model, and largest rotation in rad.
DEFAULT_AMPLITUDE = 0.05
LARGEST_TURN = 0.3


@dataclass(frozen=True)
class Solids:
    """Surfaces of all parts of a model; P points, C cells: first the quadrangles, then the triangles.

    Attributes:
        points: (P, 3) in m, where they are shown undeformed.
        quads: (Q, 4) numbers of the corners, counter-clockwise from outside.
        triangles: (T, 3) likewise.
        part: (C,) number of each cell's part among the names.
        kind: (C,) likewise of its kind.
        shaft: (C,) likewise of its shaft; -1 for a casing.
        part_names: addresses such as "gears.pinion".
        kind_names: names of the kinds.
        shaft_names: names of the shafts.
        attachment: what carries each point.
        node_positions: (p, 3) where the nodes are shown.
        axes: (s, 3, 3) directions of the shafts in space, in columns; None where all are those of the model.
    """

    points: np.ndarray
    quads: np.ndarray
    triangles: np.ndarray
    part: np.ndarray
    kind: np.ndarray
    shaft: np.ndarray
    part_names: tuple[str, ...]
    kind_names: tuple[str, ...]
    shaft_names: tuple[str, ...]
    attachment: Attachment
    node_positions: np.ndarray
    axes: np.ndarray | None = None

    @property
    def size(self) -> float:
        """Diagonal of the box around everything in m."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    def displacement(self, shape: np.ndarray) -> np.ndarray:
        """Displacements (P, 3) of all points in space from those of the nodes (p, 6), real or complex, in m and rad."""
        moved = self.attachment.displacement(shape)
        if self.axes is None:
            return moved
        turned = self.attachment.frame >= 0
        moved[turned] = np.einsum("pij,pj->pi", self.axes[self.attachment.frame[turned]], moved[turned])
        return moved

    def scaled(self, shape: np.ndarray, amplitude: float | None = None) -> tuple[np.ndarray, float]:
        """Displacements (P, 3) large enough to be seen, and the factor on those of the nodes (p, 6); 1 if nothing moves.

        The largest becomes `amplitude` times the size of the model; for None 0.05, or less where a rotation would exceed 0.3 rad:
        u + theta x r swells a body by sqrt(1 + theta^2).
        """
        raw = self.displacement(shape)
        largest = _largest(raw)
        if largest == 0.0:
            return raw, 1.0
        scale = (amplitude or DEFAULT_AMPLITUDE) * self.size / largest
        turn = _largest(shape[:, 3:])
        if amplitude is None and turn * scale > LARGEST_TURN:
            scale = LARGEST_TURN / turn
        return scale * raw, scale


def _largest(vectors: np.ndarray) -> float:
    """Largest length of real or complex vectors (k, 3)."""
    return float(np.sqrt(np.max(np.sum(np.abs(vectors) ** 2, axis=1), initial=0.0)))


def build_solids(model: Model, nodes: NodeTable, detail: Detail = LIGHT) -> Solids:
    """Return the surfaces of all parts of a model with the nodes of one of its results; AnalysisError where that has none."""
    nodes.require()
    frames = display_frames(model)
    skeleton = Skeleton(model, nodes, frames)
    parts = list(part_surfaces(model, skeleton, detail))
    surface = join([part.surface for part in parts])
    part_names = tuple(dict.fromkeys(part.part for part in parts))
    shaft_names = tuple(model.shafts)
    # Cells are the quadrangles of all parts, then their triangles.
    counts = [len(part.surface.quads) for part in parts] + [len(part.surface.triangles) for part in parts]

    def by_cell(numbers: list[int]) -> np.ndarray:
        return np.repeat(np.array(numbers * 2, dtype=np.int16), counts)

    return Solids(
        points=surface.points,
        quads=surface.quads,
        triangles=surface.triangles,
        part=by_cell([part_names.index(part.part) for part in parts]),
        kind=by_cell([KINDS.index(part.kind) for part in parts]),
        shaft=by_cell([shaft_names.index(part.shaft) if part.shaft else -1 for part in parts]),
        part_names=part_names,
        kind_names=KINDS,
        shaft_names=shaft_names,
        attachment=join_attachments([part.attachment for part in parts]),
        node_positions=skeleton.positions(),
        axes=np.array([frame.axes for frame in frames.values()])
        if any(frame.is_turned for frame in frames.values())
        else None,
    )


__all__ = ["DEFAULT_AMPLITUDE", "FINE", "KINDS", "LARGEST_TURN", "LIGHT", "Detail", "Solids", "build_solids"]
