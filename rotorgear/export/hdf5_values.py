"""Values of a result in HDF5: arrays, numbers, texts (UTF-8), dictionaries, the model, and records such as the table of nodes.

A dictionary of arrays is a group with `names` and `values`: a part's name may hold a slash, and the order counts. A record is a
group of its fields, a tuple of records a group of columns, or of numbered entries where they don't fit into columns. The model
is JSON in SI units, which keeps every digit of a float. The attribute `type` of each item names its
kind, which says how to read it.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass, fields
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
    for kind in _KINDS:
        if kind.fits(value):
            kind.write(h5, parent, name, value)
            parent[name].attrs["type"] = kind.name
            return
    raise TypeError(f"{name} of type {type(value).__name__} has no form in HDF5")


def get_value(item: Any) -> Any:
    """Read what `put_value` wrote; KeyError, TypeError or ValueError for anything else."""
    return _BY_NAME[item.attrs["type"]].read(item)


def digest_of(file: Any) -> str:
    """SHA-256 over all that a file holds: names, kinds, shapes and values. A file that was changed since has another one.

    Raises:
        ValueError: a data set says that it has more values than the whole file has bytes.
    """
    digest = hashlib.sha256()
    size = file.id.get_filesize()

    def add(name: str, item: Any) -> None:
        digest.update(f"{name} {sorted(item.attrs.items())}".encode())
        if not hasattr(item, "shape"):  # a group
            return
        if item.shape is not None and item.nbytes > size:
            raise ValueError(f"{name} says that it has {item.size:.3g} values, more than the file has bytes")
        value = item[()] if item.shape is not None else None
        digest.update(f"{item.dtype} {item.shape}".encode())
        if isinstance(value, np.ndarray) and value.dtype != object:
            digest.update(np.ascontiguousarray(value).tobytes())
        else:  # texts of an array in full; numpy shortens long ones
            digest.update(repr(value.tolist() if isinstance(value, np.ndarray | np.generic) else value).encode())

    file.visititems(add)
    return digest.hexdigest()


_OF_A_NOTE = ("part", "what", "why", "value")


@dataclass(frozen=True)
class Kind:
    """A kind of value: which ones it fits, and how they are written and read. This one is a plain array or number."""

    name: str
    type: type | tuple[type, ...] = ()
    plain: Callable[[Any], Any] = np.asarray

    def fits(self, value: Any) -> bool:
        """Whether a value is of this kind; the first kind that fits takes it."""
        return isinstance(value, self.type)

    def write(self, h5: ModuleType, parent: Any, name: str, value: Any) -> None:
        """Write it as a data set or group of a name."""
        parent[name] = np.asarray(value)

    def read(self, item: Any) -> Any:
        """The value again."""
        return self.plain(item[()])


class Nothing(Kind):
    """None: an empty data set."""

    def fits(self, value: Any) -> bool:
        return value is None

    def write(self, h5: ModuleType, parent: Any, name: str, value: None) -> None:
        parent[name] = h5.Empty("f8")

    def read(self, item: Any) -> None:
        return None


class Text(Kind):
    """A text, in UTF-8."""

    def write(self, h5: ModuleType, parent: Any, name: str, value: str) -> None:
        parent.create_dataset(name, data=value, dtype=h5.string_dtype())

    def read(self, item: Any) -> Any:
        return item.asstr()[()]


class WholeModel(Kind):
    """The model, as JSON."""

    def write(self, h5: ModuleType, parent: Any, name: str, value: Model) -> None:
        parent.create_dataset(name, data=value.model_dump_json(exclude_none=True), dtype=h5.string_dtype())

    def read(self, item: Any) -> Model:
        return Model(**json.loads(item.asstr()[()]))


class Texts(Kind):
    """A tuple of texts."""

    def fits(self, value: Any) -> bool:
        return _is_texts(value)

    def write(self, h5: ModuleType, parent: Any, name: str, value: tuple[str, ...]) -> None:
        _put_texts(h5, parent, name, value)

    def read(self, item: Any) -> tuple[str, ...]:
        return _get_texts(item)


class Notes(Kind):
    """A tuple of facts: a group of columns."""

    def fits(self, value: Any) -> bool:
        return isinstance(value, tuple) and bool(value) and all(isinstance(entry, Note) for entry in value)

    def write(self, h5: ModuleType, parent: Any, name: str, value: tuple[Note, ...]) -> None:
        group = parent.create_group(name)
        for key in _OF_A_NOTE:
            _put_texts(h5, group, key, tuple(getattr(note, key) for note in value))

    def read(self, item: Any) -> tuple[Note, ...]:
        return tuple(Note(*row) for row in zip(*(_get_texts(item[key]) for key in _OF_A_NOTE), strict=True))


class ListsOfTexts(Kind):
    """A tuple of tuples of texts, each of them as JSON."""

    def fits(self, value: Any) -> bool:
        return isinstance(value, tuple) and all(_is_texts(entry) for entry in value)

    def write(self, h5: ModuleType, parent: Any, name: str, value: tuple[tuple[str, ...], ...]) -> None:
        _put_texts(h5, parent, name, tuple(json.dumps(item) for item in value))

    def read(self, item: Any) -> tuple[tuple[str, ...], ...]:
        return tuple(tuple(json.loads(text)) for text in _get_texts(item))


class OneRecord(Kind):
    """A record: a group of its fields."""

    def write(self, h5: ModuleType, parent: Any, name: str, value: Any) -> None:
        group = parent.create_group(name)
        group.attrs["record"] = record_name(type(value))
        for field in stored_fields(type(value)):
            put_value(h5, group, field, getattr(value, field))

    def read(self, item: Any) -> Any:
        cls = record_of(item.attrs["record"])
        # A field that came later than the file has its default; one without a default is missed by the class.
        return cls(**{name: get_value(item[name]) for name in stored_fields(cls) if name in item})


class Records(Kind):
    """Records of one class: a group of columns."""

    def fits(self, value: Any) -> bool:
        """Whether they fit into columns: texts, lists of texts, or numbers of one kind, in each field."""
        if not (isinstance(value, tuple) and value and isinstance(value[0], Record)):
            return False
        if any(type(record) is not type(value[0]) for record in value):
            return False
        for name in stored_fields(type(value[0])):
            column = [getattr(record, name) for record in value]
            numbers = isinstance(column[0], str | bool | int | float) and len({type(entry) for entry in column}) == 1
            if not numbers and not all(map(_is_texts, column)):
                return False
        return True

    def write(self, h5: ModuleType, parent: Any, name: str, value: tuple[Any, ...]) -> None:
        group = parent.create_group(name)
        group.attrs["record"] = record_name(type(value[0]))
        for field in stored_fields(type(value[0])):
            column = tuple(getattr(record, field) for record in value)
            put_value(h5, group, field, column if isinstance(column[0], str | tuple) else np.array(column))

    def read(self, item: Any) -> tuple[Any, ...]:
        cls = record_of(item.attrs["record"])
        names = [name for name in stored_fields(cls) if name in item]
        columns = [get_value(item[name]) for name in names]
        plain = [column if isinstance(column, tuple) else column.tolist() for column in columns]
        return tuple(cls(**dict(zip(names, row, strict=True))) for row in zip(*plain, strict=True))


class Table(Kind):
    """A dictionary of numbers, or of arrays of one shape and kind, under texts."""

    def fits(self, value: Any) -> bool:
        if not isinstance(value, dict) or not all(isinstance(entry, self.type) for entry in value.values()):
            return False
        shapes = {(np.shape(entry), np.asarray(entry).dtype) for entry in value.values()}
        return all(isinstance(key, str) for key in value) and len(shapes) <= 1

    def write(self, h5: ModuleType, parent: Any, name: str, value: dict[str, Any]) -> None:
        group = parent.create_group(name)
        _put_texts(h5, group, "names", tuple(value))
        group["values"] = np.array(list(value.values()))

    def read(self, item: Any) -> dict[str, Any]:
        return dict(zip(_get_texts(item["names"]), map(self.plain, item["values"][()]), strict=True))


class Sequence(Kind):
    """Any other tuple: a group of numbered entries."""

    def write(self, h5: ModuleType, parent: Any, name: str, value: tuple[Any, ...]) -> None:
        group = parent.create_group(name)
        for number, entry in enumerate(value):
            put_value(h5, group, str(number), entry)

    def read(self, item: Any) -> tuple[Any, ...]:
        return tuple(get_value(item[str(number)]) for number in range(len(item)))


class Mapping(Kind):
    """Any other dictionary: its keys as JSON, and its values."""

    def write(self, h5: ModuleType, parent: Any, name: str, value: dict[Any, Any]) -> None:
        group = parent.create_group(name)
        _put_texts(h5, group, "keys", tuple(json.dumps(key) for key in value))
        _SEQUENCE.write(h5, group, "values", tuple(value.values()))

    def read(self, item: Any) -> dict[Any, Any]:
        keys = [json.loads(text) for text in _get_texts(item["keys"])]
        return dict(zip(keys, _SEQUENCE.read(item["values"]), strict=True))


def _put_texts(h5: ModuleType, parent: Any, name: str, value: tuple[str, ...]) -> None:
    data = np.array(list(value), dtype=object)
    parent.create_dataset(name, data=data, shape=(len(value),), dtype=h5.string_dtype())


def _get_texts(item: Any) -> tuple[str, ...]:
    return tuple(item.asstr()[()]) if item.shape[0] else ()


def _is_texts(value: Any) -> bool:
    return isinstance(value, tuple) and all(isinstance(entry, str) for entry in value)


_SEQUENCE = Sequence("sequence", tuple)
# The first that fits takes a value, so those of few values stand before those of many: a truth is an integer too, and texts are
# a sequence. The names stand in files, so they stay.
_KINDS: tuple[Kind, ...] = (
    Nothing("nothing"),
    WholeModel("model", Model),
    OneRecord("record", Record),
    Records("records"),
    Text("text", str),
    Notes("notes"),
    Texts("texts"),
    ListsOfTexts("lists"),
    Kind("array", np.ndarray),
    Kind("truth", bool, bool),
    Table("numbers", float, float),
    Table("arrays", np.ndarray),
    Kind("integer", (int, np.integer), int),
    Kind("number", (float, np.floating), float),
    _SEQUENCE,
    Mapping("mapping", dict),
)
_BY_NAME = {kind.name: kind for kind in _KINDS}
