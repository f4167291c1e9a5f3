"""Which part names which other one: checks of names, and the model without some of its parts."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import Any, get_origin

from rotorgear.errors import Problem
from rotorgear.model.parts.problems import address as address_of
from rotorgear.model.parts.problems import shown, told
from rotorgear.model.parts.references import ON_SHAFTS, PartName, references
from rotorgear.model.parts.shaft import LIBRARY
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import nearest

# Tables of parts by name.
_FIELDS = Tables.model_fields.items()
TABLES = tuple(key for key, field in _FIELDS if get_origin(field.annotation) is dict and key != "scatter")


def part_of(address: str) -> PartName:
    """Return the table and the name of the part that an address lies in."""
    table, _, rest = address.partition(".")
    return table, "" if table == "operation" else rest.split(".")[0].split("[")[0]


def sound(model: Tables, broken: Collection[PartName]) -> Tables:
    """Return the model without some parts; what refers to them stays."""
    kept: dict[str, Any] = {
        table: {name: part for name, part in getattr(model, table).items() if (table, name) not in broken}
        for table in TABLES
    }
    operation = None if ("operation", "") in broken else model.operation
    return model.model_copy(update={**kept, "operation": operation})


def without(model: Tables, dropped: Iterable[PartName]) -> Tables:
    """Return the model without some parts and all that stands on them; materials that are not there become the default."""
    gone = set(dropped)
    arrows = list(references(model))
    while lost := {owner for owner, _, target in arrows if owner not in gone and _is_lost(model, target, gone)}:
        gone |= lost
    rest = sound(model, gone)
    known = {None, *LIBRARY, *rest.materials}

    def dressed(part: Any, default: str | None = None, **changes: Any) -> Any:
        """A part of a known material, else of the default."""
        return part.model_copy(update=changes | ({} if part.material in known else {"material": default}))

    tables: dict[str, Any] = {
        table: {name: dressed(part) for name, part in getattr(rest, table).items()}
        for table in ("gears", "disks", "casings")
    }
    tables["shafts"] = {
        name: dressed(shaft, "steel", sections=tuple(map(dressed, shaft.sections)))
        for name, shaft in rest.shafts.items()
    }
    return rest.model_copy(update=tables)


def _is_lost(model: Tables, target: PartName, gone: set[PartName]) -> bool:
    table, name = target
    return target in gone or ((table, "") in gone and name not in getattr(model, table, {}))


# Tables of what a point may be on.
_WITH_POINTS = (*ON_SHAFTS, "casings", "couplings")

_SINGULAR = {"meshes": "mesh"}

Broken = Collection[PartName]
_LISTED = 20  # names that a hint lists at most


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
    for owner, key, (table, name) in references(model):
        address = ".".join(item for item in (*owner, key) if item)
        if key != "on":
            if not _is_known(model, table, name, broken):
                yield unknown(
                    address, name, _names(model, table, broken), f"a {_SINGULAR.get(table, table.removesuffix('s'))}"
                )
        # What a point is on is written with its table, which may be wrong itself: then all parts on shafts are valid.
        elif table not in _WITH_POINTS or not _is_known(model, table, name, broken):
            tables = [table] if table in _WITH_POINTS else ON_SHAFTS
            valid = [f"{one}.{part}" for one in tables for part in _names(model, one, broken)]
            yield unknown(address, f"{table}.{name}" if name else table, valid, "a part such as 'bearings.left'")


def _names(model: Tables, table: str, broken: Broken) -> list[str]:
    """Names in a table of the file, those of broken parts at the end."""
    lost = sorted(name for owner, name in broken if owner == table and name)
    return list(dict.fromkeys([*getattr(model, table), *lost]))


def _is_known(model: Tables, table: str, name: str, broken: Broken) -> bool:
    return name in getattr(model, table) or (table, name) in broken or (table, "") in broken


def points(model: Tables) -> Iterator[Problem]:
    """A point is on a part, or at a place of a shaft."""
    for name, point in model.points.items():
        address = f"points.{name}"
        keys = [key for key in ("shaft", "at") if getattr(point, key) is not None]
        either = "one of the two ways to give the place"
        if point.on_casing is not None:
            # It has a place on the surface of the casing, which moves along x, y and z.
            rotates = point.direction not in ("x", "y", "z")
            place = "required on a casing: x y z of a place on its surface"
            yield from told(
                address,
                ("place", point.place is None, "", "missing", place),
                ("", keys, "on together with shaft or at", either),
                ("direction", rotates, f"'{point.direction}'", "x, y or z: a surface has no rotations"),
            )
        elif point.place is not None:
            yield Problem(f"{address}.place", "a place", "on = 'casings.NAME' beside it, or shaft and at")
        elif point.on is not None and keys:
            yield Problem(address, f"on together with {keys[0]}", either)
        elif point.on is None and point.shaft is None:
            yield Problem(address, "neither on nor shaft", "either on = 'bearings.left' or shaft and at")
        elif point.on is None and point.at is None:
            yield Problem(f"{address}.at", "", "missing", "required beside shaft: z on that shaft")


def unknown_materials(model: Tables, broken: Broken) -> Iterator[Problem]:
    """Names of materials that are neither in the file nor in the library."""
    named: list[tuple[str, Any]] = list(model.parts_of("shafts"))
    for address, shaft in model.parts_of("shafts"):
        named += [(f"{address}.sections[{number}]", section) for number, section in enumerate(shaft.sections)]
    named += model.parts_of("gears", "disks", "casings")
    named += [(f"gears.{name}.body", gear.body) for name, gear in model.gears.items()]
    valid = [*_names(model, "materials", broken), *LIBRARY]
    for address, part in named:
        if part.material is not None and part.material not in valid and ("materials", "") not in broken:
            yield unknown(f"{address}.material", part.material, valid, "a material")
