"""Planet carriers in a model file: where their pins are held, the bodies of pins and side plates, and what joins their shafts."""

from __future__ import annotations

import math

from rotorgear.rexs.bearings import add_stub, between, seats
from rotorgear.rexs.planets import Planets
from rotorgear.rexs.shafts import Materials, Section, ShaftPart
from rotorgear.rexs.structure import Structure
from rotorgear.rexs.toml_text import Names, Table, quantity, text

# Density of steel in kg/m^3.
_STEEL = 7850.0


class Carriers:
    """Tables of the carriers of a gearbox.

    Args:
        planets: what the planetary stages make of the file.
        shafts: of the model by number.
        structure: of the whole file.
    """

    def __init__(self, planets: Planets, shafts: dict[str, ShaftPart], structure: Structure) -> None:
        self.planets = planets
        self.shafts = shafts
        self.structure = structure
        # Carriers whose shaft and planets could be made.
        self.names = [
            name
            for name, stage in planets.stages.items()
            if stage.carriers[0] in shafts and any(number in planets.places for number in stage.planets)
        ]
        # Side plates that couplings hold on the shafts of each carrier, and z in m there.
        self._plates = {
            (name, number): self._plates_on(name, number)
            for name in self.names
            for number in planets.stages[name].carriers
            if number in shafts
        }
        # Where the pins are held: z in m on that shaft, and the comment beside it.
        self.held = {name: self._held(name, shafts[planets.stages[name].carriers[0]]) for name in self.names}

    def tables(self) -> list[Table]:
        """The carriers."""
        found = []
        for name in self.names:
            stage = self.planets.stages[name]
            shaft = self.shafts[stage.carriers[0]]
            at, comment = self.held[name]
            table = Table(f"carriers.{name}", str(stage.component))
            table.add("shaft", text(shaft.name))
            table.add("at", quantity(at, "length"), comment)
            angles = self.planets.angles[name]
            if angles:
                table.add("angles", "[" + ", ".join(quantity(angle, "angle") for angle in angles) + "]")
            else:
                kinds = sum(number in self.planets.places for number in stage.planets)
                table.add("planets", str(len(stage.planets) // kinds))
            found.append(table)
        return found

    def _plates_on(self, name: str, number: str) -> dict[str, float]:
        """Side plates of a carrier on one of its shafts, and z in m there."""
        plates = {plate.id for plate in self.planets.stages[name].plates}
        found: dict[str, float] = {}
        for part in self.planets.on.get(number, ()):
            beside = {side.id for side in self.structure.beside(part)} & plates
            seat = (
                next(filter(None, seats(part, {number: self.shafts[number]}, self.structure)), None) if beside else None
            )
            if seat is not None:
                found |= dict.fromkeys(beside, seat[1])
        return found

    def _held(self, name: str, shaft: ShaftPart) -> tuple[float, str]:
        """z in m where the pins of a carrier are held on a shaft of it, and the comment beside it."""
        plates = list(self._plates[name, shaft.component.id].values())
        if plates:
            return sum(plates) / len(plates), "where its side plates are"
        own = [
            self.shafts[one] for one, pins in self.planets.places.items() if pins.carrier == name and one in self.shafts
        ]
        middle = sum(sum(part.ends) for part in own) / (2.0 * len(own)) if own else shaft.start
        at = min(max(middle, shaft.ends[0]), shaft.ends[1])
        reason = "the file couples no side plate to this shaft: nearest to the middle of the planets"
        return at, self.structure.account.assume(f"carriers.{name}.at", f"{1e3 * at:.6g} mm", reason)

    def bodies(self, materials: Materials, names: Names) -> list[Table]:
        """Disks for the side plates and the pins."""
        return [
            table
            for name in self.names
            for table in (*self._plate_disks(name, materials, names), *self._pin_disk(name, names))
        ]

    def _plate_disks(self, name: str, materials: Materials, names: Names) -> list[Table]:
        stage = self.planets.stages[name]
        account = self.structure.account
        places = {
            plate: (self.shafts[number], z)
            for number in reversed(stage.carriers)
            if number in self.shafts
            for plate, z in self._plates[name, number].items()
        }
        found = []
        for plate in stage.plates:
            sizes = (
                account.number(plate, (key,), "length") or 0.0 for key in ("outer_diameter", "inner_diameter", "length")
            )
            outer, bore, width = sizes
            if plate.id not in places or width <= 0.0 or not 0.0 <= bore < outer:
                needs = "a coupling to a shaft of the carrier, outer_diameter, inner_diameter and length say it"
                account.left_out.append(f"{plate}: its mass; {needs}")
                continue
            shaft, z = places[plate.id]
            table = shaft.table(f"disks.{names.of(plate.name, 'side_plate', plate.id)}", str(plate), z)
            for key, size in (("outer_diameter", outer), ("bore", bore), ("width", width)):
                table.add(key, quantity(size, "length"))
            material, comment = materials.of(plate, table.header)
            table.add("material", text(material), comment)
            found.append(table)
        return found

    def _pin_disk(self, name: str, names: Names) -> list[Table]:
        """All pins as one body: N m r^2 about z, N m (r^2/2 + l^2/12) across, of pins of length l on a circle of radius r."""
        stage = self.planets.stages[name]
        radius = next(pins.radius for pins in self.planets.places.values() if pins.carrier == name)
        mass = diametral = 0.0
        for sections in (self.planets.pins[number].sections for number in stage.pins if number in self.planets.pins):
            one = _STEEL * sum(map(_volume, sections))
            mass += one
            diametral += one * (0.5 * radius**2 + sum(section.length for section in sections) ** 2 / 12.0)
        if not mass:
            return []
        shaft = self.shafts[stage.carriers[0]]
        header = f"disks.{names.of(f'{name} pins', 'pins', stage.component.id)}"
        table = shaft.table(header, f"pins of {stage.component}", self.held[name][0])
        reason = f"pins are part of the carrier: steel, on a circle of {1e3 * radius:.6g} mm"
        note = self.structure.account.assume(f"{header}.mass", f"{mass:.4g} kg", reason)
        for key, value, kind, comment in (
            ("mass", mass, "mass", note),
            ("polar_inertia", mass * radius**2, "inertia", ""),
            ("diametral_inertia", diametral, "inertia", ""),
        ):
            table.add(key, quantity(float(f"{value:.6g}"), kind), comment)
        return [table]

    def joins(self, coupled: list[tuple[str, str]], names: Names) -> list[Table]:
        """Couplings to shafts of a carrier that only pins and plates join to the one that holds the pins.

        Args:
            coupled: numbers of shafts that couplings join.
            names: of couplings.
        """
        found = []
        for name in self.names:
            stage = self.planets.stages[name]
            first = self.shafts[stage.carriers[0]]
            reached = {first.component.id}
            while more := {b if a in reached else a for a, b in coupled if (a in reached) != (b in reached)}:
                reached |= more
            for other in (self.shafts[one] for one in stage.carriers[1:] if one in self.shafts and one not in reached):
                plates = list(self._plates[name, other.component.id].values())
                ends = ((first, self.held[name][0]), (other, sum(plates) / len(plates) if plates else other.start))
                header = f"couplings.{names.of(f'{other.name} carrier', 'carrier', other.component.id)}"
                table = between(header, f"pins and side plates of {stage.component}", *ends)
                add_stub(table, min(shaft.diameter(z) for shaft, z in ends), self.structure.account)
                found.append(table)
        return found


def _volume(section: Section) -> float:
    """Of a section in m^3, whose diameters change linearly."""
    (a, b), (c, d) = section.outer, section.inner
    return math.pi * section.length * (a * a + a * b + b * b - c * c - c * d - d * d) / 12.0
