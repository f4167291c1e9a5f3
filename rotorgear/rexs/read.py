"""Reads REXS files 1.0 to 1.6: XML, JSON, or either in a zip archive; told apart by their first bytes.

XML is read as it comes, and what no model takes is not kept. The format: REXS specification, FVA e.V., https://www.rexs.info.
Arrays may be coded: base64 of little-endian numbers.
"""

from __future__ import annotations

import base64
import binascii
import json
import struct
from collections.abc import Iterable
from contextlib import ExitStack
from pathlib import Path
from typing import IO, Any
from xml.parsers import expat

from rotorgear.errors import AnalysisError
from rotorgear.files.archive import opened_zip
from rotorgear.files.bounds import LONGEST_TEXT, MOST_COMPONENTS, MOST_ELEMENTS, MOST_MEMBERS, REXS
from rotorgear.files.read import UnreadableError, opened, too_large
from rotorgear.rexs.document import Component, Document, Relation, Value

_CODES = {"float32": "f", "float64": "d", "int32": "i", "int64": "q"}
_TOGETHER = 1 << 16
_LONGEST_TAG = 1_000_000
# Commas and opening brackets in JSON for each element of XML.
_MARKS = 4


class _UnreadableError(Exception):
    """The reason why a file is no REXS file."""


def read_document(path: str | Path) -> Document:
    """Read a REXS file.

    Raises:
        AnalysisError: no such file, or not REXS; the sentence says why.
    """
    path = Path(path)
    try:
        with ExitStack() as stack:
            stream: IO[bytes] = stack.enter_context(opened(path, REXS.most_bytes))
            data = stream.read(_TOGETHER)
            if data[:4] == b"PK\x03\x04":
                stream = stack.enter_context(_unpacked(path, stack))
                data = stream.read(_TOGETHER)
            start = data.lstrip(b"\xef\xbb\xbf \t\r\n")[:1]
            if start == b"<" or data[:2] in (b"\xff\xfe", b"\xfe\xff"):
                return _from_xml(data, stream)
            if start == b"{":
                data += stream.read(REXS.most_bytes)
                if len(data) > REXS.most_bytes:
                    raise _UnreadableError(too_large(REXS.most_bytes))
                return _from_json(data)
            raise _UnreadableError("it is neither XML nor JSON nor a zip archive of one of them")
    except UnreadableError as error:
        raise AnalysisError(f"{path}: can't be read: {error.reason}") from None
    except _UnreadableError as error:
        raise AnalysisError(f"{path}: no REXS file: {error}") from None


def _unpacked(path: Path, stack: ExitStack) -> IO[bytes]:
    """The one gearbox in an archive, opened."""
    archive = stack.enter_context(opened_zip(path, REXS.most_bytes))
    endings = (".rexs", ".rexsj", ".xml", ".json")
    members = [item for item in archive.infolist() if item.filename.lower().endswith(endings)]
    members = [item for item in members if not item.filename.startswith("__MACOSX")]
    if len(members) != 1:
        names = ", ".join(item.filename for item in members[:10]) or "none"
        raise _UnreadableError(f"the archive must hold one file .rexs, .rexsj, .xml or .json, and holds: {names}")
    return archive.open(members[0])


def _from_xml(data: bytes, stream: IO[bytes]) -> Document:
    """The document of a text in XML, of which the first bytes are read already."""
    found = _Elements()
    parser = expat.ParserCreate(namespace_separator="}")  # some programs write a namespace, others none
    parser.buffer_text = True
    parser.StartElementHandler = found.start
    parser.EndElementHandler = found.end
    parser.CharacterDataHandler = found.data
    parser.StartDoctypeDeclHandler = _refuse_doctype
    try:
        fed = 0
        while data:
            parser.Parse(data, False)
            fed += len(data)
            # An open tag is read again from its begin with each piece.
            if fed - parser.CurrentByteIndex > _LONGEST_TAG:
                raise _UnreadableError(f"a tag or a comment of more than {_LONGEST_TAG // 1000} kB")
            data = stream.read(_TOGETHER)
        parser.Parse(b"", True)
    except (expat.ExpatError, ValueError, LookupError) as error:  # the latter two of encodings
        raise _UnreadableError(f"not well-formed XML: {error}") from None
    return found.document()


def _refuse_doctype(*declared: Any) -> None:
    """A document type may declare entities that expand to gigabytes, or name files of this machine; REXS has none."""
    raise _UnreadableError("it declares a document type (DOCTYPE), which REXS has not: it is not expanded")


