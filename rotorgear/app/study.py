"""A model under the hand: the text of its file, changes and how they are taken back, and what was found of it; no widget.

The text is what counts. A change writes one value into it, as `changed_text` does, and stands where the whole file then reads
without a mistake; until then the change waits, with the sentences that the file would be answered with.
"""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.files.bounds import MODEL
from rotorgear.files.read import UnreadableError, read_text
from rotorgear.files.toml import tables_of
from rotorgear.files.write import WriteError, written
from rotorgear.model.load import load, loads, schema
from rotorgear.model.model import Model
from rotorgear.model.named_files import with_named_files
from rotorgear.model.text import changed_text
from rotorgear.quantity import split_number

# Tables that are one part, and not one for each name.
_SINGLE = ("operation", "damping")
_RIG = ".csv"


@dataclass(frozen=True)
class Field:
    """A key of a part: its value as the file spells it, and what the schema says of it.

    `given`: the file spells it; else `text` is empty. `choices`: all values that it may have, where they are words. `bounds`,
    `unit`, `meaning`: in words. `is_number`: it may be dragged. `is_whole`: in whole numbers.
    """

    address: str
    text: str
    given: bool
    unit: str = ""
    bounds: str = ""
    meaning: str = ""
    choices: tuple[str, ...] = ()
    is_number: bool = False
    is_whole: bool = False

    @property
    def key(self) -> str:
        """The last word of the address."""
        return self.address.rpartition(".")[2]


