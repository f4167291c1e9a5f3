"""Rules by which a row gets its verdict, from the printed text and from computed values alone.

A rule is a list of tests, parted by ";". The first that holds gives the verdict; where none holds it is "differs", or "open"
where one could not be decided within the error of a computed value.

    input                     given: the model holds what is printed, to the last digit
    follows                   exact: the given data give what is printed, to the last digit; else inconsistent
    within 5 %                assumed: the computed number is the printed one within this share of it
    outside LOW .. HIGH       not reproducible: what is printed lies outside of the values over a swept assumption
    VERDICT if CONDITION      this verdict where a condition on computed values holds: "trend if rms_1 > rms_3"
    shown                     shown: nothing is printed to compare with

Names in a condition are keys of the system's values, `computed` and `printed` those of the row. A value with an error ("0.22 +-
0.03") or from several runs ("4.9 to 5.6") is an interval: a comparison holds where it holds for all of it.
"""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

# Verdicts in the order of the page.
VERDICTS = ("given", "exact", "assumed", "trend", "open", "differs", "inconsistent", "not reproducible", "shown")
Value = float | str
_NUMBER = re.compile(r"[+-]?\d+(\.\d*)?(e[+-]?\d+)?", re.IGNORECASE)
_WORDS = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True)
class Interval:
    """All numbers from low to high."""

    low: float
    high: float

    def combined(self, other: Interval, by: Callable[[float, float], float]) -> Interval:
        """All results of an operation between numbers of both."""
        found = [by(a, b) for a in (self.low, self.high) for b in (other.low, other.high)]
        return Interval(min(found), max(found))


Operand = Interval | str
_ARITHMETIC: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}


def tests(rule: str) -> list[str]:
    """The tests of a rule, in their order."""
    return [test.strip() for test in rule.split(";")]


def judged(rule: str, printed: str, computed: Value | None, known: Mapping[str, Value]) -> tuple[str, str]:
    """The verdict on a row, and the test that gave it, with the values it compares.

    Args:
        rule: of the row. printed: its text. computed: its value. known: all values of the system by their key.

    Raises:
        ValueError: a rule that says nothing. KeyError: a value that the system does not have.
    """
    names = dict(known)
    if computed is not None:
        names["computed"] = computed
    if printed:
        names["printed"] = bare(printed)
    last = ""
    undecided = False
    for test in tests(rule):
        verdict, holds, last = _tried(test, printed, computed, names)
        if holds:
            return verdict, last
        undecided |= holds is None
        if test in ("input", "follows"):
            return ("differs" if test == "input" else "inconsistent"), last
    return ("open" if undecided else "differs"), last


def _tried(test: str, printed: str, computed: Value | None, names: Mapping[str, Value]) -> tuple[str, bool | None, str]:
    """Verdict of a test that holds, whether it holds (None: undecided), and the test with its values."""
    if test == "shown":
        return "shown", True, test
    if test in ("input", "follows"):
        return ("given" if test == "input" else "exact"), agrees(printed, computed), test
    verdict, found, condition = test.partition(" if ")
    if found and verdict in VERDICTS:
        return verdict, holds(condition, names), f"{verdict} if {with_values(condition, names)}"
    word, _, rest = test.partition(" ")
    if word == "within" and rest.endswith(" %"):
        share = float(rest.removesuffix(" %")) / 100.0
        condition = f"{1.0 - share} * printed <= computed <= {1.0 + share} * printed"
        if str(names["printed"]).startswith("-"):
            condition = f"{1.0 + share} * printed <= computed <= {1.0 - share} * printed"
        return "assumed", holds(condition, names), test
    low, found, high = rest.partition(" .. ")
    if word == "outside" and found:
        condition = f"printed < {low} or printed > {high}"
        return "not reproducible", holds(condition, names), f"outside {with_values(f'{low} .. {high}', names)}"
    raise ValueError(f'"{test}" is no test of a row: see validation/seeds/rules.py')


def bare(printed: str) -> Value:
    """A printed text as a number where it is one, without "~" and the sign of a bound."""
    text = printed.lstrip("~<>= ")
    return float(text) if _NUMBER.fullmatch(text) else printed


