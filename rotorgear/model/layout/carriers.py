"""Planets: what a file writes once of them stands on every pin of their carrier.

The tables of a file become those of the whole gearbox: a shaft with a carrier, and all that names it, is there as often as the
carrier has pins, as "planet#1", "planet#2" and so on. Each planet has a frame of its own, whose x points outwards along its
arm and whose z is that of the carrier's shaft. Everything that follows from a model follows from these tables.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from rotorgear.errors import Problem
from rotorgear.model.layout.placing import centre_distance, meshes_of, placed_by_meshes
from rotorgear.model.parts.carrier import Carrier, sister, written_name
from rotorgear.model.parts.references import PartName, references
from rotorgear.model.parts.shaft import PositionByMesh, Shaft
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import millimetres

# Two meshes of a planet ask for one distance of its pin from the carrier's axis; this share of the module may lie between them.
RADIUS_TOLERANCE = 0.05


@dataclass(frozen=True)
class Place:
    """Where the first of the planets of a kind stands: radius of its pins' circle (m), and angle ahead of the pin (rad)."""

    radius: float
    offset: float = 0.0


def carried(tables: Tables) -> dict[PartName, str]:
    """Parts that are there once for each pin -> the carrier that they go round with: planets' shafts and all that names them."""
    found = {
        ("shafts", name): shaft.carrier for name, shaft in tables.shafts.items() if shaft.carrier in tables.carriers
    }
    arrows = list(references(tables))
    while more := {
        owner: found[target]
        for owner, _, target in arrows
        if target in found and owner not in found and owner[0] not in ("carriers", "operation", "shafts")
    }:
        found |= more
    return {part: carrier for part, carrier in found.items() if carrier is not None}


def says_less(tables: Tables) -> bool:
    """Whether the file says less than the whole gearbox has: planets once, rings by their seats, shafts by their meshes."""
    return bool(
        tables.carriers
        or any(gear.casing is not None for gear in tables.gears.values())
        or any(isinstance(shaft.position, PositionByMesh) for shaft in tables.shafts.values())
    )


def repeated(tables: Tables, overrides: Mapping[str, Mapping[str, Any]] | None = None) -> tuple[Tables, list[Problem]]:
    """The tables of the whole gearbox, and what keeps shafts and planets from being placed; the latter are left out.

    Args:
        tables: as the file has them, whose names are those of parts.
        overrides: table -> name such as "sun_planet#2" -> the keys that one of the sisters has otherwise.
    """
    tables, unplaced = placed_by_meshes(tables)
    tables, rings = _seated_rings(tables)
    rings = [*unplaced, *rings]
    if not tables.carriers:
        return tables, rings
    parts = carried(tables)
    places, problems = _places(tables, parts)
    problems = [*rings, *problems]
    # What hangs on a planet without a place is left out with it.
    lost = {part for part in parts if part[0] == "shafts" and part[1] not in places}
    arrows = list(references(tables))
    while more := {owner for owner, _, target in arrows if target in lost and owner not in lost}:
        lost |= more
    found: dict[str, dict[str, Any]] = {}
    for table in {table for table, _ in parts} | {table for table, _ in lost} - {"operation"}:
        found[table] = {}
        for name, part in getattr(tables, table).items():
            if (table, name) in lost:
                continue
            if (table, name) not in parts:
                found[table][name] = part
                continue
            carrier = tables.carriers[parts[table, name]]
            named = {key: target for owner, key, target in arrows if owner == (table, name) and target in parts}
            for number in range(1, len(carrier.directions) + 1):
                changes = {
                    key: sister(f"{target[0]}.{target[1]}" if key == "on" else target[1], number)
                    for key, target in named.items()
                }
                if table == "shafts":
                    changes |= _on_pin(tables, carrier, places[name], number)
                found[table][sister(name, number)] = part.model_copy(update=changes)
    problems += _overridden(found, overrides or {})
    _coaxial(tables, found, parts)
    return tables.model_copy(update=found), problems


