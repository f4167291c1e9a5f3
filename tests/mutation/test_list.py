"""The list of faults can be read, names tests that there are, and the runner puts a fault in once or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.mutation.runner import LIST, ROOT, Mutation, fault, mutated, read


def test_every_fault_names_tests_that_there_are_or_says_why_none_can_see_it() -> None:
    found = read()
    assert len(found) > 100
    for each in found:
        assert each.why, each.name
        for test in each.tests:
            assert (ROOT / test.partition("::")[0]).exists(), (each.name, test)


def test_a_text_that_stands_there_twice_or_not_at_all_is_not_changed() -> None:
    once = Mutation("name", "file.py", "a + b", "a - b", "why", ("tests",))
    assert mutated("x = a + b", once) == "x = a - b"
    assert mutated("x = a + b; y = a + b", once) is None
    assert mutated("x = a * b", once) is None


def test_a_fault_is_taken_out_again(tmp_path: Path) -> None:
    (tmp_path / "rotorgear").mkdir()
    file = tmp_path / "rotorgear" / "file.py"
    file.write_text("x = a + b\n", encoding="utf-8")
    once = Mutation("name", "file.py", "a + b", "a - b", "why", ("tests",))
    with fault(tmp_path, once) as put:
        assert put
        assert file.read_text(encoding="utf-8") == "x = a - b\n"
    assert file.read_text(encoding="utf-8") == "x = a + b\n"


def test_a_list_with_two_of_one_name_or_without_tests_is_refused(tmp_path: Path) -> None:
    entry = '[[mutation]]\nname = "n"\nfile = "f"\nold = "a"\nnew = "b"\nwhy = "w"\n'
    for text, words in ((entry, "either tests or a reason"), (2 * (entry + 'tests = ["t"]\n'), "two mutations")):
        path = tmp_path / LIST.name
        path.write_text(text, encoding="utf-8")
        with pytest.raises(ValueError, match=words):
            read(path)
