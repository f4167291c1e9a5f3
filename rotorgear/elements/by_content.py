"""Results of functions of a record of arrays, kept: analyses of one model compute the same elements again and again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import lru_cache, wraps
from typing import Any, Concatenate, Generic, ParamSpec, TypeVar

import numpy as np

Record = TypeVar("Record")
Result = TypeVar("Result")
Others = ParamSpec("Others")


def kept_by_content(
    rows: int, results: int
) -> Callable[
    [Callable[Concatenate[Record, Others], Result]],
    Callable[Concatenate[Record, Others], Result],
]:
    """A decorator of compute(record, ...), whose result is a record of arrays too: equal ones are computed once.

    The arrays of a kept result can't be written to, for several callers share them.

    Args:
        rows: records with more than so many rows are computed each time, and not kept in memory.
        results: so many are kept, the latest ones.
    """

    def decorated(
        compute: Callable[Concatenate[Record, Others], Result],
    ) -> Callable[Concatenate[Record, Others], Result]:
        def computed(content: _ByContent[Record], *args: Any, **options: Any) -> Result:
            result = compute(content.record, *args, **options)
            for array in _arrays(result):
                array.setflags(write=False)
            return result

        known: Callable[..., Result] = lru_cache(maxsize=results)(computed)

        @wraps(compute)
        def kept(record: Record, *args: Others.args, **options: Others.kwargs) -> Result:
            if max(len(array) for array in _arrays(record)) > rows:
                return compute(record, *args, **options)
            return known(_ByContent(record), *args, **options)

        return kept

    return decorated


class _ByContent(Generic[Record]):
    """A record of arrays that equals every other of its class with the same arrays."""

    def __init__(self, record: Record) -> None:
        self.record = record
        self._content = (type(record), *((array.dtype.str, array.shape, array.tobytes()) for array in _arrays(record)))
        self._hash = hash(self._content)

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ByContent) and self._content == other._content


def _arrays(record: Any) -> list[np.ndarray]:
    """The fields of a record that are arrays."""
    values = [getattr(record, item.name) for item in fields(record)]
    return [value for value in values if isinstance(value, np.ndarray)]
