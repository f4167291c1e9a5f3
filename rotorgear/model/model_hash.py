"""A name for a model that changes with every value in it."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rotorgear.model.model import Model


def model_hash(model: Model) -> str:
    """Return the SHA-256 of the canonical JSON of a model's fields, in SI units: 64 hexadecimal digits.

    Canonical: keys in alphabetical order and no blanks, so that it does not matter how the file was written or in which order
    its tables stand; Python writes the shortest digits that give a float back.
    """
    text = json.dumps(
        model.model_dump(mode="json", exclude_none=True), sort_keys=True, separators=(",", ":"), ensure_ascii=False
    )
    return hashlib.sha256(text.encode("utf-8")).hexdigest()
