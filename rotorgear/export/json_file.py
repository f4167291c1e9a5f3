"""A result's plain values as a JSON file (RFC 8259): UTF-8, no NaN or infinity, all or nothing."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rotorgear.errors import RotorgearError
from rotorgear.export.files import replacing


def write_json(data: dict[str, Any], path: str | Path) -> None:
    """Write plain values to a JSON file.

    Raises:
        RotorgearError: a value is not finite or no plain one; the file can't be written (WriteError).
    """
    try:
        text = json.dumps(data, indent=1, allow_nan=False, ensure_ascii=False)
    except (ValueError, TypeError) as error:
        raise RotorgearError(f"{path} can't be written as JSON: {error}") from None
    with replacing(path) as scratch:
        scratch.write_text(text + "\n", encoding="utf-8")
