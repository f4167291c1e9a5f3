"""Reduced bodies on disk (HDF5), one file a body, named by a hash of the meshes, of what the model file says and of the sources.

The folder is ROTORGEAR_CACHE, else "bodies" in the user's cache folder. A file is written under a temporary name and moved into
place, it carries the text of its key and a checksum, and what can't be read is computed anew. Where nothing can be written,
nothing is kept.
"""

from __future__ import annotations

import hashlib
import os
import uuid
from contextlib import suppress
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.casings.reduced_body import ReducedBody, Surface
from rotorgear.casings.settings import CasingSettings
from rotorgear.casings.wheel import ReducedWheel
from rotorgear.fingerprint import fingerprint

# Where bodies are computed: entries of other sources are passed over.
_MAKERS = ("casings",)
_SURFACE = "surface."
# Fields that are texts, or lists of them.
_TEXTS = ("name", "seats", "notes", "ground_sets")


def cache_folder() -> Path:
    """Where reduced bodies are kept."""
    given = os.environ.get("ROTORGEAR_CACHE")
    if given:
        return Path(given)
    base = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or "~/.cache"
    return Path(base).expanduser() / "rotorgear" / "bodies"


def key_of(settings: CasingSettings, modes_to: float | None) -> str:
    """All that a body depends on, as a text: files count by their contents."""
    files = tuple((part, hashlib.sha256(path.read_bytes()).hexdigest()) for part, path in settings.files)
    return f"{fingerprint(*_MAKERS)} {files} {modes_to!r} {replace(settings, files=())!r}"


def path_of(key: str) -> Path:
    """The file of a key."""
    return cache_folder() / f"body-{hashlib.sha256(key.encode()).hexdigest()[:32]}.h5"


def read_body(path: Path, key: str) -> ReducedBody | None:
    """The casing of a file; None where it is missing, damaged, or of another key."""
    values = _read(path, key)
    try:
        if values is not None:
            return ReducedBody(**{"rigid": None, **values})  # a body that is held has no rigid motions
    except (KeyError, TypeError):
        pass  # of another kind: computed anew
    return None


def write_body(path: Path, key: str, body: ReducedBody) -> None:
    """Write a casing; a full disk or a folder that can't be written costs time only."""
    _write(path, key, {one.name: getattr(body, one.name) for one in fields(body) if one.name != "seconds"})


def read_wheel(path: Path, key: str) -> ReducedWheel | None:
    """The gear body of a file; None where it is missing, damaged, or of another key."""
    values = _read(path, key)
    try:
        return None if values is None else ReducedWheel(**values)
    except TypeError:
        return None  # of another kind: computed anew


def write_wheel(path: Path, key: str, wheel: ReducedWheel) -> None:
    """Write a gear body, as `write_body` does."""
    _write(path, key, {one.name: getattr(wheel, one.name) for one in fields(wheel)})


def _read(path: Path, key: str) -> dict[str, Any] | None:
    import h5py

    try:
        with h5py.File(path, "r") as file:
            values = {name: data[()] for name, data in file.items()}
            if file.attrs["key"] != key or file.attrs["checksum"] != _checksum(values):
                return None
            plain: dict[str, Any] = {name: value.item() if value.ndim == 0 else value for name, value in values.items()}
            plain["surface"] = Surface(*(plain.pop(f"{_SURFACE}{one.name}") for one in fields(Surface)))
            for name in _TEXTS:
                if name in file.attrs:
                    text = file.attrs[name]
                    plain[name] = text if isinstance(text, str) else tuple(str(one) for one in text)
            return plain
    except Exception:  # whatever is wrong with the file, the body is computed anew
        return None


def _write(path: Path, key: str, record: dict[str, Any]) -> None:
    import h5py

    surface = record.pop("surface")
    assert surface is not None, "a body of a mesh has a surface"
    record |= {f"{_SURFACE}{one.name}": getattr(surface, one.name) for one in fields(Surface)}
    values = {name: np.asarray(value) for name, value in record.items() if name not in _TEXTS and value is not None}
    texts = {name: value for name, value in record.items() if name in _TEXTS}
    scratch = path.with_name(f".{path.stem}.{uuid.uuid4().hex}")
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            with h5py.File(scratch, "w") as file:
                for name, value in values.items():
                    file[name] = value
                file.attrs["key"] = key
                file.attrs["checksum"] = _checksum(values)
                for name, text in texts.items():
                    if isinstance(text, str):
                        file.attrs[name] = text
                    else:
                        file.attrs.create(name, list(text), dtype=h5py.string_dtype())
            os.replace(scratch, path)
        finally:
            scratch.unlink(missing_ok=True)


def _checksum(values: dict[str, Any]) -> str:
    digest = hashlib.sha256()
    for name in sorted(values):
        digest.update(name.encode())
        digest.update(np.ascontiguousarray(values[name]).tobytes())
    return digest.hexdigest()
