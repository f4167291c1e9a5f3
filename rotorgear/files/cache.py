"""What takes long is kept on disk between runs, in folders that nobody else can write to.

An entry is one file, named by a hash of all that it depends on. It is written under a temporary name and moved into place, so
that several runs may share the folder; it carries the text of its key and a checksum over all of it, and what can't be read is
computed anew. Where nothing can be written, nothing is kept.

Compiled code is loaded from such a folder too: whoever can write there can have code run. A folder counts where this user owns it
and nobody else can write to it, and it is no link; one that the owner of the package made, such as in an image of a container, is
read and not written.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import shutil
import stat
import tempfile
import uuid
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rotorgear.files.archive import read_arrays

if TYPE_CHECKING:
    import numpy as np

_PRIVATE = 0o700
# Number of versions of a subject that are kept: other checkouts may be in use at the same time.
MOST_VERSIONS = 12
_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_PACKAGE = Path(__file__).resolve().parents[1]
# A larger entry is none of ours.
_MOST_BYTES = 4_000_000_000


def cache_folder(subject: str, within: str | os.PathLike[str] | None = None) -> Path | None:
    """Folder of what is kept of a subject, such as "teeth", to read and to write; None where there is none to trust.

    It is made if need be: in a given folder, else ROTORGEAR_CACHE itself for all subjects, else in the user's cache folder.
    """
    place = _place(subject, within)
    if place is None:
        return None
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileExistsError):
            place.mkdir(_PRIVATE)
        if not _trusted(place, own=True):
            return None
        if place != _given():  # that is the user's own
            place.chmod(_PRIVATE)
        tempfile.TemporaryFile(dir=place).close()
    except (OSError, ValueError):
        return None
    return place


def readable_cache_folder(subject: str, within: str | os.PathLike[str] | None = None) -> Path | None:
    """The folder of a subject to read from: that of `cache_folder`, or one that only the package's owner can write to."""
    place = _place(subject, within)
    try:
        return place if place is not None and _trusted(place, own=False) else None
    except (OSError, ValueError):
        return None


def folder_of_version(subject: str, version: str, within: str | os.PathLike[str] | None = None) -> Path | None:
    """Folder of a version of a subject that is written and read by others' names; None where there is none to trust.

    Where one is warm and can only be read, a copy of it for this process alone.
    """
    parent = cache_folder(subject, within)
    try:
        if parent is None:
            warm = readable_cache_folder(subject, within)
            return _copy_of(warm / version) if warm is not None else None
        folder = parent / version
        folder.mkdir(_PRIVATE, exist_ok=True)
        os.utime(folder)
        # Those that have not been used for longest are removed.
        for old in sorted(parent.iterdir(), key=lambda each: each.stat().st_mtime)[:-MOST_VERSIONS]:
            shutil.rmtree(old, ignore_errors=True)
    except OSError:
        return None
    return folder


def _copy_of(warm: Path) -> Path | None:
    """A private copy of what is in a folder, without what others could have written; it goes away with the process."""
    if not _trusted(warm, own=False):
        return None
    private = Path(tempfile.mkdtemp(prefix="rotorgear-"))
    atexit.register(shutil.rmtree, private, ignore_errors=True)
    for folder, inner, names in os.walk(warm):
        place = private / Path(folder).relative_to(warm)
        place.mkdir(exist_ok=True)
        inner[:] = [name for name in inner if _trusted(Path(folder, name), own=False)]
        for name in names:
            if _trusted(Path(folder, name), own=False, kind=stat.S_ISREG):
                shutil.copy2(Path(folder, name), place / name)
    return private


def _place(subject: str, within: str | os.PathLike[str] | None) -> Path | None:
    if within:
        return Path(within) / subject
    if given := _given():
        return given
    try:
        from platformdirs import user_cache_path

        return user_cache_path("rotorgear", appauthor=False) / subject
    except Exception:  # a user without a home and without an entry in the list of users
        return None


def _given() -> Path | None:
    given = os.environ.get("ROTORGEAR_CACHE")
    return Path(given) if given else None


def _trusted(folder: Path, *, own: bool, kind: Callable[[int], bool] = stat.S_ISDIR) -> bool:
    """Whether a folder is no link, and only this user can write there, or, without `own`, the owner of the package."""
    found = folder.lstat()
    if not kind(found.st_mode):
        return False
    if not hasattr(os, "getuid"):  # Windows: a user's folders are the user's
        return True
    owners = {os.getuid()} | (set() if own else {_PACKAGE.stat().st_uid})
    return found.st_uid in owners and not found.st_mode & _OTHERS


def read_entry(subject: str, kind: str, key: str) -> dict[str, Any] | None:
    """Values of an entry: arrays, numbers and texts; None where the file is missing, damaged or of another key.

    Args:
        subject: folder, such as "teeth".
        kind: of the entry, such as "map".
        key: a text that tells all it depends on.
    """
    folder = readable_cache_folder(subject)
    if folder is None:
        return None
    try:
        values = read_arrays(folder / _name(kind, key), _MOST_BYTES)
        # The name is a hash only; the text of the key decides.
        if str(values.pop("key")) != key or str(values.pop("checksum")) != _checksum(key, values):
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


def write_entry(subject: str, kind: str, key: str, values: Mapping[str, Any]) -> None:
    """Write arrays, numbers, texts and tuples of texts under a name; None is left out. Other runs see all of it or nothing.

    A full disk or a folder that can't be written costs time only; arguments as of `read_entry`.
    """
    import numpy as np

    folder = cache_folder(subject)
    if folder is None:
        return
    given = {name: value for name, value in values.items() if value is not None}
    arrays = {name: np.asarray(value, str if isinstance(value, tuple) else None) for name, value in given.items()}
    labels = {"key": np.array(key), "checksum": np.array(_checksum(key, arrays))}
    path = folder / _name(kind, key)
    scratch = path.with_name(f".{path.stem}.{uuid.uuid4().hex}")
    store: Any = np.savez  # its stubs take names for options
    with suppress(OSError):
        try:
            with scratch.open("wb") as file:
                store(file, **arrays, **labels)
            os.replace(scratch, path)
        finally:
            scratch.unlink(missing_ok=True)


def _name(kind: str, key: str) -> str:
    return f"{kind}_{hashlib.sha256(key.encode()).hexdigest()[:32]}.npz"


def _checksum(key: str, values: Mapping[str, np.ndarray]) -> str:
    """SHA-256 over the key, and names, kinds of numbers, shapes and bytes of all values."""
    digest = hashlib.sha256(key.encode())
    for name in sorted(values):
        value = values[name]
        digest.update(f"\n{name!r} {value.dtype.str} {value.shape}\n".encode())
        digest.update(value.tobytes())
    return digest.hexdigest()
