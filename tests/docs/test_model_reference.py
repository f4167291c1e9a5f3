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
    for title, part in GENERATOR.SECTIONS:
        table = text.split(f"\n## {title}\n")[1].split("\n## ")[0]
        rows = {row.split("|")[1].strip(): row.split("|") for row in table.splitlines() if row.startswith("| `")}
        assert list(rows) == [f"`{name}`" for name in part.model_fields], title
        assert all(row[-2].strip() for row in rows.values()), title
