"""The files that the tables of a model name: meshes, matrices, topographies, histories."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any


def with_named_files(data: dict[str, Any], named: Callable[[str], str]) -> None:
    """Give the files that the tables of a model name other names: the program looks for them beside the model file."""

    def parts(name: str) -> Iterable[Any]:
        table = data.get(name)
        return table.values() if isinstance(table, dict) else ()

    def find(table: Any, *keys: str) -> None:
        for key in keys if isinstance(table, dict) else ():
            if isinstance(table.get(key), str):
                table[key] = named(table[key])

    for gear in parts("gears"):
        if isinstance(gear, dict):
            find(gear.get("flank"), "topography")
            find(gear.get("body"), "mesh")
    for load in parts("loads"):
        find(load, "history")
    for casing in parts("casings"):
        find(casing, "mesh", "matrices")
        if isinstance(casing, dict) and isinstance(casing.get("mesh"), dict):
            find(casing["mesh"], *casing["mesh"])
