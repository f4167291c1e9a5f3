"""A model file from plain tables: what tomllib reads, written back, with whatever names and numbers a mutation put there."""

from __future__ import annotations

import json
import math
from typing import Any


def toml_text(data: dict[str, Any]) -> str:
    """The text of a document; parts are tables of their own, as in models/."""
    lines: list[str] = []
    plain = {key: value for key, value in data.items() if not isinstance(value, dict)}
    lines += [f"{_key(key)} = {_value(value)}" for key, value in plain.items()]
    for table, parts in data.items():
        if not isinstance(parts, dict):
            continue
        inner = {key: value for key, value in parts.items() if not isinstance(value, dict)}
        if inner or not parts:
            lines += ["", f"[{_key(table)}]", *[f"{_key(key)} = {_value(value)}" for key, value in inner.items()]]
        for name, part in parts.items():
            if isinstance(part, dict):
                head = f"[{_key(table)}.{_key(name)}]"
                lines += ["", head, *[f"{_key(key)} = {_value(value)}" for key, value in part.items()]]
    return "\n".join(lines) + "\n"


def _key(name: str) -> str:
    return name if name.isascii() and name.replace("_", "a").replace("-", "a").isalnum() else _text(name)


def _text(value: str) -> str:
    # A basic string of TOML is one of JSON, but for code points above 16 bits and the character DEL.
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return (
            repr(value) if math.isfinite(value) else ("nan" if math.isnan(value) else "inf" if value > 0.0 else "-inf")
        )
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key)} = {_value(entry)}" for key, entry in value.items()) + "}"
    return _text(str(value))
