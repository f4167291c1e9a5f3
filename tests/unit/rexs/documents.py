"""The public sample as a document, documents changed in a line, and documents written as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from rotorgear.rexs.document import Component, Document, Value
from rotorgear.rexs.read import read_document
from tests.paths import ROOT

SAMPLE = ROOT / "tests" / "rexs_files" / "sew_3_stage_1.0.rexs"
BEARINX = ROOT / "tests" / "rexs_files" / "fva_2_stage_1.4.rexs"


@cache
def sample() -> Document:
    """The public sample: three stages, nine bearings with placeholders."""
    return read_document(SAMPLE)


@cache
def bearinx() -> Document:
    """The public two-stage gearbox of version 1.4: a shaft borne in another one, four load cases."""
    return read_document(BEARINX)


def changed(document: Document, number: str, **attributes: Value | None) -> Document:
    """The document with attributes of one component set, or taken away by None."""
    old = document.components[number]
    kept = {key: value for key, value in {**old.attributes, **attributes}.items() if value is not None}
    return replace(document, components={**document.components, number: replace(old, attributes=kept)})


def without(document: Document, kind: str, *names: str) -> Document:
    """The document with attributes taken away from all components of a type."""
    for component in document.of_type(kind):
        document = changed(document, component.id, **dict.fromkeys(names))
    return document


def with_component(document: Document, component: Component) -> Document:
    """The document with one more component."""
    return replace(document, components={**document.components, component.id: component})


def write_json(document: Document, path: Path) -> Path:
    """Write a document as REXS JSON."""
    model = {
        "version": document.version,
        "applicationId": document.application,
        "components": [
            {"id": int(c.id), "type": c.type, "name": c.name, "attributes": _entries(c.attributes)}
            for c in document.components.values()
        ],
        "relations": [
            {"id": k, "type": item.type, "refs": [{"role": role, "id": int(number)} for role, number in item.refs]}
            for k, item in enumerate(document.relations)
        ],
        "load_spectrum": {
            "id": 1,
            "load_cases": [
                {"id": int(name), "components": [{"id": int(n), "attributes": _entries(a)} for n, a in parts.items()]}
                for name, parts in document.load_cases
            ],
        },
    }
    path.write_text(json.dumps({"model": model}), encoding="utf-8")
    return path


def _entries(attributes: Mapping[str, Value]) -> list[dict[str, Any]]:
    return [{"id": name, "unit": value.unit, **_typed(name, value.raw)} for name, value in attributes.items()]


def _typed(name: str, raw: object) -> dict[str, object]:
    if isinstance(raw, list) and raw and raw[0] in ("true", "false"):
        return {"boolean_array": [entry == "true" for entry in raw]}
    if isinstance(raw, list):
        return {"floating_point_array": [float(entry) for entry in raw]}
    if name == "name":
        return {"string": raw}
    try:
        return {"floating_point": float(raw)}  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return {"string": raw}
