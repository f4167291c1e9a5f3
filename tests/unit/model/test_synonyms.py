"""Words of the field for keys: each leads to a key of the file, and an unknown key is answered with it."""

from __future__ import annotations

import re

import pytest

import rotorgear as rg
from rotorgear.model.parts.synonyms import GROUPS, MEANT, meant
from tests.paths import ROOT

DEFINITIONS = rg.schema()["$defs"]
KEYS = {key for one in DEFINITIONS.values() for key in one.get("properties", {})} | set(rg.schema()["properties"])
ROTOR = """
    [shafts.rotor]
    material = "steel"
    sections = [{ length = "1 m", outer_diameter = "40 mm", WORD = "10 mm" }]
"""


def test_every_word_leads_to_a_key_that_there_is() -> None:
    assert len(MEANT) >= 60
    assert {key for keys in MEANT.values() for key in keys} <= KEYS


TABLES = [set(one.get("properties", {})) for one in (*DEFINITIONS.values(), rg.schema())]


@pytest.mark.parametrize("word", list(MEANT))
def test_each_word_is_answered_with_each_of_its_keys_in_a_table_that_has_it(word: str) -> None:
    """A word that is a key of all those tables, or of which an earlier key is always there, would never be answered so."""
    for key in MEANT[word]:
        assert any(key in keys and word not in keys and meant(word, keys) == key for keys in TABLES), key


def test_the_page_has_each_word_once() -> None:
    page = (ROOT / "docs" / "coming_from.md").read_text(encoding="utf-8")
    rows = [line for line in page.split("\n## ", 1)[1].splitlines() if line.startswith("| `")]
    words = [word for row in rows for word in re.findall(r"`([^`]+)`", row.split("|")[1])]
    assert sorted(words) == sorted(MEANT)
    assert len(words) == sum(map(len, GROUPS.values())), "a word in two groups"


@pytest.mark.parametrize(
    ("word", "part", "key"),
    [
        ("inner_diameter", "Section", "bore"),
        ("OD", "Disk", "outer_diameter"),
        ("E", "Material", "youngs_modulus"),
        ("Ip", "Disk", "polar_inertia"),
        ("kxx", "StiffnessMatrix", "x"),
        ("kxx", "Bearing", "stiffness"),
        ("module", "Gear", "normal_module"),
        ("Face width", "Gear", "width"),
        ("n_balls", "RollingElements", "elements"),
        ("eccentricity", "Unbalance", "magnitude"),
    ],
)
def test_a_word_leads_to_the_key_of_its_table(word: str, part: str, key: str) -> None:
    assert meant(word, DEFINITIONS[part]["properties"]) == key


def problems_of(text: str) -> list[str]:
    with pytest.raises(rg.ModelError) as told:
        rg.loads(text)
    return list(map(str, told.value.problems))


def test_an_unknown_key_is_answered_with_what_is_meant() -> None:
    place = "shafts.rotor.sections[0]"
    assert problems_of(ROTOR.replace("WORD", "inner_diameter")) == [
        f"{place}.inner_diameter: unknown key (here that is 'bore')"
    ]
    assert problems_of(ROTOR.replace("WORD", "bored")) == [f"{place}.bored: unknown key (did you mean 'bore'?)"]
    # What is required and stands there by another word is not missing as well.
    assert problems_of(ROTOR.replace("length", "L").replace("WORD", "bore")) == [
        f"{place}.L: unknown key (here that is 'length')"
    ]


def test_a_key_of_another_table_says_of_which() -> None:
    text = ROTOR.replace("WORD", "bore")
    assert problems_of(f"gravity = [0, -9.81, 0]\n{text}") == ["gravity: unknown key (it is a key of [operation])"]
