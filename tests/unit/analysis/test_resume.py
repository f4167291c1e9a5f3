"""Maps, studies and pages that were broken off go on with what they kept, and end with the same numbers."""

from __future__ import annotations

import json
import pickle
import re
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from rotorgear.errors import RotorgearError
from rotorgear.export.stream import ChunkStream
from tests.models import pair_file, spur_pair
from tests.overhung import overhung_disk
from tests.paths import ROOT
from validation.studies.dead_zone import DeadZone

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


class Elsewhere:
    """An executor that takes what it is handed, and gives what it did, as another process would."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Future[Any]:
        own, given = pickle.loads(pickle.dumps((function, arguments)))
        done: Future[Any] = Future()
        done.set_result(pickle.loads(pickle.dumps(own(*given))))
        return done


def test_a_map_goes_on_at_the_next_point_even_elsewhere(tmp_path: Path) -> None:
    model = rg.loads(pair_file(mesh=PREVIEW))
    asked: dict[str, Any] = {"over": {"torque": [300.0, 800.0], "misalignment": [0.0, 15e-6]}, "positions": 8}
    whole = rg.mesh_map(model, **asked)

    def run(stream: ChunkStream) -> rg.MeshMap:
        return rg.mesh_map(model, executor=Elsewhere(), stream=stream, **asked)

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


def differences(a: Any, b: Any, where: str = "") -> list[str]:
    """Where two results differ in any bit of what is no time."""
    if is_dataclass(a):
        names = [field.name for field in fields(a) if field.name not in ("seconds", "cpu_per_point")]
        return [text for name in names for text in differences(getattr(a, name), getattr(b, name), f"{where}.{name}")]
    if isinstance(a, tuple) and len(a) == len(b):
        pairs = enumerate(zip(a, b, strict=True))
        return [text for i, (own, other) in pairs for text in differences(own, other, f"{where}[{i}]")]
    if isinstance(a, dict) and list(a) == list(b):
        return [text for key in a for text in differences(a[key], b[key], f"{where}[{key}]")]
    if isinstance(a, np.ndarray):
        same = a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    else:
        same = type(a) is type(b) and repr(a) == repr(b)
    return [] if same else [where]


def pair_over_speed(stream: ChunkStream | None) -> rg.OrbitsResult:
    """Branches of shafts and a mesh, by harmonic balance with few exact solutions."""
    model = spur_pair()
    ends = [157.0, 163.0]
    return rg.orbits(model, {"operation.speed": ends}, harmonics=3, step=0.25, points=12, elements=1, stream=stream)


def doubling_over_two_parameters(stream: ChunkStream | None) -> rg.OrbitsResult:
    """A period doubling, a branch behind it, its curve, and transients beside the motions."""
    case = DeadZone(amplitude=0.2)
    over = {"operation.speed": [case.speed(1.61), case.speed(1.6)], "loads.drive.ripple": [4.0, 4.004]}
    asked: dict[str, Any] = {"method": "harmonic balance", "harmonics": 4, "step": 0.5, "points": 6}
    return rg.orbits(rg.loads(case.text(1.6)), over, switch=True, stream=stream, **asked)


def pair_over_frequency(stream: ChunkStream | None) -> rg.FrequencyResponse:
    """Solutions in a basis of few, and others on a finer mesh."""
    places = ["gears.pinion:y", "housing"]
    return rg.frf(spur_pair(), inputs=places, outputs=places, fmax=9000.0, points=90, elements=4, stream=stream)


def pair_over_speeds(stream: ChunkStream | None) -> rg.CampbellResult:
    """Modes in a basis of few over speeds."""
    return rg.campbell(spur_pair(), points=3, modes=4, elements=1, stream=stream)


@pytest.mark.parametrize(
    ("run", "each"),
    [(pair_over_speed, 3), (doubling_over_two_parameters, 5), (pair_over_frequency, 2), (pair_over_speeds, 2)],
)
def test_a_run_that_is_killed_again_and_again_ends_with_the_same_bits(
    run: Callable[[ChunkStream | None], rg.Result], each: int, tmp_path: Path
) -> None:
    whole = run(None)
    path = tmp_path / "run.h5"
    stream = Counted(path, most=each)
    starts = 1
    found = None
    while found is None:
        try:
            found = run(stream)
        except _StopError:
            starts += 1
            stream = Counted(path, resume=True, most=each)
    assert starts >= 3
    assert differences(whole, found) == []


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
