"""Former keys and values of the model file, by the name of the part's class: read for one version, with a warning.

The loader, constructors, addresses of a sweep and attributes all look here, so that a renamed key is named once.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rotorgear.old_names import warn_old

# Class -> former key -> key.
KEYS: dict[str, dict[str, str]] = {
    "Mesh": {"back_flank": "coast_flank", "damping_depth": "regularisation_depth", "helix_stagger": "stagger"},
}
# Class -> key -> former value -> value.
VALUES: dict[str, dict[str, dict[str, str]]] = {
    "Mesh": {"contact_damping": {"clamped": "non-adhesive", "unclamped": "adhesive"}},
    "NonlinearElement": {"law": {"loaded_face": "loaded_teeth"}},
}


def current_key(part: str, key: str) -> str:
    """Return the present name of a key of the class `part`; a warning where it has changed."""
    new = KEYS.get(part, {}).get(key, key)
    if new != key:
        warn_old(f"{part}: key", key, new, stacklevel=4)
    return new


def current_address(address: str) -> str:
    """Return the address of a value by present keys: "meshes.pair.back_flank" -> "meshes.pair.coast_flank"."""
    renamed = {old: new for keys in KEYS.values() for old, new in keys.items()}
    parts = address.split(".")
    current = ".".join(renamed.get(part, part) for part in parts[2:])
    if current == ".".join(parts[2:]):
        return address
    current = ".".join([*parts[:2], current])
    warn_old("address", address, current, stacklevel=4)
    return current


def with_current_names(part: str, data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the data of a part by present keys and values.

    A former key beside the new one stays, so that the check for unknown keys reports it, unless both say the same.
    """
    keys = KEYS.get(part, {})
    values = VALUES.get(part, {})
    current: dict[str, Any] = {}
    for key, value in data.items():
        clashes = key in keys and keys[key] in data and data[keys[key]] != value
        name = key if clashes or key not in keys else current_key(part, key)
        renamed = values.get(name, {}).get(value) if isinstance(value, str) else None
        if renamed is not None:
            warn_old(f"{part}: {name} =", value, renamed, stacklevel=4)
        current[name] = value if renamed is None else renamed
    return current
