"""What takes long is kept on disk between runs: one file an entry, named by a hash of all that it depends on.

The folder is ROTORGEAR_CACHE, else one in the user's cache folder. A file is written under a temporary name and moved into place,
so that several runs may share the folder; it carries the text of its key and a checksum, and what can't be read is computed anew.
Where nothing can be written, nothing is kept.
"""

from __future__ import annotations

import hashlib
import os
import uuid
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np


def cache_folder(subject: str) -> Path:
    """Folder of what is kept of a subject, such as "teeth"; ROTORGEAR_CACHE is one for all subjects."""
    given = os.environ.get("ROTORGEAR_CACHE")
    return Path(given) if given else user_cache_folder(subject)


def user_cache_folder(subject: str) -> Path:
    """Folder of a subject in the user's cache folder, where the system has such folders."""
    from platformdirs import user_cache_path

    return user_cache_path("rotorgear", appauthor=False) / subject


def entry_path(subject: str, kind: str, key: str) -> Path:
    """File of an entry: its kind, such as "map", and a hash of the text that tells all it depends on."""
    return cache_folder(subject) / f"{kind}_{hashlib.sha256(key.encode()).hexdigest()[:32]}.npz"


def read_entry(path: Path, key: str) -> dict[str, Any] | None:
    """Values of an entry: arrays, numbers and texts; None where the file is missing, damaged or of another key."""
    import numpy as np

    try:
        with np.load(path, allow_pickle=False) as stored:
            values = {name: stored[name] for name in stored.files}
        # The name is a hash only; the text of the key decides.
        if str(values.pop("key")) != key or str(values.pop("checksum")) != _checksum(values):
            return None
    except Exception:  # whatever is wrong with the file, it is computed anew
        return None
    plain: dict[str, Any] = {}
    for name, value in values.items():
        if value.ndim == 0:
            plain[name] = value.item()
        else:
            plain[name] = tuple(value.tolist()) if value.dtype.kind == "U" else value
    return plain


def write_entry(path: Path, key: str, values: Mapping[str, Any]) -> None:
    """Write arrays, numbers, texts and tuples of texts under a name; None is left out. Other runs see all of it or nothing.

    A full disk or a folder that can't be written costs time only.
    """
    import numpy as np

    given = {name: value for name, value in values.items() if value is not None}
    arrays = {name: np.asarray(value, str if isinstance(value, tuple) else None) for name, value in given.items()}
    labels = {"key": np.array(key), "checksum": np.array(_checksum(arrays))}
    scratch = path.with_name(f".{path.stem}.{uuid.uuid4().hex}")
    store: Any = np.savez  # its stubs take names for options
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            with scratch.open("wb") as file:
                store(file, **arrays, **labels)
            os.replace(scratch, path)
        finally:
            scratch.unlink(missing_ok=True)


def _checksum(values: Mapping[str, np.ndarray]) -> str:
    digest = hashlib.sha256()
    for name in sorted(values):
        digest.update(name.encode())
        digest.update(values[name].tobytes())
    return digest.hexdigest()
