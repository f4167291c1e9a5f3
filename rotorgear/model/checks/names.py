"""Which part names which other one: checks of names, and the model without some of its parts."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from rotorgear.errors import Problem
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.problems import address as address_of
from rotorgear.model.parts.problems import shown
from rotorgear.model.parts.shaft import LIBRARY
from rotorgear.model.parts.tables import Tables
from rotorgear.note import Note
from rotorgear.quantity import nearest

PartName = tuple[str, str]  # (table, name); the name "" stands for the whole table

TABLES = (
    "materials",
    "shafts",
    "disks",
    "point_masses",
    "gears",
    "meshes",
    "bearings",
    "casings",
    "supports",
    "couplings",
    "nonlinear_elements",
    "loads",
    "unbalances",
    "points",
)

ON_SHAFTS = ("disks", "point_masses", "gears", "bearings", "supports", "nonlinear_elements")


@dataclass(frozen=True)
class Reference:
    """`key` of part `owner` names the part `target`."""

    owner: PartName
    key: str
    target: PartName

    @property
    def address(self) -> str:
        """Where the name stands in the file."""
        return ".".join(item for item in (*self.owner, self.key) if item)


def references(model: Tables) -> Iterator[Reference]:
    """Yield every name of a shaft, a gear or another part that some part gives (materials apart)."""
    for table in (*ON_SHAFTS, "unbalances"):
        for name, part in getattr(model, table).items():
            yield Reference((table, name), "shaft", ("shafts", part.shaft))
    for name, load in model.loads.items():
        named = {"shaft": load.shaft, "gear": load.gear, "point": load.point, "order_of": load.order_of}
        for key, part in named.items():
            if part is not None:
                table = "shafts" if key == "order_of" else f"{key}s"
                yield Reference(("loads", name), key, (table, part))
    for name, mesh in model.meshes.items():
        yield Reference(("meshes", name), "pinion", ("gears", mesh.pinion))
        yield Reference(("meshes", name), "gear", ("gears", mesh.gear))
    for name, coupling in model.couplings.items():
        yield Reference(("couplings", name), "from_shaft", ("shafts", coupling.from_shaft))
        yield Reference(("couplings", name), "to_shaft", ("shafts", coupling.to_shaft))
    for table in ("bearings", "nonlinear_elements"):
        for name, part in getattr(model, table).items():
            if part.casing is not None:
                yield Reference((table, name), "casing", ("casings", part.casing))
    for name, element in model.nonlinear_elements.items():
        if element.to_shaft is not None:
            yield Reference(("nonlinear_elements", name), "to_shaft", ("shafts", element.to_shaft))
    for name, point in model.points.items():
        if point.on is not None:
            table, _, part = point.on.partition(".")
            yield Reference(("points", name), "on", (table, part))
        elif point.shaft is not None:
            yield Reference(("points", name), "shaft", ("shafts", point.shaft))
    if model.operation:
        yield Reference(("operation", ""), "input_shaft", ("shafts", model.operation.input_shaft))
        if model.operation.output_shaft is not None:
            yield Reference(("operation", ""), "output_shaft", ("shafts", model.operation.output_shaft))


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
    arrows = [(item.owner, item.target) for item in references(model)]
    while lost := {owner for owner, target in arrows if owner not in gone and _is_lost(model, target, gone)}:
        gone |= lost
    rest = sound(model, gone)
    known = {*LIBRARY, *rest.materials}
    shafts = {}
    for shaft_name, shaft in rest.shafts.items():
        sections = tuple(
            section
            if section.material is None or section.material in known
            else section.model_copy(update={"material": None})
            for section in shaft.sections
        )
        material = shaft.material if shaft.material in known else "steel"
        shafts[shaft_name] = shaft.model_copy(update={"sections": sections, "material": material})
    bodies: dict[str, Any] = {
        table: {
            name: part
            if part.material is None or part.material in known
            else part.model_copy(update={"material": None})
            for name, part in getattr(rest, table).items()
        }
        for table in ("gears", "disks", "casings")
    }
    return rest.model_copy(update={"shafts": shafts, **bodies})


def _is_lost(model: Tables, target: PartName, gone: set[PartName]) -> bool:
    table, name = target
    return target in gone or ((table, "") in gone and name not in getattr(model, table, {}))


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
            # It has a place on the surface of the casing, which moves along x, y and z.
            if point.place is None:
                yield Problem(
                    f"{address}.place", "", "missing", "required on a casing: x y z of a place on its surface"
                )
            if point.shaft is not None or point.at is not None:
                yield Problem(address, "on together with shaft or at", "one of the two ways to give the place")
            if point.direction not in ("x", "y", "z"):
                yield Problem(f"{address}.direction", f"'{point.direction}'", "x, y or z: a surface has no rotations")
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


def estimated(layout: Layout) -> Iterator[Note]:
    """Yield a fact on every bearing whose rolling elements follow from its boundary dimensions."""
    for name, bearing in layout.model.bearings.items():
        for kind, geometry in bearing.geometries.items():
            what, why, value = geometry.estimate
            if what:
                yield Note(f"bearings.{name}.{kind}", what, why, value)
