"""Reads the cases: a case is a folder of validation/cases/ (or of validation/measured/, what others measured).

Its `expected.csv` has one line a number.

Columns of expected.csv:

    model           file of the model, from the case's folder; or a Python program with a function measure(quantity, mode)
    speed           of the input shaft, with its unit; empty: an undamped analysis at standstill
    elements        basic elements in each piece of a section; "5 > 10" or "5 > 10 > 20" for what needs several meshes
    accuracy        refine until every frequency is estimated to be within it, in place of elements
    mesh_stiffness  in N/m, in place of that of all meshes in the file; "1e11 > 1e12" as above; empty: as in the file
    quantity        what is compared, as quantities.py lists it; or "order of" or "extrapolated" and the name of a modal quantity
    mode            number of the elastic mode, or of the order of a forced response; "1+2": a pair that must agree; "2-1": the
                    difference of two
    expected        a number as its source prints it, ">= 3.4", or a word
    tolerance       relative, "1e-5"; "abs 0.1"; "2e-4 or half digit": the larger of 2e-4 and half a unit of the last printed
                    digit; "bound" with ">=", "exact" for a word; empty: shown, but not judged (the note says why)
    source          where the expected number comes from
    note            what a reader should know
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rotorgear.errors import AnalysisError
from rotorgear.old_names import warn_old

FOLDERS = tuple(Path(__file__).resolve().parent / name for name in ("cases", "measured"))
SHOWN_ONLY = float("inf")
# What the rows are made from, for docs/machinery/made.py.
INPUTS = (
    "validation/cases/*/*.csv",
    "validation/cases/*/*.toml",
    "validation/cases/*/*.py",
    "validation/measured/*/*.csv",
    "validation/measured/*/*.toml",
    "validation/measured/*/*.py",
)


@dataclass(frozen=True)
class Expectation:
    """One line of expected.csv, as it stands there, with `elements` and `mesh_stiffness` split at ">"."""

    model: str
    speed: str
    elements: tuple[int, ...]
    accuracy: float | None
    mesh_stiffness: tuple[float, ...]
    quantity: str
    mode: str
    expected: str
    tolerance: str
    source: str
    note: str

    @property
    def number(self) -> float:
        """The expected number, without the sign of a bound.

        Raises:
            ValueError: a word is expected.
        """
        return float(self.expected.removeprefix(">="))

    @property
    def is_bound(self) -> bool:
        """Whether more than the expected number is fine as well."""
        return self.expected.startswith(">=")

    @property
    def is_word(self) -> bool:
        """Whether a word is expected, such as "backward"."""
        return self.expected.isalpha()

    @property
    def absolute(self) -> bool:
        """Whether the tolerance is that of the difference itself."""
        return self.tolerance.startswith("abs ")

    def allowed(self) -> float:
        """The allowed error: relative, or absolute where `absolute` says so."""
        if not self.tolerance:
            return SHOWN_ONLY
        if self.tolerance in ("bound", "exact"):
            return 0.0
        if self.absolute:
            return float(self.tolerance.removeprefix("abs "))
        relative = float(self.tolerance.removesuffix("or half digit"))
        return max(relative, self._half_digit()) if self.tolerance.endswith("or half digit") else relative

    def _half_digit(self) -> float:
        decimals = len(self.expected.partition(".")[2])
        return 0.5 * 10.0**-decimals / abs(self.number)


@dataclass(frozen=True)
class Case:
    """A case: its name, title, the text of its README below the title, and what it expects."""

    name: str
    title: str
    text: str
    expectations: tuple[Expectation, ...]

    @property
    def folder(self) -> Path:
        """Where its files are."""
        return folder_of(self.name)


def names() -> list[str]:
    """Return the names of all cases, those of measured machines last."""
    return [name for folder in FOLDERS for name in sorted(path.parent.name for path in folder.glob("*/expected.csv"))]


def folder_of(name: str) -> Path:
    """The folder of a case."""
    return next(folder / name for folder in FOLDERS if (folder / name / "expected.csv").is_file())


def read_case(name: str) -> Case:
    """Read one case from its folder."""
    folder = folder_of(name)
    title, _, text = (folder / "README.md").read_text(encoding="utf-8").partition("\n")
    with (folder / "expected.csv").open(encoding="utf-8", newline="") as file:
        lines = tuple(_expectation(row) for row in csv.DictReader(file))
    return Case(name, title.removeprefix("# ").strip(), text.strip(), lines)


def _expectation(row: dict[str, str]) -> Expectation:
    given = {key: value.strip() for key, value in row.items()}
    elements = tuple(int(part) for part in given.pop("elements").split(">") if part)
    stiffness = tuple(float(part) for part in given.pop("mesh_stiffness").split(">") if part)
    accuracy = given.pop("accuracy")
    return Expectation(
        elements=elements, accuracy=float(accuracy) if accuracy else None, mesh_stiffness=stiffness, **given
    )


# The names of the first versions, read for the last time in this one.
_FORMER_NAMES = {
    "a1": "timoshenko_beam",
    "a2": "axial_and_torsional_bars",
    "a4": "spinning_shaft",
    "b1": "two_disk_rotor",
    "b2": "three_disk_rotor",
    "b4": "jeffcott_rotor",
    "c1": "turbo_alternator",
    "c2": "marine_turbines",
    "c3": "torsional_pair_and_chain",
    "c8": "rigid_helical_pair",
    "d1": "newmark_methods",
    "d2": "dead_zone_free",
    "d3": "backlash_forced",
    "d4": "lyapunov_exponents",
    "d5": "meissner_equation",
    "d6": "contact_energy",
    "e1": "helical_geometry",
    "e2": "iso6336_stiffness",
    "e4": "tooth_fe_contact",
    "f1": "ball_bearing",
    "f3": "roller_bearing",
    "f5": "journal_whirl",
    "g1": "dynamic_factor",
    "g2": "teeth_at_rest",
    "r1": "beam_sensors",
    "t1": "split_torque_lines",
}


def read_cases(wanted: Sequence[str] = ()) -> list[Case]:
    """Read the named cases, all where none is named.

    Raises:
        AnalysisError: there is no case of that name.
    """
    known = names()
    chosen: dict[str, None] = {}  # in order, each once
    for name in wanted:
        present = _FORMER_NAMES.get(name.lower(), name.lower())
        if present not in known:
            raise AnalysisError(f"no validation case '{name}'; there are {', '.join(known)}")
        if present != name.lower():
            warn_old("validation case", name, present)
        chosen[present] = None
    return [read_case(name) for name in chosen or known]
