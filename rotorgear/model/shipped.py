"""The models that come with the package: where they lie, their titles, and the files that belong to them."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rotorgear.errors import AnalysisError
from rotorgear.files.own import text_of
from rotorgear.quantity import did_you_mean

_PACKAGE = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class ShippedModel:
    """A model that comes with the package.

    Attributes:
        name: by which `rotorgear new --source` takes it.
        title: what it is.
        path: its file.
        companions: files that it names (meshes, measured flanks), and the lines of its rig; they lie beside it.
    """

    name: str
    title: str
    path: Path
    companions: tuple[Path, ...]


def models() -> tuple[ShippedModel, ...]:
    """Return the models that come with the package, by name: examples to look at and to start from."""
    # The wheel carries a copy of the folder inside the package, a clone has it at its top.
    inside = _PACKAGE / "models"
    folder = inside if inside.is_dir() else _PACKAGE.parent / "models"
    found = []
    for path in sorted(folder.glob("*.toml")):
        data = tomllib.loads(text_of(path))
        named = {path.with_name(text) for text in _texts(data) if text.endswith((".msh", ".inp", ".csv", ".npz"))}
        beside = sorted(file for file in {*named, path.with_name(f"{path.stem}_rig.csv")} if file.is_file())
        found.append(ShippedModel(path.stem, str(data.get("title", "")), path, tuple(beside)))
    return tuple(found)


def shipped_model(name: str) -> ShippedModel:
    """Return one of `models()`.

    Raises:
        AnalysisError: none has this name.
    """
    known = {model.name: model for model in models()}
    if name not in known:
        guess = did_you_mean(name, known)
        hint = f"{guess} " if guess else ""
        raise AnalysisError(f"no model '{name}' comes with rotorgear: {hint}`rotorgear models` lists them")
    return known[name]


def _texts(value: Any) -> Iterator[str]:
    """All texts in the tables of a file, at any depth."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for entry in value.values() if isinstance(value, dict) else value:
            yield from _texts(entry)
