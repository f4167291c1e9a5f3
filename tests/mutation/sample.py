"""Faults of one operator, function or number, drawn at random from the arithmetic of the package, and the tests nearest to them.

A draw is the same for the same seed and sources. What changes no result is not drawn: shares of a progress bar, examples of laws,
tiny numbers that only keep a divisor from zero, and a product that becomes a quotient by a sign. Some other faults change nothing
that matters either; a survivor is read before it becomes a test, and then an entry of the list, with a reason in place of tests
where it is equivalent: such ones are told apart when they are drawn again.

What fresh draws gave on first sight, by `python -m tests.mutation --sample 6 --seed 55 --limit 40 --only PACKAGE`, of those that
are not equivalent: solvers/periodic 4 of 6 killed, analysis/scatter 4 of 5, gears/maps 4 of 5, rexs 4 of 5, casings 4 of 5,
model/layout 5 of 6. The other ones became tests.
"""

from __future__ import annotations

import ast
import functools
import random
from collections.abc import Iterator
from pathlib import Path

from tests.mutation.runner import ROOT, Mutation

_OPERATORS = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.Lt: ("<", ">"),
    ast.Gt: (">", "<"),
    ast.LtE: ("<=", ">="),
    ast.GtE: (">=", "<="),
}
_FUNCTIONS = {
    "sin": "cos",
    "cos": "sin",
    "tan": "sin",
    "min": "max",
    "max": "min",
    "minimum": "maximum",
    "maximum": "minimum",
}
# Functions that are told a share of the work.
_OF_PROGRESS = ("progress", "tell", "part_of")
# Smaller numbers keep divisors from zero.
_GUARD = 1e-100
# Names of numbers that are 1 or -1: a product with them is the quotient.
_SIGNS = ("sign", "sense", "side")
# Numbers that tests try laws with.
_FOR_TESTS = "examples"
# Laws that every part of a kind holds; quick, and run behind the tests that mirror a module.
_OF_LAWS = {
    "forces": "test_force_laws.py",
    "elements": "test_conventions*.py",
    "model": "test_conventions*.py",
    "system": "test_conventions*.py",
}


def packages(root: Path = ROOT) -> list[str]:
    """Every package below rotorgear/, such as "gears/maps"."""
    base = root / "rotorgear"
    return sorted({file.parent.relative_to(base).as_posix() for file in base.rglob("*.py")} - {"."})


@functools.cache  # all tests are read for a file
def nearest_tests(file: str, root: Path = ROOT) -> tuple[str, ...]:
    """Paths of tests of a file below rotorgear/, the nearest first.

    Those that import it, those of its name wherever they stand, the folder that mirrors its own, those that import what imports
    it, and those of laws.
    """
    module = _module(file)
    places = [root / "tests" / "unit" / parent for parent in Path(file).parents]
    mirror = next(place for place in places if place.is_dir())
    contract = root / "tests" / "contract"
    every = sorted([*(root / "tests" / "unit").rglob("test_*.py"), *contract.glob("test_*.py")])
    direct = _that_import([module], every)
    direct += [test for test in every if test.name.startswith(f"test_{Path(file).stem}") and test not in direct]
    around = [] if mirror.name == "unit" else sorted(set(mirror.rglob("test_*.py")) - set(direct))
    package = root / "rotorgear"
    users = [
        _module(user.relative_to(package).as_posix()) for user in _that_import([module], sorted(package.rglob("*.py")))
    ]
    of_users = [test for test in _that_import(users, every) if test not in direct and test not in around]
    kind = file.partition("/")[0]
    laws = sorted(set(contract.glob(_OF_LAWS[kind])) - {*direct, *of_users}) if kind in _OF_LAWS else []
    return tuple(test.relative_to(root).as_posix() for test in (*direct, *around, *of_users, *laws))


def _module(file: str) -> str:
    """The name under which a file below rotorgear/ is imported."""
    return "rotorgear." + file.removesuffix(".py").replace("/", ".")


def _that_import(modules: list[str], files: list[Path]) -> list[Path]:
    """Those of some files that import one of the modules."""
    wanted = [f"from {module} import" for module in modules]
    return [file for file in files if any(each in file.read_text(encoding="utf-8") for each in wanted)]