def _seated_rings(tables: Tables) -> tuple[Tables, list[Problem]]:
    """Rings in casings on shafts of their own, which stand still in the plane of a gear that meshes with them."""
    seated = {name: gear for name, gear in tables.gears.items() if gear.casing is not None}
    shafts = dict(tables.shafts)
    gears = dict(tables.gears)
    problems = []
    for name, ring in seated.items():
        beside = [
            tables.gears[mesh.pinion] for mesh in tables.meshes.values() if mesh.gear == name and mesh.pinion in gears
        ]
        mate = next((gear for gear in beside if gear.shaft in tables.shafts), None)
        carrier = tables.carriers.get(tables.shafts[mate.shaft].carrier or "") if mate else None
        if name in tables.shafts:
            problems.append(
                Problem(f"gears.{name}", f"the name of shaft '{name}'", "a name of its own: its seat brings a shaft")
            )
            continue
        if mate is None or carrier is None or carrier.shaft not in tables.shafts:
            why = "a ring in a casing that no planet meshes with: give its shaft and at, and the shaft a bearing in the casing"
            problems.append(Problem(f"gears.{name}.casing", f"'{ring.casing}'", why))
            continue
        own = tables.shafts[carrier.shaft]
        at = tables.shafts[mate.shaft].station(mate.at)
        where = {"position": tuple(own.frame.origin.tolist()), "axis": own.axis, "x_axis": own.x_axis}
        shafts[name] = Shaft(**where, start=at, speed_ratio=0.0)
        gears[name] = ring.model_copy(update={"shaft": name, "at": at})
    for problem in problems:
        gears.pop(problem.address.split(".")[1])
    return (tables.model_copy(update={"shafts": shafts, "gears": gears}) if seated else tables), problems


def _on_pin(tables: Tables, carrier: Carrier, place: Place, number: int) -> dict[str, Any]:
    """Position and directions of a planet's shaft."""
    frame = tables.shafts[carrier.shaft].frame
    angle = carrier.directions[number - 1] + place.offset
    outwards = frame.axes @ [math.cos(angle), math.sin(angle), 0.0]
    return {
        "position": tuple((frame.origin + place.radius * outwards).tolist()),
        "axis": tuple(frame.axes[:, 2].tolist()),
        "x_axis": tuple(outwards.tolist()),
        "radius": place.radius,
        "offset": place.offset,
    }


def _coaxial(tables: Tables, found: dict[str, dict[str, Any]], parts: Mapping[PartName, str]) -> None:
    """Shafts without a position that planets mesh with, and the carrier's, stand on the carrier's axis."""
    shafts = found.setdefault("shafts", dict(tables.shafts))
    for (table, name), carrier in parts.items():
        mesh = tables.meshes[name] if table == "meshes" else None
        beside = [tables.gears[gear].shaft for gear in (mesh.pinion, mesh.gear) if gear in tables.gears] if mesh else []
        own = tables.carriers[carrier].shaft
        frame = tables.shafts[own].frame
        for shaft in {own, *beside} & shafts.keys():
            if shafts[shaft].origin is None:
                where: dict[str, Any] = {"position": tuple(frame.origin.tolist())}
                if shaft != own:
                    where |= {"axis": tables.shafts[own].axis, "x_axis": tables.shafts[own].x_axis}
                shafts[shaft] = shafts[shaft].model_copy(update=where)


def _overridden(found: dict[str, dict[str, Any]], overrides: Mapping[str, Mapping[str, Any]]) -> list[Problem]:
    """Put the keys in that single sisters have otherwise."""
    problems = []
    for table, parts in overrides.items():
        for name, keys in parts.items():
            address = f'{table}."{name}"'
            known = found.get(table, {}).get(name)
            if known is None:
                hint = "a number from 1 to that of the planets behind the name of a part that goes round with a carrier"
                problems.append(Problem(address, "no such part", "one of several equal parts, such as 'pin#2'", hint))
            else:
                data = {**known.model_dump(exclude_unset=True, exclude_none=True), **keys}
                found[table][name] = type(known)(**data)
    return problems


