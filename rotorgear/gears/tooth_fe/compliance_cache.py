"""Compliances on disk, one file a gear, named by a hash of all that it depends on.

The folder is ROTORGEAR_CACHE, else the user's cache folder. A file is written under a temporary name and moved into place, so
that several runs may share the folder; it carries the sources' hash and a checksum, and what can't be read is computed anew.
Where nothing can be written, nothing is kept.
"""

from __future__ import annotations

import hashlib
import os
import uuid
from collections.abc import Callable
from contextlib import suppress
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.fingerprint import fingerprint
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance

# Where compliances are computed: entries of other sources are passed over.
MAKERS = ("gears/tooth_fe",)
# A process keeps this many compliances in memory; one in 3D takes several MB.
_MOST_KEPT = 16
_KEPT: dict[str, GearCompliance] = {}


def cache_folder() -> Path:
    """Where compliances are kept."""
    given = os.environ.get("ROTORGEAR_CACHE")
    if given:
        return Path(given)
    base = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or "~/.cache"
    return Path(base).expanduser() / "rotorgear" / "teeth"


def entry_name(key: Any) -> str:
    """Name of the entry of a frozen key: a hash of its text and of the sources that compute it."""
    return hashlib.sha256(f"{fingerprint(*MAKERS)} {key!r}".encode()).hexdigest()[:32]


def cached(key: Any, compute: Callable[[], GearCompliance]) -> GearCompliance:
    """The compliance of a key from memory, from disk, or computed and kept."""
    name = entry_name(key)
    if name not in _KEPT:
        path = cache_folder() / f"{name}.npz"
        compliance = _read(path, key)
        if compliance is None:
            compliance = compute()
            with suppress(OSError):  # a full disk or a folder that can't be written costs time only
                _write(path, key, compliance)
        while len(_KEPT) >= _MOST_KEPT:
            _KEPT.pop(next(iter(_KEPT)))  # the oldest: dicts keep their order
        _KEPT[name] = compliance
    return _KEPT[name]


def forget() -> None:
    """Drop what is kept in memory; the disk stays."""
    _KEPT.clear()


def _checksum(values: dict[str, np.ndarray]) -> str:
    digest = hashlib.sha256()
    for name in sorted(values):
        digest.update(name.encode())
        digest.update(np.ascontiguousarray(values[name]).tobytes())
    return digest.hexdigest()


def _read(path: Path, key: Any) -> GearCompliance | None:
    """The entry of a file; None where it is missing, damaged, or of another key or of other sources."""
    try:
        with np.load(path, allow_pickle=False) as stored:
            values = {field.name: stored[field.name] for field in fields(GearCompliance)}
            # The name is a hash only; the text of the key decides.
            good = str(stored["key"]) == f"{fingerprint(*MAKERS)} {key!r}" and str(stored["checksum"]) == _checksum(
                values
            )
    except Exception:  # whatever is wrong with the file, it is computed anew
        return None
    if not good:
        return None
    plain = {name: value if value.ndim else value.item() for name, value in values.items()}
    return GearCompliance(**plain)


def _write(path: Path, key: Any, compliance: GearCompliance) -> None:
    """Write an entry under a name of its own and move it into place: other runs see all of it or nothing."""
    path.parent.mkdir(parents=True, exist_ok=True)
    values = {field.name: np.asarray(getattr(compliance, field.name)) for field in fields(GearCompliance)}
    scratch = path.with_name(f".{path.stem}.{uuid.uuid4().hex}")
    try:
        with scratch.open("wb") as file:
            labels = {"key": np.array(f"{fingerprint(*MAKERS)} {key!r}"), "checksum": np.array(_checksum(values))}
            store: Any = np.savez  # its stubs take names for options
            store(file, **values, **labels)
        os.replace(scratch, path)
    finally:
        scratch.unlink(missing_ok=True)
