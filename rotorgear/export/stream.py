"""Chunks of a long run in files of their own beside the result: each is written under a temporary name and then moved, so that
whatever stops the process, even kill -9, leaves all chunks before whole.

`run.h5.parts/` holds settings.json and chunk_000001.h5 ...; they go away when the result itself is saved, and nothing else that
lies there. Each chunk says which one it is and of which run: one that was moved, or comes from another run, is not read.
"""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path
from typing import Any

from rotorgear.analysis.sweep.cluster import versions
from rotorgear.errors import RotorgearError
from rotorgear.export.hdf5_values import digest_of, get_value, put_value
from rotorgear.files.bounds import MODEL, RESULT
from rotorgear.files.hdf5 import new_hdf5, opened_hdf5
from rotorgear.files.read import UnreadableError, read_text
from rotorgear.files.write import WriteError, reason_of, remove_files, written

_NOTE = "settings.json"
# Files of a run, those too that a kill left under their temporary name.
_OWN = re.compile(r"settings\.json|chunk_[0-9]{6}\.h5|\.(?:settings\.json|chunk_[0-9]{6}\.h5)\.[0-9a-f]{32}")


class ChunkStream:
    """Keeps chunks in a folder beside the file that the result will be saved to."""

    def __init__(self, path: str | Path, *, resume: bool = False) -> None:
        self.path = Path(path)
        self.folder = Path(f"{path}.parts")
        self._resume = resume
        self._count = 0
        self._run = ""

    def begin(self, settings: dict[str, str]) -> list[dict[str, Any]]:
        """Make the folder, or read the chunks of the same run that are there.

        Raises:
            RotorgearError: chunks of another run are there, or of another rotorgear.
            WriteError: the folder can't be made, or the result would go to the name of a folder.
        """
        if self.path.is_dir():
            raise WriteError(self.path, "it is a folder; give the name of a file")
        # Digests of the settings are enough to recognise another run. Versions of programs are written in full: a history whose
        # halves come from two versions belongs to neither.
        run = {name: hashlib.sha256(text.encode()).hexdigest() for name, text in settings.items()}
        mark = {"program": versions(), "run": run}
        self._run = hashlib.sha256(json.dumps(mark, sort_keys=True).encode()).hexdigest()
        note = self.folder / _NOTE
        if self._resume and (note.exists() or any(self.folder.glob("chunk_*.h5"))):
            try:
                there = json.loads(read_text(note, MODEL.most_bytes))
                there = {"program": dict(there["program"]), "run": dict(there["run"])}
            except (UnreadableError, RecursionError, ValueError, KeyError, TypeError):
                raise RotorgearError(f"{note} is damaged: start without resume") from None
            for name, own in versions().items():
                other = there["program"].get(name, "unknown")
                if other != own:
                    raise RotorgearError(
                        f"{self.folder} was computed with {name} {other}, and here is {own}: go on with that one, or start "
                        "without resume"
                    )
            if there["run"] != run:
                raise RotorgearError(
                    f"{self.folder} holds a run with another model or other settings; repeat those, or start without resume"
                )
            return self._read()
        self._remove()
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise WriteError(self.folder, reason_of(error)) from None
        with written(note) as scratch:
            scratch.write_text(json.dumps(mark), encoding="utf-8")
        return []

    def write(self, chunk: dict[str, Any]) -> None:
        """Write a chunk, of values that results may have, to a file of its own.

        Raises:
            WriteError: no space, no permission.
        """
        with new_hdf5(self.folder / _chunk_name(self._count + 1)) as (h5, file):
            for name, value in chunk.items():
                put_value(h5, file, name, value)
            file.attrs.update({"run": self._run, "number": self._count + 1})
            file.attrs["sha256"] = _digest(file)
        self._count += 1

    def _read(self) -> list[dict[str, Any]]:
        """The chunks from the first to the last; RotorgearError where one in between is missing: time would jump."""
        names = sorted(path.name for path in self.folder.glob("chunk_*.h5"))
        for number, name in enumerate(names, start=1):
            if name != _chunk_name(number):
                raise RotorgearError(
                    f"{self.folder} has no {_chunk_name(number)}, but later ones: remove those to go on from there, or start "
                    "without resume"
                )
        self._count = len(names)
        return [read_chunk(self.folder / name, self._run, number) for number, name in enumerate(names, 1)]

    def close(self) -> None:
        """Take the chunks away: the result is saved elsewhere."""
        self._remove()

    def _remove(self) -> None:
        """Remove what a run wrote, whole or not, and the folder where nothing else is in it."""
        if self.folder.is_dir() and not self.folder.is_symlink():
            remove_files(self.folder, [path.name for path in self.folder.iterdir() if _OWN.fullmatch(path.name)])


def read_chunk(path: Path, run: str = "", number: int = 0) -> dict[str, Any]:
    """Read one chunk.

    Args:
        path: of its file.
        run: the mark of the run that it belongs to; "": of any.
        number: which chunk of the run it is, from 1; 0: any.

    Raises:
        RotorgearError: it is cut off, its values are not those that were written, or it is another one.
    """
    other = ""
    try:
        with opened_hdf5(path, RESULT.most_bytes) as file:
            whole = file.attrs["sha256"] == _digest(file)
            if whole and run and file.attrs["run"] != run:
                other = "is of another run"
            elif whole and number and file.attrs["number"] != number:
                other = f"is chunk {file.attrs['number']} of the run under another name"
            chunk = {name: get_value(file[name]) for name in file} if whole else {}
    except (UnreadableError, OSError, KeyError, ValueError, TypeError, RuntimeError):
        whole = False
    if not whole or other:
        remedy = "remove it and all chunks after it to go on from there, or start without resume"
        raise RotorgearError(f"{path} {other or 'is damaged'}: {remedy}")
    return chunk


def _digest(file: Any) -> str:
    """SHA-256 over the run, the number and all values of a chunk."""
    return hashlib.sha256(f"{file.attrs['run']} {file.attrs['number']} {digest_of(file)}".encode()).hexdigest()


def _chunk_name(number: int) -> str:
    return f"chunk_{number:06d}.h5"


def stream(path: str | Path, *, resume: bool = False) -> ChunkStream:
    """Return where a long run keeps its chunks; with `resume` an interrupted run of the same settings goes on.

    Args:
        path: of the result; the chunks stand in a folder beside it.
        resume: whether to go on with an interrupted run.

    Returns:
        What analyses take as `stream`.
    """
    return ChunkStream(path, resume=resume)
