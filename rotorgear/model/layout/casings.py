"""Casings as the model file gives them, in the plain values that their bodies are made from."""

from __future__ import annotations

from pathlib import Path

from rotorgear.casings.assembly import Elastic
from rotorgear.casings.patches import Cylinder
from rotorgear.casings.settings import CasingSettings, JoinSettings, MountSettings, Rows
from rotorgear.model.parts.casing import UNIT_LENGTHS, Casing, Seat
from rotorgear.model.parts.shaft import LIBRARY
from rotorgear.model.parts.tables import Tables

_NO_DAMPING: Rows = ((0.0,) * 6,) * 6


def casing_settings(model: Tables, name: str) -> CasingSettings:
    """The settings of a casing whose fields are in order."""
    casing = model.casings[name]
    assert casing.unit is not None, "checked: a mesh has a unit"
    return CasingSettings(
        name=name,
        files=tuple((part, Path(file)) for part, file in casing.mesh.items()),
        unit=UNIT_LENGTHS[casing.unit],
        material=_material(model, casing),
        held=casing.held,
        mounts=tuple(
            MountSettings(place, mount.as_rows(), mount.damping.as_rows() if mount.damping else _NO_DAMPING)
            for place, mount in casing.mounts.items()
        ),
        seats=tuple((bearing, place_of(seat)) for bearing, seat in casing.seats.items()),
        connection=casing.connection,
        joins=tuple(JoinSettings(*one.faces, one.stiffness) for one in casing.joins),
        modes_to=casing.modes_to,
        damping_ratio=casing.damping_ratio,
        mass=casing.mass,
        mass_tolerance=casing.mass_tolerance,
        splits=casing.splits,
    )


def _material(model: Tables, casing: Casing) -> Elastic:
    if casing.material is not None:
        known = model.materials.get(casing.material) or LIBRARY[casing.material]
        return Elastic(known.youngs_modulus, known.nu, known.density)
    # Checked: where there is no material, all three are given.
    return Elastic(casing.youngs_modulus or 0.0, casing.poisson_ratio or 0.0, casing.density or 0.0)


def place_of(seat: Seat) -> str | Cylinder:
    """Name of a set, or a bore."""
    if seat.set is not None:
        return seat.set
    # Checked: where there is no set, the whole place is given.
    center = seat.center or (0.0, 0.0)
    return Cylinder("xyz".index(seat.axis or "z"), center, seat.begin or 0.0, seat.to or 0.0, seat.radius or 0.0)
