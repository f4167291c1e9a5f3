"""Speeds of the shafts of an import, by the walk over the train that models have."""

from __future__ import annotations

from rotorgear.files.toml import tables_of
from rotorgear.model.layout.carriers import repeated
from rotorgear.model.layout.walk import walk
from rotorgear.model.parts.tables import Tables
from rotorgear.rexs.toml_text import Table, quantity, text

_OF_THE_TRAIN = ("shafts.", "carriers.", "gears.", "meshes.", "couplings.")


def speed_ratios(tables: list[Table], reference: str, speed: float) -> dict[str, float]:
    """Speed of each shaft over that of one, by name; only of those that the train joins to it.

    Args:
        tables: of the model file. reference: name of that shaft.
        speed: its speed in rad/s; 0: none is known.
    """
    operation = Table("operation", rows=[("input_shaft", text(reference), ""), ("speed", quantity(speed, "speed"), "")])
    lines = [line for table in (operation, *tables) if _counts(table) for line in table.lines()]
    try:
        whole, _ = repeated(Tables(**tables_of("\n".join(lines))))
    except ValueError:  # a number that no part can have, which is told where the model is made
        return {reference: 1.0}
    train, _ = walk(whole)
    group = train.group.get(reference)
    return {name: train.ratio(name) for name in train.ratios if train.group[name] == group}


def _counts(table: Table) -> bool:
    return table.header == "operation" or table.header.startswith(_OF_THE_TRAIN)
