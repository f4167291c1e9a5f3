"""Which part of a model names which other one."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.model.parts.shaft import PositionByMesh
from rotorgear.model.parts.tables import Tables

PartName = tuple[str, str]  # (table, name); the name "" stands for the whole table

ON_SHAFTS = ("disks", "point_masses", "gears", "bearings", "supports", "nonlinear_elements")

# Keys of a part that name another one, with the table of that one.
_NAMES: tuple[tuple[str, dict[str, str]], ...] = (
    *((table, {"shaft": "shafts"}) for table in (*ON_SHAFTS, "unbalances")),
    ("shafts", {"carrier": "carriers"}),
    ("carriers", {"shaft": "shafts"}),
    ("loads", {"shaft": "shafts", "gear": "gears", "point": "points", "order_of": "shafts"}),
    ("meshes", {"pinion": "gears", "gear": "gears"}),
    ("couplings", {"from_shaft": "shafts", "to_shaft": "shafts"}),
    ("gears", {"casing": "casings"}),
    ("bearings", {"casing": "casings"}),
    ("nonlinear_elements", {"casing": "casings"}),
    ("nonlinear_elements", {"to_shaft": "shafts"}),
)


def references(model: Tables) -> Iterator[tuple[PartName, str, PartName]]:
    """Yield a part, its key, and the shaft, gear or other part that the key names (materials apart)."""
    for table, keys in _NAMES:
        for name, part in getattr(model, table).items():
            for key, named in keys.items():
                in_casing = table == "gears" and key == "shaft" and part.casing is not None
                if (target := getattr(part, key)) is not None and not in_casing:
                    yield (table, name), key, (named, target)
    for name, shaft in model.shafts.items():
        if isinstance(shaft.position, PositionByMesh):
            yield ("shafts", name), "position.mesh", ("meshes", shaft.position.mesh)
    for name, point in model.points.items():
        if point.on is not None:
            table, _, part = point.on.partition(".")
            yield ("points", name), "on", (table, part)
        elif point.shaft is not None:
            yield ("points", name), "shaft", ("shafts", point.shaft)
    for key in ("input_shaft", "output_shaft") if model.operation else ():
        if (reference := getattr(model.operation, key)) is not None:
            yield ("operation", ""), key, ("shafts", reference)
