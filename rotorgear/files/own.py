"""Files of this package and of the system, which nobody sends."""

from __future__ import annotations

import os
from typing import TextIO


def text_of(path: str | os.PathLike[str], encoding: str = "utf-8") -> str:
    """The text of a file of the package or of the system."""
    with open(path, encoding=encoding) as file:
        return file.read()


def bytes_of(path: str | os.PathLike[str]) -> bytes:
    """The bytes of a file of the package."""
    with open(path, "rb") as file:
        return file.read()


def nowhere() -> TextIO:
    """A text file that takes anything and keeps nothing."""
    return open(os.devnull, "w", encoding="utf-8")
