"""Planetary stages: planets that a file has one by one are written once, on the carrier that they go round with.

A stage names shafts by relations: planet_carrier_shaft, planet_shaft, planet_pin (shafts that stand still on the carrier) and
central_shaft. Bearings sit between pins and planets, couplings between pins, side plates and shafts of the carrier. In a model
file pins stand rigidly on one shaft of the carrier: plates and pins are there as bodies with their masses, and what joins them
is rigid. Planets that mesh with the same gears beside the carrier are of one kind; those of several kinds (Ravigneaux, meshed
planets) share the pins' numbers.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from rotorgear.rexs.account import Account
from rotorgear.rexs.bearings import is_bearing, is_coupling
from rotorgear.rexs.document import Component
from rotorgear.rexs.gears import GearPart, read_gear
from rotorgear.rexs.shafts import Pins, ShaftPart, read_sections
from rotorgear.rexs.structure import GEAR, PLANETARY, Axis, Pair, Structure
from rotorgear.rexs.toml_text import Names

# Pins this near (m) to equal places on one circle stand there.
_ONE_PLACE = 1e-5
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class Stage:
    """A planetary stage: numbers of the shafts that it names, first that which carries the pins, and its side plates."""

    component: Component
    carriers: tuple[str, ...]
    planets: tuple[str, ...]
    pins: tuple[str, ...]
    plates: tuple[Component, ...]


@dataclass
class Planets:
    """What planetary stages make of a file.

    Attributes:
        on: number of a shaft -> what is on it, and the bearings and couplings that it is a side of.
        stages: by the name of their carrier.
        places: number of a planet's shaft that is written -> where it stands.
        pins: shafts of the file by number that stand rigidly on a carrier; their z is their u.
        angles: carrier -> direction of each pin from the first in rad; empty where they are equally spaced.
        dropped: numbers of the components that others stand for, or that are part of a carrier.
    """

    on: dict[str, list[Component]]
    stages: dict[str, Stage] = field(default_factory=dict)
    places: dict[str, Pins] = field(default_factory=dict)
    pins: dict[str, ShaftPart] = field(default_factory=dict)
    angles: dict[str, list[float]] = field(default_factory=dict)
    dropped: set[str] = field(default_factory=set)


def on_shafts(structure: Structure) -> dict[str, list[Component]]:
    """What is on each shaft, by its number, and the bearings and couplings that it is a side of."""
    found: dict[str, list[Component]] = {}
    for part in structure.document.components.values():
        joint = is_bearing(part) or is_coupling(part)
        sides = [side.id for side in structure.beside(part)] if joint else [structure.shaft_of(part, "assembly")]
        for number in dict.fromkeys(sides):
            found.setdefault(number, []).append(part)
    return found


def read_stages(structure: Structure, on: dict[str, list[Component]]) -> list[Stage]:
    """The planetary stages; one without a carrier or without planets is a problem."""
    account = structure.account
    found = []
    for component in structure.document.of_type(PLANETARY):
        carriers = structure.parts_of(component, "planet_carrier")
        planets = structure.shafts_of(component, "planet_shaft")
        shafts = structure.shafts_of(component, "planet_carrier_shaft")
        if not shafts:
            account.missing(component, "a planet carrier is needed: a relation planet_carrier_shaft with its shaft")
        if not planets:
            account.missing(component, "planets are needed: relations planet_shaft with the shaft of each")
        if not shafts or not planets:
            continue
        # The shaft of the carrier that most parts are on holds the pins.
        shafts.sort(key=lambda number: -sum(map(_stands_on, on.get(number, ()))))
        plates = [plate for carrier in carriers for plate in structure.parts_of(carrier, "side_plate")]
        # Some files name pins by their carrier alone.
        parts = [part.id for carrier in carriers for part in structure.parts_of(carrier, "shaft")]
        held = dict.fromkeys([*structure.shafts_of(component, "planet_pin"), *parts])
        pins = [number for number in held if number not in shafts and number not in planets]
        found.append(Stage(component, tuple(shafts), tuple(planets), tuple(pins), tuple(plates)))
    staged = {
        part.id
        for stage in structure.document.of_type(PLANETARY)
        for part in structure.parts_of(stage, "planet_carrier")
    }
    for carrier in structure.document.of_type("planet_carrier"):
        if carrier.id not in staged:
            account.missing(carrier, "it must be part of a planetary stage, by an assembly relation")
    return found


def _stands_on(part: Component) -> bool:
    return part.type in (GEAR, "external_load") or is_bearing(part)


def placed_planets(
    stages: list[Stage],
    on: dict[str, list[Component]],
    axes: dict[str, Axis],
    pairs: list[Pair],
    structure: Structure,
    version: tuple[int, int],
) -> Planets:
    """Which planets are written, and where they stand; planets that differ are a problem."""
    found = Planets(on)
    names = Names()
    for stage in stages:
        _note_forgotten(stage, on, structure)
        name = names.of(stage.component.name, "carrier", stage.component.id)
        found.stages[name] = stage
        for number in stage.pins:
            pin = structure.document.components[number]
            axis = Axis(0.0, 0.0, 0.0, 1, np.eye(3), structure.model)
            if sections := read_sections(pin, structure):
                found.pins[number] = ShaftPart(pin, "", axis, sections)
        found.dropped |= _of_carrier(stage, on, structure)
        kinds = _kinds(stage, pairs, structure)
        if kinds is None or any(number not in axes for number in (*stage.planets, stage.carriers[0])):
            continue
        if not all(_alike(kind, stage, on, axes, structure, version) for kind in kinds):
            continue
        _place(found, name, kinds, axes, pairs, structure)
        written = {number for number in stage.planets if number in found.places}
        found.dropped |= _of_sisters(set(stage.planets) - written, on, pairs)
    return found


def _note_forgotten(stage: Stage, on: dict[str, list[Component]], structure: Structure) -> None:
    """Shafts that run on pins and are no planets of the stage are problems."""
    known = {*stage.planets, *stage.pins, *stage.carriers}
    bearings = [part for number in stage.pins for part in on.get(number, ()) if is_bearing(part)]
    for shaft in (side for part in bearings for side in structure.beside(part)):
        if shaft.type == "shaft" and shaft.id not in known:
            structure.account.missing(
                shaft, f"it runs on a pin of {stage.component}: a relation planet_shaft is needed"
            )


def _of_carrier(stage: Stage, on: dict[str, list[Component]], structure: Structure) -> set[str]:
    """Pins, plates, and what joins them to each other and to shafts of the carrier."""
    own = {*stage.pins, *(plate.id for plate in stage.plates)}
    whole = own | set(stage.carriers)
    joints = {part.id: part for number in own for part in on.get(number, ()) if is_bearing(part) or is_coupling(part)}
    inside = [part for part in joints.values() if {side.id for side in structure.beside(part)} <= whole]
    shaft = structure.document.components[stage.carriers[0]]
    structure.account.left_out.append(
        f"{stage.component}: struts, and what pins, side plates and their joints ({len(inside)}) yield: they are rigid on {shaft}"
    )
    return own | {part.id for part in inside}


def _kinds(stage: Stage, pairs: list[Pair], structure: Structure) -> list[list[str]] | None:
    """Planets by the gears beside the carrier that they mesh with; None, and a problem, where there are not as many of each."""
    mates: dict[str, list[str]] = {number: [] for number in stage.planets}
    for pair in pairs:
        for own, other in (pair.members, pair.members[::-1]):
            number = structure.shaft_of(own)
            if number in mates and structure.shaft_of(other) not in mates:
                mates[number].append(other.name or other.id)
    kinds: dict[tuple[str, ...], list[str]] = {}
    for number, gears in mates.items():
        kinds.setdefault(tuple(sorted(gears)), []).append(number)
    shared = [gear for gear, count in Counter(gear for key in kinds for gear in set(key)).items() if count > 1]
    if len({len(kind) for kind in kinds.values()}) == 1 and not shared:
        return list(kinds.values())
    told = ", ".join(f"{len(kind)} with {' and '.join(key) or 'no gear'}" for key, kind in kinds.items())
    wanted = f"its planets must mesh alike, or be of several kinds with as many of each; they mesh {told}"
    structure.account.missing(stage.component, wanted)
    return None


def _alike(
    kind: list[str],
    stage: Stage,
    on: dict[str, list[Component]],
    axes: dict[str, Axis],
    structure: Structure,
    version: tuple[int, int],
) -> bool:
    """Whether planets of a kind have equal gears, sections and bearings; if not, a problem tells the first difference."""
    document = structure.document
    # Read apart: assumptions about them are told once, of the one that is written.
    trial = Structure(document, Account())
    trial.model = structure.model
    first: tuple[Component, dict[str, object]] | None = None
    for number in kind:
        shaft = document.components[number]
        part = ShaftPart(shaft, "", axes[number], read_sections(shaft, trial))
        there = on.get(number, [])
        toothed = [gear for gear in there if gear.type == GEAR] if part.sections else []
        gears = [read_gear(gear, "", {number: part}, trial, version) for gear in toothed]
        about = _about(part, [gear for gear in gears if gear is not None])
        about["number of bearings"] = sum(map(is_bearing, there))
        if first is None:
            first = (shaft, about)
        for key, value in about.items():
            if value != first[1].get(key):
                told = f"its planets must be alike; {key}: {first[1].get(key)} of {first[0]}, {value} of {shaft}"
                structure.account.missing(stage.component, told)
                return False
    return True


def _about(shaft: ShaftPart, gears: list[GearPart]) -> dict[str, object]:
    """What planets of a kind have in common, in the words of a message."""
    found: dict[str, object] = {"number of gears": len(gears)}
    for gear in sorted(gears, key=lambda gear: gear.z):
        where = f"gear at z = {1e3 * gear.z:.3f} mm"
        found |= {
            f"number_of_teeth of the {where}": gear.teeth,
            f"normal_module in mm of the {where}": round(1e3 * gear.module, 9),
            f"helix angle in deg of the {where}": round(math.degrees(gear.helix_angle), 6),
            f"face_width in mm of the {where}": round(1e3 * gear.width, 6),
            f"profile shift of the {where}": None if gear.shift is None else round(gear.shift, 6),
        }
    outline = [(part.length, *part.outer, *part.inner) for part in shaft.sections[:: shaft.axis.sense]]
    found["sections (lengths and diameters in mm)"] = [tuple(round(1e3 * x, 6) for x in part) for part in outline]
    found["z in mm of the shaft's end"] = round(1e3 * shaft.start, 6) if shaft.sections else None
    return found


def _of_sisters(sisters: set[str], on: dict[str, list[Component]], pairs: list[Pair]) -> set[str]:
    """Planets' shafts that another one stands for, and all that is on them."""
    found = sisters | {part.id for number in sisters for part in on.get(number, ())}
    return found | {pair.stage.id for pair in pairs if any(gear.id in found for gear in pair.members)}


