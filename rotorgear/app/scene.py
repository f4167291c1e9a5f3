"""What the turntable of the page is told: solids, the motion of a mode, and how parts are coloured."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.export.solids import LIGHT, Solids, build_solids
from rotorgear.page.turntable import geometry, motion
from rotorgear.results.modal import ModalResult

COLOURINGS = {
    "displacement": "displacement",
    "kinetic": "kinetic energy by part",
    "strain": "strain energy by part",
    "parts": "kinds of parts",
}
# Light for nothing, dark for the most; other than the colours of displacement, which a casing may show at the same time.
_LOW = np.array([236.0, 238.0, 242.0])
_HIGH = np.array([125.0, 20.0, 75.0])


class View:
    """The solids of a result, and what of them travels to the browser."""

    def __init__(self, result: ModalResult) -> None:
        self.result = result
        self.solids: Solids = build_solids(result.model, result.nodes, LIGHT)

    @property
    def geometry(self) -> dict[str, Any]:
        """Surfaces at rest."""
        return geometry(self.solids)

    def motion(self, mode: int) -> dict[str, Any]:
        """Displacements of a mode, counted from 0."""
        shape = self.result.shapes[:, :, mode]
        return motion(self.solids, shape if self.result.speed is not None else np.real(shape))

    def shares(self, mode: int, kind: str) -> dict[str, float]:
        """Share of each part in the kinetic or strain energy of a mode, the largest first."""
        energy = self.result.kinetic_energy if kind == "kinetic" else self.result.strain_energy
        shares = {part: float(values[mode]) for part, values in energy.items()}
        return dict(sorted(shares.items(), key=lambda item: -item[1]))

    def colours(self, mode: int, kind: str) -> list[list[int]]:
        """Red, green and blue of each solid by its share in an energy, over the largest of all parts."""
        shares = self.shares(mode, kind)
        most = max(shares.values(), default=0.0) or 1.0
        level = np.array([[shares.get(name, 0.0) / most] for name in self.solids.part_names])
        found: list[list[int]] = np.round(_LOW + level * (_HIGH - _LOW)).astype(int).tolist()
        return found