class Study:
    """A model file that is changed.

    Attributes:
        path, folder: of the file, resolved.
        text: as it stands now. saved: as it stands on the disk.
        model: what the text reads as.
        waiting: changes that don't fit yet, by address.
        problems: why they don't.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path).resolve()
        self.folder = self.path.parent
        self.model: Model = load(self.path)
        self.text: str = (self.model.source or ("", ""))[0]
        self.saved = self.text
        self.waiting: dict[str, Any] = {}
        self.problems: tuple[Problem, ...] = ()
        self._before: list[str] = []
        self._known_files = _files_of(self.text)

    @property
    def parts(self) -> list[str]:
        """Addresses of all parts that the file has, such as "bearings.left"; "" for the keys above all tables."""
        found = [""]
        for table, value in tables_of(self.text).items():
            if table in _SINGLE:
                found.append(table)
            elif isinstance(value, dict):
                found += [f"{table}.{name}" for name in value]
        return found

    def fields(self, part: str) -> list[Field]:
        """The keys of a part, those that the file spells first."""
        node: Any = _schema()
        value: Any = tables_of(self.text)
        for key in part.split(".", 1) if part else ():
            value = value[key]
            node = _below(_resolved(node, value), key)
        node = _resolved(node, value)
        if not part:
            above = [key for key in node["properties"] if key != "schema_version" and key not in _tables()]
            value = {key: value[key] for key in above if key in value}
            node = {"properties": {key: node["properties"][key] for key in above}}
        found = list(_fields(part, value, node))
        return [one for one in found if one.given] + [one for one in found if not one.given]

    def change(self, address: str, text: str | bool | None) -> bool:
        """Write a value at an address; None takes the key away. False: it waits, for `problems`."""
        value = _value(text) if isinstance(text, str) else text
        tried = {**self.waiting, address: value}
        try:
            changed = changed_text(self.text, tried)
            model = self._read(changed)
        except ModelError as error:
            self.waiting = tried
            self.problems = error.problems
            return False
        except AnalysisError as error:
            self.problems = (Problem(address, "", str(error).removeprefix(f"{address}: ")),)
            return False
        if changed != self.text:
            self._before.append(self.text)
        self._take(changed, model)
        return True

    def trial(self, address: str, text: str) -> Model:
        """The model with another value at an address, while that is dragged; nothing is kept.

        Raises:
            RotorgearError: it does not fit.
        """
        return self._read(changed_text(self.text, {address: _value(text)}))

    def dragged(self, field: Field, factor: float) -> str:
        """The number of a field times a factor, in four digits and its unit."""
        number, unit = split_number(field.text)
        if field.is_whole:
            return str(round(number * factor))
        return f"{float(f'{number * factor:.4g}'):.10g}{unit}"

    @property
    def can_undo(self) -> bool:
        """Whether there is a change to take back."""
        return bool(self._before or self.waiting)

    def undo(self) -> None:
        """Take the last change back; first those that wait."""
        if self.waiting:
            self.waiting = {}
            self.problems = ()
        elif self._before:
            text = self._before.pop()
            self._take(text, self._read(text))

    def _read(self, text: str) -> Model:
        """The model of a text; what is typed into a page names no file outside the folder, unless the file on the disk does."""
        outside = [
            Problem(name, "", "a file that the page names lies in the folder of the model")
            for name in sorted(_files_of(text) - self._known_files)
            if not (self.folder / name).resolve().is_relative_to(self.folder)
        ]
        if outside:
            raise ModelError(outside, self.path.name)
        return loads(text, self.path.name, self.folder)

    def _take(self, text: str, model: Model) -> None:
        self.text = text
        self.model = model
        self.waiting = {}
        self.problems = ()

    @property
    def difference(self) -> list[str]:
        """The lines that differ from those on the disk, with - and + before them."""
        lines = difflib.unified_diff(self.saved.splitlines(), self.text.splitlines(), lineterm="", n=0)
        return [line for line in lines if not line.startswith(("---", "+++", "@@"))]

    def save(self) -> Path:
        """Write the text into the file that it came from.

        Raises:
            WriteError: it can't be written, or someone else has changed it since.
        """
        try:
            there = read_text(self.path, MODEL.most_bytes)
        except UnreadableError as error:
            raise WriteError(self.path, error.reason) from None
        if there != self.saved:
            raise WriteError(
                self.path, "another program has changed it since it was read: start again, or save your text elsewhere"
            )
        with written(self.path) as scratch:
            scratch.write_text(self.text, encoding="utf-8")
        self.saved = self.text
        return self.path

    @property
    def rigs(self) -> list[str]:
        """Names of files beside the model that may hold lines of a rig."""
        return sorted(path.name for path in self.folder.glob(f"*{_RIG}") if self._is_inside(path))

    def rig(self, name: str) -> Path:
        """A file of `rigs` by its name.

        Raises:
            AnalysisError: any other name or path: the browser chooses among these, and names none itself.
        """
        if name not in self.rigs:
            raise AnalysisError("this is no file of a rig in the folder of the model")
        return self.folder / name

    def _is_inside(self, path: Path) -> bool:
        """Whether a path is a file of the model's folder, and no link that leads out of it."""
        return path.is_file() and path.resolve().parent == self.folder


def _files_of(text: str) -> set[str]:
    """The names of other files in the text of a model file."""
    found: set[str] = set()

    def named(name: str) -> str:
        found.add(name)
        return name

    with_named_files(tables_of(text), named)
    return found


def _value(text: str) -> Any:
    """What is typed, as a file spells it: a number, a list or a table as TOML has it, else a text."""
    stripped = text.strip()
    try:
        value = tables_of(f"value = {stripped}")["value"] if "\n" not in stripped else text
    except (ValueError, KeyError):
        return stripped
    return value if isinstance(value, int | float | list | dict | str) else stripped


