"""The list of faults can be read, names tests that there are, and the runner puts a fault in once or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.mutation.runner import LIST, ROOT, Mutation, fault, mutated, read
from tests.mutation.sample import drawn, faults_of, nearest_tests, packages


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


def test_faults_are_drawn_from_arithmetic_and_not_from_texts_and_annotations() -> None:
    text = '''"""a - b"""


def f(x: float | None = 2.0) -> float:
    """x / 2.0"""
    é = "a - b" + f"{x - 1.0}"
    y: int | None = 3
    progress(0.3 + 0.2 * x, "half")
    z = x / np.maximum(y, 1e-300) + side[0] * self.sense * 7
    return np.sin(x) * 0.5 if x < y else x


def examples():
    return Spring(2.0 * 7)
'''
    found = [(old, new) for *_, old, new in faults_of(text)]
    # No guard of a divisor, no product with a sign, and no example.
    third = [("/", "*"), ("maximum", "minimum"), ("+", "-"), ("*", "/")]
    assert found == [("+", "-"), *third, ("sin", "cos"), ("*", "/"), ("0.5", "1.0"), ("<", ">")]
    for begin, length, old, _ in faults_of(text):
        assert text[begin : begin + length] == old


@pytest.mark.parametrize("package", ["forces", "gears/maps", "rexs"])
def test_a_draw_can_be_put_in_is_the_same_again_and_has_tests(package: str) -> None:
    found = drawn(package, 6, 3)
    assert found == drawn(package, 6, 3)
    assert found != drawn(package, 6, 4)
    for each in found:
        text = (ROOT / "rotorgear" / each.file).read_text(encoding="utf-8")
        changed = mutated(text, each)
        assert changed not in (None, text)
        assert f"tests/unit/{package}" in " ".join(each.tests)


def test_every_package_is_drawn_from_and_the_tests_that_import_a_module_come_first() -> None:
    assert {"forces", "gears/geometry", "solvers/time", "analysis/rig", "model/layout", "rexs"} <= set(packages())
    tests = nearest_tests("rexs/bearings.py")
    assert tests[0] == "tests/unit/rexs/test_import.py"
    assert set(tests) > {"tests/unit/rexs/test_numbers.py", "tests/unit/rexs/test_other_files.py"}
    of_user = nearest_tests("solvers/frequency/contact_basis.py")
    assert of_user[0] == "tests/unit/solvers/frequency/test_contact_basis.py"
    assert "tests/unit/analysis/sweep/test_sweep_reduction.py" in of_user
    assert "tests/contract/test_force_laws.py" in nearest_tests("forces/law.py")
    assert "tests/contract/test_conventions_of_the_mesh.py" in nearest_tests("system/groups.py")
