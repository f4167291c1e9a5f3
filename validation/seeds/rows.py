"""The rows of a system: what its text prints, what rotorgear computes, and what that is worth.

Columns of NAME.csv:

    where     table or place in the text
    what      the quantity
    printed   as the text prints it; empty for what follows from its data without being printed
    unit      of both numbers
    key       a value of NAME.py; or "@" and an address in the model file, "@gears.bull.teeth"; or "@file:address" for
              another file of the system; empty where nothing can be computed
    verdict   given (data of the source that the model holds: an input, no result), exact (follows from given data), assumed
              (comes out with stated assumptions), trend (the direction agrees, not the number), or not reproducible
    reason    why, in a sentence; must stand for every verdict but given and exact
    runs      of a motion: where it starts, how long it settles and counts, and how many starts end in it; a text, or "@" and a
              key of NAME.py
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

import rotorgear as rg

FOLDER = Path(__file__).resolve().parent
MODELS = FOLDER.parents[1] / "models"
SYSTEMS = ("marine", "pair24", "split", "pair12", "pair16")
VERDICTS = ("given", "exact", "assumed", "trend", "not reproducible")
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
    """A line of a system's table; `computed` is None where nothing is computed."""

    where: str
    what: str
    printed: str
    unit: str
    computed: float | str | None
    verdict: str
    reason: str
    runs: str = ""

    @property
    def agrees(self) -> bool:
        """Whether the computed number is the printed one, to one unit of its last digit."""
        if isinstance(self.computed, str) or self.computed is None:
            return str(self.computed) == self.printed
        mantissa, _, exponent = self.printed.lower().partition("e")
        last = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
        return abs(self.computed - float(self.printed)) < last

    @property
    def shown(self) -> str:
        """The computed value with a digit more than the printed one, four at least."""
        if self.computed is None:
            return "-"
        if isinstance(self.computed, str):
            return self.computed
        digits = len(self.printed.lower().partition("e")[0].lstrip("+-0.").replace(".", ""))
        return f"{self.computed:.{max(4, digits + 1)}g}"


def entries(system: str) -> list[dict[str, str]]:
    """Return the lines of NAME.csv."""
    with (FOLDER / f"{system}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def counts() -> str:
    """A line a system: its rows, and how many of them have each verdict."""
    lines = [f"{'':8}{'rows':>4}  {'  '.join(VERDICTS)}"]
    for system in SYSTEMS:
        found = Counter(line["verdict"] for line in entries(system))
        cells = "  ".join(f"{found[verdict]:{len(verdict)}}" for verdict in VERDICTS)
        lines.append(f"{system:8}{found.total():4}  {cells}")
    return "\n".join(lines)


def rows(system: str, *, quick: bool = False) -> list[Row]:
    """Return the rows of a system; `quick`: those that are given or exact, which take no time.

    Raises:
        KeyError: a key that neither the model nor NAME.py has.
    """
    module = import_module(f"validation.seeds.{system}")
    if quick:
        lines = [line for line in entries(system) if line["verdict"] in ("given", "exact")]
        return [_row(module.MODEL, module.quick(), line) for line in lines]
    known = module.quick() | module.values()
    return [_row(module.MODEL, known, line) for line in entries(system)]


def _row(model: str, known: Mapping[str, float | str], line: dict[str, str]) -> Row:
    key = line["key"]
    computed: float | str | None = None
    if key.startswith("@"):
        computed = _given(model, key[1:], line["unit"])
    elif key:
        computed = known[key]
    return Row(
        line["where"],
        line["what"],
        line["printed"],
        line["unit"],
        computed,
        line["verdict"],
        line["reason"],
        _runs(known, line["runs"]),
    )


def _runs(known: Mapping[str, float | str], text: str) -> str:
    return str(known[text[1:]]) if text.startswith("@") else text


def _given(model: str, address: str, unit: str) -> float | str:
    """A value of the model file, in the unit of the row."""
    file, _, path = address.rpartition(":")
    value: Any = loaded(file or model)
    for name in path.split("."):
        value = value[int(name)] if name.isdigit() else value[name] if isinstance(value, dict) else getattr(value, name)
    return value if isinstance(value, str) else float(value) / _SCALE.get(unit, 1.0)


@cache
def loaded(name: str) -> rg.Model:
    """A model of models/, by the name of its file."""
    return rg.load(MODELS / f"{name}.toml")


def changed(model: rg.Model, **tables: Mapping[str, Any]) -> rg.Model:
    """A model with some keys changed: changed(model, meshes={"left": {"backlash": None}}); None takes a key out."""
    data = model.model_dump(exclude_none=True)
    for table, parts in tables.items():
        for name, keys in parts.items():
            target = data[table] if name == "" else data[table][name]
            for key, value in keys.items():
                if value is None:
                    target.pop(key, None)
                else:
                    target[key] = value
    return rg.Model(**data)