_COMPONENT = (("model", "components", "component"),)
_OF_CASE = (
    ("model", "load_spectrum", "load_case", "component"),
    ("model", "load_spectrum", "load_case", "components", "component"),
)
_KNOWN = {name for path in (*_COMPONENT, *_OF_CASE) for name in path}
_KNOWN |= {"relations", "relation", "ref", "attribute", "array", "c"}


class _Elements:
    """The elements of a file as they come: what a model takes of them is kept."""

    def __init__(self) -> None:
        self.root: dict[str, str] = {}
        self.components: list[Component] = []
        self.relations: list[Relation] = []
        self.cases: list[tuple[str, dict[str, dict[str, Value]]]] = []
        self._count = 0
        self._path: list[str] = []
        self._refs: list[tuple[str, str]] = []
        self._attributes: dict[str, Value] | None = None  # of the component that is open
        self._depth = 0  # of that component
        self._attribute = ("", "")  # id and unit of the attribute that is open
        self._code: str | None = None  # of its array, where that is coded
        self._array: list[object] | None = None
        self._content: object = None
        self._text: list[str] | None = None

    def start(self, name: str, given: dict[str, str]) -> None:
        self._count += 1
        if self._count > MOST_ELEMENTS:
            raise _UnreadableError(f"it has more than {MOST_ELEMENTS} elements")
        tag = name.rpartition("}")[2]
        path = self._path
        path.append(tag)
        if len(path) == 1:
            if tag != "model":
                raise _UnreadableError(f"its root is <{tag[:60]}>, not <model>")
            self.root = given
        if tag not in _KNOWN:
            if self._attributes is not None and len(path) == self._depth + 2 and self._text is not None:
                self._text = None  # of an attribute: a matrix, of contact results; nothing that a model takes
                self._content = None
            return
        if any(len(text) > LONGEST_TEXT for text in given.values()):
            raise _UnreadableError(f"a <{tag}> has a text of more than {LONGEST_TEXT} letters")
        place = tuple(path) if len(path) <= 5 else ()
        if place == ("model", "load_spectrum", "load_case"):
            self.cases.append((given.get("id", str(len(self.cases) + 1)), {}))
        elif place in _COMPONENT or place in _OF_CASE:
            self._attributes = {}
            self._depth = len(path)
            number = _needed(tag, given, "id")
            if place in _COMPONENT:
                self.components.append(
                    Component(number, given.get("type", ""), given.get("name", ""), self._attributes)
                )
            else:
                self.cases[-1][1][number] = self._attributes
        elif place == ("model", "relations", "relation"):
            self._refs = []
            self.relations.append(Relation(given.get("type", ""), ()))
        elif place == ("model", "relations", "relation", "ref"):
            self._refs.append((given.get("role", ""), _needed(tag, given, "id")))
            if len(self._refs) > MOST_MEMBERS:
                raise _UnreadableError(f"a relation has more than {MOST_MEMBERS} members")
        elif self._attributes is not None:
            self._inside(tag, given, len(path) - self._depth)

    def _inside(self, tag: str, given: dict[str, str], level: int) -> None:
        """An element at a level below a component: an attribute, its array, an entry of that."""
        if tag == "attribute" and level == 1:
            self._attribute = (_needed(tag, given, "id"), given.get("unit", ""))
            self._array = self._code = self._content = None
            self._text = []
        elif tag == "array" and level == 2 and self._array is None:
            self._code = given.get("code")
            self._array = []
            self._text = [] if self._code else None
        elif tag == "c" and level == 3 and self._array is not None and not self._code:
            self._text = []
        elif level == 2:
            self._text = None

    def data(self, text: str) -> None:
        if self._text is not None:
            self._text.append(text)

    def end(self, name: str) -> None:
        path = self._path
        tag = path.pop()
        if tag == "relation" and path == ["model", "relations"]:
            self.relations[-1] = Relation(self.relations[-1].type, tuple(self._refs))
        if self._attributes is None or tag not in _KNOWN:
            return
        level = len(path) + 1 - self._depth
        if level == 0:
            self._attributes = self._text = None
        elif tag == "c" and level == 3 and self._text is not None and self._array is not None:
            self._array.append(self._taken())
        elif tag == "array" and level == 2:
            if self._content is None:
                self._content = _decoded(self._taken(), self._code) if self._code else self._array
            self._text = None
        elif tag == "attribute" and level == 1:
            number, unit = self._attribute
            content = self._taken() if self._text is not None else self._content
            self._attributes[number] = Value(content, unit)
            self._text = None

    def _taken(self) -> str:
        """The text that was gathered, without blanks around it."""
        text = "".join(self._text or ()).strip()
        self._text = None
        if len(text) > LONGEST_TEXT and not self._code:
            raise _UnreadableError(f"the attribute {self._attribute[0]} has a text of more than {LONGEST_TEXT} letters")
        return text

    def document(self) -> Document:
        """What was found."""
        application = " ".join(filter(None, (self.root.get("applicationId"), self.root.get("applicationVersion"))))
        version = self.root.get("version", "")
        if max(len(application), len(version)) > LONGEST_TEXT:
            raise _UnreadableError(f"version or program are texts of more than {LONGEST_TEXT} letters")
        return Document(version, application, _by_id(self.components), tuple(self.relations), tuple(self.cases))


