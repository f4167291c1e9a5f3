"""Makes the best of a file with mistakes in single fields, so that the rest of it can be checked in the same go.

A misspelt key is read as the key that it is nearest to; a wrong value is taken out, with the whole part where it can't be
without, and what refers to the part is known to refer to something. Only the report uses the result: no model comes out of
a file with a mistake.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydantic import ValidationError

from rotorgear.errors import Problem
from rotorgear.model.checks.names import TABLES
from rotorgear.model.parts.problems import Loc, class_at, from_validation, guessed_key, root_causes
from rotorgear.model.parts.references import PartName
from rotorgear.model.parts.tables import Tables


def repaired(data: dict[str, Any]) -> tuple[list[Problem], Tables, set[PartName]]:
    """Return the problems of single fields, the tables without the parts that have them, and the names of these parts."""
    problems: list[Problem] = []
    broken: set[PartName] = set()
    renamed: set[Loc] = set()
    while True:  # a misspelt table is looked into in the next round; every round mends all that the one before found
        try:
            return problems, Tables.model_validate(data), broken
        except ValidationError as error:
            found = from_validation(error, Tables, renamed)
            version = [problem for problem in found if problem.address == "schema_version"]
            if version:  # another format: everything else would be guesswork
                return version, Tables(), {("shafts", "")}
            problems += found
            for item in root_causes(error, Tables):
                data = _mended(data, item, broken, renamed)


def _mended(data: dict[str, Any], item: Any, broken: set[PartName], renamed: set[Loc]) -> dict[str, Any]:
    """Return a copy of the data without one mistake."""
    loc: Loc = item["loc"]
    if item["type"] == "extra_forbidden":
        guess = guessed_key(item, Tables)
        if guess or len(loc) == 1:
            renamed.add((*loc[:-1], guess))
            return _edited(data, loc[:-1], lambda table: _rename(table, loc[-1], guess))
    table = str(loc[0])
    depth = 2 if table in TABLES and len(loc) > 1 and isinstance(data.get(table), dict) else 1
    broken.add((table, str(loc[1]) if depth == 2 else ""))
    # A part is still one without a key that isn't required; its names of other parts can be checked then.
    owner = class_at(loc[:depth], Tables)
    field = owner.model_fields.get(str(loc[depth])) if owner and len(loc) > depth else None
    wrong = loc[:depth] if field is None or field.is_required() else loc[: depth + 1]
    return _edited(data, wrong[:-1], lambda parts: parts.pop(wrong[-1], None))


def _rename(table: dict[Any, Any], old: Any, new: str) -> None:
    """Move an entry to the key that was meant; two tables of parts become one."""
    value = table.pop(old, None)
    if not new:
        return
    if isinstance(value, dict) and isinstance(table.get(new), dict):
        table[new] = {**value, **table[new]}
    else:
        table.setdefault(new, value)


def _edited(data: Any, loc: Loc, change: Callable[[dict[Any, Any]], Any]) -> Any:
    """Return a copy of nested tables with a change in the one at `loc`; nothing changes where it is gone already."""
    if not loc:
        copy = dict(data)
        change(copy)
        return copy
    try:
        below = data[loc[0]]
    except (KeyError, IndexError, TypeError):
        return data
    if not isinstance(below, dict | list | tuple):
        return data
    twin: Any = list(data) if isinstance(data, list | tuple) else dict(data)
    twin[loc[0]] = _edited(below, loc[1:], change)
    return twin
