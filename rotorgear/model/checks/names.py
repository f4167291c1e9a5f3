"""Checks of names: duplicates, references to parts and materials that are there, points."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.references import ON_SHAFTS, TABLES, PartName, references
from rotorgear.model.parts.operation import Point
from rotorgear.model.parts.problems import address as address_of
from rotorgear.model.parts.problems import shown
from rotorgear.model.parts.shaft import LIBRARY
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import nearest

# Tables of what a point may be on.
_WITH_POINTS = (*ON_SHAFTS, "casings")

Broken = Collection[PartName]
_LISTED = 20  # so many names a hint lists at most


def unknown(address: str, name: str, valid: list[str], kind: str) -> Problem:
    """Return the problem of a name that is not there, with the nearest one that is."""
    guess = nearest(name, valid)
    listed = ", ".join(address_of((item,)) for item in valid[:_LISTED]) + (" ..." if len(valid) > _LISTED else "")
    hint = f"did you mean {shown(guess)}?" if guess else f"there is: {listed}" if valid else "there is none"
    return Problem(address, shown(name), f"the name of {kind}", hint)


def duplicate_names(model: Tables, broken: Broken) -> Iterator[Problem]:
    """Names that differ in capitals, blanks or dashes only are one name to a reader."""
    for table in TABLES:
        seen: dict[str, str] = {}
        for name in _names(model, table, broken):
            key = "".join(character for character in name.casefold() if character.isalnum())
            if key in seen:
                text = f"the same name as '{seen[key]}' but for capitals, blanks or dashes"
                yield Problem(f"{table}.{name}", text, "names that differ in letters or digits")
            seen.setdefault(key, name)


def unknown_names(model: Tables, broken: Broken) -> Iterator[Problem]:
    """Names of shafts, gears and other parts that are not there."""
    for item in references(model):
        table, name = item.target
        if item.key != "on":
            if not _is_known(model, table, name, broken):
                yield unknown(item.address, name, _names(model, table, broken), f"a {table.removesuffix('s')}")
        # What a point is on is written with its table, which may be wrong itself: then all parts on shafts are valid.
        elif table not in _WITH_POINTS or not _is_known(model, table, name, broken):
            tables = [table] if table in _WITH_POINTS else ON_SHAFTS
            valid = [f"{owner}.{part}" for owner in tables for part in _names(model, owner, broken)]
            yield unknown(item.address, f"{table}.{name}" if name else table, valid, "a part such as 'bearings.left'")


def _names(model: Tables, table: str, broken: Broken) -> list[str]:
    """Names in a table of the file, those of broken parts at the end."""
    return list(
        dict.fromkeys([*getattr(model, table), *sorted(name for owner, name in broken if owner == table and name)])
    )


def _is_known(model: Tables, table: str, name: str, broken: Broken) -> bool:
    return name in getattr(model, table) or (table, name) in broken or (table, "") in broken


def points(model: Tables) -> Iterator[Problem]:
    """A point is on a part, or at a place of a shaft."""
    for name, point in model.points.items():
        address = f"points.{name}"
        if point.on_casing is None and point.place is not None:
            yield Problem(f"{address}.place", "a place", "on = 'casings.NAME' beside it, or shaft and at")
        elif point.on_casing is not None:
            yield from _on_casing(address, point)
        elif point.on is None and point.shaft is None:
            yield Problem(address, "neither on nor shaft", "either on = 'bearings.left' or shaft and at")
        elif point.on is not None and (point.shaft is not None or point.at is not None):
            yield Problem(
                address,
                f"on together with {'at' if point.shaft is None else 'shaft'}",
                "one of the two ways to give the place",
            )
        elif point.on is None and point.at is None:
            yield Problem(f"{address}.at", "", "missing", "required beside shaft: z on that shaft")


def _on_casing(address: str, point: Point) -> Iterator[Problem]:
    """A point on a casing has a place on its surface, which moves along x, y and z."""
    if point.place is None:
        yield Problem(f"{address}.place", "", "missing", "required on a casing: x y z of a place on its surface")
    if point.shaft is not None or point.at is not None:
        yield Problem(address, "on together with shaft or at", "one of the two ways to give the place")
    if point.direction not in ("x", "y", "z"):
        yield Problem(f"{address}.direction", f"'{point.direction}'", "x, y or z: a surface has no rotations")


def unknown_materials(model: Tables, broken: Broken) -> Iterator[Problem]:
    """Names of materials that are neither in the file nor in the library."""
    named = [(f"shafts.{name}.material", shaft.material) for name, shaft in model.shafts.items()]
    named += [
        (f"shafts.{name}.sections[{number}].material", section.material)
        for name, shaft in model.shafts.items()
        for number, section in enumerate(shaft.sections)
        if section.material is not None
    ]
    named += [
        (f"{table}.{name}.material", part.material)
        for table in ("gears", "disks", "casings")
        for name, part in getattr(model, table).items()
        if part.material is not None
    ]
    named += [
        (f"gears.{name}.body.material", gear.body.material)
        for name, gear in model.gears.items()
        if gear.body.material is not None
    ]
    valid = [*_names(model, "materials", broken), *LIBRARY]
    for address, material in named:
        if material not in valid and ("materials", "") not in broken:
            yield unknown(address, material, valid, "a material")
