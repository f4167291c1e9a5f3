"""Addresses of values in a model, such as "bearings.left.stiffness" or "shafts.rotor.sections[0].length", as errors write them.

A place in a list may also be written with a dot, "sections.0.length", and "*" stands for all names or places there.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

from rotorgear.errors import ModelError, Problem
from rotorgear.files.numbers import is_count
from rotorgear.forces.designations import bore_of, inner_geometry
from rotorgear.model.parts.fields import Part
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import did_you_mean

Place = tuple[str | int, ...]


def tables_of(model: Tables) -> dict[str, Any]:
    """The tables of a model as plain values in SI, as a file would hold them; what is not given is not there."""
    data: dict[str, Any] = json.loads(model.model_dump_json(exclude_none=True))
    return data


def places_of(data: Mapping[str, Any], address: str) -> list[Place]:
    """Where an address leads in the tables of a model; several places where it has a "*".

    The last key may be missing: it may have its default, and the checks of the model know all names.

    Raises:
        ModelError: it leads nowhere, with the nearest valid name.
    """
    parts = re.sub(r"\[(.*?)\]", r".\1", address).split(".")
    places: list[Place] = [()]
    for depth, part in enumerate(parts):
        last = depth == len(parts) - 1
        places = [(*place, key) for place in places for key in _keys(value_at(data, place), part, address, last)]
    if not places:
        raise _nowhere(address, "the model has nothing there")
    return places


def value_at(data: Any, place: Place) -> Any:
    """The value or table at a place."""
    for key in place:
        data = data[key]
    return data


def changed(data: Mapping[str, Any], changes: Iterable[tuple[list[Place], Any]]) -> dict[str, Any]:
    """A copy of the tables of a model with other values at some places; None takes a key away."""
    # Through text and back: the fastest deep copy of plain values.
    copy: dict[str, Any] = json.loads(json.dumps(data))
    for places, value in changes:
        _put(copy, places, value)
    return copy


def _put(data: dict[str, Any], places: Iterable[Place], value: Any) -> None:
    """Write a value to some places of the tables of a model; None takes the key away."""
    for place in places:
        owner = value_at(data, place[:-1])
        key: Any = place[-1]
        if value is None and isinstance(owner, dict):
            owner.pop(key, None)
            continue
        old = owner[key] if isinstance(owner, list) else owner.get(key)
        if isinstance(old, dict) and "radial" in old and isinstance(value, str | int | float):
            # One number for the stiffness or damping of a bearing is the radial one, as on a drawing; the others stay.
            old["radial"] = value
            continue
        if key == "designation" and isinstance(value, str):
            # What the former designation filled is no word of the file: the new one fills it again.
            for filled, known in {**inner_geometry(str(old))[0], "bore": bore_of(str(old))}.items():
                if owner.get(filled) == known:
                    del owner[filled]
        # Where a whole number stands, a whole float is one too: numbers of teeth and harmonics are swept in floats.
        whole = isinstance(old, int) and isinstance(value, float) and value.is_integer()
        owner[key] = int(value) if whole else value


def with_values(model: Tables, values: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a model with other values at some addresses, one after the other: a part that is added has its keys then.

    Raises:
        ModelError: addresses that lead nowhere, all at once.
    """
    data = tables_of(model)
    problems: list[Problem] = []
    for address, value in values.items():
        given = value.model_dump(mode="json", exclude_none=True) if isinstance(value, Part) else value
        try:
            places = places_of(data, address)
        except ModelError as error:
            problems += error.problems
            continue
        # Each place its own copy: what a later address changes in one is neither another's nor the caller's.
        for place in places:
            _put(data, [place], deepcopy(given))
    if problems:
        raise ModelError(problems)
    return data


def _keys(value: Any, part: str, address: str, last: bool) -> list[str | int]:
    """Keys of a table, or places of a list, that a part of an address means."""
    if isinstance(value, list):
        if part == "*":
            return list(range(len(value)))
        if is_count(part) and int(part) < len(value):
            return [int(part)]
        raise _nowhere(address, f"'{part}' is no place in a list of {len(value)} (the first is 0)")
    if isinstance(value, dict):
        if part == "*":
            return list(value)
        if part in value or last:
            return [part]
        hint = did_you_mean(part, value, f"there are {', '.join(value) or 'none'}")
        raise _nowhere(address, f"the model has no '{part}' there", hint)
    raise _nowhere(address, "nothing lies below a number or a text")


def _nowhere(address: str, text: str, hint: str = "") -> ModelError:
    return ModelError([Problem(address, "", text, hint)])
