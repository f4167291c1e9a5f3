"""Former values of keys of the model file, by the name of the part's class: read for one version, with a warning."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rotorgear.old_names import warn_old

# Class -> key -> former value -> value.
VALUES: dict[str, dict[str, dict[str, str]]] = {
    "NonlinearElement": {"law": {"loaded_face": "loaded_teeth"}},
}


def with_current_names(part: str, data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the data of a part by present values."""
    values = VALUES.get(part, {})
    current: dict[str, Any] = {}
    for key, value in data.items():
        renamed = values.get(key, {}).get(value) if isinstance(value, str) else None
        if renamed is not None:
            warn_old(f"{part}: {key} =", value, renamed, stacklevel=4)
        current[key] = value if renamed is None else renamed
    return current
