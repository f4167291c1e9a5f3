"""Caches: folders that nobody else can write to, and entries that are what was written."""

from __future__ import annotations

import os
import pwd
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rotorgear.files import cache
from rotorgear.files.cache import cache_folder, folder_of_version, read_entry, readable_cache_folder, write_entry
from tests.paths import ROOT

root = pytest.mark.skipif(os.name == "nt" or os.getuid() != 0, reason="only root gives files away")


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user without any setting but a cache folder of the system."""
    for name in ("ROTORGEAR_CACHE", "NUMBA_CACHE_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "rotorgear"


def test_the_folder_is_this_users_alone(home: Path) -> None:
    folder = cache_folder("compiled")
    assert folder == home / "compiled"
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    folder.chmod(0o755)  # as an older version made it: nobody else could write there
    assert cache_folder("compiled") == folder
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def of_all(folder: Path) -> None:
    folder.mkdir(parents=True)
    folder.chmod(0o777)


def of_a_group(folder: Path) -> None:
    folder.mkdir(parents=True)
    folder.chmod(0o770)


def a_link(folder: Path) -> None:
    folder.parent.mkdir(parents=True)
    (folder.parent / "elsewhere").mkdir(0o700)
    folder.symlink_to(folder.parent / "elsewhere")


def of_another(folder: Path) -> None:
    folder.mkdir(mode=0o700, parents=True)
    os.chown(folder, 12345, 12345)


def a_file(folder: Path) -> None:
    folder.parent.mkdir(parents=True)
    folder.write_text("in the way")


@pytest.mark.parametrize("make", [of_all, of_a_group, a_link, a_file, pytest.param(of_another, marks=root)])
def test_a_folder_that_somebody_else_may_have_filled_is_neither_read_nor_written(
    home: Path, make: Callable[[Path], None]
) -> None:
    make(home / "compiled")
    assert cache_folder("compiled") is None
    assert readable_cache_folder("compiled") is None
    assert folder_of_version("compiled", "abc") is None


def test_nothing_is_kept_in_a_folder_for_everybody(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    of_all(home / "compiled")
    monkeypatch.setenv("TMPDIR", str(home.parent / "tmp"))
    (home.parent / "tmp").mkdir()
    program = "from rotorgear.solvers.time.compiled import cache_folder; print(cache_folder())"
    run = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.strip() == "None"
    assert not list((home.parent / "tmp").iterdir())


def test_a_user_without_a_home_keeps_nothing_and_is_told_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("HOME", "XDG_CACHE_HOME", "ROTORGEAR_CACHE", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)

    def unknown(*_: object) -> None:
        raise KeyError("uid not found")

    monkeypatch.setattr(pwd, "getpwuid", unknown)
    assert cache_folder("teeth") is None
    write_entry("teeth", "map", "key", {"a": 1.0})
    assert read_entry("teeth", "map", "key") is None


@root
def test_a_warm_folder_of_the_packages_owner_is_read_and_not_written(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    warm = home / "compiled" / "abc"
    warm.mkdir(parents=True)
    (warm / "code.nbc").write_text("machine code")
    (warm / "planted.nbc").write_text("of anybody")
    (warm / "planted.nbc").chmod(0o666)
    for path in (home / "compiled", warm, warm / "code.nbc", warm / "planted.nbc", home):
        os.chown(path, 777, 777)
    monkeypatch.setattr(cache, "_PACKAGE", home)
    found = folder_of_version("compiled", "abc")
    assert found is not None
    assert found != warm
    assert stat.S_IMODE(found.stat().st_mode) == 0o700
    assert [path.name for path in found.iterdir()] == ["code.nbc"]
    (warm / "code.nbc").chmod(0o644)
    monkeypatch.setattr(cache, "_PACKAGE", tmp_path)  # of somebody else
    assert folder_of_version("compiled", "abc") is None


# --- entries -------------------------------------------------------------------------------------------------

VALUES = {"frequency": np.array([814.0, 912.5]), "note": ("a", "b"), "size": 3, "gone": None}


@pytest.fixture
def entry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROTORGEAR_CACHE", str(tmp_path))
    write_entry("bodies", "body", "key", VALUES)
    (path,) = tmp_path.iterdir()
    return path


def test_an_entry_comes_back(entry: Path) -> None:
    found = read_entry("bodies", "body", "key")
    assert found is not None
    assert np.array_equal(found.pop("frequency"), VALUES["frequency"])
    assert found == {"note": ("a", "b"), "size": 3}
    assert read_entry("bodies", "body", "other key") is None


def big_endian(stored: dict[str, np.ndarray]) -> None:
    stored["frequency"] = stored["frequency"].view(">f8")


def reshaped(stored: dict[str, np.ndarray]) -> None:
    stored["frequency"] = stored["frequency"].reshape(2, 1)


def as_whole(stored: dict[str, np.ndarray]) -> None:
    stored["frequency"] = stored["frequency"].view(np.int64)


def other_text(stored: dict[str, np.ndarray]) -> None:
    stored["note"] = np.array(["a", "c"])


def other_name(stored: dict[str, np.ndarray]) -> None:
    stored["frequencz"] = stored.pop("frequency")


def one_less(stored: dict[str, np.ndarray]) -> None:
    del stored["size"]


@pytest.mark.parametrize("change", [big_endian, reshaped, as_whole, other_text, other_name, one_less])
def test_everything_in_an_entry_is_under_its_checksum(
    entry: Path, change: Callable[[dict[str, np.ndarray]], None]
) -> None:
    with np.load(entry) as file:
        stored = dict(file)
    change(stored)
    np.savez(entry, **stored)
    assert read_entry("bodies", "body", "key") is None


def test_an_entry_with_any_byte_turned_is_computed_anew_or_the_same(entry: Path) -> None:
    data = entry.read_bytes()
    for place in range(0, len(data), 37):
        entry.write_bytes(data[:place] + bytes([data[place] ^ 0x10]) + data[place + 1 :])
        found = read_entry("bodies", "body", "key")
        assert found is None or np.array_equal(found["frequency"], VALUES["frequency"])
    for length in (0, 1, len(data) // 2, len(data) - 1):
        entry.write_bytes(data[:length])
        assert read_entry("bodies", "body", "key") is None
