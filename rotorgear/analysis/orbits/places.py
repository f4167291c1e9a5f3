"""Where motions are told: mesh contacts, and the displacements across bearings, nonlinear elements and at unbalances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.orbits.family import SystemFamily
from rotorgear.errors import AnalysisError
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.system.local_parts import LocalPart

_TABLES = ("bearings", "nonlinear_elements", "unbalances")
_ANGLES = DOF_NAMES[3:]


@dataclass(frozen=True)
class Contacts:
    """Places of the mesh contacts among the local displacements and laws, cos(beta_b), labels."""

    column: np.ndarray
    law: np.ndarray
    transverse: np.ndarray
    label: tuple[str, ...]


@dataclass(frozen=True)
class Places:
    """Other local displacements that are told: their columns, names such as "bearings.front x", and units, m or rad."""

    column: np.ndarray
    label: tuple[str, ...]
    unit: tuple[str, ...]


@dataclass(frozen=True)
class Told:
    """All that a result tells of a motion."""

    contacts: Contacts
    places: Places

    @property
    def columns(self) -> np.ndarray:
        """The local displacements that tell one motion from another: of the contacts; without any, of the places."""
        if self.contacts.column.size:
            return self.contacts.column
        along = [unit == "m" for unit in self.places.unit]
        return self.places.column[along] if any(along) else self.places.column


def told_of(family: SystemFamily) -> Told:
    """Contacts and places of a family.

    Raises:
        AnalysisError: the model has neither.
    """
    told = Told(_contacts(family), _places(family))
    if not told.columns.size:
        raise AnalysisError(
            "nothing tells one motion from another: orbits looks at meshes, bearings of rolling elements or oil films, nonlinear "
            "elements and unbalances, and the model has none of them; response solves for its forced motions"
        )
    return told


def _contacts(family: SystemFamily) -> Contacts:
    parts = family.parts
    law = np.array([i for i, part in enumerate(parts) if part.is_mesh], int)
    return Contacts(
        family.plant(0.0).forces.first[law],
        law,
        np.array([parts[i].transverse for i in law]),
        tuple(parts[i].label for i in law),
    )


def _places(family: SystemFamily) -> Places:
    plant = family.plant(0.0)
    column: list[int] = []
    label: list[str] = []
    unit: list[str] = []
    for part, first in zip(family.parts, plant.forces.first[:-1], strict=True):
        if part.part.partition(".")[0] not in _TABLES:
            continue
        for k, axis in enumerate(_axes(family, part), int(first)):
            # A displacement that supports hold says nothing.
            if plant.B[:, k].any():
                column.append(k)
                label.append(f"{part.part} {axis}")
                unit.append("rad" if axis in _ANGLES else "m")
    return Places(np.array(column, int), tuple(label), tuple(unit))


def _axes(family: SystemFamily, part: LocalPart) -> tuple[str, ...]:
    """Names of the displacements of a part's law."""
    elements = family.local.system.model.nonlinear_elements
    if part.part.startswith("nonlinear_elements."):
        return tuple(elements[part.label].directions)
    return DOF_NAMES[: part.law.components]