def _places(tables: Tables, parts: Mapping[PartName, str]) -> tuple[dict[str, Place], list[Problem]]:
    """Where the planets of each kind stand, and the problems of those that can't be placed."""
    places: dict[str, Place] = {}
    problems: list[Problem] = []
    waiting = [name for table, name in parts if table == "shafts"]
    while waiting:
        # First planets that say it, or mesh with what stands on the carrier's axis; then those that mesh with them.
        ready = [name for name in waiting if _wanted(tables, parts, name, places)] or waiting
        name = ready[0]
        waiting.remove(name)
        shaft = tables.shafts[name]
        carrier = tables.carriers[parts["shafts", name]]
        given = shaft.radius or carrier.radius
        wanted = list(_radii(tables, parts, name))
        if given is None and not wanted:
            why = "required: no mesh with a gear on the axis of its carrier gives it"
            problems.append(Problem(f"shafts.{name}.radius", "", "missing", why))
            continue
        radii = [radius for _, radius, _ in wanted]
        slack = min((slack for *_, slack in wanted), default=0.0)
        if given is None and max(radii) - min(radii) > slack:
            text = " and ".join(f"{millimetres(radius)} by meshes.{mesh}" for mesh, radius, _ in wanted)
            hint = "change teeth or profile shifts, or give the radius"
            problems.append(Problem(f"shafts.{name}", f"pins on a circle of {text}", "one radius", hint))
            continue
        radius = sum(radii) / len(radii) if given is None else given
        places[name] = Place(radius, _offset(tables, parts, name, radius, places))
    return places, problems


def _wanted(tables: Tables, parts: Mapping[PartName, str], name: str, places: Mapping[str, Place]) -> bool:
    """Whether a planet's angle on its carrier is known: given, of the first set, or beside a planet that has its place."""
    if tables.shafts[name].offset is not None:
        return True
    beside = [other for _, other, _ in _beside(tables, parts, name)]
    return not beside or any(other in places for other in beside)


def _radii(tables: Tables, parts: Mapping[PartName, str], name: str) -> Iterator[tuple[str, float, float]]:
    """Mesh with a gear on the carrier's axis, the distance of the axes that it wants, and by how much that may be missed."""
    for mesh_name, mesh, own, other in meshes_of(tables, name):
        distance = centre_distance(mesh, own, other)
        if ("shafts", other.shaft) not in parts and distance:
            lumped = math.inf if own.lumped else RADIUS_TOLERANCE * (own.normal_module or 0.0)
            yield mesh_name, distance, lumped


def _beside(tables: Tables, parts: Mapping[PartName, str], name: str) -> Iterator[tuple[str, str, float]]:
    """Mesh with another planet of the carrier, its shaft, and the distance of their axes."""
    for mesh_name, mesh, own, other in meshes_of(tables, name):
        distance = centre_distance(mesh, own, other)
        if parts.get(("shafts", other.shaft)) == parts["shafts", name] and distance:
            yield mesh_name, other.shaft, distance


def _offset(
    tables: Tables, parts: Mapping[PartName, str], name: str, radius: float, places: Mapping[str, Place]
) -> float:
    """Angle of a planet ahead of its carrier's pin: given, 0, or where it touches a planet that has its place already."""
    given = tables.shafts[name].offset
    if given is not None:
        return given
    for _, other, distance in _beside(tables, parts, name):
        if other in places:
            mate = places[other]
            # The triangle of both pins and the carrier's axis; a distance that closes none is told by the mesh.
            cosine = (radius**2 + mate.radius**2 - distance**2) / (2.0 * radius * mate.radius)
            return mate.offset + math.acos(min(max(cosine, -1.0), 1.0))
    return 0.0


@dataclass(frozen=True)
class PlanetSet:
    """The planets of one kind on one carrier.

    Attributes:
        carrier: name of the carrier; part: what the file says of it; shaft: name of its shaft.
        planets: names of the planets' shafts, one for each pin.
        angles: direction of each from +x of the carrier's shaft (N,), in rad.
        radius: of the pins' circle in m.
    """

    carrier: str
    part: Carrier
    shaft: str
    planets: tuple[str, ...]
    angles: np.ndarray
    radius: float


def planet_sets(model: Tables) -> tuple[PlanetSet, ...]:
    """All planets of the tables of a whole gearbox."""
    sets: dict[str, list[str]] = {}
    for name, shaft in model.shafts.items():
        if shaft.carrier is not None:
            sets.setdefault(written_name(name), []).append(name)
    found = []
    for names in sets.values():
        first = model.shafts[names[0]]
        carrier = first.carrier or ""
        part = model.carriers[carrier]
        angles = np.array(part.directions) + (first.offset or 0.0)
        found.append(PlanetSet(carrier, part, part.shaft, tuple(names), angles, first.radius or 0.0))
    return tuple(found)
