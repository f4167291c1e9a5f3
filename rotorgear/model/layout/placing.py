"""Shafts that stand where a mesh wants them: at the centre distance of its teeth without backlash, in a given direction.

O = O_m + a (x_m cos phi + y_m sin phi), with O_m, x_m and y_m the origin and directions of the mating shaft, and a the working
centre distance of ISO 21771; of a pinion in a ring the difference of the radii counts. z = 0 of both lies side by side.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.errors import Problem, RotorgearError
from rotorgear.gears.geometry.pair import working_centre_distance
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.shaft import PositionByMesh, Shaft
from rotorgear.model.parts.tables import Tables


def placed_by_meshes(tables: Tables) -> tuple[Tables, list[Problem]]:
    """The tables with the shafts that meshes place at their places, and what keeps others from one."""
    wanted = {name: by for name, shaft in tables.shafts.items() if isinstance(by := shaft.position, PositionByMesh)}
    if not wanted:
        return tables, []
    problems = []
    waiting: dict[str, tuple[str, float]] = {}  # shaft -> the one that it stands beside, and how far from it
    for name, by in wanted.items():
        found = _beside(tables, name, by)
        if isinstance(found, Problem):
            problems.append(found)
        elif found is not None:
            waiting[name] = found
    shafts = dict(tables.shafts)
    # Chains, from the shafts on that have their places.
    while ready := [name for name, (mate, _) in waiting.items() if shafts[mate].origin is not None]:
        for name in ready:
            mate, distance = waiting.pop(name)
            shafts[name] = _at(shafts[name], shafts[mate], distance, wanted[name].angle)
    return tables.model_copy(update={"shafts": shafts}), [*problems, *_unplaced(tables, waiting)]


def _beside(tables: Tables, name: str, by: PositionByMesh) -> Problem | tuple[str, float] | None:
    """The shaft that a mesh places another one beside, and how far from it, or what keeps it from that; None of what is told
    elsewhere: teeth that can't mesh by their mesh, a planet's place among all that a planet must not say.
    """

    def refused(value: str, expected: str, hint: str = "") -> Problem:
        return Problem(f"shafts.{name}.position", value, expected, hint)

    own = {mesh: (part, gear, other) for mesh, part, gear, other in meshes_of(tables, name)}
    if by.mesh not in own:
        hint = f"those of this shaft: {', '.join(own)}" if own else "no gear on this shaft meshes with one on another"
        return refused(f"mesh '{by.mesh}'", "a mesh of a gear on this shaft with one on another", hint)
    mesh, gear, other = own[by.mesh]
    if gear.is_bevel or other.is_bevel:
        return refused(
            f"mesh '{by.mesh}' of bevel gears", "a position in numbers, and an axis that meets the other one"
        )
    if tables.shafts[name].carrier is not None:
        return None
    if other.shaft not in tables.shafts or tables.shafts[other.shaft].carrier is not None:
        return refused(f"mesh '{by.mesh}' with a planet, or with a ring in a casing", "a position in numbers")
    distance = centre_distance(mesh, gear, other)
    if distance is None and gear.lumped:
        text = f"mesh '{by.mesh}', whose gears say no distance of their axes"
        return refused(text, "a position in numbers, or transverse_pressure_angle of the gears")
    return None if distance is None else (other.shaft, distance)


def _at(shaft: Shaft, mate: Shaft, distance: float, angle: float) -> Shaft:
    """A shaft at its place beside its mate."""
    frame = mate.frame
    place = frame.origin + distance * (frame.axes @ [math.cos(angle), math.sin(angle), 0.0])
    return shaft.model_copy(update={"position": tuple(place.tolist()[: 3 if frame.is_moved else 2])})


def _unplaced(tables: Tables, waiting: dict[str, tuple[str, float]]) -> Iterator[Problem]:
    """What keeps chains of shafts from their places, told once where it begins."""
    told: set[str] = set()
    for name in waiting:
        chain = [name]
        while (mate := waiting.get(chain[-1], ("", 0.0))[0]) and mate not in chain:
            chain.append(mate)
        if mate in chain and mate not in told:
            circle = chain[chain.index(mate) :]
            told |= set(circle)
            text = "', beside '".join([*circle[1:], circle[0]])
            yield Problem(
                f"shafts.{circle[0]}.position",
                f"a place beside '{text}'",
                "one of these shafts with a position in numbers",
            )
        # A mate that has no place for a reason of its own is told there.
        elif not mate and chain[-1] not in told and tables.shafts[chain[-1]].position is None:
            told.add(chain[-1])
            text = f"a place beside shaft '{chain[-1]}', which has none"
            yield Problem(f"shafts.{chain[-2]}.position", text, f"a position of shaft '{chain[-1]}'")


def meshes_of(tables: Tables, shaft: str) -> Iterator[tuple[str, Mesh, Gear, Gear]]:
    """Meshes of the gears of a shaft with those of others: name, part, its own gear and the other one."""
    for name, mesh in tables.meshes.items():
        pair = [tables.gears[gear] for gear in (mesh.pinion, mesh.gear) if gear in tables.gears]
        if len(pair) == 2 and [gear.shaft for gear in pair].count(shaft) == 1:
            own, other = pair if pair[0].shaft == shaft else pair[::-1]
            yield name, mesh, own, other


def centre_distance(mesh: Mesh, own: Gear, other: Gear) -> float | None:
    """Distance (m) of the axes of two gears that mesh without backlash; None where the file does not say it."""
    if own.geometry is not None and other.geometry is not None:
        pair = (other, own) if own.internal else (own, other)
        first = pair[0].geometry
        second = pair[1].geometry
        assert first is not None
        assert second is not None
        try:
            return abs(working_centre_distance(first, second))
        except RotorgearError:  # teeth that can't mesh: their mesh says why
            return None
    angle = mesh.pressure_angle or own.transverse_pressure_angle or other.transverse_pressure_angle
    if own.base_radius is None or other.base_radius is None or angle is None:
        return None
    sign = -1.0 if own.internal or other.internal else 1.0
    return abs(own.base_radius + sign * other.base_radius) / math.cos(angle)
