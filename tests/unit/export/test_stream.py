"""A streamed run can be stopped anywhere and goes on to the same histories."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import RotorgearError
from rotorgear.export.stream import read_chunk
from rotorgear.files.write import WriteError
from rotorgear.model.model import model_hash
from tests.models import spur_pair
from tests.paths import ROOT

SETTINGS: dict[str, Any] = {"time": 0.1, "discard": 0.02, "steps": 160, "error_estimate": False}


class _StopError(Exception):
    pass


def stopped(path: Path, after: int, method: str) -> None:
    """Run until so many chunks are written, then break off as a crash would."""
    stream = rg.stream(path)
    keep = stream.write
    written = []

    def write(chunk: dict[str, np.ndarray]) -> None:
        keep(chunk)
        written.append(1)
        if len(written) == after:
            raise _StopError

    stream.write = write  # type: ignore[method-assign]
    with pytest.raises(_StopError):
        rg.transient(spur_pair(meshes__pair__backlash="20 um"), **SETTINGS, method=method, stream=stream)


@pytest.mark.parametrize(
    "method", ["newmark", "hht", "generalised-alpha", "exponential", pytest.param("explicit", marks=pytest.mark.long)]
)
def test_a_run_that_was_broken_off_goes_on_to_the_same_histories(tmp_path: Path, method: str) -> None:
    model = spur_pair(meshes__pair__backlash="20 um")
    whole = rg.transient(model, **SETTINGS, method=method)
    stopped(tmp_path / "run.h5", 3, method)
    assert len(list((tmp_path / "run.h5.parts").glob("chunk_*.h5"))) == 3
    rest = rg.transient(model, **SETTINGS, method=method, stream=rg.stream(tmp_path / "run.h5", resume=True))
    for field in fields(whole):
        if field.name not in ("seconds", "energy", "model", "left_out", "warnings"):
            np.testing.assert_array_equal(getattr(rest, field.name), getattr(whole, field.name), field.name)
    for name, column in vars(whole.energy).items():
        np.testing.assert_array_equal(getattr(rest.energy, name), column, name)


def test_another_run_is_not_continued(tmp_path: Path) -> None:
    stopped(tmp_path / "run.h5", 1, "newmark")
    with pytest.raises(RotorgearError, match="another model or other settings"):
        rg.transient(spur_pair(), **SETTINGS, method="newmark", stream=rg.stream(tmp_path / "run.h5", resume=True))


@pytest.mark.parametrize("name", ["rotorgear", "rotorgear with the source", "numpy"])
def test_a_run_is_not_continued_by_another_program(tmp_path: Path, name: str) -> None:
    stopped(tmp_path / "run.h5", 1, "newmark")
    note = tmp_path / "run.h5.parts" / "settings.json"
    kept = json.loads(note.read_text())
    kept["program"][name] = "0.0"
    note.write_text(json.dumps(kept))
    with pytest.raises(
        RotorgearError, match=f"was computed with {name} 0.0, and here is .*: go on with that one, or start"
    ):
        rg.transient(
            spur_pair(meshes__pair__backlash="20 um"),
            **SETTINGS,
            method="newmark",
            stream=rg.stream(tmp_path / "run.h5", resume=True),
        )


def test_a_run_is_marked_with_the_hash_of_its_model(tmp_path: Path) -> None:
    stopped(tmp_path / "run.h5", 1, "newmark")
    kept = json.loads((tmp_path / "run.h5.parts" / "settings.json").read_text())
    name = model_hash(spur_pair(meshes__pair__backlash="20 um"))
    assert kept["run"]["model"] == hashlib.sha256(name.encode()).hexdigest()


def test_a_full_disk_ends_the_run_with_a_sentence_and_keeps_the_chunks_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import h5py

    real = h5py.File
    opened = []

    def full(name: Any, mode: str = "r", **options: Any) -> Any:
        if mode == "w":
            opened.append(name)
            if len(opened) == 3:
                raise OSError(errno.ENOSPC, "No space left on device")
        return real(name, mode, **options)

    monkeypatch.setattr(h5py, "File", full)
    with pytest.raises(WriteError, match="space"):
        rg.transient(spur_pair(), **SETTINGS, method="newmark", stream=rg.stream(tmp_path / "run.h5"))
    chunks = sorted((tmp_path / "run.h5.parts").glob("*"))
    assert [chunk.name for chunk in chunks] == ["chunk_000001.h5", "chunk_000002.h5", "settings.json"]
    assert all(np.all(np.isfinite(read_chunk(chunk)["F"])) for chunk in chunks[:2])


def test_what_kill_leaves_is_readable_and_goes_on(tmp_path: Path) -> None:

    program = (
        "import rotorgear as rg\nfrom tests.models import spur_pair\n"
        f"rg.transient(spur_pair(), time=20.0, discard=0.0, steps=160, error_estimate=False, method='newmark', "
        f"stream=rg.stream({str(tmp_path / 'run.h5')!r}))\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    process = subprocess.Popen([sys.executable, "-c", program], env=environment, cwd=ROOT)
    parts = tmp_path / "run.h5.parts"
    until = time.monotonic() + 60.0
    while len(list(parts.glob("chunk_*.h5"))) < 3 and time.monotonic() < until:
        time.sleep(0.05)
    process.send_signal(signal.SIGKILL)
    process.wait()
    chunks = [read_chunk(path) for path in sorted(parts.glob("chunk_*.h5"))]
    assert len(chunks) >= 3
    t = np.concatenate([chunk["t"] for chunk in chunks])
    assert np.allclose(np.diff(t), t[1] - t[0])
    assert all(np.all(np.isfinite(chunk["F"])) for chunk in chunks)


def test_an_interrupted_run_returns_what_it_has_and_says_so() -> None:
    calls = []

    def progress(fraction: float, text: str) -> None:
        calls.append(fraction)
        if len(calls) == 3:
            raise KeyboardInterrupt

    result = rg.transient(spur_pair(), **SETTINGS, method="newmark", progress=progress)
    assert result.status.startswith("interrupted after")
    assert 0 < len(result.time) < 3000
    assert any("ended early" in note for note in result.warnings)


# --- chunks know where they belong ---------------------------------------------------------------------------


def three_chunks(path: Path, model: str = "a") -> Path:
    stream = rg.stream(path)
    stream.begin({"model": model})
    for k in (1.0, 2.0, 3.0):
        stream.write({"value": np.array([k])})
    return stream.folder


def swap(folder: Path, other: Path) -> None:
    first, second = (folder / f"chunk_00000{k}.h5" for k in (1, 2))
    first.rename(folder / "t")
    second.rename(first)
    (folder / "t").rename(second)


def repeat(folder: Path, other: Path) -> None:
    shutil.copy(folder / "chunk_000001.h5", folder / "chunk_000002.h5")


def take_anothers(folder: Path, other: Path) -> None:
    shutil.copy(other / "chunk_000002.h5", folder / "chunk_000002.h5")


def renumber(folder: Path, other: Path) -> None:
    with h5py.File(folder / "chunk_000002.h5", "r+") as file:
        file.attrs["number"] = 1
    swap(folder, other)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (swap, r"chunk_000001\.h5 is chunk 2 of the run under another name: remove it"),
        (repeat, r"chunk_000002\.h5 is chunk 1 of the run under another name: remove it"),
        (take_anothers, r"chunk_000002\.h5 is of another run: remove it"),
        (renumber, r"chunk_000001\.h5 is damaged: remove it"),
    ],
)
def test_a_chunk_in_the_place_of_another_is_not_read(
    tmp_path: Path, change: Callable[[Path, Path], None], sentence: str
) -> None:
    folder = three_chunks(tmp_path / "x.h5")
    found = rg.stream(tmp_path / "x.h5", resume=True).begin({"model": "a"})
    assert [chunk["value"][0] for chunk in found] == [1.0, 2.0, 3.0]
    change(folder, three_chunks(tmp_path / "y.h5", "b"))
    with pytest.raises(RotorgearError, match=sentence):
        rg.stream(tmp_path / "x.h5", resume=True).begin({"model": "a"})


def test_only_files_of_a_run_are_removed_from_its_folder(tmp_path: Path) -> None:
    folder = three_chunks(tmp_path / "x.h5")
    (folder / f".chunk_000004.h5.{'0' * 32}").write_text("what a kill left")
    for name in ("thesis.txt", "chunk_1.h5", "my settings.json"):
        (folder / name).write_text("mine")
    again = rg.stream(tmp_path / "x.h5")
    again.begin({"model": "a"})
    mine = ["chunk_1.h5", "my settings.json", "thesis.txt"]
    assert sorted(path.name for path in folder.iterdir()) == [*mine[:2], "settings.json", mine[2]]
    again.write({"value": np.array([9.0])})
    again.close()
    assert sorted(path.name for path in folder.iterdir()) == mine
    three_chunks(tmp_path / "z.h5")
    rg.stream(tmp_path / "z.h5").close()
    assert not (tmp_path / "z.h5.parts").exists()
