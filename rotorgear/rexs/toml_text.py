"""Tables of a model file as text, with a comment beside each value that needs one."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass, field

# Digits of a written number: those of a double that rounding in the unit does not touch.
_DIGITS = 12
# A longer comment is above its line.
_BESIDE = 70
_UNITS = {
    "length": ("mm", 1e-3),
    "angle": ("deg", 0.017453292519943295),
    "speed": ("rpm", 0.10471975511965977),
    "stiffness": ("N/m", 1.0),
    "rotational_stiffness": ("N m/rad", 1.0),
    "torque": ("N m", 1.0),
    "force": ("N", 1.0),
    "modulus": ("GPa", 1e9),
    "density": ("kg/m^3", 1.0),
    "mass": ("kg", 1.0),
    "inertia": ("kg m^2", 1.0),
    "unbalance": ("g mm", 1e-6),
}


def quantity(value: float, kind: str) -> str:
    """A number in SI as a text in the unit that engineers use: 0.053 m is "53 mm"."""
    unit, factor = _UNITS[kind]
    return f'"{number(value / factor)} {unit}"'


def number(value: float) -> str:
    """A plain number."""
    shown = f"{value:.{_DIGITS}g}"
    return "0" if shown == "-0" else shown


def text(value: str) -> str:
    """A text in quotes."""
    return '"' + comment_line(value).replace("\\", "\\\\").replace('"', '\\"') + '"'


def row(**values: str) -> str:
    """An inline table of values that are texts already."""
    return "{ " + ", ".join(f"{key} = {value}" for key, value in values.items()) + " }"


@dataclass
class Table:
    """A table of the model file: its header, a comment above it, and rows of key, value and comment."""

    header: str
    remark: str = ""
    rows: list[tuple[str, str, str]] = field(default_factory=list)

    def add(self, key: str, value: str, comment: str = "") -> None:
        """Add a row; `value` is TOML already."""
        self.rows.append((key, value, comment))

    def lines(self) -> list[str]:
        """The table as lines."""
        out = [f"# {comment_line(part)}" for part in self.remark.splitlines()]
        out.append(f"[{self.header}]")
        for key, value, comment in self.rows:
            notes = comment.splitlines()
            beside = notes.pop() if len(notes) == 1 and len(notes[0]) <= _BESIDE else ""
            out += [f"# {comment_line(note)}" for note in notes]
            out.append(f"{key} = {value}" + (f"  # {comment_line(beside)}" if beside else ""))
        return out


def comment_line(words: str) -> str:
    """Words for a comment, with blanks in place of control characters, which TOML forbids."""
    return "".join(letter if letter.isprintable() else " " for letter in words)


class Names:
    """Names of parts that a model file takes, one for each component: letters, digits and underscores, and no two alike."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def of(self, wanted: str, kind: str, component_id: str) -> str:
        """A free name, as near as possible to that of the component."""
        plain = unicodedata.normalize("NFKD", wanted.replace("ß", "ss")).encode("ascii", "ignore").decode()
        name = re.sub(r"[^0-9A-Za-z]+", "_", plain).strip("_").lower()[:40] or f"{kind}_{component_id}"
        if name in self._taken:
            name = f"{name}_{component_id}"
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name
