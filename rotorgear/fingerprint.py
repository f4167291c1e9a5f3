"""A hash of sources: what is kept on disk between runs is named by the code that made it, so that it can't be served stale."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from rotorgear.files.own import bytes_of, text_of

PACKAGE = Path(__file__).resolve().parent
_IMPORT = re.compile(r"^\s*from rotorgear\.([\w.]+) import (\([^)]*\)|[^\n]+)", re.MULTILINE)


def imported_files(file: Path) -> set[Path]:
    """The files of this package that one of its files imports, at the top or inside a function."""
    found = set()
    for module, names in _IMPORT.findall(text_of(file)):
        place = PACKAGE / module.replace(".", "/")
        candidates = [place.with_suffix(".py")]
        candidates += [place / f"{name}.py" for name in re.findall(r"\w+", names)]
        found |= {candidate for candidate in candidates if candidate.is_file()}
    return found


def with_imports(files: Iterable[Path]) -> set[Path]:
    """The files, and all of this package that they import, directly or not."""
    waiting = list(files)
    found: set[Path] = set()
    while waiting:
        file = waiting.pop()
        if file not in found:
            found.add(file)
            waiting += imported_files(file)
    return found


def hash_of(files: Iterable[Path]) -> str:
    """16 digits of the SHA-256 over the files' places in the package and contents."""
    digest = hashlib.sha256()
    for file in sorted(files):
        digest.update(file.relative_to(PACKAGE).as_posix().encode())
        digest.update(bytes_of(file))
    return digest.hexdigest()[:16]


@cache
def fingerprint(*places: str) -> str:
    """Hash of files and folders of the package, such as "gears/tooth_fe", with all that they import."""
    files: list[Path] = []
    for place in places:
        path = PACKAGE / place
        files += path.rglob("*.py") if path.is_dir() else [path]
    return hash_of(with_imports(files))
