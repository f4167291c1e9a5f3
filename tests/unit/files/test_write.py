"""Writers: whole or nothing, never onto an input, with the mode that was there."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from rotorgear.files.read import noted_inputs, noting_inputs, read_named
from rotorgear.files.write import WriteError, check_output, filling, publish, written


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_a_file_keeps_its_mode_and_nobody_sees_more_in_between(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_text("old")
    path.chmod(0o600)
    with written(path) as scratch:
        assert mode(scratch) == 0o600
        scratch.write_text("new")
    assert (path.read_text(), mode(path)) == ("new", 0o600)


@pytest.mark.parametrize("name", ["a", "link"])
def test_a_read_only_file_stays(tmp_path: Path, name: str) -> None:
    path = tmp_path / "a"
    path.write_text("old")
    path.chmod(0o444)
    (tmp_path / "link").symlink_to(path)
    with pytest.raises(WriteError, match="read-only"), written(tmp_path / name) as scratch:
        scratch.write_text("new")
    assert (path.read_text(), mode(path)) == ("old", 0o444)
    with pytest.raises(WriteError, match="read-only"):
        check_output(tmp_path / name)


def test_what_a_run_reads_it_does_not_write_by_any_name(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_text("old")
    os.link(path, tmp_path / "hard")
    (tmp_path / "soft").symlink_to(path)
    with pytest.raises(WriteError, match="this run reads it"), written(tmp_path / "soft", inputs=[path]):
        pass
    with noting_inputs() as known:
        read_named(path, 10)
        assert list(known.values()) == [path]
        for name in ("a", "hard", "soft"):
            with pytest.raises(WriteError, match="this run reads it"), written(tmp_path / name):
                pass
            with pytest.raises(WriteError, match="this run reads it"):
                check_output(tmp_path / name)
    assert not noted_inputs()
    with written(path) as scratch:
        scratch.write_text("new")
    assert (tmp_path / "soft").read_text() == "new"
    assert (tmp_path / "hard").read_text() == "old"


def test_a_folder_that_was_made_for_nothing_goes_away_again(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    for folder in ("mine/new/inner", "mine"):
        with pytest.raises(WriteError, match="no space"), filling(tmp_path / folder):
            raise OSError(28, "no space")
    assert list(tmp_path.rglob("*")) == [tmp_path / "mine"]


def test_where_one_file_of_several_can_not_be_moved_none_is(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    with filling(tmp_path) as scratch:
        for name in "ab":
            (scratch / name).write_text("new")
        with pytest.raises(WriteError, match="stands in the way"):
            publish(scratch, tmp_path, ["a", "b"])
    assert [path.name for path in tmp_path.iterdir()] == ["b"]


def test_outputs_are_checked_without_a_trace(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    check_output(tmp_path / "new.json")
    check_output(tmp_path / "a" / "b", folder=True)
    check_output("/dev/null" if os.name != "nt" else "NUL")
    for path, folder in ((tmp_path / "no" / "x", False), (tmp_path, False), (tmp_path / "file" / "x", True)):
        with pytest.raises(WriteError):
            check_output(path, folder=folder)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
