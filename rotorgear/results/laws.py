"""Operating points of force laws: what a linear analysis is linear about, and what statics finds."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from rotorgear.model.layout.state import OperatingPoint, State
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, of
from rotorgear.results.table import Block, grid, written


class LawRow(Record):
    """Operating point of a bearing or nonlinear element: where its force law stands in the static equilibrium."""

    part: str = of("bearing or nonlinear element")
    speed: float | None = of("speed of the reference shaft", "rad/s", default=None, kw_only=True)
    force: np.ndarray = of(
        "force of the shaft on it", "N and N m", "component", note=" along its displacements", json="force"
    )
    displacement: np.ndarray = of("displacement of the shaft against it", "m and rad", "component")
    stiffness: np.ndarray = of("tangent stiffness", "SI", "component", "displacement")
    damping: np.ndarray = of("tangent damping", "SI", "component", "velocity")
    averaged: bool = of("whether these are means over a pitch of its rolling elements")

    @property
    def load(self) -> float:
        """Force across the shaft (N)."""
        return float(np.linalg.norm(self.force[self._across]))

    @property
    def deflection(self) -> float:
        """Displacement across the shaft (m): of a journal, its eccentricity."""
        return float(np.linalg.norm(self.displacement[self._across]))

    @property
    def along_load(self) -> float:
        """Tangent stiffness along the force, F.KF/F^2 (N/m); NaN without a force."""
        F = self.force[self._across]
        square = float(F @ F)
        return float(F @ self.stiffness[self._across, self._across] @ F) / square if square else float("nan")

    @property
    def _across(self) -> slice:
        return slice(0, min(2, len(self.force)))


def law_rows(points: Iterable[OperatingPoint]) -> tuple[LawRow, ...]:
    """The operating points that an equilibrium found, as a result has them."""
    return tuple(LawRow(**vars(point)) for point in points)


def about_state(state: State) -> str:
    """What a linear analysis is linear about, for the words on its method; "" where nothing depends on the mean load."""
    speeds = dict.fromkeys(f"{point.speed * RPM_PER_RAD_S:.6g}" for point in state.operating)
    if not (speeds or state.faces or state.cycle):
        return ""
    return "; linear about the static equilibrium" + (f" at {' to '.join(speeds)} rpm" if speeds else "")


class AboutEquilibrium(ModelResult):
    """A result of an analysis about a static equilibrium, with what it found of bearings and elements that have laws."""

    laws: tuple[LawRow, ...] = of(
        "operating points",
        "",
        "law",
        record=LawRow,
        default=(),
        kw_only=True,
        note=" of bearings and nonlinear elements in the static equilibrium, at the first and the last speed",
    )

    def operating_points(self) -> Block:
        """Force, deflection and stiffness of each across the shaft, in the direction of the force, and along z.

        "mean" stands behind those that are averaged over a pitch of rolling elements.
        """
        if not self.laws:
            return "\nno bearing or element of the model has a force law"
        rows = []
        for row in self.laws:
            # What is rounding of the largest component is shown as none.
            least = 1e-6 * max(map(abs, row.force), default=0.0)
            carries = row.load > least
            across = (row.load if carries else None, 1e6 * row.deflection, 1e-6 * row.along_load if carries else None)
            along = (None, None, None)
            if len(row.force) >= 3 and abs(row.force[2]) > least:
                along = (row.force[2], 1e6 * row.displacement[2], 1e-6 * row.stiffness[2, 2])
            speed = None if row.speed is None else row.speed * RPM_PER_RAD_S
            cells = (written(speed, ".6g"), *(written(x, ".4g") for x in (*across, *along)))
            rows.append((row.part + (", mean" if row.averaged else ""), *cells))
        heads = ("operating point", "rpm", "F N", "moves um", "N/um", "Fz N", "z um", "z N/um")
        return grid(rows, *heads, caption="Operating points")