def agrees(printed: str, computed: Value | None) -> bool:
    """Whether a computed value is what is printed: a text word by word, a bound kept, a number to one unit of its last digit."""
    number = bare(printed)
    if isinstance(number, str) or not isinstance(computed, (int, float)):
        return str(computed) == printed
    if printed[0] in "<>":
        return computed < number if printed[0] == "<" else computed > number
    mantissa, _, exponent = printed.lstrip("~ ").lower().partition("e")
    return abs(computed - number) < 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def operand(value: Value) -> Operand:
    """A value as an interval, or as the text that it is."""
    if not isinstance(value, str):
        return Interval(float(value), float(value))
    middle, with_error, error = value.partition(" +- ")
    low, with_range, high = value.partition(" to ")
    if with_error and _NUMBER.fullmatch(middle) and _NUMBER.fullmatch(error):
        return Interval(float(middle) - float(error), float(middle) + float(error))
    if with_range and _NUMBER.fullmatch(low) and _NUMBER.fullmatch(high):
        return Interval(float(low), float(high))
    return Interval(float(value), float(value)) if _NUMBER.fullmatch(value) else value


def holds(condition: str, names: Mapping[str, Value]) -> bool | None:
    """Whether a condition holds; None where a value's error leaves it undecided.

    Raises:
        KeyError: a name without a value. ValueError: what is no condition.
    """
    return _truth(ast.parse(condition, mode="eval").body, names)


def used(rule: str) -> set[str]:
    """The names of values that a rule compares."""
    found: set[str] = set()
    for test in tests(rule):
        _, is_condition, condition = test.partition(" if ")
        word, _, rest = test.partition(" ")
        texts = [condition] if is_condition else rest.split(" .. ") if word == "outside" else []
        for text in texts:
            found |= {node.id for node in ast.walk(ast.parse(text, mode="eval")) if isinstance(node, ast.Name)}
    return found - {"abs", "computed", "printed"}


def with_values(text: str, names: Mapping[str, Value]) -> str:
    """A condition with its values in place of their names."""
    parts = re.split(r'("[^"]*")', text)
    for i in range(0, len(parts), 2):
        parts[i] = _WORDS.sub(lambda word: _short(names.get(word[0], word[0])), parts[i])
    return "".join(parts)


def _short(value: Value) -> str:
    return value if isinstance(value, str) else f"{value:.4g}"


def _truth(node: ast.expr, names: Mapping[str, Value]) -> bool | None:
    if isinstance(node, ast.BoolOp):
        found = [_truth(one, names) for one in node.values]
        decisive = isinstance(node.op, ast.Or)
        return decisive if decisive in found else None if None in found else not decisive
    if not isinstance(node, ast.Compare):
        raise ValueError(f'"{ast.unparse(node)}" is no comparison')
    left = _operand(node.left, names)
    found = []
    for by, other in zip(node.ops, node.comparators, strict=True):
        right = _operand(other, names)
        found.append(_compared(by, left, right))
        left = right
    return False if False in found else None if None in found else True


def _compared(by: ast.cmpop, left: Operand, right: Operand) -> bool | None:
    if isinstance(left, str) or isinstance(right, str):
        if isinstance(by, (ast.In, ast.NotIn)):
            return (str(left) in str(right).split(", ")) == isinstance(by, ast.In)
        if isinstance(by, (ast.Eq, ast.NotEq)):
            return (left == right) == isinstance(by, ast.Eq)
        raise ValueError(f"{left} and {right} have no order")
    if isinstance(by, (ast.Gt, ast.GtE)):
        left, right = right, left
    elif not isinstance(by, (ast.Lt, ast.LtE)):
        raise ValueError("numbers are compared by < and >: an equation of two of them rests on their rounding")
    strict = isinstance(by, (ast.Lt, ast.Gt))
    if left.high < right.low or (not strict and left.high <= right.low):
        return True
    return False if left.low > right.high or (strict and left.low >= right.high) else None


def _operand(node: ast.expr, names: Mapping[str, Value]) -> Operand:
    if isinstance(node, ast.Name):
        return operand(names[node.id])
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float, str)):
        return operand(node.value)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return _operand(ast.BinOp(ast.Constant(0.0), ast.Sub(), node.operand), names)
    if isinstance(node, ast.BinOp) and type(node.op) in _ARITHMETIC:
        left, right = (_operand(one, names) for one in (node.left, node.right))
        if isinstance(left, Interval) and isinstance(right, Interval):
            return left.combined(right, _ARITHMETIC[type(node.op)])
    if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "abs" and len(node.args) == 1:
        inner = _operand(node.args[0], names)
        if isinstance(inner, Interval):
            ends = sorted((abs(inner.low), abs(inner.high)))
            return Interval(0.0 if inner.low < 0.0 < inner.high else ends[0], ends[1])
    raise ValueError(f'"{ast.unparse(node)}" is no value')
