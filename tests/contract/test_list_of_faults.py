"""The list of faults follows the code: whoever moves or rewrites a line moves the fault that is put there with it."""

from __future__ import annotations

from tests.mutation.runner import applies, read


def test_the_text_of_every_fault_stands_exactly_once_in_its_file() -> None:
    lost = [f"{each.name}: {each.file}: {each.old!r}" for each in read() if not applies(each)]
    assert not lost, "\n".join(["not exactly once there (tests/mutation/mutations.toml):", *lost])


def test_every_fault_changes_something() -> None:
    assert not [each.name for each in read() if each.old == each.new]
