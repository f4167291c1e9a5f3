"""Who knows what of force laws: nothing outside forces/ asks what a law is, and solvers have never heard of gears."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from rotorgear.forces import registry
from tests.paths import ROOT

PACKAGE = ROOT / "rotorgear"
LAWS = {registry.law_of(name).__name__ for name in registry.names()}
# The parts of a model are made into laws here, bearings by their geometry, and nowhere else.
MADE_IN = re.compile(r"(system/(local|local_\w+)|model/parts/bearings/\w+)\.py")
WORDS = re.compile(r"\b(flanks?|mesh(es)?|teeth|tooth|bearings?|gears?|pinions?)\b", re.IGNORECASE)


def names_of_laws(source: str) -> Iterator[str]:
    """Every place where code speaks of a law by its class: as a name, an attribute, an import, or a string of it."""
    for node in ast.walk(ast.parse(source)):
        found = {
            ast.Name: lambda n: n.id,
            ast.Attribute: lambda n: n.attr,
            ast.alias: lambda n: n.name.rpartition(".")[2],
            ast.Constant: lambda n: n.value,
        }.get(type(node))
        if found and found(node) in LAWS:
            yield f"{getattr(node, 'lineno', 0)}: {found(node)}"


def sources(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.py"))


def test_only_forces_and_what_makes_laws_of_parts_name_their_classes() -> None:
    named = {
        f"{file.relative_to(PACKAGE).as_posix()}:{place}"
        for file in sources(PACKAGE)
        if file.parent.name != "forces" and not MADE_IN.fullmatch(file.relative_to(PACKAGE).as_posix())
        for place in names_of_laws(file.read_text(encoding="utf-8"))
    }
    assert named == set()


def test_nothing_asks_a_law_what_it_is() -> None:
    asked = re.compile(r"isinstance\([^()]*\blaw\b|type\(law\)\.__name__")
    found = [
        f"{file.relative_to(PACKAGE)}: {line}"
        for file in sources(PACKAGE)
        if file.parent.name != "forces"
        for line in asked.findall(file.read_text(encoding="utf-8"))
    ]
    assert found == []


def test_the_search_for_names_of_laws_finds_them() -> None:
    text = "from rotorgear.forces.mesh_contact import MeshContact\nif type(x).__name__ == 'BallBearing': pass\n"
    assert list(names_of_laws(text)) == ["1: MeshContact", "2: BallBearing"]


def test_solvers_have_no_word_of_gears() -> None:
    said = [
        f"{file.relative_to(PACKAGE)}:{number}: {line.strip()}"
        for file in sources(PACKAGE / "solvers")
        for number, line in enumerate(file.read_text(encoding="utf-8").replace("rotorgear", "").splitlines(), 1)
        if WORDS.search(line)
    ]
    assert said == []
