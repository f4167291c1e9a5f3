"""Values of a result in HDF5: arrays, numbers, texts (UTF-8), dictionaries, the model, and records such as the table of nodes.

A dictionary of arrays is a group with `names` and `values`: a part's name may hold a slash, and the order counts. A record is a
group of its fields, a tuple of records a group of columns, or of numbered entries where they don't fit into columns. The model
is JSON in SI units, which keeps every digit of a float. The attribute `type` of each item says how to read it.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import fields
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.results.schema import Record, record_name


def stored_fields(cls: type[Record]) -> list[str]:
    """Names of the fields of a record that belong in a file."""
    declared = cls.declarations
    return [item.name for item in fields(cls) if item.name not in declared or declared[item.name].stored]


def put_value(h5: ModuleType, parent: Any, name: str, value: Any) -> None:
    """Write one value under a name; TypeError for a kind of value that has no place in a file."""
    for kind, fits, write in _WRITERS:
        if fits(value):
            write(h5, parent, name, value)
            parent[name].attrs["type"] = kind
            return
    raise TypeError(f"{name} of type {type(value).__name__} has no form in HDF5")


def get_value(item: Any) -> Any:
    """Read what `put_value` wrote; KeyError, TypeError or ValueError for anything else."""
    return _READERS[item.attrs["type"]](item)


def _put_array(h5: ModuleType, parent: Any, name: str, value: Any) -> None:
    parent[name] = np.asarray(value)


def _put_text(h5: ModuleType, parent: Any, name: str, value: str) -> None:
    parent.create_dataset(name, data=value, dtype=h5.string_dtype())


def _put_texts(h5: ModuleType, parent: Any, name: str, value: tuple[str, ...]) -> None:
    data = np.array(list(value), dtype=object)
    parent.create_dataset(name, data=data, shape=(len(value),), dtype=h5.string_dtype())


def _put_table(h5: ModuleType, parent: Any, name: str, value: dict[str, Any]) -> None:
    group = parent.create_group(name)
    _put_texts(h5, group, "names", tuple(value))
    group["values"] = np.array(list(value.values()))


def _put_model(h5: ModuleType, parent: Any, name: str, value: Model) -> None:
    _put_text(h5, parent, name, value.model_dump_json(exclude_none=True))


def _put_nothing(h5: ModuleType, parent: Any, name: str, value: None) -> None:
    parent[name] = h5.Empty("f8")


def _put_record(h5: ModuleType, parent: Any, name: str, value: Any) -> None:
    group = parent.create_group(name)
    group.attrs["record"] = record_name(type(value))
    for name in stored_fields(type(value)):
        put_value(h5, group, name, getattr(value, name))


def _put_records(h5: ModuleType, parent: Any, name: str, value: tuple[Any, ...]) -> None:
    group = parent.create_group(name)
    group.attrs["record"] = record_name(type(value[0]))
    for name in stored_fields(type(value[0])):
        column = tuple(getattr(record, name) for record in value)
        put_value(h5, group, name, column if isinstance(column[0], str | tuple) else np.array(column))


def _put_lists(h5: ModuleType, parent: Any, name: str, value: tuple[tuple[str, ...], ...]) -> None:
    _put_texts(h5, parent, name, tuple(json.dumps(item) for item in value))


def _put_sequence(h5: ModuleType, parent: Any, name: str, value: tuple[Any, ...]) -> None:
    group = parent.create_group(name)
    for number, entry in enumerate(value):
        put_value(h5, group, str(number), entry)


def _put_mapping(h5: ModuleType, parent: Any, name: str, value: dict[Any, Any]) -> None:
    group = parent.create_group(name)
    _put_texts(h5, group, "keys", tuple(json.dumps(key) for key in value))
    _put_sequence(h5, group, "values", tuple(value.values()))


def _get_texts(item: Any) -> tuple[str, ...]:
    return tuple(item.asstr()[()]) if item.shape[0] else ()


def _get_record(item: Any) -> Any:
    cls = Record.known[item.attrs["record"]]
    # A field that came later than the file has its default; one without a default is missed by the class.
    return cls(**{name: get_value(item[name]) for name in stored_fields(cls) if name in item})


def _get_records(item: Any) -> tuple[Any, ...]:
    cls = Record.known[item.attrs["record"]]
    names = [name for name in stored_fields(cls) if name in item]
    columns = [get_value(item[name]) for name in names]
    plain = [column if isinstance(column, tuple) else column.tolist() for column in columns]
    return tuple(cls(**dict(zip(names, row, strict=True))) for row in zip(*plain, strict=True))


def _table_of(kind: Callable[[Any], Any]) -> Callable[[Any], dict[str, Any]]:
    return lambda item: dict(zip(_get_texts(item["names"]), map(kind, item["values"][()]), strict=True))


def _get_sequence(item: Any) -> tuple[Any, ...]:
    return tuple(get_value(item[str(number)]) for number in range(len(item)))


def _get_mapping(item: Any) -> dict[Any, Any]:
    keys = [json.loads(text) for text in _get_texts(item["keys"])]
    return dict(zip(keys, _get_sequence(item["values"]), strict=True))


def _is_record(value: Any) -> bool:
    return isinstance(value, Record)


def _are_columns(value: Any) -> bool:
    """Whether records of one class fit into columns: texts, lists of texts, or numbers of one kind, in each field."""
    if not (isinstance(value, tuple) and value and isinstance(value[0], Record)):
        return False
    if any(type(record) is not type(value[0]) for record in value):
        return False
    return all(_is_column([getattr(record, name) for record in value]) for name in stored_fields(type(value[0])))


def _is_column(entries: list[Any]) -> bool:
    if all(map(_is_texts, entries)):
        return True
    return isinstance(entries[0], str | bool | int | float) and len({type(entry) for entry in entries}) == 1


def _is_sound_table(value: Any) -> bool:
    """Whether a dictionary holds arrays of one shape and kind under texts."""
    if not _is_table(value, np.ndarray):
        return False
    return all(isinstance(key, str) for key in value) and len({(x.shape, x.dtype) for x in value.values()}) <= 1


def _is_texts(value: Any) -> bool:
    return isinstance(value, tuple) and all(isinstance(entry, str) for entry in value)


def _is_table(value: Any, kind: type | tuple[type, ...]) -> bool:
    return isinstance(value, dict) and all(isinstance(entry, kind) for entry in value.values())


_Writer = tuple[str, Callable[[Any], bool], Callable[..., None]]
_WRITERS: tuple[_Writer, ...] = (
    ("nothing", lambda v: v is None, _put_nothing),
    ("model", lambda v: isinstance(v, Model), _put_model),
    ("record", _is_record, _put_record),
    ("records", _are_columns, _put_records),
    ("text", lambda v: isinstance(v, str), _put_text),
    ("texts", _is_texts, _put_texts),
    ("lists", lambda v: isinstance(v, tuple) and all(_is_texts(x) for x in v), _put_lists),
    ("array", lambda v: isinstance(v, np.ndarray), _put_array),
    ("truth", lambda v: isinstance(v, bool), _put_array),
    ("numbers", lambda v: _is_table(v, float), _put_table),
    ("arrays", _is_sound_table, _put_table),
    ("integer", lambda v: isinstance(v, int | np.integer), _put_array),
    ("number", lambda v: isinstance(v, float | np.floating), _put_array),
    ("sequence", lambda v: isinstance(v, tuple), _put_sequence),
    ("mapping", lambda v: isinstance(v, dict), _put_mapping),
)
_READERS: dict[str, Callable[[Any], Any]] = {
    "nothing": lambda item: None,
    "model": lambda item: Model(**json.loads(item.asstr()[()])),
    "record": _get_record,
    "records": _get_records,
    "text": lambda item: item.asstr()[()],
    "texts": _get_texts,
    "lists": lambda item: tuple(tuple(json.loads(text)) for text in _get_texts(item)),
    "array": lambda item: item[()],
    "truth": lambda item: bool(item[()]),
    "numbers": _table_of(float),
    "arrays": _table_of(np.asarray),
    "integer": lambda item: int(item[()]),
    "number": lambda item: float(item[()]),
    "sequence": _get_sequence,
    "mapping": _get_mapping,
}
