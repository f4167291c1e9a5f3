"""Records of arrays as keys of `functools.lru_cache`: analyses of one model compute the same elements again and again."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Generic, TypeVar

import numpy as np

Record = TypeVar("Record")


class ByContent(Generic[Record]):
    """A record of arrays that equals every other with the same values."""

    def __init__(self, record: Record) -> None:
        self.record = record
        self._content = tuple(part.tobytes() for part in arrays(record))
        self._hash = hash(self._content)

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ByContent) and self._content == other._content


def arrays(record: Any) -> list[np.ndarray]:
    """The fields of a record that are arrays."""
    values = [getattr(record, item.name) for item in fields(record)]
    return [value for value in values if isinstance(value, np.ndarray)]


def read_only(record: Record) -> Record:
    """The record, whose arrays can no longer be written to: several callers share them."""
    for value in arrays(record):
        value.setflags(write=False)
    return record
