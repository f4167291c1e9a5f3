"""A result in one HDF5 file, with its model, so that `read(save(result))` is the same result to the last bit.

Layout: the root's attributes say what it is; every field of the result is a dataset or a group of that name (hdf5_values.py).
"""

from __future__ import annotations

from contextlib import ExitStack
from inspect import signature
from pathlib import Path
from typing import Any

from rotorgear.errors import AnalysisError, ModelError, RotorgearError
from rotorgear.export.hdf5_values import digest_of, get_value, put_value, stored_fields
from rotorgear.files.bounds import RESULT
from rotorgear.files.hdf5 import new_hdf5, opened_hdf5
from rotorgear.files.read import UnreadableError
from rotorgear.results.kinds import kinds
from rotorgear.results.result import Result
from rotorgear.version import VERSION

FORMAT = "rotorgear result"
FORMAT_VERSION = 1


class ReadError(RotorgearError):
    """A file is no result that this rotorgear can read; the text says why."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path} can't be read: {reason}")


def save(result: Result, path: str | Path) -> Path:
    """Write a result to an HDF5 file and return its path.

    Args:
        result: of any verb.
        path: file to write; what is there is replaced when all is written.

    Returns:
        The path.

    Raises:
        WriteError: the file can't be written; what was there before stays. AnalysisError: it is no result.
    """
    if not isinstance(result, Result):
        raise AnalysisError(
            f"save keeps results of analyses, and got a {type(result).__name__}; model.to_toml writes a model"
        )
    with new_hdf5(path) as (h5, file):
        file.attrs.update(
            {"format": FORMAT, "format_version": FORMAT_VERSION, "kind": result.kind, "rotorgear_version": VERSION}
        )
        for item in stored_fields(type(result)):
            put_value(h5, file, item, getattr(result, item))
        file.attrs["sha256"] = digest_of(file)
    return Path(path)


def read(path: str | Path) -> Any:
    """Read a result from an HDF5 file.

    Args:
        path: of a file that `save` wrote.

    Returns:
        The result, equal to the one that was saved.

    Raises:
        ReadError: no such file, no HDF5, not written by rotorgear, written by a newer one, or changed or damaged.
    """
    path = Path(path)
    with ExitStack() as stack:
        try:
            file = stack.enter_context(opened_hdf5(path, RESULT.most_bytes))
        except UnreadableError as error:
            raise ReadError(path, error.reason) from None
        cls = _kind(path, file)
        try:
            digest = digest_of(file)
            # A field that came later has its default in an older file; the version stands in every file.
            old = {"rotorgear_version": str(file.attrs["rotorgear_version"])}
            names = stored_fields(cls)
            stored = {name: get_value(file[name]) for name in names if name in file}
            needed = [name for name, one in signature(cls).parameters.items() if one.default is one.empty]
            lacking = ", ".join(name for name in needed if name in names and name not in stored)
            if lacking:
                cause = f"it is damaged, or from a rotorgear that did not compute {lacking}; run the analysis again"
                raise ReadError(path, cause)
            result = cls(**old | stored)
        except ModelError as error:
            raise ReadError(path, f"its model does not pass the checks of rotorgear {VERSION}\n{error}") from None
        except (KeyError, ValueError, TypeError, AttributeError, OSError, RuntimeError) as error:
            raise ReadError(path, f"it is damaged ({error})") from None
        # Files of 0.1 have no digest.
        if file.attrs.get("sha256", digest) != digest:
            cause = "it is damaged: its values are not those that rotorgear wrote; run the analysis again"
            raise ReadError(path, cause)
        return result


def _kind(path: Path, file: Any) -> type[Any]:
    """Class of the result in a file; ReadError for a foreign or newer file."""
    if file.attrs.get("format") != FORMAT:
        raise ReadError(path, "it is no result of rotorgear")
    version = file.attrs.get("format_version")
    kind = file.attrs.get("kind")
    if version != FORMAT_VERSION or kind not in kinds():
        by = f"rotorgear {file.attrs.get('rotorgear_version', 'of another version')} in format {version} ({kind})"
        this = f"this is rotorgear {VERSION}, which reads format {FORMAT_VERSION}"
        raise ReadError(path, f"it was written by {by}, and {this}; use the newer one, or run the analysis again")
    return kinds()[kind]
