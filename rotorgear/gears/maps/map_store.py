"""Contact maps on disk, beside the compliances: one file a map, named by a hash of teeth, load and the sources that solve it.

A map that took less than a second is not kept. Files are written under a temporary name and moved into place; what can't be
read is solved anew, and where nothing can be written nothing is kept.
"""

from __future__ import annotations

import hashlib
import os
import time
import uuid
from collections.abc import Callable
from contextlib import suppress
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.fingerprint import fingerprint
from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.gears.tooth_fe.compliance_cache import cache_folder

# Maps of other sources are passed over.
_MAKERS = ("gears",)
# Seconds from which on a map is worth a file.
_WORTH = 1.0


def kept_map(key: Any, solve: Callable[[], ContactMap]) -> ContactMap:
    """The map of a key from disk, or solved and kept."""
    text = f"{fingerprint(*_MAKERS)} {_text(key)}"
    path = cache_folder() / f"map_{hashlib.sha256(text.encode()).hexdigest()[:32]}.npz"
    found = _read(path, text)
    if found is not None:
        return found
    start = time.process_time()
    found = solve()
    if time.process_time() - start >= _WORTH:
        with suppress(OSError):
            _write(path, text, found)
    return found


def _text(value: Any) -> str:
    """All that a value holds, arrays in full by their hash: a repr would leave out the middle of a long one."""
    if is_dataclass(value):
        inside = ", ".join(f"{field.name}={_text(getattr(value, field.name))}" for field in fields(value))
        return f"{type(value).__name__}({inside})"
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape} {hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()}"
    if isinstance(value, tuple | list):
        return f"({', '.join(_text(one) for one in value)})"
    return repr(value)


def _read(path: Path, text: str) -> ContactMap | None:
    """The map of a file; None where it is missing, damaged or of another key."""
    try:
        with np.load(path, allow_pickle=False) as stored:
            values = {
                name: stored[name]
                for name in ("position", "load", "approach", "compliance", "moment")
                if name in stored
            }
            good = str(stored["key"]) == text and str(stored["checksum"]) == _checksum(values)
            periods = int(stored["periods"])
            error = float(stored["error"])
            warnings = tuple(str(note) for note in stored["warnings"])
    except Exception:  # whatever is wrong with the file, the map is solved anew
        return None
    return ContactMap(periods=periods, warnings=warnings, error=error, **values) if good else None


def _write(path: Path, text: str, found: ContactMap) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    assert found.compliance is not None
    values = {
        "position": found.position,
        "load": found.load,
        "approach": found.approach,
        "compliance": found.compliance,
    }
    if found.moment is not None:
        values["moment"] = found.moment
    scratch = path.with_name(f".{path.stem}.{uuid.uuid4().hex}")
    labels = {"key": np.array(text), "checksum": np.array(_checksum(values)), "warnings": np.array(found.warnings, str)}
    store: Any = np.savez  # its stubs take names for options
    try:
        with scratch.open("wb") as file:
            store(file, **values, **labels, periods=found.periods, error=found.error)
        os.replace(scratch, path)
    finally:
        scratch.unlink(missing_ok=True)


def _checksum(values: dict[str, np.ndarray]) -> str:
    digest = hashlib.sha256()
    for name in sorted(values):
        digest.update(name.encode())
        digest.update(np.ascontiguousarray(values[name]).tobytes())
    return digest.hexdigest()
