"""The rows of a system: what its text prints, what rotorgear computes, and what that is worth by a rule.

Columns of NAME.csv:

    where     table or place in the text; "claim": a statement without a number; "follows": not printed; "equations": a misprint
    what      the quantity
    printed   as the text prints it; empty for what is not printed
    unit      of both numbers
    key       a value of the system's modules; or "@" and an address in the model file, "@gears.bull.teeth"; or "@file:address"
              for another file of the system; empty where the rule alone has what is computed
    rule      what gives the verdict, see rules.py
    reason    what the number rests on, and what follows from it
    runs      of a motion: where it starts, how long it settles and counts, how many starts end in it; a text, or "@" and a key
"""

from __future__ import annotations

import csv
import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from validation.seeds import kept
from validation.seeds.models import loaded
from validation.seeds.rules import VERDICTS, Value, bare, judged

FOLDER = Path(__file__).resolve().parent
# The modules of each system; the first has its MODEL.
SYSTEMS = {
    "marine": ("marine", "marine_trials"),
    "pair24": ("pair24", "pair24_trials"),
    "split": ("split", "split_trials"),
    "pair12": ("pair12", "pair12_trials"),
    "pair16": ("pair16", "pair16_trials"),
}
_SCALE = {
    "um": 1e-6,
    "mm": 1e-3,
    "kN m": 1e3,
    "kW": 1e3,
    "MW": 1e6,
    "deg": math.pi / 180.0,
    "rpm": math.pi / 30.0,
    "%": 1e-2,
}


@dataclass(frozen=True)
class Row:
    """A line of a system's table; `computed` is None where the rule alone has it, `because` is the test that gave the verdict."""

    where: str
    what: str
    printed: str
    unit: str
    computed: Value | None
    rule: str
    verdict: str
    because: str
    reason: str
    runs: str = ""

    @property
    def by(self) -> str:
        """The test that gave the verdict, or the last one that failed: "if 4.9 > 1", "trend only if 5 < 4"; "" for shown."""
        word, with_condition, condition = self.because.partition(" if ")
        if not with_condition:
            if self.because == "shown":
                return ""
            gives = {"input": "given", "follows": "exact", "within": "assumed", "outside": "not reproducible"}
            if gives[word.split(" ")[0]] == self.verdict:
                return self.because
            return "does not follow" if self.because == "follows" else f"not {self.because}"
        return f"if {condition}" if word == self.verdict else f"{word} only if {condition}"

    @property
    def shown(self) -> str:
        """The computed value with a digit more than the printed one, four at least."""
        if self.computed is None:
            return "-"
        if isinstance(self.computed, str):
            return self.computed
        is_number = not isinstance(bare(self.printed), str)
        digits = len(self.printed.lower().partition("e")[0].lstrip("+-0.<>~ ").replace(".", "")) if is_number else 0
        return f"{self.computed:.{max(4, digits + 1)}g}"


def entries(system: str) -> list[dict[str, str]]:
    """Return the lines of NAME.csv."""
    with (FOLDER / f"{system}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def counts() -> str:
    """A line a system: its rows, and how many of them have each verdict."""
    lines = [f"{'':8}{'rows':>4}  {'  '.join(VERDICTS)}"]
    for system in SYSTEMS:
        found = Counter(row.verdict for row in rows(system))
        cells = "  ".join(f"{found[verdict]:{len(verdict)}}" for verdict in VERDICTS)
        lines.append(f"{system:8}{found.total():4}  {cells}".rstrip())
    return "\n".join(lines)


@cache
def known(system: str) -> dict[str, Value]:
    """All values of a system: those that take no time anew, the others as NAME.json has them."""
    found: dict[str, Value] = {}
    for name in SYSTEMS[system]:
        module = import_module(f"validation.seeds.{name}")
        derived = getattr(module, "derived", None)
        found |= module.quick() | kept.values(name) | (derived(kept.values(name)) if derived else {})
    return found


def rows(system: str) -> list[Row]:
    """Return the rows of a system.

    Raises:
        KeyError: a key or name of a rule that neither the model nor the system's modules have.
    """
    model = import_module(f"validation.seeds.{system}").MODEL
    return [_row(model, known(system), line) for line in entries(system)]


def _row(model: str, names: Mapping[str, Value], line: dict[str, str]) -> Row:
    key = line["key"]
    computed: Value | None = None
    if key:
        computed = _given(model, key[1:], line["unit"]) if key.startswith("@") else names[key]
    verdict, because = judged(line["rule"], line["printed"], computed, names)
    runs = line["runs"]
    return Row(
        line["where"],
        line["what"],
        line["printed"],
        line["unit"],
        computed,
        line["rule"],
        verdict,
        because,
        line["reason"],
        str(names[runs[1:]]) if runs.startswith("@") else runs,
    )


def _given(model: str, address: str, unit: str) -> Value:
    """A value of the model file, in the unit of the row."""
    file, _, path = address.rpartition(":")
    value: Any = loaded(file or model)
    for name in path.split("."):
        value = value[int(name)] if name.isdigit() else value[name] if isinstance(value, dict) else getattr(value, name)
    return value if isinstance(value, str) else float(value) / _SCALE.get(unit, 1.0)
