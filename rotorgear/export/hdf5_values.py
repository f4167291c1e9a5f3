"""Values of a result in HDF5: arrays, numbers, texts (UTF-8), dictionaries, the model, and records such as the table of nodes.

A dictionary of arrays is a group with `names` and `values`: a part's name may hold a slash, and the order counts. A record is a
group of its fields, a tuple of records a group of columns, or of numbered entries where they don't fit into columns. The model
is JSON in SI units, which keeps every digit of a float. The attribute `type` of each item names its
kind, which says how to read it; these names stand in files, so they stay.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import fields
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.results.schema import Record, record_name, record_of


def stored_fields(cls: type[Record]) -> list[str]:
    """Names of the fields of a record that belong in a file."""
    declared = cls.declarations
    return [item.name for item in fields(cls) if item.name not in declared or declared[item.name].stored]


def put_value(h5: ModuleType, parent: Any, name: str, value: Any) -> None:
    """Write one value under a name; TypeError for a kind of value that has no place in a file."""
    kind = _kind_of(value, name)
    match kind:
        case "nothing":
            parent[name] = h5.Empty("f8")
        case "text":
            parent.create_dataset(name, data=value, dtype=h5.string_dtype())
        case "model":
            parent.create_dataset(name, data=value.model_dump_json(exclude_none=True), dtype=h5.string_dtype())
        case "texts":
            _put_texts(h5, parent, name, value)
        case "lists":
            _put_texts(h5, parent, name, [json.dumps(entry) for entry in value])
        case "array" | "truth" | "integer" | "number":
            parent[name] = np.asarray(value)
        case _:
            _put_group(h5, parent.create_group(name), kind, value)
    parent[name].attrs["type"] = kind


def _put_group(h5: ModuleType, group: Any, kind: str, value: Any) -> None:
    """Write a value that consists of several ones."""
    match kind:
        case "notes":
            for key in _OF_A_NOTE:
                _put_texts(h5, group, key, [getattr(note, key) for note in value])
        case "record":
            group.attrs["record"] = record_name(type(value))
            for field in stored_fields(type(value)):
                put_value(h5, group, field, getattr(value, field))
        case "records":
            group.attrs["record"] = record_name(type(value[0]))
            for field in stored_fields(type(value[0])):
                column = tuple(getattr(record, field) for record in value)
                put_value(h5, group, field, column if isinstance(column[0], str | tuple) else np.array(column))
        case "numbers" | "arrays":
            _put_texts(h5, group, "names", list(value))
            group["values"] = np.array(list(value.values()))
        case "mapping":
            _put_texts(h5, group, "keys", [json.dumps(key) for key in value])
            _put_group(h5, group.create_group("values"), "sequence", value.values())
        case "sequence":
            for number, entry in enumerate(value):
                put_value(h5, group, str(number), entry)


def _kind_of(value: Any, name: str) -> str:
    """The kind of a value."""
    for kind, types in _TYPES:
        if isinstance(value, types):
            return kind
    if isinstance(value, tuple):
        if _fit_into_columns(value):
            return "records"
        if value and all(isinstance(entry, Note) for entry in value):
            return "notes"
        if _is_texts(value):
            return "texts"
        return "lists" if all(map(_is_texts, value)) else "sequence"
    if isinstance(value, dict):
        # A table has texts as keys, and numbers, or arrays of one shape and kind.
        shapes = {(np.shape(entry), np.asarray(entry).dtype) for entry in value.values()}
        if all(isinstance(key, str) for key in value) and len(shapes) <= 1:
            for kind, entries in (("numbers", float), ("arrays", np.ndarray)):
                if all(isinstance(entry, entries) for entry in value.values()):
                    return kind
        return "mapping"
    raise TypeError(f"{name} of type {type(value).__name__} has no form in HDF5")


def _fit_into_columns(value: tuple[Any, ...]) -> bool:
    """Whether they are records of one class with texts, lists of texts, or numbers of one kind in each field."""
    if not value or not isinstance(value[0], Record) or len({type(record) for record in value}) > 1:
        return False
    for name in stored_fields(type(value[0])):
        column = [getattr(record, name) for record in value]
        numbers = isinstance(column[0], str | bool | int | float) and len({type(entry) for entry in column}) == 1
        if not numbers and not all(map(_is_texts, column)):
            return False
    return True


def get_value(item: Any) -> Any:
    """Read what `put_value` wrote; KeyError, TypeError or ValueError for anything else."""
    match item.attrs["type"]:
        case "nothing":
            return None
        case "text":
            return item.asstr()[()]
        case "model":
            return Model(**json.loads(item.asstr()[()]))
        case "texts":
            return _get_texts(item)
        case "lists":
            return tuple(tuple(json.loads(text)) for text in _get_texts(item))
        case "array" | "truth" | "integer" | "number" as kind:
            return _PLAIN.get(kind, np.asarray)(item[()])
        case "notes":
            return tuple(Note(*row) for row in zip(*(_get_texts(item[key]) for key in _OF_A_NOTE), strict=True))
        case "record":
            cls, names = _stored_in(item)
            return cls(**{name: get_value(item[name]) for name in names})
        case "records":
            cls, names = _stored_in(item)
            columns = [get_value(item[name]) for name in names]
            plain = [column if isinstance(column, tuple) else column.tolist() for column in columns]
            return tuple(cls(**dict(zip(names, row, strict=True))) for row in zip(*plain, strict=True))
        case "numbers" | "arrays" as kind:
            values = map(_PLAIN.get(kind, np.asarray), item["values"][()])
            return dict(zip(_get_texts(item["names"]), values, strict=True))
        case "mapping":
            keys = [json.loads(text) for text in _get_texts(item["keys"])]
            return dict(zip(keys, _entries(item["values"]), strict=True))
        case "sequence":
            return _entries(item)
        case other:
            raise KeyError(other)


def _stored_in(item: Any) -> tuple[type[Record], list[str]]:
    """Class of a record or of records, and its fields that are there: one that came later than the file has its default."""
    cls = record_of(item.attrs["record"])
    return cls, [name for name in stored_fields(cls) if name in item]


def _entries(item: Any) -> tuple[Any, ...]:
    return tuple(get_value(item[str(number)]) for number in range(len(item)))


def _put_texts(h5: ModuleType, parent: Any, name: str, value: Sequence[str]) -> None:
    data = np.array(list(value), dtype=object)
    parent.create_dataset(name, data=data, shape=(len(value),), dtype=h5.string_dtype())


def _get_texts(item: Any) -> tuple[str, ...]:
    return tuple(item.asstr()[()]) if item.shape[0] else ()


def _is_texts(value: Any) -> bool:
    return isinstance(value, tuple) and all(isinstance(entry, str) for entry in value)


# Kinds of single values; a truth is an integer too, so that it is asked for before.
_TYPES: tuple[tuple[str, Any], ...] = (
    ("nothing", type(None)),
    ("model", Model),
    ("record", Record),
    ("text", str),
    ("array", np.ndarray),
    ("truth", bool),
    ("integer", (int, np.integer)),
    ("number", (float, np.floating)),
)
_OF_A_NOTE = ("part", "what", "why", "value")
# How a number, alone or in a table, comes back from what h5py reads; all else is an array.
_PLAIN: dict[str, Callable[[Any], Any]] = {"truth": bool, "integer": int, "number": float, "numbers": float}


def digest_of(file: Any) -> str:
    """SHA-256 over all that a file holds: names, kinds, shapes and values. A file that was changed since has another one."""
    digest = hashlib.sha256()

    def add(name: str, item: Any) -> None:
        digest.update(f"{name} {sorted(item.attrs.items())}".encode())
        if not hasattr(item, "shape"):  # a group
            return
        value = item[()] if item.shape is not None else None
        digest.update(f"{item.dtype} {item.shape}".encode())
        if isinstance(value, np.ndarray) and value.dtype != object:
            digest.update(np.ascontiguousarray(value).tobytes())
        else:  # texts of an array in full; numpy shortens long ones
            digest.update(repr(value.tolist() if isinstance(value, np.ndarray | np.generic) else value).encode())

    file.visititems(add)
    return digest.hexdigest()
