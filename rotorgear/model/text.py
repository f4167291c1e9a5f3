"""The text of a model file from a model, and a text with other values at some addresses; comments and units stay.

A model that came from a file keeps that text, and so does what `with_` makes of it. Written again, only values that differ change
there, in the unit in which they stand. A model of Python objects has a text of its own, in SI.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from decimal import Decimal
from pathlib import Path
from typing import Any

from rotorgear.errors import AnalysisError, ModelError
from rotorgear.extras import require
from rotorgear.files.toml import tables_of
from rotorgear.files.write import written
from rotorgear.model.named_files import with_named_files
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import DIMENSIONS, QuantityError, parse_quantity

_PURPOSE = "Writing a model file"
_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(\s*[^\d\s].*)", re.DOTALL)
# A list of more numbers, or of tables, stands on several lines.
_SHORT_LIST = 6
# From this one on, numbers are written with powers of ten.
_LONG = 1e5


def write_model(model: Tables, path: str | Path, source: tuple[str, str] | None) -> Path:
    """Write a model file that reads as the same model; see `text_of`.

    Raises:
        WriteError: the file can't be written. MissingExtraError: tomlkit is not installed.
    """
    target = Path(path)
    text = text_of(model, target.parent, source)
    with written(target) as scratch:
        scratch.write_text(text, encoding="utf-8")
    return target


def text_of(model: Tables, folder: str | Path, source: tuple[str, str] | None) -> str:
    """The text of a file that reads as a model.

    Args:
        model: whatever it came from.
        folder: where the file will lie; names of other files are told from there.
        source: text that it came from, with its folder: what is not different stays as it was written there.

    Raises:
        MissingExtraError: tomlkit is not installed.
    """
    require("tomlkit", _PURPOSE)
    now = _told_from(_tables(model), Path(folder))
    if source is not None:
        text, home = source
        then = _read(model, text, Path(home))
        for in_units in (True, False):
            found = _with_changes(text, then, now, in_units=in_units)
            try:
                if _read(model, found, Path(folder)) == now:
                    return found
            except ModelError:
                continue
    return _new_text(model.schema_version, now)


def _read(model: Tables, text: str, folder: Path) -> dict[str, Any]:
    """What the text of a file in a folder says, as a model of the same class has it."""
    data = tables_of(text)
    with_named_files(data, lambda name: str(folder / name))
    return _told_from(_tables(type(model)(**data)), folder)


def changed_text(text: str, values: Mapping[str, Any]) -> str:
    """The text of a model file with other values at some addresses; everything else stays as it was written.

    Args:
        text: of the file (TOML).
        values: address, such as "bearings.left.stiffness.radial" or "shafts.rotor.sections[0].length", -> what is written there:
            a number in SI, a text with its unit, a list or a table; None takes the key away.

    Raises:
        AnalysisError: an address that leads through what the file does not spell out.
        MissingExtraError: tomlkit is not installed.
    """
    require("tomlkit", _PURPOSE)
    import tomlkit

    document = tomlkit.parse(text)
    for address, value in values.items():
        *owners, last = re.sub(r"\[(\d+)\]", r".\1", address).split(".")
        owner: Any = document
        above = owner
        for key in owners:
            above, owner = owner, below(owner, key, address)
        if last == "radial" and isinstance(owner, int | float | str):  # a bearing whose one number is the radial one
            _put(above, owners[-1], value)
        else:
            _put(owner, last, value)
    return tomlkit.dumps(document)


def below(owner: Any, key: str, address: str) -> Any:
    """What stands below a key of a table, or at a place of a list, of a document.

    Raises:
        AnalysisError: nothing does.
    """
    try:
        return owner[int(key)] if isinstance(owner, list) else owner[key]
    except (KeyError, IndexError, ValueError, TypeError):
        raise AnalysisError(f"{address}: the file does not spell this value out: it can't be written there") from None


def _tables(model: Tables) -> dict[str, Any]:
    """What the file of a model has to say, as plain values in SI: no defaults."""
    dumped = model.model_dump(exclude_none=True, exclude_defaults=True)
    plain: dict[str, Any] = _plain(dumped)
    return plain


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    return [_plain(entry) for entry in value] if isinstance(value, list | tuple) else value


def _told_from(data: dict[str, Any], folder: Path) -> dict[str, Any]:
    """The tables with the names of files as a model file in a folder gives them."""

    def name(path: str) -> str:
        try:
            return os.path.relpath(path, folder)
        except ValueError:  # on another drive
            return str(Path(path).absolute())

    with_named_files(data, name)
    return data


def _with_changes(text: str, then: dict[str, Any], now: dict[str, Any], *, in_units: bool) -> str:
    import tomlkit

    document = tomlkit.parse(text)
    _change(document, then, now, in_units)
    return tomlkit.dumps(document)


def _change(node: Any, then: dict[str, Any], now: dict[str, Any], in_units: bool) -> None:
    """Write into a table of a document what differs between the tables that it stands for, then and now."""
    for key in [*then, *(key for key in now if key not in then)]:
        old: Any = then.get(key)
        new: Any = now.get(key)
        if old == new and type(old) is type(new):
            continue
        spelled = node.get(key)
        both = isinstance(old, dict) and isinstance(new, dict)
        if both and isinstance(spelled, int | float | str) and {*old, *new} == {"radial"}:  # one number of a bearing
            number = new["radial"]
            _put(node, key, _in_unit(spelled, old["radial"], number) if in_units else number)
        elif both and isinstance(spelled, dict):
            _change(spelled, old, new, in_units)
        elif isinstance(new, list) and isinstance(old, list) and isinstance(spelled, list) and len(new) == len(old):
            for place, (was, is_now) in enumerate(zip(old, new, strict=True)):
                if isinstance(was, dict) and isinstance(is_now, dict):
                    _change(spelled[place], was, is_now, in_units)
                elif was != is_now:
                    _put(spelled, str(place), _in_unit(spelled[place], was, is_now) if in_units else is_now)
        else:
            _put(node, key, _in_unit(spelled, old, new) if in_units else new)


def _in_unit(spelled: Any, old: Any, new: Any) -> Any:
    """A number in SI as a text in the unit of the one that it replaces, where that says one; else as it is."""
    number = _QUANTITY.fullmatch(spelled) if isinstance(spelled, str) else None
    if number is None or not isinstance(new, int | float) or not isinstance(old, int | float):
        return new
    for dimension in DIMENSIONS:
        try:
            if parse_quantity(spelled, dimension) != old:
                continue
            one, zero = (parse_quantity(f"{value}{number[2]}", dimension) for value in (1, 0))
            for digits in range(1, 18):
                text = f"{_digits(float(f'{(new - zero) / (one - zero):.{digits}g}'))}{number[2]}"
                if parse_quantity(text, dimension) == new:
                    return text
        except QuantityError:
            continue
    return new


def _digits(number: float) -> str:
    if abs(number) >= _LONG:
        return str(Decimal(repr(number)).normalize()).replace("E+", "e")
    return str(int(number)) if number.is_integer() else repr(number)


def _put(owner: Any, key: str, value: Any) -> None:
    """Write a value into a table or list of a document, behind which its comment stays."""
    import tomlkit
    from tomlkit.items import InlineTable, Item

    if isinstance(owner, list):
        owner[int(key)] = _item(value)
        return
    old = owner.get(key)
    if value is None:
        if old is not None:
            del owner[key]
        return
    inline = isinstance(owner, list | InlineTable)
    # A document has tables of parts below its names, and parts are tables of their own.
    depth = 2 if isinstance(owner, tomlkit.TOMLDocument) and isinstance(value, dict) else 0 if inline else 1
    owner[key] = _item(value, tables=0 if isinstance(old, InlineTable) or inline else depth)
    if isinstance(old, Item) and old.trivia.comment and not inline and not isinstance(value, dict):
        trivia = owner[key].trivia
        trivia.comment_ws = old.trivia.comment_ws
        trivia.comment = old.trivia.comment


def _item(value: Any, tables: int = 0) -> Any:
    """A value as a document has it; `tables`: of so many levels tables have a head of their own."""
    import tomlkit

    if isinstance(value, dict):
        table = tomlkit.table() if tables else tomlkit.inline_table()
        for key, entry in value.items():
            table.add(key, _item(entry, max(tables - 1, 0)))
        return table
    if isinstance(value, list):
        found = tomlkit.array()
        for entry in value:
            found.append(_item(entry))
        return found.multiline(len(value) > _SHORT_LIST or any(isinstance(entry, dict) for entry in value))
    return value


def _new_text(version: int, now: dict[str, Any]) -> str:
    """A text of its own: numbers in SI, one table for each part."""
    import tomlkit

    document = tomlkit.document()
    for key, value in {"schema_version": version, **now}.items():
        if not isinstance(value, dict):
            document.add(key, _item(value))
    for name, table in now.items():
        if not isinstance(table, dict):
            continue
        if not all(isinstance(part, dict) for part in table.values()) or name in ("operation", "damping"):
            document.add(name, _item(table, 1))
            continue
        whole = tomlkit.table(is_super_table=True)
        for part, keys in table.items():
            whole.add(part, _item(keys, 1))
        document.add(name, whole)
    return tomlkit.dumps(document)
