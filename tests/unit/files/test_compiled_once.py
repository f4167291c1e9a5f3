"""One process compiles what several need at once."""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from rotorgear.files.compiled_once import CompiledOnce
from rotorgear.progress import hearing_forecasts
from rotorgear.solvers.time import compiled


class Kept:
    """What several processes see of one folder."""

    def __init__(self) -> None:
        self.code: dict[str, str] = {}
        self.path = "kept"

    def load_overload(self, signature: str, context: Any) -> str | None:
        return self.code.get(signature)

    def save_overload(self, signature: str, data: str) -> None:
        self.code[signature] = data


def test_the_second_waits_for_what_the_first_compiles(tmp_path: Path) -> None:
    kept = Kept()
    first, second = (CompiledOnce(kept, tmp_path / "function.lock") for _ in range(2))
    assert first.load_overload("double", None) is None
    with ThreadPoolExecutor(1) as pool:
        waiting = pool.submit(second.load_overload, "double", None)
        with pytest.raises(TimeoutError):
            waiting.result(0.2)
        first.save_overload("double", "machine code")
        assert waiting.result(5.0) == "machine code"
    # Nobody holds the lock now: either may compile what is still missing.
    assert second.load_overload("single", None) is None
    second.save_overload("single", "more code")
    assert first.load_overload("single", None) == "more code"


def test_who_failed_to_compile_may_try_again(tmp_path: Path) -> None:
    once = CompiledOnce(Kept(), tmp_path / "function.lock")
    assert once.load_overload("double", None) is None
    assert once.load_overload("double", None) is None
    once.save_overload("double", "machine code")
    assert once.load_overload("double", None) == "machine code"


def test_where_no_lock_can_be_kept_each_compiles(tmp_path: Path) -> None:
    once = CompiledOnce(Kept(), tmp_path / "missing" / "function.lock")
    assert once.load_overload("double", None) is None
    once.save_overload("double", "machine code")
    assert once.load_overload("double", None) == "machine code"


def test_all_else_is_the_cache_itself(tmp_path: Path) -> None:
    assert CompiledOnce(Kept(), tmp_path / "function.lock").path == "kept"


# --- damaged files -------------------------------------------------------------------------------------------

SOURCE = """
def doubled(x):
    return 2.0 * x
"""


def cut(file: Path) -> None:
    os.truncate(file, file.stat().st_size // 2)


def emptied(file: Path) -> None:
    os.truncate(file, 0)


def zeroed(file: Path) -> None:
    data = bytearray(file.read_bytes())
    half = len(data) // 2
    data[half : half + 512] = bytes(len(data[half : half + 512]))
    file.write_bytes(data)


def flipped(file: Path) -> None:
    data = bytearray(file.read_bytes())
    data[len(data) // 3] ^= 1
    file.write_bytes(data)


def without_its_sum(file: Path) -> None:
    file.with_name(file.name + ".sha256").unlink()


@pytest.fixture
def kept_function(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[], Any]:
    """Compiles a function of a file, or takes it from the disk as another process would."""
    module = tmp_path / "doubling.py"
    module.write_text(SOURCE, encoding="utf-8")
    folder = tmp_path / "compiled"
    folder.mkdir()
    monkeypatch.setattr(compiled, "cache_folder", lambda: folder)

    def load() -> Any:
        spec = importlib.util.spec_from_file_location("doubling", module)
        assert spec is not None
        assert spec.loader is not None
        loaded = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, "doubling", loaded)
        spec.loader.exec_module(loaded)
        function = compiled.compiled(loaded.doubled)
        assert function(3.0) == 6.0
        return function

    return load


@pytest.mark.parametrize("ending", [".nbc", ".nbi"])
def test_damaged_code_is_compiled_anew_and_its_folder_named(
    kept_function: Callable[[], Any], tmp_path: Path, ending: str, caplog: pytest.LogCaptureFixture
) -> None:
    kept_function()
    for damage in (cut, emptied, zeroed, flipped, without_its_sum):
        assert not kept_function().stats.cache_misses, "a whole file is read"
        assert not caplog.records
        (file,) = (tmp_path / "compiled").rglob(f"*{ending}")
        damage(file)
        assert kept_function().stats.cache_misses, damage.__name__
        (told,) = caplog.messages
        assert str(tmp_path / "compiled") in told
        caplog.clear()


def test_a_full_disk_costs_time_only(kept_function: Callable[[], Any], monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "no space left on device")

    monkeypatch.setattr(os, "replace", full)
    assert kept_function().stats.cache_misses


def test_each_compilation_that_is_to_come_is_foretold_once(tmp_path: Path) -> None:
    (tmp_path / "module.loop-7.nbi").write_bytes(b"index")
    heard: list[tuple[str, float]] = []

    def loop(line: int, seconds: float) -> CompiledOnce:
        kept = Kept()
        kept.cache_path = str(tmp_path)  # type: ignore[attr-defined]
        return CompiledOnce(kept, tmp_path / f"function-{line}.lock", f"module.loop-{line}.", seconds)

    with hearing_forecasts(lambda what, seconds, more: heard.append((what, seconds))):
        loop(7, 3.0).foretell_unless_kept()
        loop(13, 0.0).load_overload("double", None)
        assert not heard
        new = loop(12, 25.0)
        new.foretell_unless_kept()
        new.load_overload("double", None)
        new.load_overload("double", None)
        assert heard == [("compiling, once", 25.0)]
        new.save_overload("double", "machine code")
        assert new.load_overload("double", None) == "machine code"
        assert len(heard) == 1
        # Other types are compiled anew.
        new.load_overload("single", None)
    assert heard == [("compiling, once", 25.0)] * 2
