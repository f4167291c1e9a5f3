"""Maps, studies and pages that were broken off go on with what they kept, and end with the same numbers."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from rotorgear.errors import RotorgearError
from rotorgear.export.stream import ChunkStream
from tests.models import pair_file
from tests.overhung import overhung_disk
from tests.paths import ROOT

PREVIEW = 'stiffness = "tooth_fe"\ntooth_fe = { preset = "preview" }'


class _StopError(Exception):
    pass


class Counted(ChunkStream):
    """A stream that counts the pieces that are worked on, and breaks off after some as a crash would."""

    def __init__(self, path: Path, *, resume: bool = False, most: int = 10**9) -> None:
        super().__init__(path, resume=resume)
        self.most = most
        self.worked = 0
        self.chunks: list[dict[str, Any]] = []

    def write(self, chunk: dict[str, Any]) -> None:
        super().write(chunk)
        self.chunks.append(chunk)
        self.worked += 1
        if self.worked == self.most:
            raise _StopError


def broken_off_and_resumed(run: Callable[[ChunkStream], Any], path: Path, after: int, all_pieces: int) -> Any:
    """The result of a run that is broken off after some of its pieces and goes on; it works on the rest alone."""
    with pytest.raises(_StopError):
        run(Counted(path, most=after))
    rest = Counted(path, resume=True)
    result = run(rest)
    assert rest.worked == all_pieces - after
    rest.close()
    assert not rest.folder.exists()
    return result


def test_a_map_goes_on_at_the_next_point(tmp_path: Path) -> None:
    model = rg.loads(pair_file(mesh=PREVIEW))
    asked: dict[str, Any] = {"over": {"torque": [300.0, 800.0], "misalignment": [0.0, 15e-6]}, "positions": 8}
    whole = rg.mesh_map(model, **asked)

    def run(stream: ChunkStream) -> rg.MeshMap:
        return rg.mesh_map(model, stream=stream, **asked)

    again = broken_off_and_resumed(run, tmp_path / "map.h5", after=3, all_pieces=4)
    for field in fields(whole):
        if field.name != "seconds":
            assert np.array_equal(getattr(whole, field.name), getattr(again, field.name)), field.name
    with pytest.raises(_StopError):
        run(Counted(tmp_path / "map.h5", most=1))
    with pytest.raises(RotorgearError, match="another model or other settings"):
        rg.mesh_map(model, stream=rg.stream(tmp_path / "map.h5", resume=True), **{**asked, "positions": 9})


def test_a_study_keeps_its_rows_with_their_times(tmp_path: Path) -> None:
    path = tmp_path / "study.h5"
    first = Counted(path, most=2)
    with pytest.raises(_StopError):
        rg.accuracy(overhung_disk(), "static", stream=first)
    rest = Counted(path, resume=True)
    study = rg.accuracy(overhung_disk(), "static", stream=rest)
    assert isinstance(study, rg.ConvergenceStudy)
    assert rest.worked == len(study.rungs) - 2
    assert list(study.rungs[:2]) == [chunk["rung"] for chunk in first.chunks]
    with pytest.raises(RotorgearError, match="another model or other settings"):
        rg.accuracy(overhung_disk(), "modal", stream=rg.stream(path, resume=True))


def without_speed() -> str:
    """A model whose page has few sections."""
    text = (ROOT / "models" / "jeffcott.toml").read_text(encoding="utf-8")
    return re.sub(r"\[operation\].*?(?=\n\[)", "", text, flags=re.DOTALL)


def test_a_page_keeps_its_sections(tmp_path: Path) -> None:
    model = rg.loads(without_speed())

    def run(stream: ChunkStream) -> dict[str, Any]:
        return rg.report(model, tmp_path / "page.html", stream=stream).to_dict()

    every = Counted(tmp_path / "whole.html")
    whole = run(every)
    again = broken_off_and_resumed(run, tmp_path / "page.html", after=2, all_pieces=every.worked)
    assert every.worked >= 3
    for name in ("missing", "largest_error_estimate", "settings", "model_hash"):
        assert json.dumps(again[name]) == json.dumps(whole[name])
    assert _numbers(again["results"]) == _numbers(whole["results"])


def _numbers(value: Any) -> Any:
    """Without times, which differ from run to run."""
    if isinstance(value, dict):
        return {
            key: _numbers(entry) for key, entry in value.items() if "seconds" not in key and key != "largest_memory"
        }
    return [_numbers(entry) for entry in value] if isinstance(value, list | tuple) else repr(value)


def test_the_command_keeps_sections_beside_the_page_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = tmp_path / "page.html"
    (tmp_path / "rotor.toml").write_text(without_speed(), encoding="utf-8")
    arguments = ["report", str(tmp_path / "rotor.toml"), "-o", str(page)]
    write = ChunkStream.write

    def stop(self: ChunkStream, chunk: dict[str, Any]) -> None:
        write(self, chunk)
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(ChunkStream, "write", stop)
        done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 130
    assert f"the blocks that were done are kept in {page}.parts: go on with --resume" in done.stderr
    assert not page.exists()
    done = CliRunner().invoke(app, [*arguments, "--resume"])
    assert done.exit_code == 0, done.output
    assert sorted(path.name for path in tmp_path.iterdir()) == ["page.html", "rotor.toml"]