def _needed(tag: str, given: dict[str, str], key: str) -> str:
    found = given.get(key)
    if not found:
        raise _UnreadableError(f"a <{tag}> has no {key}")
    return found


def _by_id(components: Iterable[Component]) -> dict[str, Component]:
    """Components by their id; two components of one id are refused, because relations would be ambiguous."""
    found: dict[str, Component] = {}
    for one in components:
        other = found.setdefault(one.id, one)
        if len(found) > MOST_COMPONENTS:
            raise _UnreadableError(f"it has more than {MOST_COMPONENTS} components")
        if other is not one:
            both = " and ".join(f"{part.type} '{part.name}'" for part in (other, one))
            raise _UnreadableError(f"two components have the id {one.id}: {both}")
    return found


def _decoded(text: str, code: str) -> list[float] | None:
    letter = _CODES.get(code)
    if letter is None:
        return None
    try:
        raw = base64.b64decode(text, validate=True)
        return list(struct.unpack(f"<{len(raw) // struct.calcsize(letter)}{letter}", raw))
    except (binascii.Error, struct.error):
        raise _UnreadableError(f"an array coded as {code} is damaged") from None


def _from_json(data: bytes) -> Document:
    if data.count(b",") + data.count(b"[") + data.count(b"{") > _MARKS * MOST_ELEMENTS:
        raise _UnreadableError(f"it has more than {MOST_ELEMENTS} elements")
    try:
        whole = json.loads(data.decode("utf-8-sig"))
        root = whole["model"]
        components = _by_id(
            Component(str(item["id"]), str(item.get("type", "")), str(item.get("name") or ""), _entries(item))
            for item in root.get("components", ())
        )
        relations = [
            Relation(
                str(item.get("type", "")), tuple((str(ref.get("role", "")), str(ref["id"])) for ref in item["refs"])
            )
            for item in root.get("relations", ())
        ]
        if any(len(one.refs) > MOST_MEMBERS for one in relations):
            raise _UnreadableError(f"a relation has more than {MOST_MEMBERS} members")
        spectrum = root.get("load_spectrum") or {}
        cases = [
            (str(case.get("id", k)), {str(item["id"]): _entries(item) for item in case.get("components", ())})
            for k, case in enumerate(spectrum.get("load_cases", ()), 1)
        ]
    except (ValueError, UnicodeDecodeError, RecursionError) as error:
        raise _UnreadableError(f"not valid JSON: {error}") from None
    except (KeyError, TypeError, AttributeError) as error:
        raise _UnreadableError(f"its JSON has not the shape of a model: {error}") from None
    application = " ".join(str(root[key]) for key in ("applicationId", "applicationVersion") if root.get(key))
    return Document(str(root.get("version", "")), application, components, tuple(relations), tuple(cases))


def _entries(item: dict[str, Any]) -> dict[str, Value]:
    found = {}
    for entry in item.get("attributes", ()):
        typed = [(key, value) for key, value in entry.items() if key not in ("id", "unit")]
        raw: object = None
        if typed:
            key, raw = typed[0]
            if key.endswith("_coded") and isinstance(raw, dict):
                raw = None if "matrix" in key else _decoded(str(raw.get("value", "")), str(raw.get("code", "")))
        value = Value(raw, str(entry.get("unit") or ""))
        number = str(entry["id"])
        if max(len(number), len(value.unit), len(raw) if isinstance(raw, str) else 0) > LONGEST_TEXT:
            raise _UnreadableError(f"an attribute has a text of more than {LONGEST_TEXT} letters")
        found[number] = value
    return found
