"""Where motions are told: mesh contacts, and the displacements across bearings, nonlinear elements and at unbalances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.orbits.family import SystemFamily
from rotorgear.errors import AnalysisError
from rotorgear.model.parts.fields import DOF_NAMES

_TABLES = ("bearings", "nonlinear_elements", "unbalances")
_ANGLES = DOF_NAMES[3:]


@dataclass(frozen=True)
class Told:
    """All that a result tells of a motion, by columns of the local displacements.

    Attributes:
        contact: labels of the mesh contacts; contact_column, contact_law: their columns and the numbers of their laws.
        transverse: (c,) displacement of a contact over its approach in the transverse plane.
        place: names of the others, such as "bearings.front x"; place_column: theirs; place_unit: m or rad.
    """

    contact: tuple[str, ...]
    contact_column: np.ndarray
    contact_law: np.ndarray
    transverse: np.ndarray
    place: tuple[str, ...]
    place_column: np.ndarray
    place_unit: tuple[str, ...]

    @property
    def columns(self) -> np.ndarray:
        """The local displacements that tell one motion from another: of the contacts; without any, of the places."""
        if self.contact:
            return self.contact_column
        along = [unit == "m" for unit in self.place_unit]
        return self.place_column[along] if any(along) else self.place_column


def told_of(family: SystemFamily) -> Told:
    """Contacts and places of a family.

    Raises:
        AnalysisError: the model has neither.
    """
    parts = family.parts
    plant = family.plant(0.0)
    law = np.array([i for i, part in enumerate(parts) if part.is_mesh], int)
    elements = family.local.system.model.nonlinear_elements
    places: list[tuple[str, int, str]] = []
    for part, first in zip(parts, plant.forces.first[:-1], strict=True):
        table, _, _ = part.part.partition(".")
        if table not in _TABLES:
            continue
        own = table == "nonlinear_elements"
        axes = elements[part.label].directions if own else DOF_NAMES[: part.law.components]
        for k, axis in enumerate(axes, int(first)):
            # A displacement that supports hold is always zero.
            if plant.B[:, k].any():
                places.append((f"{part.part} {axis}", k, "rad" if axis in _ANGLES else "m"))
    told = Told(
        contact=tuple(parts[i].label for i in law),
        contact_column=plant.forces.first[law],
        contact_law=law,
        transverse=np.array([parts[i].transverse for i in law]),
        place=tuple(label for label, _, _ in places),
        place_column=np.array([k for _, k, _ in places], int),
        place_unit=tuple(unit for _, _, unit in places),
    )
    if not told.columns.size:
        raise AnalysisError(
            "nothing tells one motion from another: orbits looks at meshes, bearings of rolling elements or oil films, nonlinear "
            "elements and unbalances, and the model has none of them; response solves for its forced motions"
        )
    return told
