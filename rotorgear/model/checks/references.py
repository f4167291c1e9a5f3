"""Which part names which other one, and the model without some of its parts."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from rotorgear.model.parts.shaft import LIBRARY
from rotorgear.model.parts.tables import Tables

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
