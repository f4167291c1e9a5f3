"""HDF5 files: new ones, written whole, and those of others, from which nothing leads out.

A link may name an object of another file, and a data set may be kept as bytes in any file of the machine: who reads such a file
reads those. An object that two names lead to would be read as often as there are ways to it, which doubles with every level.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rotorgear.errors import MissingExtraError
from rotorgear.files.read import UnreadableError, named_file
from rotorgear.files.write import written

if TYPE_CHECKING:
    from types import ModuleType


def import_h5py() -> ModuleType:
    """Return h5py.

    Raises:
        MissingExtraError: it is not installed.
    """
    try:
        import h5py
    except ImportError:
        raise MissingExtraError("Saving and reading results", "h5py", "all") from None
    return h5py


@contextmanager
def new_hdf5(path: str | Path) -> Iterator[tuple[ModuleType, Any]]:
    """Give h5py and a new file of it, which takes its place when all went well.

    The file is made in memory and then written as bytes: on a full disk h5py leaves objects behind that it can't close, which
    print their innards and end Python with a crash.

    Raises:
        WriteError: the file can't be written.
    """
    h5 = import_h5py()
    with written(path) as scratch, h5.File(scratch, "w", driver="core", backing_store=False) as file:
        yield h5, file
        file.flush()
        scratch.write_bytes(file.id.get_file_image())


@contextmanager
def opened_hdf5(path: str | Path, most_bytes: int, *, packed: int = 1) -> Iterator[Any]:
    """Open a named HDF5 file from which nothing leads out.

    Args:
        path, most_bytes: as of `rotorgear.files.read.opened`.
        packed: how many times as large as the file its data may be together.

    Raises:
        UnreadableError: as `rotorgear.files.read.opened`; no HDF5 file; one with such links or such data.
    """
    h5 = import_h5py()
    name = named_file(path, most_bytes)
    try:
        file = h5.File(name, "r")
    except (OSError, RuntimeError, ValueError):
        raise UnreadableError(path, "it is no HDF5 file, or damaged") from None
    with file:
        try:
            _refuse_ways_out(h5, file, name, packed)
        except (OSError, RuntimeError, ValueError, KeyError) as error:
            raise UnreadableError(path, f"it is damaged ({error})") from None
        yield file


def _refuse_ways_out(h5: ModuleType, file: Any, path: Path, packed: int) -> None:
    left = packed * file.id.get_filesize()
    waiting = [file]
    while waiting:
        group = waiting.pop()
        for name in group:
            where = f"{group.name.rstrip('/')}/{name}"
            if not isinstance(group.get(name, getlink=True), h5.HardLink):
                raise UnreadableError(path, f"'{where}' is a link to another place")
            item = group[name]
            if h5.h5o.get_info(item.id).rc != 1:
                raise UnreadableError(path, f"two names lead to '{where}'")
            if isinstance(item, h5.Group):
                waiting.append(item)
            elif isinstance(item, h5.Dataset):
                if item.external or item.is_virtual:
                    raise UnreadableError(path, f"'{where}' is kept in another file")
                left -= item.nbytes if item.shape is not None else 0
                if left < 0:
                    much = f"{item.size:.3g} values, more than the file has bytes"
                    raise UnreadableError(path, f"{where.lstrip('/')} says that it has {much}")
