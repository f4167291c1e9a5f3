"""Kinds of bearings answer for themselves: a kind stands in its law, its geometry, its record, and a line each that names it."""

from __future__ import annotations

import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from rotorgear.forces.registry import law_of, names
from rotorgear.model.parts.bearings.geometry import BearingGeometry
from rotorgear.model.parts.supports import Bearing
from rotorgear.results.bearing import BearingSheet
from tests.models import disk_in_bearing
from tests.paths import ROOT

THRUST = {
    "forces/registry.py",
    "forces/thrust_film.py",
    "model/parts/bearings/thrust.py",
    "model/parts/supports.py",
    "results/bearing.py",
}
# Rolling bearings that take thrust by their designation, of the model file and of REXS: another kind, with the same word.
ROLLING = {"forces/designations.py", "rexs/bearings.py"}
WORD = re.compile(r"(?<![A-Za-z])(thrust|Thrust)(?![a-z])")
PULL = "[300.0, 400.0, 0.0]"


def code_of(file: Path) -> Iterator[str]:
    """Names and texts of a file, without comments and docstrings: the first word of a statement that is a text is one."""
    start = True
    for token in tokenize.generate_tokens(io.StringIO(file.read_text(encoding="utf-8")).readline):
        if token.type in (tokenize.NAME, tokenize.STRING) and not (start and token.type == tokenize.STRING):
            yield token.string
        if token.type != tokenize.COMMENT:
            start = token.type in (tokenize.NEWLINE, tokenize.NL, tokenize.INDENT, tokenize.DEDENT)


def test_a_thrust_bearing_stands_in_five_files() -> None:
    package = ROOT / "rotorgear"
    found = {str(file.relative_to(package)) for file in package.rglob("*.py") if any(map(WORD.search, code_of(file)))}
    assert found - ROLLING == THRUST


def test_the_walk_sees_names_and_texts_and_no_prose(tmp_path: Path) -> None:
    file = tmp_path / "part.py"
    for text, told in (
        ('"""A thrust."""', False),
        ("x = 1  # a thrust", False),
        ('def f():\n    """Of a thrust."""', False),
        ("x = part.thrust", True),
        ("from forces.thrust_film import ThrustFilm", True),
        ('part = {"thrust": 1}', True),
        ("ThrustState = int", True),
        ("thrusting = 1", False),
    ):
        file.write_text(text, encoding="utf-8")
        assert any(map(WORD.search, code_of(file))) is told, text


def test_the_kinds_are_the_fields_of_a_bearing_that_have_a_geometry() -> None:
    kinds = Bearing.kinds()
    assert {"rolling", "journal", "thrust"} <= set(kinds)
    assert {"stiffness", "table", "pedestal"}.isdisjoint(kinds)
    assert all(issubclass(kind, BearingGeometry) for kind in kinds.values())
    assert all(kind.ring in kind.model_fields for kind in kinds.values())


def test_a_bearing_has_the_geometry_that_its_file_gives() -> None:
    keys = 'journal = { diameter = "60 mm", length = "30 mm", clearance = "60 um", viscosity = "20 mPa s" }'
    film = disk_in_bearing(keys, PULL).bearings["front"]
    assert film.geometries == {"journal": film.journal}
    assert film.film is film.geometry
    spring = disk_in_bearing('stiffness = { radial = "1e8 N/m" }', PULL).bearings["front"]
    assert (spring.geometry, spring.film, spring.has_law) == (None, None, False)
    assert list(spring.beside("journal")) == ["stiffness"]


@pytest.mark.parametrize("name", names())
def test_what_is_inside_a_law_has_its_record_in_the_sheet(name: str) -> None:
    for law in law_of(name).examples():
        d = np.zeros(law.components)
        inside = law.settled(d).inside(d, speed=100.0)
        if inside is None:
            continue
        declared = BearingSheet.declarations[inside.told_as]
        records = [declared.record(**row) for row in inside.told(law, np.ones(law.components), d, 100.0)]
        assert declared.axes or len(records) == 1
