"""Reading files that somebody named: regular files of a bounded size, whatever stands behind their name.

A device or a pipe has no end, or waits for ever; it is refused by what it is, before it is opened.
"""

from __future__ import annotations

import io
import os
import stat
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from rotorgear.errors import RotorgearError

# Files that this run has read by their device and number, where somebody asked for that; `written` keeps off them. One for all
# threads: any of them may write.
_inputs: list[dict[tuple[int, int], Path]] = []
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)
_KINDS = (
    (stat.S_ISDIR, "it is a folder"),
    (stat.S_ISFIFO, "it is a pipe, which may have no end: write it to a file first"),
    (stat.S_ISCHR, "it is a device, which may have no end"),
    (stat.S_ISBLK, "it is a device"),
    (stat.S_ISSOCK, "it is a socket"),
)


class UnreadableError(RotorgearError):
    """A file that somebody named can't be read.

    Attributes:
        path: as it was named.
        reason: what stands behind "can't be read: ".
        missing: whether there is no such file.
    """

    def __init__(self, path: str | Path, reason: str, *, missing: bool = False) -> None:
        super().__init__(f"{path} can't be read: {reason}")
        self.path = Path(path)
        self.reason = reason
        self.missing = missing


@contextmanager
def noting_inputs() -> Iterator[dict[tuple[int, int], Path]]:
    """Within it every named file that is read is noted, and nothing is written onto one of them."""
    known: dict[tuple[int, int], Path] = {}
    _inputs.append(known)
    try:
        yield known
    finally:
        _inputs.remove(known)


@contextmanager
def noting_nothing() -> Iterator[None]:
    """Within it nothing is noted: for an editor, which writes the file that it has read."""
    kept = list(_inputs)
    _inputs.clear()
    try:
        yield
    finally:
        _inputs[:] = kept


def noted_inputs() -> dict[tuple[int, int], Path]:
    """The files that this run has read, by device and number."""
    return {key: path for known in _inputs for key, path in known.items()}


@contextmanager
def opened(path: str | Path, most_bytes: int, kinds: Collection[str] = ()) -> Iterator[IO[bytes]]:
    """Open a named file.

    Args:
        path: as somebody named it.
        most_bytes: a larger file is refused.
        kinds: endings that its name may have, in lower case with their point; none: any.

    Raises:
        UnreadableError: no such file, another ending, no regular file, too large, no permission.
    """
    name = Path(path)
    if kinds and name.suffix.lower() not in kinds:
        raise UnreadableError(name, f"its ending is none of {', '.join(sorted(kinds))}")
    try:
        _check(name, os.stat(name), most_bytes)
        # Whatever takes the place of the file in between does not make this wait.
        file = os.fdopen(os.open(name, _FLAGS), "rb")
    except (FileNotFoundError, NotADirectoryError):
        raise UnreadableError(name, "there is no such file", missing=True) from None
    except (OSError, ValueError) as error:
        raise UnreadableError(name, _words(error)) from None
    with file:
        found = os.fstat(file.fileno())
        _check(name, found, most_bytes)
        for noted in _inputs:
            noted[found.st_dev, found.st_ino] = name
        try:
            yield file
        except OSError as error:
            raise UnreadableError(name, _words(error)) from None


def named_file(path: str | Path, most_bytes: int, kinds: Collection[str] = ()) -> Path:
    """The path of a file that `opened` takes, for what reads by name; errors as there."""
    with opened(path, most_bytes, kinds):
        return Path(path)


def read_named(path: str | Path, most_bytes: int, kinds: Collection[str] = ()) -> bytes:
    """What a named file holds; arguments and errors as of `opened`."""
    with opened(path, most_bytes, kinds) as file:
        # What the system says of a size need not be true: files of /proc have none.
        data = file.read(most_bytes + 1) or b""
    if len(data) > most_bytes:
        raise UnreadableError(path, too_large(most_bytes))
    return data


def read_text(path: str | Path, most_bytes: int, kinds: Collection[str] = ()) -> str:
    """The text (UTF-8) of a named file; arguments and errors as of `opened`, and one for what is no such text."""
    data = read_named(path, most_bytes, kinds)
    try:
        # Some editors put a byte order mark in front. Ends of lines are those of any system.
        return data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        place = f"byte {error.object[error.start]:#04x} at position {error.start}"
        raise UnreadableError(path, f"not a text in UTF-8: {place}") from None


def text_lines(path: str | Path, most_bytes: int, kinds: Collection[str] = ()) -> Iterator[str]:
    """The lines of a named file in which the words count are ASCII; arguments and errors as of `opened`."""
    with opened(path, most_bytes, kinds) as file:
        lines = io.TextIOWrapper(file, encoding="utf-8", errors="replace")
        try:
            yield from lines
        finally:
            with suppress(ValueError):  # a generator that was left in the middle may find it closed
                lines.detach()


def digest_of_named(path: str | Path, most_bytes: int) -> str:
    """SHA-256 of what a named file holds; errors as of `opened`."""
    import hashlib  # here: help needs none

    with opened(path, most_bytes) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()  # type: ignore[arg-type]


def too_large(most_bytes: int) -> str:
    """The sentence on a file that is larger than a bound."""
    return f"it is larger than {most_bytes / 1e6:,.0f} MB"


def _check(name: Path, found: os.stat_result, most_bytes: int) -> None:
    reason = next((words for is_one, words in _KINDS if is_one(found.st_mode)), "")
    if reason or not stat.S_ISREG(found.st_mode):
        raise UnreadableError(name, reason or "it is no regular file")
    if found.st_size > most_bytes:
        raise UnreadableError(name, too_large(most_bytes))


def _words(error: Exception) -> str:
    """What the system says, in lower case."""
    text = (error.strerror if isinstance(error, OSError) else None) or str(error)
    return text[:1].lower() + text[1:]
