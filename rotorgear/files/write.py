"""Files come into being whole: they are written under a temporary name beside their place and then moved there.

What a run has read it does not write over; a file that is there keeps its mode, and one that is read-only stays.
"""

from __future__ import annotations

import json
import os
import shutil
import stat
import tempfile
import uuid
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from rotorgear.errors import RotorgearError
from rotorgear.files.read import noted_inputs


class WriteError(RotorgearError):
    """A file or folder can't be written; the text names it and says why."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path} can't be written: {reason}")


@contextmanager
def written(path: str | Path, inputs: Iterable[str | Path] = ()) -> Iterator[Path]:
    """Give a temporary path to write to; it takes the place of `path` when all went well, and is removed when not.

    What is no regular file, such as /dev/stdout, is given as it is.

    Args:
        path: of the file.
        inputs: files that it must not be, beside those that `noting_inputs` knows.

    Raises:
        WriteError: there is no such folder, a folder stands in the way, it is an input or read-only, no permission, no space.
    """
    target, device = _target(Path(path), inputs)
    # In the same folder, so that the move is one of names within a file system: it happens whole or not at all.
    scratch = target if device else target.with_name(f".{target.name}.{uuid.uuid4().hex}")
    try:
        if not device:
            _like(target, scratch)
        yield scratch
        if not device:
            os.replace(scratch, target)
    except OSError as error:
        raise WriteError(target, reason_of(error)) from None
    finally:
        if not device:
            with suppress(OSError):  # the name itself may be what the system refuses
                scratch.unlink()


def check_output(path: str | Path, *, folder: bool = False) -> None:
    """Find out, before anything is computed, whether a file or folder can be written; nothing is left behind.

    Raises:
        WriteError: as `written` and `filling` would.
    """
    target = Path(path)
    if folder:
        above = target
        while not above.exists() and above != above.parent:
            above = above.parent
        if not above.is_dir():
            raise WriteError(target, "a file stands in the way; choose another folder")
    else:
        target, device = _target(target, ())
        if device:
            return
        above = target.parent
    try:
        tempfile.TemporaryFile(dir=above).close()
    except OSError as error:
        raise WriteError(target, reason_of(error)) from None


def _target(path: Path, inputs: Iterable[str | Path]) -> tuple[Path, bool]:
    """The file that a name stands for, and whether it is a device; WriteError where it must not be written."""
    try:
        device = path.exists() and not path.is_file()
        target = path if device else path.resolve()
        there = target.stat() if target.exists() else None
    except (OSError, RuntimeError, ValueError) as error:  # too long a name, a loop of symbolic links
        raise WriteError(path, reason_of(error)) from None
    if target.is_dir():
        raise WriteError(target, "it is a folder; give the name of a file")
    if not device and not target.parent.is_dir():
        raise WriteError(target, f"there is no folder {target.parent}; make it first, or choose another")
    if there is not None and not device:
        known = noted_inputs()
        if (there.st_dev, there.st_ino) in known or any(_same(target, one) for one in inputs):
            raise WriteError(target, "this run reads it; give another name")
        if not there.st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH):
            raise WriteError(target, "it is read-only; make it writable (chmod u+w), or give another name")
    return target, device


def _same(target: Path, other: str | Path) -> bool:
    with suppress(OSError, ValueError):
        return os.path.samefile(target, other)
    return False


def _like(target: Path, scratch: Path) -> None:
    """Make the temporary file with mode and owner of the one that it will replace, if that is there: nobody else sees more."""
    if not target.exists():
        return
    there = target.stat()
    os.close(os.open(scratch, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))
    if hasattr(os, "chown"):
        with suppress(OSError):  # that needs the right to give files away
            os.chown(scratch, there.st_uid, there.st_gid)
    os.chmod(scratch, stat.S_IMODE(there.st_mode) & 0o777)


@contextmanager
def filling(directory: str | Path) -> Iterator[Path]:
    """Give a temporary folder inside `directory`, made if need be, and remove it afterwards; move what is ready with `publish`.

    Where nothing was moved, folders that were made for it go away again.

    Raises:
        WriteError: a file stands in the way, no permission, no space.
    """
    target = Path(directory)
    scratch = target / f".{uuid.uuid4().hex}"
    made: list[Path] = []
    try:
        made = [one for one in (target, *target.parents) if not one.exists()]
        scratch.mkdir(parents=True)
        yield scratch
    except (FileExistsError, NotADirectoryError):
        raise WriteError(target, "a file stands in the way; choose another folder") from None
    except (OSError, ValueError) as error:
        raise WriteError(target, reason_of(error)) from None
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
        for one in made:
            with suppress(OSError):  # it is not empty
                one.rmdir()


def publish(scratch: Path, directory: Path, names: list[str]) -> list[Path]:
    """Move files from a temporary folder to their places in `directory`, in this order; return where they are.

    Raises:
        WriteError: a folder of one of the names, an input or a read-only file stands in the way; then none was moved.
    """
    targets = [directory / name for name in names]
    for target in targets:
        if target.is_dir():
            raise WriteError(target, "a folder of that name stands in the way")
        if target.exists():
            _target(target, ())
    for name, target in zip(names, targets, strict=True):
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(scratch / name, target)
    return targets


def remove_files(folder: Path, names: Iterable[str]) -> None:
    """Remove files of these names from a folder, and the folder itself where nothing else is in it."""
    for name in names:
        with suppress(OSError):
            (folder / name).unlink()
    with suppress(OSError):
        folder.rmdir()


def reason_of(error: Exception) -> str:
    """What the system says, in lower case and without numbers; libraries below add their own innards, which help nobody."""
    number = getattr(error, "errno", None)
    text = os.strerror(number) if number else (str(error).splitlines() or [type(error).__name__])[0]
    return text[:1].lower() + text[1:]


def write_json(data: dict[str, Any], path: str | Path) -> None:
    """Write plain values to a JSON file.

    Raises:
        RotorgearError: a value is not finite or no plain one; the file can't be written (WriteError).
    """
    try:
        text = json.dumps(data, indent=1, allow_nan=False, ensure_ascii=False)
    except (ValueError, TypeError) as error:
        raise RotorgearError(f"{path} can't be written as JSON: {error}") from None
    with written(path) as scratch:
        scratch.write_text(text + "\n", encoding="utf-8", errors="backslashreplace")
