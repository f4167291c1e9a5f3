"""The keys of a result's JSON output, from the declarations of its fields: what docs/json.md lists."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from rotorgear.results.result import Result
from rotorgear.results.schema import Record


@dataclass(frozen=True)
class Key:
    """A key: its path, with `[]` for the entries of a list and a word in capitals for a name; its unit and its meaning."""

    path: str
    unit: str
    text: str


def keys_of(cls: type[Record], prefix: str = "") -> Iterator[Key]:
    """Yield the keys that a result or a record writes, `prefix` before each."""
    if issubclass(cls, Result):
        yield Key(f"{prefix}analysis", "", f'`"{cls.analysis_word}"`')
    declared = list(cls.declarations.values())
    title = [one for one in declared if one.name == "title"]
    for one in [*title, *(one for one in declared if one.name != "title")]:
        for written in one.written():
            axes = one.axes if written.axes is None else written.axes
            path = prefix + written.key + "".join(f".{axis}" if axis.isupper() else "[]" for axis in axes)
            unit = one.unit if written.unit is None else written.unit
            label = one.label if written.label is None else written.label
            # A label of the key's own does without the note of the field.
            note = written.note if written.note is not None else one.note if written.label is None else ""
            if one.record is None or written.label is not None:
                yield Key(path, unit, label + note)
                continue
            if note:
                yield Key(path.removesuffix("[]"), "", label + note)
            yield from keys_of(one.record, f"{path}.")
