"""The reference page of the model file covers every part and every key."""

from __future__ import annotations

import typing
from collections.abc import Iterator
from typing import Any

from machinery.snippets import ROOT
from pydantic import BaseModel
from update import load_generator

from rotorgear.model.model import Model

GENERATOR = load_generator(ROOT / "docs" / "generate_model_reference.py")


def parts(part: type[BaseModel], seen: set[type[BaseModel]]) -> Iterator[type[BaseModel]]:
    """Yield a class and every part class that its fields lead to."""
    if part in seen:
        return
    seen.add(part)
    yield part
    for field in part.model_fields.values():
        for inner in classes(field.annotation):
            yield from parts(inner, seen)


def classes(annotation: Any) -> Iterator[type[BaseModel]]:
    """Yield the part classes in an annotation, however deep."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for inner in typing.get_args(annotation):
        yield from classes(inner)


def test_every_part_that_a_model_can_hold_has_a_section() -> None:
    assert {part for _, part in GENERATOR.SECTIONS} == set(parts(Model, set()))


def test_every_key_of_a_part_stands_in_its_table_with_a_meaning() -> None:
    text = GENERATOR.pages()["docs/model_file.md"]
    tables = {title: rows_of(text, title) for title, _ in GENERATOR.SECTIONS}
    titles = {part: title for title, part in GENERATOR.SECTIONS}
    for title, part in GENERATOR.SECTIONS:
        shared = tables[titles[GENERATOR.AS_ANOTHER[part]]] if part in GENERATOR.AS_ANOTHER else {}
        # A key without a row of its own has that of the other part, whose section this one leads to.
        missing = [name for name in part.model_fields if f"`{name}`" not in tables[title]]
        assert not missing or f"](#{GENERATOR._anchor(titles[GENERATOR.AS_ANOTHER[part]])})" in text, title
        assert {f"`{name}`" for name in missing} <= shared.keys(), title
        assert list(tables[title]) == [f"`{name}`" for name in part.model_fields if name not in missing], title
        assert all(row[-2].strip() for row in tables[title].values()), title


def rows_of(text: str, title: str) -> dict[str, list[str]]:
    """The rows of a section's table by their keys."""
    table = text.split(f"\n## {title}\n")[1].split("\n## ")[0]
    return {row.split("|")[1].strip(): row.split("|") for row in table.splitlines() if row.startswith("| `")}


def test_choices_bounds_and_defaults_stand_with_their_keys() -> None:
    text = GENERATOR.pages()["docs/model_file.md"]
    assert rows_of(text, "[bearings.NAME]")["`at`"][2].split() == ['`"20', 'mm"`', '`"start"`', '`"end"`']
    assert '> 0 `"iso"`' in rows_of(text, "[meshes.NAME]")["`stiffness`"][2]
    assert rows_of(text, "rolling = { ... } of a bearing")["`clearance_class`"][2].count("`") == 10
    assert rows_of(text, "grids = [{ ... }] of a topography")["`deviation`"][2].strip() == 'rows of `"20 mm"`'
    assert rows_of(text, "[gears.NAME]")["`normal_pressure_angle`"][3].strip() == '`"20 deg"`'