def faults_of(text: str) -> list[tuple[int, int, str, str]]:
    """Faults of a source: offset, length, and what stands there and becomes of it; none in annotations, texts and defaults."""
    lines = text.splitlines(keepends=True)
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line))

    def offset(line: int, column: int) -> int:
        """Columns of the syntax tree count bytes."""
        return starts[line - 1] + len(lines[line - 1].encode()[:column].decode())

    found = []
    for node in _arithmetic(ast.parse(text)):
        if isinstance(node, ast.BinOp):
            pairs = [(node.left, node.op, node.right)]
        elif isinstance(node, ast.Compare):
            pairs = [(node.left, node.ops[0], node.comparators[0])] if len(node.ops) == 1 else []
        else:
            pairs = []
        for left, operator, right in pairs:
            old, new = _OPERATORS.get(type(operator), ("", ""))
            begin = offset(left.end_lineno or 1, left.end_col_offset or 0)
            between = text[begin : offset(right.lineno, right.col_offset)]
            if old in ("*", "/") and _name_of(right) in _SIGNS:
                continue
            if old and between.count(old) == 1:
                found.append((begin + between.index(old), len(old), old, new))
        if isinstance(node, ast.Attribute) and node.attr in _FUNCTIONS:
            end = offset(node.end_lineno or 1, node.end_col_offset or 0)
            found.append((end - len(node.attr), len(node.attr), node.attr, _FUNCTIONS[node.attr]))
        if isinstance(node, ast.Constant) and isinstance(node.value, float) and _GUARD < node.value < 1e3:
            begin = offset(node.lineno, node.col_offset)
            old = text[begin : offset(node.end_lineno or 1, node.end_col_offset or 0)]
            found.append((begin, len(old), old, f"{2.0 * node.value!r}"))
    return sorted(set(found))


def _name_of(node: ast.expr) -> str:
    """The last name of a variable, an attribute, an entry of one or a call; "" of other expressions."""
    while isinstance(node, (ast.Subscript, ast.Call)):
        node = node.value if isinstance(node, ast.Subscript) else node.func
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def _arithmetic(node: ast.AST, inside: bool = False) -> Iterator[ast.AST]:
    """Nodes of the bodies of functions, without annotations, defaults, texts of messages and shares of progress."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "args") and isinstance(node, (ast.FunctionDef, ast.AnnAssign)):
            continue
        if isinstance(node, ast.FunctionDef) and node.name == _FOR_TESTS:
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.Call) and isinstance(child.func, ast.Name) and child.func.id in _OF_PROGRESS:
                continue
            if isinstance(child, ast.AST) and not isinstance(child, (ast.JoinedStr, ast.Raise)):
                within = inside or isinstance(node, ast.FunctionDef)
                if within:
                    yield child
                yield from _arithmetic(child, within)


def _unique(text: str, begin: int, length: int, new: str) -> tuple[str, str]:
    """The text about a fault, as far up and down as it takes to stand there once, and what becomes of it."""
    low = text.rfind("\n", 0, begin) + 1
    high = (text.find("\n", begin) + 1 or len(text) + 1) - 1
    while text.count(text[low:high]) > 1:
        low = text.rfind("\n", 0, low - 1) + 1
    return text[low:high], text[low:begin] + new + text[begin + length : high]


def drawn(package: str, count: int, seed: int, root: Path = ROOT) -> list[Mutation]:
    """`count` faults of the files of a package, or all there are."""
    every = []
    for path in sorted((root / "rotorgear" / package).glob("*.py")):
        text = path.read_text(encoding="utf-8")
        every += [(path, text, *fault) for fault in faults_of(text)]
    draw = random.Random(f"{package} {seed}")
    found = []
    for path, text, begin, length, old, new in draw.sample(every, min(count, len(every))):
        file = path.relative_to(root / "rotorgear").as_posix()
        line = text.count("\n", 0, begin) + 1
        column = begin - text.rfind("\n", 0, begin)
        before, after = _unique(text, begin, length, new)
        name = f"{file}:{line}:{column} {old} -> {new}"
        found.append(Mutation(name, file, before, after, after.strip(), nearest_tests(file, root)))
    return found
