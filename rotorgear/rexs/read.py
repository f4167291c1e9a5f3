"""Reads REXS files 1.0 to 1.6: XML, JSON, or either in a zip archive; told apart by their first bytes.

The format: REXS specification, FVA e.V., https://www.rexs.info. Arrays may be coded: base64 of little-endian numbers.
"""

from __future__ import annotations

import base64
import binascii
import io
import json
import struct
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.parsers import expat

from rotorgear.errors import AnalysisError
from rotorgear.rexs.document import Component, Document, Relation, Value

# A gearbox with all its contact results has some ten megabytes; an archive that unpacks to more than this is no gearbox.
_LARGEST = 500_000_000
_CODES = {"float32": "f", "float64": "d", "int32": "i", "int64": "q"}


class _UnreadableError(Exception):
    """The reason why a file is no REXS file."""


def read_document(path: str | Path) -> Document:
    """Read a REXS file.

    Raises:
        AnalysisError: no such file, or not REXS; the sentence says why.
    """
    path = Path(path)
    try:
        data = _unpacked(path.read_bytes())
        start = data.lstrip(b"\xef\xbb\xbf \t\r\n")[:1]
        if start == b"<" or data[:2] in (b"\xff\xfe", b"\xfe\xff"):
            return _from_xml(data)
        if start == b"{":
            return _from_json(data)
        raise _UnreadableError("it is neither XML nor JSON nor a zip archive of one of them")
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise AnalysisError(f"{path}: can't be read: {reason}") from None
    except _UnreadableError as error:
        raise AnalysisError(f"{path}: no REXS file: {error}") from None


def _unpacked(data: bytes) -> bytes:
    """The one gearbox in an archive; anything else as it is."""
    if data[:4] != b"PK\x03\x04":
        return data
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            endings = (".rexs", ".rexsj", ".xml", ".json")
            members = [item for item in archive.infolist() if item.filename.lower().endswith(endings)]
            members = [item for item in members if not item.filename.startswith("__MACOSX")]
            if len(members) != 1:
                names = ", ".join(item.filename for item in members) or "none"
                raise _UnreadableError(
                    f"the archive must hold one file .rexs, .rexsj, .xml or .json, and holds: {names}"
                )
            # What the archive says of a size need not be true.
            with archive.open(members[0]) as stream:
                found = stream.read(_LARGEST + 1) if members[0].file_size <= _LARGEST else None
            if found is None or len(found) > _LARGEST:
                raise _UnreadableError(f"{members[0].filename} in the archive is larger than {_LARGEST // 10**6} MB")
            return found
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError) as error:
        raise _UnreadableError(f"the archive can't be unpacked: {error}") from None


def _from_xml(data: bytes) -> Document:
    _refuse_entities(data)
    try:
        root = ElementTree.fromstring(data)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise _UnreadableError(f"not well-formed XML: {error}") from None
    if _tag(root) != "model":
        raise _UnreadableError(f"its root is <{_tag(root)}>, not <model>")
    components = _by_id(
        Component(_needed(node, "id"), node.get("type", ""), node.get("name", ""), _attributes(node))
        for node in _inside(root, "components", "component")
    )
    relations = [
        Relation(node.get("type", ""), tuple((ref.get("role", ""), _needed(ref, "id")) for ref in _all(node, "ref")))
        for node in _inside(root, "relations", "relation")
    ]
    cases: list[tuple[str, dict[str, dict[str, Value]]]] = []
    for node in _inside(root, "load_spectrum", "load_case"):
        parts = [*_all(node, "component"), *_inside(node, "components", "component")]
        cases.append((node.get("id", str(len(cases) + 1)), {_needed(part, "id"): _attributes(part) for part in parts}))
    application = " ".join(filter(None, (root.get("applicationId"), root.get("applicationVersion"))))
    return Document(root.get("version", ""), application, components, tuple(relations), tuple(cases))


def _by_id(components: Iterable[Component]) -> dict[str, Component]:
    """Components by their id; two components of one id are refused, because relations would be ambiguous."""
    found: dict[str, Component] = {}
    for one in components:
        other = found.setdefault(one.id, one)
        if other is not one:
            both = " and ".join(f"{part.type} '{part.name}'" for part in (other, one))
            raise _UnreadableError(f"two components have the id {one.id}: {both}")
    return found


def _refuse_entities(data: bytes) -> None:
    """A document type may declare entities that expand to gigabytes, or name files of this machine; REXS has none."""
    parser = expat.ParserCreate()

    def refuse(*declared: Any) -> None:
        raise _UnreadableError("it declares a document type (DOCTYPE), which REXS has not: it is not expanded")

    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise _UnreadableError(f"not well-formed XML: {error}") from None


def _tag(node: ElementTree.Element) -> str:
    """Tag without namespace: some programs write one, others none."""
    return str(node.tag).rpartition("}")[2]


def _all(node: ElementTree.Element, tag: str) -> Iterator[ElementTree.Element]:
    return (child for child in node if _tag(child) == tag)


def _inside(node: ElementTree.Element, outer: str, inner: str) -> Iterator[ElementTree.Element]:
    return (child for group in _all(node, outer) for child in _all(group, inner))


def _needed(node: ElementTree.Element, key: str) -> str:
    found = node.get(key)
    if not found:
        raise _UnreadableError(f"a <{_tag(node)}> has no {key}")
    return found


def _attributes(node: ElementTree.Element) -> dict[str, Value]:
    return {_needed(item, "id"): Value(_content(item), item.get("unit", "")) for item in _all(node, "attribute")}


def _content(node: ElementTree.Element) -> object:
    for array in _all(node, "array"):
        code = array.get("code")
        if code:
            return _decoded((array.text or "").strip(), code)
        return [(entry.text or "").strip() for entry in _all(array, "c")]
    if len(node):
        return None  # a matrix, of contact results: nothing that a model takes
    return (node.text or "").strip()


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
        found[str(entry["id"])] = Value(raw, str(entry.get("unit") or ""))
    return found
