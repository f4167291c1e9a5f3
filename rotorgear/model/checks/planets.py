"""Checks of carriers: what a planet's shaft says of its place, whether planets can be put in, and whether they touch."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator

from rotorgear.errors import Problem
from rotorgear.model.layout.carriers import PlanetSet, carried
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.carrier import MARK, written_name
from rotorgear.model.parts.fields import RIGID
from rotorgear.model.parts.problems import told
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import millimetres

# Pitches that the last mesh of a planet may be off by the digits of its pin's angle.
_ROUNDED = 0.02


def once(problems: Iterable[Problem]) -> list[Problem]:
    """Problems of parts that are written once, told once and at their address in the file."""

    def plain(text: str) -> str:
        return re.sub(rf"{MARK}\d+", "", text)

    found = (Problem(*(plain(part) for part in (p.address, p.value, p.expected, p.hint))) for p in problems)
    return list(dict.fromkeys(found))


def on_carriers(model: Tables) -> Iterator[Problem]:
    """Planets have their place from the carrier, and stand on it alone."""
    planets = {name for name, shaft in model.shafts.items() if shaft.carrier is not None}
    for name, shaft in model.shafts.items():
        carrier = shaft.carrier is not None
        address = f"shafts.{name}"
        from_carrier = "nothing here: a planet has its place from its carrier"
        given = shaft.speed_ratio is not None or shaft.speed is not None
        turned = shaft.axis != (0.0, 0.0, 1.0) or shaft.x_axis is not None
        both = shaft.speed is not None and shaft.speed_ratio is not None
        standing = model.operating_speed in (None, 0.0)
        yield from told(
            address,
            ("position", carrier and shaft.position is not None, "a position", from_carrier),
            ("axis", carrier and turned, "a direction", from_carrier),
            ("speed_ratio", carrier and given, "a speed", "nothing here: a planet's speed follows from its meshes"),
            ("radius", not carrier and shaft.radius is not None, "a radius", "nothing here: only a planet has one"),
            ("offset", not carrier and shaft.offset is not None, "an angle", "nothing here: only a planet has one"),
            ("speed", both, "speed and speed_ratio", "one of the two"),
            ("speed", shaft.speed is not None and standing, "a speed", "an operating speed beside it: operation.speed"),
        )
    for name, carrier_part in model.carriers.items():
        if carrier_part.shaft in planets:
            text = f"shaft '{carrier_part.shaft}', which goes round with a carrier itself"
            yield Problem(f"carriers.{name}.shaft", text, "a shaft in bearings of its own")
        if not any(shaft.carrier == name for shaft in model.shafts.values()):
            yield Problem(f"carriers.{name}", "no planet", f"a shaft with carrier = '{name}'")
    for key in ("input_shaft", "output_shaft") if model.operation else ():
        shaft_name = getattr(model.operation, key)
        if shaft_name in planets:
            yield Problem(f"operation.{key}", f"'{shaft_name}', a planet", "a shaft in bearings of its own")
    parts = carried(model)
    for (table, name), own in parts.items():
        address = f"{table}.{name}"
        if table == "meshes":
            gears = [model.gears.get(gear) for gear in (model.meshes[name].pinion, model.meshes[name].gear)]
            carriers = {model.shafts[gear.shaft].carrier for gear in gears if gear and gear.shaft in model.shafts}
            if model.meshes[name].stiffness == RIGID and carriers - {None}:
                yield Problem(
                    f"{address}.stiffness", "'rigid' of a mesh on a carrier", "a stiffness, or a stiffness model"
                )
            if len(carriers - {None}) > 1:
                yield Problem(address, "planets of two carriers", "planets of one carrier")
        elif table == "couplings":
            ends = (model.couplings[name].from_shaft, model.couplings[name].to_shaft)
            if {model.shafts[end].carrier for end in ends if end in model.shafts} != {own}:
                yield Problem(address, "a planet and another shaft", "two planets of one carrier, on one axis")
        elif table == "supports":
            yield Problem(address, "a support to ground of a planet", "a bearing, which holds it on the carrier's pin")
        elif table == "bearings":
            bearing = model.bearings[name]
            yield from told(
                address,
                ("casing", bearing.casing is not None, "a casing", "nothing here: a planet runs on its carrier's pin"),
                ("pedestal", bearing.pedestal is not None, "a pedestal", "nothing here: a planet runs on its pin"),
                ("stiffness", bearing.rigid_directions, "'rigid' of a planet's bearing", "a stiffness"),
            )
        elif table == "nonlinear_elements":
            wanted = "a bearing on the pin, with its stiffness or by its rolling elements"
            yield Problem(address, "a nonlinear element of a planet", wanted)
        elif table == "gears" and model.gears[name].body.mesh is not None:
            yield Problem(f"{address}.body.mesh", "an elastic body of a planet", "a rigid one: leave the mesh out")


def assembled(layout: Layout) -> Iterator[Problem]:
    """All planets can be put in, and do not touch each other."""
    model = layout.model
    if not model.carriers:
        return
    missed: set[str] = set()
    for name, closing, rest in layout.assembly.loops:
        written = written_name(name)
        if layout.mesh(name).carrier is None or closing or abs(rest) <= _ROUNDED or written in missed:
            continue
        missed.add(written)
        pinion, gear = (gear.part.teeth for gear in layout.mesh(name).gears)
        text = f"teeth that miss by {abs(rest):.3f} of a pitch, {pinion} in {gear} on pin {name.partition(MARK)[2]}"
        wanted = (
            "planets that can be put in: (z_sun + z_ring)/N whole, or pins at multiples of 360 deg/(z_sun + z_ring)"
        )
        yield Problem(f"meshes.{name}", text, wanted, "change the number of planets, teeth or angles")
    for planets in layout.planets:
        yield from _neighbours(layout, planets)


def _neighbours(layout: Layout, planets: PlanetSet) -> Iterator[Problem]:
    """Tips of planets side by side pass each other."""
    tips = [
        abs(gear.geometry.effective_tip_diameter)
        for gear in layout.gears
        if gear.geometry is not None and gear.shaft == planets.planets[0] and not gear.part.internal
    ]
    order = sorted(angle % (2.0 * math.pi) for angle in planets.angles.tolist())
    if not tips or len(order) == 1:
        return
    pairs = zip(order, [*order[1:], order[0] + 2.0 * math.pi], strict=True)
    least = min(2.0 * planets.radius * math.sin(0.5 * min(b - a, math.pi)) for a, b in pairs)
    if max(tips) > least:
        text = f"planets of {millimetres(max(tips))} tip diameter whose axes are {millimetres(least)} apart"
        address = f"shafts.{written_name(planets.planets[0])}"
        yield Problem(address, text, "planets that do not touch", "take fewer planets, or smaller ones")
