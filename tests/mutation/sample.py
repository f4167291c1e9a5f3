"""Faults of one operator, function or number, drawn at random from the arithmetic of the package, and the tests nearest to them.

A draw is the same for the same seed and sources. Some of its faults change nothing that matters; a survivor is read before it
becomes a test, and then an entry of the list.
"""

from __future__ import annotations

import ast
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


def nearest_tests(file: str, root: Path = ROOT) -> tuple[str, ...]:
    """Paths of tests of a file below rotorgear/, the nearest first.

    Those that import it, those of its name wherever they stand, the folder that mirrors its own, and those of laws.
    """
    module = "rotorgear." + file.removesuffix(".py").replace("/", ".")
    places = [root / "tests" / "unit" / parent for parent in Path(file).parents]
    mirror = next(place for place in places if place.is_dir())
    contract = root / "tests" / "contract"
    every = sorted([*(root / "tests" / "unit").rglob("test_*.py"), *contract.glob("test_*.py")])
    direct = [test for test in every if f"from {module} import" in test.read_text(encoding="utf-8")]
    direct += [test for test in every if test.name.startswith(f"test_{Path(file).stem}") and test not in direct]
    around = [] if mirror.name == "unit" else sorted(set(mirror.rglob("test_*.py")) - set(direct))
    kind = file.partition("/")[0]
    laws = sorted(set(contract.glob(_OF_LAWS[kind])) - set(direct)) if kind in _OF_LAWS else []
    return tuple(test.relative_to(root).as_posix() for test in (*direct, *around, *laws))


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
            if old and between.count(old) == 1:
                found.append((begin + between.index(old), len(old), old, new))
        if isinstance(node, ast.Attribute) and node.attr in _FUNCTIONS:
            end = offset(node.end_lineno or 1, node.end_col_offset or 0)
            found.append((end - len(node.attr), len(node.attr), node.attr, _FUNCTIONS[node.attr]))
        if isinstance(node, ast.Constant) and isinstance(node.value, float) and 0.0 < node.value < 1e3:
            begin = offset(node.lineno, node.col_offset)
            old = text[begin : offset(node.end_lineno or 1, node.end_col_offset or 0)]
            found.append((begin, len(old), old, f"{2.0 * node.value!r}"))
    return sorted(set(found))


def _arithmetic(node: ast.AST, inside: bool = False) -> Iterator[ast.AST]:
    """Nodes of the bodies of functions, without annotations, defaults and texts of messages."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "args") and isinstance(node, (ast.FunctionDef, ast.AnnAssign)):
            continue
        for child in value if isinstance(value, list) else [value]:
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
