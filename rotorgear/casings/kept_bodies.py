"""Reduced bodies on disk (HDF5), one file a body, named by a hash of the meshes, of what the model file says and of the sources.

They lie in the folder of the compliances of teeth, under the same guards: a file is written under a temporary name and moved into
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
from rotorgear.fingerprint import fingerprint
from rotorgear.gears.tooth_fe.compliance_cache import cache_folder

# Where bodies are computed: entries of other sources are passed over.
_MAKERS = ("casings",)
_SURFACE = "surface."


def key_of(settings: CasingSettings, modes_to: float | None) -> str:
    """All that a body depends on, as a text: files count by their contents."""
    files = tuple((part, hashlib.sha256(path.read_bytes()).hexdigest()) for part, path in settings.files)
    return f"{fingerprint(*_MAKERS)} {files} {modes_to!r} {replace(settings, files=())!r}"


def path_of(key: str) -> Path:
    """The file of a key."""
    return cache_folder() / f"casing-{hashlib.sha256(key.encode()).hexdigest()[:32]}.h5"


def read_body(path: Path, key: str) -> ReducedBody | None:
    """The body of a file; None where it is missing, damaged, or of another key."""
    import h5py

    try:
        with h5py.File(path, "r") as file:
            values = {name: data[()] for name, data in file.items()}
            if file.attrs["key"] != key or file.attrs["checksum"] != _checksum(values):
                return None
            plain: dict[str, Any] = {name: value.item() if value.ndim == 0 else value for name, value in values.items()}
            plain |= {name: tuple(str(text) for text in file.attrs[name]) for name in ("seats", "notes")}
            surface = Surface(*(plain.pop(f"{_SURFACE}{one.name}") for one in fields(Surface)))
            plain.setdefault("rigid", None)  # a body that is held has none
            return ReducedBody(name=str(file.attrs["name"]), surface=surface, **plain)
    except Exception:  # whatever is wrong with the file, the body is computed anew
        return None


def write_body(path: Path, key: str, body: ReducedBody) -> None:
    """Write a body; a full disk or a folder that can't be written costs time only."""
    import h5py

    values: dict[str, Any] = {
        one.name: np.asarray(getattr(body, one.name))
        for one in fields(body)
        if one.name not in ("name", "seats", "notes", "surface", "seconds") and getattr(body, one.name) is not None
    }
    assert body.surface is not None, "a body of a mesh has a surface"
    values |= {f"{_SURFACE}{one.name}": np.asarray(getattr(body.surface, one.name)) for one in fields(Surface)}
    scratch = path.with_name(f".{path.stem}.{uuid.uuid4().hex}")
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            with h5py.File(scratch, "w") as file:
                for name, value in values.items():
                    file[name] = value
                file.attrs["key"] = key
                file.attrs["checksum"] = _checksum(values)
                file.attrs["name"] = body.name
                for name in ("seats", "notes"):
                    file.attrs.create(name, list(getattr(body, name)), dtype=h5py.string_dtype())
            os.replace(scratch, path)
        finally:
            scratch.unlink(missing_ok=True)


def _checksum(values: dict[str, Any]) -> str:
    digest = hashlib.sha256()
    for name in sorted(values):
        digest.update(name.encode())
        digest.update(np.ascontiguousarray(values[name]).tobytes())
    return digest.hexdigest()
