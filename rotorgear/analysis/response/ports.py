"""Inputs and outputs of a linear model: places by name as rows on the free degrees of freedom."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.points import casing_row, named_place, spelled
from rotorgear.analysis.response.plant import dof_row
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.system.system import System


class Ports:
    """Places of a model by their names: points, a part and a direction, seats and surfaces of casings.

    Raises:
        AnalysisError: a place that the model has not.
    """

    def __init__(self, model: Model, names: Sequence[str]) -> None:
        on_casings = {text: there for text in names if (there := spelled(model, text)).startswith("casings.")}
        self._casings = {text: casing_row(model, there) for text, there in on_casings.items()}
        self._directions = {text: there.rpartition(":")[2] for text, there in on_casings.items()}
        self._places = {text: named_place(model, text) for text in names if text not in self._casings}

    def direction(self, text: str) -> str:
        """The direction of a place."""
        return self._places[text][2] if text in self._places else self._directions[text]

    def force_unit(self, text: str) -> str:
        """N, or N m of a rotation."""
        return "N m" if self.direction(text) in DOF_NAMES[3:] else "N"

    def motion_unit(self, text: str) -> str:
        """m, or rad of a rotation."""
        return "rad" if self.direction(text) in DOF_NAMES[3:] else "m"

    def row(self, system: System, text: str) -> np.ndarray:
        """Row of the map from the free dofs to the displacement, (n,).

        Raises:
            AnalysisError: the place can't move.
        """
        if text in self._casings:
            casing, own = self._casings[text]
            return np.asarray(system.dofs.transform[system.nodes.of_casing(casing), :].T @ own)
        row = dof_row(system, *self._places[text])
        if not row.any():
            raise AnalysisError(f"'{text}' can't move: a support or the motions of the model hold it")
        return row
