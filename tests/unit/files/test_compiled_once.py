"""One process compiles what several need at once."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from rotorgear.files.compiled_once import CompiledOnce


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
