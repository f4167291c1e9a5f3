"""What a REXS file holds: components with attributes, relations between them, load cases; and its units as factors to SI.

Texts of units differ by version: an angle has "°" up to 1.3 and "deg" from 1.4 on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Value:
    """A value as the file has it: text, number, truth value or a list of them, and the text of its unit."""

    raw: object
    unit: str = ""


@dataclass(frozen=True)
class Component:
    """A component: its number, type, name and attributes."""

    id: str
    type: str
    name: str
    attributes: dict[str, Value] = field(default_factory=dict)

    def given(self, name: str) -> Value | None:
        """The value of an attribute; None where it is not there, or empty."""
        value = self.attributes.get(name)
        return None if value is None or value.raw in (None, "", []) else value

    def __str__(self) -> str:
        return f"{self.type} '{self.name}' (id {self.id})" if self.name else f"{self.type} (id {self.id})"


@dataclass(frozen=True)
class Relation:
    """A relation: its type, and role and component of each that takes part."""

    type: str
    refs: tuple[tuple[str, str], ...]

    def at(self, *roles: str) -> list[str]:
        """Numbers of the components in one of these roles."""
        return [number for role, number in self.refs if role in roles]


@dataclass(frozen=True)
class Document:
    """A file: version, program that wrote it, components by number, relations, and load cases: attributes by component."""

    version: str
    application: str
    components: dict[str, Component]
    relations: tuple[Relation, ...]
    load_cases: tuple[tuple[str, dict[str, dict[str, Value]]], ...] = ()

    def of_type(self, *types: str) -> list[Component]:
        """The components of some types, in the order of the file."""
        return [component for component in self.components.values() if component.type in types]


_TURN = 2.0 * math.pi
_DEGREE = math.pi / 180.0
# Factors by kind of quantity; the first unit of each is the one that the REXS database gives the attributes read here.
FACTORS: dict[str, dict[str, float]] = {
    "length": {"mm": 1e-3, "mum": 1e-6, "um": 1e-6, "cm": 1e-2, "dm": 0.1, "m": 1.0, "in": 0.0254, "inch": 0.0254},
    "angle": {"deg": _DEGREE, "°": _DEGREE, "degree": _DEGREE, "rad": 1.0, "mrad": 1e-3},
    "speed": {
        "1/min": _TURN / 60.0,
        "rpm": _TURN / 60.0,
        "rev/min": _TURN / 60.0,
        "min^-1": _TURN / 60.0,
        "1/s": _TURN,
        "Hz": _TURN,
        "rad/s": 1.0,
        "deg/s": _DEGREE,
    },
    "force": {"N": 1.0, "kN": 1e3, "MN": 1e6},
    # Load ratings of bearings are in kN, forces of loads in N.
    "rating": {"kN": 1e3, "N": 1.0, "MN": 1e6},
    "torque": {"Nm": 1.0, "Nmm": 1e-3, "kNm": 1e3},
    "power": {"kW": 1e3, "W": 1.0, "MW": 1e6},
    "stiffness": {"N/m": 1.0, "N/mm": 1e3, "N/mum": 1e6, "N/um": 1e6, "kN/mm": 1e6},
    "rotational_stiffness": {
        "Nmm/rad": 1e-3,
        "Nm/rad": 1.0,
        "kNm/rad": 1e3,
        "Nm/deg": 1.0 / _DEGREE,
        "Nm/°": 1.0 / _DEGREE,
        "Nmm/deg": 1e-3 / _DEGREE,
        "Nmm/°": 1e-3 / _DEGREE,
    },
    "modulus": {"N/mm^2": 1e6, "MPa": 1e6, "Pa": 1.0, "GPa": 1e9, "N/m^2": 1.0},
    "density": {"kg/dm^3": 1e3, "kg/m^3": 1.0, "g/cm^3": 1e3, "kg/mm^3": 1e9},
    "mass": {"kg": 1.0, "g": 1e-3, "t": 1e3},
    "inertia": {"kgm^2": 1.0, "kgmm^2": 1e-6},
    "ratio": {"": 1.0, "%": 1e-2},
}
# What no gearbox has, in SI: a number beyond it means "unlimited" or "not set" and is taken for missing. Stiffnesses, moduli
# and densities have bounds of their own where they are read.
LARGEST = {
    "length": 1e3,
    "angle": 1e3,
    "speed": 1e6,
    "force": 1e10,
    "rating": 1e10,
    "torque": 1e10,
    "power": 1e12,
    "mass": 1e7,
    "inertia": 1e9,
    "ratio": 1e5,
}
_SPELLINGS = (("µ", "mu"), ("μ", "mu"), ("²", "^2"), ("³", "^3"), ("º", "°"), ("·", ""), ("*", ""), (" ", ""))
_NOTHING = ("", "none", "-", "1")


def factor_of(kind: str, unit: str) -> float | None:
    """Factor to SI of a unit by its text; None where the text is no unit of this kind.

    No unit at all means that of the REXS database: each attribute has one there, and some programs leave it out.
    """
    text = unit
    for old, new in _SPELLINGS:
        text = text.replace(old, new)
    known = FACTORS[kind]
    if text in _NOTHING:
        return next(iter(known.values()))
    return known.get(text)
