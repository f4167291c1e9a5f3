"""The account of an import: what was assumed, what is missing, what was left out. And values read on that account."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from rotorgear.errors import Problem
from rotorgear.files.numbers import number_of
from rotorgear.results.rexs_import import Assumption
from rotorgear.rexs.document import FACTORS, LARGEST, Component, factor_of

_TRUE = ("true", "1", "yes")
_FALSE = ("false", "0", "no")


@dataclass
class Account:
    """Assumptions, problems and warnings of the whole import, for one report."""

    assumptions: list[Assumption] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    _said: set[object] = field(default_factory=set)

    def _is_new(self, told: object) -> bool:
        """Whether a problem or a warning was not noted before; a file may give cause for one a thousand times."""
        new = told not in self._said
        self._said.add(told)
        return new

    def assume(self, address: str, value: str, reason: str) -> str:
        """Note an assumption; return the comment for the model file."""
        self.assumptions.append(Assumption(address, value, reason))
        return f"assumed: {reason}"

    def missing(self, where: Component | str, expected: str, hint: str = "") -> None:
        """Note what the file does not say and nothing can replace."""
        source = where.given("data_source") if isinstance(where, Component) else None
        if source is not None and not hint:
            # From 1.5 on a file may refer to a data base beside it.
            hint = f"its values are in '{source.raw}', which is not read: write a file that holds them itself"
        problem = Problem(str(where), "", expected, hint)
        if self._is_new(problem):
            self.problems.append(problem)

    def number(self, component: Component, names: tuple[str, ...], kind: str) -> float | None:
        """The first of some attributes that is there, in SI; placeholders are not taken, and an unknown unit is a problem."""
        for name in names:
            value = component.given(name)
            if value is None:
                continue
            number = _as_number(value.raw)
            if number is None:
                self.problems.append(Problem(f"{component}: {name}", f"'{value.raw}'", "a number"))
                continue
            found = self._in_si(component, name, [number], kind)
            if found is not None:
                return found[0]
        return None

    def plain_number(self, component: Component, name: str) -> float | None:
        """An attribute as it is written, in the unit of the file."""
        value = component.attributes.get(name)
        return None if value is None else _as_number(value.raw)

    def numbers(self, component: Component, name: str, kind: str, count: int) -> list[float] | None:
        """An array of `count` numbers in SI; None where it is not there."""
        value = component.given(name)
        if value is None:
            return None
        found = [_as_number(entry) for entry in value.raw] if isinstance(value.raw, list) else []
        numbers = [entry for entry in found if entry is not None]
        if len(numbers) != count or len(found) != count:
            self.problems.append(Problem(f"{component}: {name}", f"{value.raw}", f"{count} numbers"))
            return None
        return self._in_si(component, name, numbers, kind)

    def _in_si(self, component: Component, name: str, numbers: list[float], kind: str) -> list[float] | None:
        """Numbers of an attribute in SI; None where their unit is not known, and for a placeholder."""
        value = component.attributes[name]
        factor = factor_of(kind, value.unit)
        if factor is None:
            known = ", ".join(unit for unit in FACTORS[kind] if unit) or "none"
            self.problems.append(Problem(f"{component}: {name}", f"the unit '{value.unit}'", f"one of {known}"))
            return None
        # NaN and infinity are what programs write for "not set".
        if all(math.isfinite(one) and abs(one * factor) <= LARGEST.get(kind, math.inf) for one in numbers):
            return [one * factor for one in numbers]
        note = f"{component}: {name} = {value.raw} {value.unit}".rstrip() + " stands for no value and is not taken"
        if self._is_new(note):
            self.warnings.append(note)
        return None

    def truth(self, component: Component, name: str, entry: int = 0) -> bool | None:
        """A truth value, or one of the entries of an array; None where the file has none."""
        value = component.given(name)
        if value is not None and isinstance(value.raw, list):
            text = str(value.raw[entry]).strip().lower() if 0 <= entry < len(value.raw) else ""
        else:
            text = self.text(component, name).lower()
        return True if text in _TRUE else False if text in _FALSE else None

    def text(self, component: Component, *names: str) -> str:
        """The first of some attributes that is not empty, as text; "" where none is."""
        found = (value for name in names if (value := component.given(name)) is not None)
        return next((str(value.raw).strip() for value in found), "")


def _as_number(raw: object) -> float | None:
    if isinstance(raw, bool):
        return None
    try:
        return number_of(raw) if isinstance(raw, str) else float(raw)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return None
