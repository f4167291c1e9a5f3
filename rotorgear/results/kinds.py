"""All kinds of results, by the word that a file names them with, and the keys of their JSON output, from their declarations."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from functools import cache
from importlib import import_module

import rotorgear.results
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, Rows


@cache
def kinds() -> dict[str, type[Result]]:
    """Return the classes of all results; a new one is here as soon as its file stands in this folder."""
    name = rotorgear.results.__name__
    for module in pkgutil.iter_modules(rotorgear.results.__path__, f"{name}."):
        import_module(module.name)
    return dict(Result.kinds)


def keys_of(cls: type[Record] | Rows, prefix: str = "") -> Iterator[tuple[str, str, str]]:
    """Yield path, unit and meaning of each key that a result or a record writes, `prefix` before the path.

    In a path `[]` stands for the entries of a list and a word in capitals for a name.
    """
    if isinstance(cls, type) and issubclass(cls, Result):
        yield f"{prefix}analysis", "", f'`"{cls.analysis_word}"`'
    declared = list(cls.declarations.values())
    title = [one for one in declared if one.name == "title"]
    for one in [*title, *(one for one in declared if one.name != "title")]:
        for written in one.written():
            axes = one.along if written.axes is None else written.axes
            path = prefix + written.key + "".join(f".{axis}" if axis.isupper() else "[]" for axis in axes)
            unit = one.unit if written.unit is None else written.unit
            label = one.label if written.label is None else written.label
            # A label of the key's own does without the note of the field.
            note = written.note if written.note is not None else one.note if written.label is None else ""
            if one.record is None or written.label is not None:
                yield path, unit, label + note
                continue
            if note:
                yield path.removesuffix("[]"), "", label + note
            yield from keys_of(one.record, f"{path}.")
    if isinstance(cls, Rows) and cls.inner is not None:
        yield from keys_of(cls.inner, f"{prefix}{cls.inner_name}[].")
