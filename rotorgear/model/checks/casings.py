"""Checks of casings before their meshes are read: what a casing needs, and which bearing stands on it."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.names import unknown
from rotorgear.model.checks.references import PartName
from rotorgear.model.checks.sizes import six_by_six
from rotorgear.model.parts.casing import Casing, Seat
from rotorgear.model.parts.problems import shown
from rotorgear.model.parts.tables import Tables

_OWN = ("youngs_modulus", "poisson_ratio", "density")
_PLACE = ("axis", "center", "from", "to", "radius")


def casings(model: Tables, broken: set[PartName]) -> Iterator[Problem]:
    """Casings have mesh, unit and material; their seats are those of bearings."""
    bearings = [*model.bearings, *(name for table, name in broken if table == "bearings")]
    for name, casing in model.casings.items():
        address = f"casings.{name}"
        yield from _source(address, casing)
        yield from _material(address, casing)
        for set_name, mount in casing.mounts.items():
            yield from six_by_six(f"{address}.mounts.{set_name}", mount, None)
            yield from six_by_six(f"{address}.mounts.{set_name}", None, mount.damping)
        if not casing.seats:
            yield Problem(
                f"{address}.seats", "", "missing", "where bearings sit: seats = { left = 'name of a face set' }"
            )
        for bearing, seat in casing.seats.items():
            if bearing not in bearings and ("bearings", "") not in broken:
                yield unknown(f"{address}.seats.{bearing}", bearing, bearings, "a bearing")
            yield from _seat(f"{address}.seats.{bearing}", seat)
    yield from _bearings(model)


def _source(address: str, casing: Casing) -> Iterator[Problem]:
    if not casing.mesh:
        yield Problem(f"{address}.mesh", "", "missing", "required: the file of the mesh, such as 'box.msh'")
    elif casing.unit is None:
        hint = "required: files of meshes carry no unit of length; say unit = 'mm' or 'm'"
        yield Problem(f"{address}.unit", "", "missing", hint)


def _material(address: str, casing: Casing) -> Iterator[Problem]:
    given = [key for key in _OWN if getattr(casing, key) is not None]
    if casing.material is not None and given:
        yield Problem(address, f"material and {', '.join(given)}", "one of the two ways to say what the casing is of")
    elif casing.material is None and not given and casing.mesh:
        yield Problem(f"{address}.material", "", "missing", f"required, or {', '.join(_OWN)}")
    elif given:
        for key in _OWN:
            if key not in given:
                yield Problem(f"{address}.{key}", "", "missing", f"required beside {', '.join(given)}")
        if casing.poisson_ratio is not None and casing.poisson_ratio >= 0.5:
            yield Problem(f"{address}.poisson_ratio", f"{casing.poisson_ratio:.4g}", "one from 0 to below 0.5")


def _seat(address: str, seat: Seat) -> Iterator[Problem]:
    given = [key for key in _PLACE if getattr(seat, key) is not None]
    if seat.set is not None and given:
        yield Problem(address, f"set and {', '.join(given)}", "one of the two ways to say where it is")
    elif seat.set is None:
        for key in _PLACE:
            if key not in given:
                yield Problem(f"{address}.{key}", "", "missing", f"a seat is a set, or all of {', '.join(_PLACE)}")
        if seat.begin is not None and seat.to is not None and seat.to <= seat.begin:
            yield Problem(f"{address}.to", shown(seat.to), f"more than from, {seat.begin:.6g} m")


def _bearings(model: Tables) -> Iterator[Problem]:
    """A bearing on a casing has a seat there, and no pedestal: the casing is what it stands on."""
    for name, bearing in model.bearings.items():
        casing = model.casings.get(bearing.casing or "")
        if casing is None:
            continue
        if name not in casing.seats:
            hint = f"add it: casings.{bearing.casing}.seats.{name} = 'name of a face set'"
            yield Problem(f"bearings.{name}.casing", shown(bearing.casing), "a casing with a seat of this name", hint)
        if bearing.pedestal is not None:
            hint = "leave the pedestal out: the casing brings the flexibility of the seat"
            yield Problem(f"bearings.{name}", "casing and pedestal", "one of the two", hint)
