"""Archives of others, zip and NumPy's npz, unpacked up to a bound and no further.

What an archive says of itself need not be true: its list of files is counted before it is read, a file is read up to the size
that was said, and an array has the bytes that its header says, before memory is taken for it.
"""

from __future__ import annotations

import math
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from rotorgear.files.bounds import MOST_MEMBERS
from rotorgear.files.read import UnreadableError, opened, too_large

# Marks of an entry of the list of files, and the bytes of one at least.
_ENTRY = b"PK\x01\x02"
_LEAST_ENTRY = 46
_END = b"PK\x05\x06"
_LONGEST_END = 22 + 65_535
# Methods without a dictionary that the archive itself chooses the size of.
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
# What damaged archives raise, in zipfile and below.
_DAMAGED = (
    zipfile.BadZipFile,
    zlib.error,
    EOFError,
    NotImplementedError,
    RuntimeError,
    ValueError,
    OverflowError,
    MemoryError,
)
# Largest times that texts and numbers are packed by, but for small files: zeros alone come to a thousand.
_TIGHTEST = 100
_ANYWAY = 16_000_000
_PLAIN = "biufcUS"
_LONGEST_HEADER = 10_000


@contextmanager
def opened_zip(path: str | Path, most_bytes: int, kinds: tuple[str, ...] = ()) -> Iterator[zipfile.ZipFile]:
    """Open a named archive whose files are no larger together than a bound, packed by usual methods, and not too many.

    Raises:
        UnreadableError: as `opened`; no archive, a damaged one, one that is beyond its bounds.
    """
    with opened(path, most_bytes, kinds) as file:
        try:
            _refuse_many(path, file)
            with zipfile.ZipFile(file) as archive:
                members = archive.infolist()
                if len(members) > MOST_MEMBERS:
                    raise _many(path)
                if sum(item.file_size for item in members) > most_bytes:
                    raise UnreadableError(path, f"unpacked {too_large(most_bytes)}")
                packed = sum(item.compress_size for item in members)
                if sum(item.file_size for item in members) > _TIGHTEST * packed + _ANYWAY:
                    raise UnreadableError(path, f"it unpacks to more than {_TIGHTEST} times its size")
                if any(item.compress_type not in _METHODS for item in members):
                    raise UnreadableError(path, "the archive is packed by another method than deflate")
                yield archive
        except _DAMAGED as error:
            words = " ".join(str(error).split()) or "it is cut off"
            raise UnreadableError(path, f"the archive is damaged: {words}") from None


def _refuse_many(path: str | Path, file: IO[bytes]) -> None:
    """Refuse more entries than there may be, before an object is made of each."""
    size = file.seek(0, 2)
    file.seek(max(0, size - _LONGEST_END))
    tail = file.read()
    place = tail.rfind(_END)
    # Counted in the bytes of the list of files; the number that is written there holds 16 bits only.
    length = int.from_bytes(tail[place + 12 : place + 16], "little") if place >= 0 else 0
    if length > MOST_MEMBERS * 2000:
        raise _many(path)
    file.seek(max(0, size - len(tail) - length))
    if file.read().count(_ENTRY) > MOST_MEMBERS:
        raise _many(path)
    file.seek(0)


def _many(path: str | Path) -> UnreadableError:
    return UnreadableError(path, f"the archive holds more than {MOST_MEMBERS} files")


def read_arrays(path: str | Path, most_bytes: int) -> dict[str, Any]:
    """The arrays of a named npz, of numbers, truths and texts.

    Raises:
        UnreadableError: as `opened_zip`; an array of Python objects, or one that is larger than its place in the file.
    """
    with opened_zip(path, most_bytes) as archive:
        return {item.filename.removesuffix(".npy"): _array(archive, item, path) for item in archive.infolist()}


def _array(archive: zipfile.ZipFile, item: zipfile.ZipInfo, path: str | Path) -> Any:
    import numpy as np
    from numpy.lib import format as npy

    name = item.filename.removesuffix(".npy")
    with archive.open(item) as stream:
        try:
            version = npy.read_magic(stream)
            header = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}[version]
            shape, by_columns, dtype = header(stream, max_header_size=_LONGEST_HEADER)
        except Exception:  # a header is Python, and fails in as many ways
            raise UnreadableError(path, f"'{name}' has no header of an array") from None
        if dtype.kind not in _PLAIN or dtype.hasobject:
            raise UnreadableError(path, f"'{name}' holds no numbers or texts")
        count = math.prod(shape)
        left = item.file_size - stream.tell()
        if min(shape, default=0) < 0 or count * dtype.itemsize != left or (not dtype.itemsize and count > 1):
            raise UnreadableError(path, f"'{name}' says that it has {count:.3g} values, which {left} bytes do not hold")
        found = np.empty(count, dtype)
        view = memoryview(found.view(np.uint8).data) if left else memoryview(bytearray())
        got = 0
        while got < left:
            more = stream.readinto(view[got:])  # type: ignore[attr-defined]
            if not more:
                raise UnreadableError(path, f"'{name}' is cut off")
            got += more
        stream.read(1)  # the end, where the sum of the archive is compared
    return found.reshape(shape, order="F" if by_columns else "C")