def _place(
    found: Planets, name: str, kinds: list[list[str]], axes: dict[str, Axis], pairs: list[Pair], structure: Structure
) -> None:
    """Radius and angles of the pins of each kind, the first of which gives the numbers of the pins."""
    account = structure.account
    stage = found.stages[name]
    centre = axes[stage.carriers[0]]
    written: list[str] = []
    first: list[float] = []
    for kind in kinds:
        polar = {number: _polar(axes[number], centre) for number in kind}
        if any(axes[number].base is not centre.base for number in kind):
            account.missing(
                stage.component, "the axes of its planets must be parallel to that of its carrier, and are not"
            )
            return
        radii = [radius for radius, _ in polar.values()]
        if max(radii) - min(radii) > _ONE_PLACE or min(radii) <= 0.0:
            shown = " and ".join(f"{1e3 * radius:.6g}" for radius in (min(radii), max(radii)))
            account.missing(
                stage.component, f"its pins must stand on one circle; they stand at {shown} mm from its axis"
            )
            return
        own = next((number for number in kind if _meshes_with(number, written, pairs, structure)), kind[0])
        angles = sorted((angle - polar[own][1]) % _TURN for _, angle in polar.values())
        even = [k * _TURN / len(kind) for k in range(len(kind))]
        radius = sum(radii) / len(radii)
        off = max(abs((a - b + 0.5 * _TURN) % _TURN - 0.5 * _TURN) for a, b in zip(angles, even, strict=True))
        regular = off * radius < _ONE_PLACE
        first = first or (even if regular else angles)
        if max(abs(a - b) for a, b in zip(first, even if regular else angles, strict=True)) > 1e-9:
            account.missing(
                stage.component, "the pins of all kinds of its planets must stand at the same angles to each other"
            )
            return
        found.angles[name] = [] if regular else angles
        offset = round(polar[own][1], 12)
        found.places[own] = Pins(name, radius, offset, len(kind))
        written.append(own)


def _polar(planet: Axis, centre: Axis) -> tuple[float, float]:
    """Radius in m and angle in rad of a planet's axis about that of its carrier."""
    x, y = planet.x - centre.x, planet.y - centre.y
    return math.hypot(x, y), math.atan2(y, x)


def _meshes_with(number: str, others: list[str], pairs: list[Pair], structure: Structure) -> bool:
    """Whether a planet meshes with one of some others."""
    for pair in pairs if others else ():
        shafts = {structure.shaft_of(gear) for gear in pair.members}
        if number in shafts and shafts & set(others):
            return True
    return False
