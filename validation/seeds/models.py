"""The models of the five systems, by the names of their files in models/, and with some of their keys changed."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import rotorgear as rg

MODELS = Path(__file__).resolve().parents[2] / "models"


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
