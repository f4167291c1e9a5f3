"""Turns what pydantic says of a part into `Problem`s: address, value, what was expected, nearest valid name."""

from __future__ import annotations

import json
import math
import re
import types
import typing
from collections.abc import Collection, Iterable, Iterator
from typing import Any

from pydantic import BaseModel, ValidationError

from rotorgear.errors import Problem
from rotorgear.model.parts.synonyms import meant
from rotorgear.quantity import did_you_mean, nearest

Loc = tuple[int | str, ...]
# Pydantic's marks in a location of which kind of value it took: no keys of the file.
LIST = "[list]"
TABLE = "[table]"
_LONGEST = 60
_TYPES = {
    "model_type": "a table",
    "model_attributes_type": "a table",
    "dict_type": "a table of named parts",
    "tuple_type": "a list in brackets",
    "string_type": "a text in quotes",
    "bool_type": "true or false",
}
_BOUNDS = {
    "greater_than_equal": ("at least", "ge"),
    "greater_than": ("more than", "gt"),
    "less_than_equal": ("at most", "le"),
    "less_than": ("less than", "lt"),
}


def address(loc: Iterable[int | str]) -> str:
    """Write a location as it reads in the file: shafts.input.sections[0].length."""
    text = ""
    for item in loc:
        if isinstance(item, int):
            text += f"[{item}]"
        elif item != "[key]":  # pydantic's mark of a name that is wrong itself
            name = item if re.fullmatch(r"[\w -]{1,60}", item) else shown(item)
            text += f".{name}" if text else name
    return text


def shown(value: Any) -> str:
    """Write a value as the file has it, on one line and short."""
    if isinstance(value, str):
        text = f"'{value}'" if value.isprintable() else repr(value)
    elif isinstance(value, dict | BaseModel):
        text = "a table" if value else "an empty table"
    elif isinstance(value, float) and not math.isfinite(value):
        text = str(value)
    else:
        try:
            text = json.dumps(value, default=str)
        except (TypeError, ValueError, RecursionError):  # such as a whole number of thousands of digits
            text = "a list" if isinstance(value, list | tuple) else f"a {type(value).__name__} that can't be shown"
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


def told(where: str, *rows: tuple[Any, ...]) -> Iterator[Problem]:
    """Rows of a table of checks that apply: key at `where` or "", whether it is wrong, value, what was expected, and a hint."""
    for key, wrong, *texts in rows:
        if wrong:
            yield Problem(f"{where}.{key}" if key else where, *texts)


def missing(where: str, why: str) -> Problem:
    """The problem of a key that is needed."""
    return Problem(where, "", "missing", f"required: {why}")


def not_default(part: BaseModel, keys: Iterable[str]) -> list[str]:
    """Which of some keys of a part have another value than their default."""
    fields = type(part).model_fields
    return [key for key in keys if getattr(part, key) != fields[key].get_default(call_default_factory=True)]


def from_validation(error: ValidationError, root: type[BaseModel], silent: Collection[Loc] = ()) -> list[Problem]:
    """List the problems of a pydantic error, those of unknown keys with the nearest valid name.

    Args:
        error: what pydantic raised.
        root: the class that it validated.
        silent: locations that need no report.
    """
    found = [_problem(item, root) for item in root_causes(error, root) if item["loc"] not in silent]
    return list(dict.fromkeys(found))


def root_causes(error: ValidationError, root: type[BaseModel]) -> list[Any]:
    """List pydantic's single errors without the missing keys that stand there misspelt: those are unknown keys already."""
    items: list[Any] = [
        {**item, "loc": tuple(key for key in item["loc"] if key not in (LIST, TABLE))}
        for item in error.errors(include_url=False)
    ]
    meant = {(*item["loc"][:-1], guessed_key(item, root)) for item in items if item["type"] == "extra_forbidden"}
    return [item for item in items if not (item["type"] == "missing" and item["loc"] in meant)]


def guessed_key(item: Any, root: type[BaseModel]) -> str:
    """Return the valid key that is nearest to an unknown one, or ""."""
    owner = class_at(item["loc"][:-1], root)
    word = str(item["loc"][-1])
    return meant(word, owner.model_fields) or nearest(word, list(owner.model_fields)) if owner else ""


def _problem(item: Any, root: type[BaseModel]) -> Problem:
    loc: Loc = item["loc"]
    where = address(loc) or "model"
    value = shown(item["input"])
    kind = item["type"]
    owner = class_at(loc[:-1], root)
    field = owner.model_fields.get(str(loc[-1])) if owner and loc else None
    description = (field.description if field else None) or ""
    if kind == "extra_forbidden":
        valid = list(owner.model_fields) if owner else []
        return Problem(where, "", "unknown key", _hint(str(loc[-1]), valid, root))
    if kind == "missing":
        return missing(where, description) if description else Problem(where, "", "missing", "required")
    if kind == "literal_error":
        listed = re.findall(r"'([^']+)'|(\w+)", item["ctx"]["expected"].replace(" or ", " "))
        choices = [text or number for text, number in listed]
        if len(choices) == 1:
            return Problem(where, value, choices[0], description)
        hint = did_you_mean(item["input"], choices) if isinstance(item["input"], str) else ""
        return Problem(where, value, "one of " + ", ".join(choices), hint)
    if kind == "too_short":
        return Problem(where, value, f"at least {item['ctx']['min_length']} entry")
    if kind in _BOUNDS:
        words, bound = _BOUNDS[kind]
        return Problem(where, value, f"{words} {item['ctx'][bound]:g}")
    return Problem(where, value, _TYPES.get(kind, str(item["msg"])))


def _hint(word: str, valid: list[str], root: type[BaseModel]) -> str:
    """What an unknown key may have been meant for: a word of the field, a key of a table elsewhere, a misspelling."""
    guess = meant(word, valid)
    if guess:
        return f"here that is '{guess}'"
    tables = {name: class_at((name,), root) or class_at((name, ""), root) for name in root.model_fields}
    owners = [name for name, part in tables.items() if part is not None and word in part.model_fields]
    if owners and not nearest(word, valid):
        return f"it is a key of {' and of '.join(f'[{name}]' for name in owners[:2])}"
    return did_you_mean(word, valid, "valid here: " + ", ".join(valid))


def class_at(loc: Loc, root: type[BaseModel]) -> type[BaseModel] | None:
    """Return the part class at a location, walking dicts by name and tuples by index."""
    current: Any = root
    for item in loc:
        if isinstance(current, type) and issubclass(current, BaseModel):
            field = current.model_fields.get(str(item))
            if field is None:
                return None
            current = _strip(field.annotation)
            continue
        args = typing.get_args(current)
        if not args:
            return None
        current = _strip(args[-1] if typing.get_origin(current) is dict else args[0])
    return current if isinstance(current, type) and issubclass(current, BaseModel) else None


def _strip(annotation: Any) -> Any:
    """Drop Annotated and None from an annotation; of several kinds of values take the part, else the first."""
    while typing.get_origin(annotation) is typing.Annotated:
        annotation = typing.get_args(annotation)[0]
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        rest = [_strip(arg) for arg in typing.get_args(annotation) if arg is not type(None)]
        return next((arg for arg in rest if isinstance(arg, type) and issubclass(arg, BaseModel)), rest[0])
    return annotation
