"""What a rig has measured: lines, and the shapes that belong to them at named points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.points import coordinates
from rotorgear.analysis.rig.sensor_table import Sensor
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.results.comparison import RigLine


@dataclass(frozen=True)
class Measured:
    """Measured modes.

    Attributes:
        lines: frequencies, with uncertainty and damping where known (n).
        points: names of the model's points where shapes were measured, or places such as "bearings.left:x" (s); empty without
            shapes.
        shapes: displacement along the direction of each point (n, s), to any scale and phase of each mode; NaN where a mode was
            not measured at a point.
        notes: sentences on what the file leaves open.
        sensors: what is known of the sensor at each point (s), where the shapes come from a file.
    """

    lines: tuple[RigLine, ...]
    points: tuple[str, ...] = ()
    shapes: NDArray[np.complex128] | None = None
    notes: tuple[str, ...] = ()
    sensors: tuple[Sensor, ...] = ()

    def __post_init__(self) -> None:
        if self.shapes is None:
            return
        if self.shapes.shape != (len(self.lines), len(self.points)):
            raise AnalysisError(
                f"measured shapes have one row a line and one column a point, ({len(self.lines)}, {len(self.points)}); "
                f"got {self.shapes.shape}"
            )
        if np.isinf(self.shapes).any():
            raise AnalysisError("measured shapes hold infinite displacements: NaN stands for one that was not measured")
        twice = sorted({point for point in self.points if self.points.count(point) > 1})
        if twice:
            raise AnalysisError(
                f"shapes were measured twice at {', '.join(twice)}: keep one sensor of each place and direction"
            )
        # A shape that is 0 everywhere has no direction to compare; its frequency is a line like any other.
        still = ~np.any(np.nan_to_num(self.shapes) != 0.0, axis=1)
        if still.any():
            object.__setattr__(self, "shapes", np.where(still[:, None], complex(np.nan), self.shapes))

    def check_points(self, model: Model) -> None:
        """Raise AnalysisError where a measured point is none of the model's."""
        for name in self.points:
            if not (name in model.points or ":" in name):
                known = ", ".join(model.points) or "none"
                raise AnalysisError(
                    f"shapes were measured at '{name}', which is no point of the model ([points]: {known}), and no part with a "
                    "direction such as 'bearings.left:x'"
                )
            coordinates(model, name)

    @property
    def real_shapes(self) -> NDArray[np.float64]:
        """The shapes turned to the phase in which each is most nearly real, (n, s); NaN rows without shapes.

        A mode with little damping moves in phase; its largest part, sum of phi^2, turned to the real axis, is that phase.
        """
        if self.shapes is None:
            return np.full((len(self.lines), 0), np.nan)
        squares = np.nansum(self.shapes**2, axis=1)
        phase = np.exp(-0.5j * np.angle(squares))
        return np.real(self.shapes * phase[:, None])