def spelled(value: Any) -> str:
    """A value of a file as it is typed into a field: texts without their quotes."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(_quoted(one) for one in value)}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_quoted(one)}' for key, one in value.items())} }}"
    return repr(value)


def _quoted(value: Any) -> str:
    # A text of JSON, with its escapes, is one of TOML.
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else spelled(value)


def _fields(address: str, value: dict[str, Any], node: dict[str, Any]) -> Iterator[Field]:
    """The fields of a table and of the tables in it."""
    known = node.get("properties", {})
    for key in [*known, *(key for key in value if key not in known)]:
        place = f"{address}.{key}" if address else key
        # The entries of a table of names are what the table is.
        own = known.get(key) or {"description": node.get("description", ""), **(node.get("additionalProperties") or {})}
        given = value.get(key)
        if isinstance(given, dict):
            yield from _fields(place, given, _resolved(own, given))
        elif isinstance(given, list) and given and all(isinstance(one, dict) for one in given):
            for number, one in enumerate(given):
                yield from _fields(f"{place}[{number}]", one, _resolved(_resolved(own, given).get("items", {}), one))
        elif given is not None or not _is_table(own):
            yield _field(place, given, own)


def _field(address: str, given: Any, node: dict[str, Any]) -> Field:
    options = _options(node)
    words = [word for one in options for word in one.get("enum", [one["const"]] if "const" in one else [])]
    closed = bool(words) and all("enum" in one or "const" in one or one.get("type") == "null" for one in options)
    if any(one.get("type") == "boolean" for one in options):
        words = ["true", "false"]
        closed = True
    meaning = node.get("description", "")
    if words and not closed:
        meaning = f"{meaning}; or {', '.join(map(str, words))}"
    default = node.get("default")
    if given is None and default not in (None, "", [], {}):
        meaning = f"{meaning} (default: {spelled(default)})"
    numeric = any(one.get("type") in ("number", "integer") for one in options)
    return Field(
        address,
        "" if given is None else spelled(given),
        given is not None,
        unit=_unit(node),
        bounds=_bounds(options),
        meaning=meaning,
        choices=tuple(map(str, words)) if closed else (),
        is_number=numeric and _is_quantity(given),
        is_whole=any(one.get("type") == "integer" for one in options),
    )


def _is_quantity(given: Any) -> bool:
    """Whether a value is a number, with its unit or without, that a factor changes."""
    try:
        return not isinstance(given, bool) and split_number(str(given))[0] != 0.0
    except ValueError:
        return False


def _bounds(options: list[dict[str, Any]]) -> str:
    signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
    found = [f"{sign} {one[key]:g}" for key, sign in signs.items() for one in options if key in one]
    return " and ".join(dict.fromkeys(found))


def _unit(node: dict[str, Any]) -> str:
    """The unit of a node, or of the first of its kinds that has one."""
    return node.get("x-unit", "") or next(filter(None, map(_unit, node.get("anyOf", ()))), "")


def _below(node: dict[str, Any], key: str) -> dict[str, Any]:
    found: dict[str, Any] = node.get("properties", {}).get(key) or node.get("additionalProperties") or {}
    return found


def _options(node: dict[str, Any]) -> list[dict[str, Any]]:
    """The kinds of values that a node of the schema allows."""
    if "$ref" in node:
        return _options(_schema()["$defs"][node["$ref"].rpartition("/")[2]])
    several = node.get("anyOf") or node.get("oneOf")
    return [kind for one in several for kind in _options(one)] if several else [node]


def _resolved(node: dict[str, Any], value: Any) -> dict[str, Any]:
    """The kind among those of a node that a value is of."""
    wanted = "object" if isinstance(value, dict) else "array"
    found = next((one for one in _options(node) if one.get("type") == wanted), node)
    return {"description": node.get("description", ""), **found}


def _is_table(node: dict[str, Any]) -> bool:
    """Whether a node allows tables only, or lists of them."""
    kinds = [one for one in _options(node) if one.get("type") != "null"]
    return all(
        one.get("type") == "object"
        or (one.get("type") == "array" and all(item.get("type") == "object" for item in _options(one.get("items", {}))))
        for one in kinds
    )


@cache
def _schema() -> dict[str, Any]:
    """Made once: it takes a tenth of a second."""
    return schema()


@cache
def _tables() -> tuple[str, ...]:
    """The keys above all that are tables."""
    return tuple(key for key, node in _schema()["properties"].items() if key in _SINGLE or _is_table(node))
