"""Files come into being whole: they are written under a temporary name beside their place and then moved there."""

from __future__ import annotations

import json
import os
import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from rotorgear.errors import RotorgearError


class WriteError(RotorgearError):
    """A file or folder can't be written; the text names it and says why."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path} can't be written: {reason}")


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Give a temporary path to write to; it takes the place of `path` when all went well, and is removed when not.

    What is no regular file, such as /dev/stdout, is given as it is.

    Raises:
        WriteError: there is no such folder, a folder stands in the way, no permission, no space.
    """
    target = Path(path)
    try:
        device = target.exists() and not target.is_file()
        target = target if device else target.resolve()
    except (OSError, RuntimeError) as error:  # too long a name, a loop of symbolic links
        raise WriteError(target, reason_of(error)) from None
    if target.is_dir():
        raise WriteError(target, "it is a folder; give the name of a file")
    if not device and not target.parent.is_dir():
        raise WriteError(target, f"there is no folder {target.parent}; make it first, or choose another")
    # In the same folder, so that the move is one of names within a file system: it happens whole or not at all.
    scratch = target if device else target.with_name(f".{target.name}.{uuid.uuid4().hex}")
    try:
        yield scratch
        if not device:
            os.replace(scratch, target)
    except OSError as error:
        raise WriteError(target, reason_of(error)) from None
    finally:
        if not device:
            with suppress(OSError):  # the name itself may be what the system refuses
                scratch.unlink()


@contextmanager
def filling(directory: str | Path) -> Iterator[Path]:
    """Give a temporary folder inside `directory`, made if need be, and remove it afterwards; move what is ready with `publish`.

    Raises:
        WriteError: a file stands in the way, no permission, no space.
    """
    target = Path(directory)
    scratch = target / f".{uuid.uuid4().hex}"
    try:
        scratch.mkdir(parents=True)
        yield scratch
    except (FileExistsError, NotADirectoryError):
        raise WriteError(target, "a file stands in the way; choose another folder") from None
    except OSError as error:
        raise WriteError(target, reason_of(error)) from None
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def publish(scratch: Path, directory: Path, names: list[str]) -> list[Path]:
    """Move files from a temporary folder to their places in `directory`, in this order; return where they are."""
    published = []
    for name in names:
        target = directory / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.is_dir():
            raise WriteError(target, "a folder of that name stands in the way")
        os.replace(scratch / name, target)
        published.append(target)
    return published


def reason_of(error: Exception) -> str:
    """What the system says, in lower case and without numbers; libraries below add their own innards, which help nobody."""
    number = getattr(error, "errno", None)
    text = os.strerror(number) if number else str(error).splitlines()[0]
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
    with replacing(path) as scratch:
        scratch.write_text(text + "\n", encoding="utf-8")
