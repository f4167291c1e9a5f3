"""REXS documents put together for tests, by short lists of parts."""

from __future__ import annotations

import math

from rotorgear.rexs.document import Component, Document, Relation, Value

MM = "mm"


class Written:
    """A document that grows part by part; numbers are given in mm, N/m and rpm."""

    def __init__(self, version: str = "1.6") -> None:
        self.version = version
        self.components: dict[str, Component] = {}
        self.relations: list[Relation] = []
        self.unit = self.add("gear_unit", "unit")
        self.casing = self.add("gear_casing", "casing")

    def add(self, kind: str, name: str, **attributes: Value) -> str:
        """A component; returns its number."""
        number = str(len(self.components) + 1)
        self.components[number] = Component(number, kind, name, attributes)
        return number

    def join(self, kind: str, **roles: str) -> None:
        """A relation."""
        self.relations.append(Relation(kind, tuple(roles.items())))

    def shaft(self, name: str, v: float = 0.0, w: float = 0.0, *, d: float = 30.0, **attributes: Value) -> str:
        """A shaft of one section from u = 0 to 100 mm, parallel to the gear unit."""
        number = self.add("shaft", name, support_vector=Value([0.0, v, w], MM), **attributes)
        section = self.add("shaft_section", "", length=Value(100.0, MM), outer_diameter_begin=Value(d, MM))
        self.join("assembly", assembly=number, part=section)
        return number

    def gear(
        self, name: str, shaft: str, teeth: int, *, u: float = 50.0, module: float = 2.0, ring: bool = False
    ) -> str:
        """A spur gear without profile shift."""
        attributes = {
            "number_of_teeth": Value(teeth),
            "normal_module": Value(module, MM),
            "face_width": Value(10.0, MM),
            "u_coordinate_on_shaft": Value(u, MM),
            "helix_angle": Value(0.0, "deg"),
        }
        number = self.add("ring_gear" if ring else "cylindrical_gear", name, **attributes)
        self.join("assembly", assembly=shaft, part=number)
        return number

    def mesh(self, name: str, one: str, other: str) -> None:
        """A cylindrical stage."""
        stage = self.add("cylindrical_stage", name)
        self.join("stage", stage=stage, gear_1=one, gear_2=other)

    def bearing(self, name: str, inner: str, outer: str, u: float, k: float = 1e8) -> str:
        """A bearing that holds in all directions."""
        attributes = {
            "u_coordinate_on_shaft_inner_side": Value(u, MM),
            "u_coordinate_on_shaft_outer_side": Value(u, MM),
            "radial_stiffness": Value(k, "N / m"),
            "axial_stiffness": Value(k, "N / m"),
            "axial_force_absorption": Value("both_directions"),
        }
        number = self.add("concept_bearing", name, **attributes)
        self.join("side", assembly=number, inner_part=inner, outer_part=outer)
        return number

    def held(self, shaft: str) -> None:
        """A coupling between a shaft and the casing."""
        number = self.add("coupling", "brake", u_coordinate_on_shaft_inner_side=Value(50.0, MM))
        self.join("side", assembly=number, inner_part=shaft, outer_part=self.casing)

    def planets(self, stage: str, name: str, count: int, radius: float, first: float = 0.0) -> list[tuple[str, str]]:
        """Shafts of planets on a circle, the first at an angle in rad, each with a pin in two bearings: planet and pin."""
        found = []
        for k in range(count):
            angle = first + 2.0 * math.pi * k / count
            place = (radius * math.cos(angle), radius * math.sin(angle))
            planet = self.shaft(f"{name} {k}", *place, d=20.0)
            pin = self.shaft(f"{name} pin {k}", *place, d=10.0)
            self.join("planet_shaft", planetary_stage=stage, shaft=planet)
            self.join("planet_pin", planetary_stage=stage, shaft=pin)
            for u in (20.0, 80.0):
                self.bearing(f"{name} {k} at {u:g}", pin, planet, u)
            found.append((planet, pin))
        return found

    def document(self) -> Document:
        """What was put together."""
        return Document(self.version, "tests", self.components, tuple(self.relations))
