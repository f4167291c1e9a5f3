"""The model: everything a file describes, as named, frozen parts that are checked as a whole."""

from __future__ import annotations

import hashlib
import json
import re
import warnings
from collections.abc import Callable, Hashable, Mapping, Sequence
from functools import cached_property
from html import escape
from operator import is_not
from pathlib import Path
from typing import Any

from pydantic import BaseModel, Field, ValidationError

from rotorgear.errors import ModelError
from rotorgear.files.bounds import MESH
from rotorgear.files.read import UnreadableError, digest_of_named
from rotorgear.model.address import value_at, with_values
from rotorgear.model.checks.check import find_problems
from rotorgear.model.checks.repair import repaired
from rotorgear.model.layout.carriers import repeated, says_less
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.state import State
from rotorgear.model.layout.torque_flow import torque_flow
from rotorgear.model.parts.carrier import MARK
from rotorgear.model.parts.fields import MOTIONS, Name, Part
from rotorgear.model.parts.shaft import Shaft
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import counted

SCHEMA_VERSION = 1


class Model(Tables):
    """A gearbox or rotor: shafts and what is on them.

    Built from Python objects or from the tables of a file (`rotorgear.load`). Construction checks everything at once.

    Raises:
        ModelError: with every problem that was found, each with address, value and what was expected.
    """

    shafts: dict[Name, Shaft] = Field(min_length=1, description="shafts")

    # Of a model with planets: the tables as the file has them, and what single planets have otherwise.
    _once: dict[str, Any] = {}  # noqa: RUF012 - pydantic gives each model its own
    _overrides: dict[str, dict[str, Any]] = {}  # noqa: RUF012

    def __init__(self, /, **data: Any) -> None:
        given, overrides = without_overrides(data)
        try:
            BaseModel.__init__(self, **given)
        except ValidationError:
            problems, rest, broken = repaired(given)
            raise ModelError([*problems, *find_problems(rest, overrides, broken)]) from None
        if says_less(self):
            once = {name: getattr(self, name) for name in type(self).model_fields}
            whole, problems = repeated(self, overrides)
            # The fields of a frozen part: what the analyses see are the parts of the whole gearbox.
            self.__dict__.update({name: getattr(whole, name) for name in once})
            self._once = {name: part for name, part in once.items() if part is not getattr(self, name)}
            self._overrides = overrides
        problems = find_problems(self.written, overrides, layout=self.layout)
        if problems:
            raise ModelError(problems)

    @property
    def written(self) -> Model:
        """The parts as the file has them: planets once, and not on every pin. It is the model itself where it has none."""
        if not self._once:
            return self
        twin = self.model_copy(update=self._once)
        twin._once = {}
        return twin

    def model_dump(self, **options: Any) -> dict[str, Any]:
        """The fields as the file has them; see pydantic."""
        fields = BaseModel.model_dump(self.written, **options)
        for table, parts in self._overrides.items():
            fields[table] |= {name: dict(keys) for name, keys in parts.items()}
        return fields

    def model_dump_json(self, **options: Any) -> str:
        """The same as a text; see pydantic."""
        if not self._overrides:
            return BaseModel.model_dump_json(self.written, **options)
        return json.dumps(self.model_dump(mode="json", **options))

    def with_(self, address: str | Mapping[str, Any], value: Any = None) -> Model:
        """Return this model with another value at an address, or with several; checked like a new one.

            model.with_("bearings.left.stiffness", "2e8 N/m")
            model.with_({"shafts.rotor.sections[0].length": "80 mm", "operation.speed": "3000 rpm"})

        Several are written one after the other, so a part may be added and its keys changed below.

        Args:
            address: of a value or a table, as errors write it; "*" stands for all names or places there. Or several addresses,
                each with its value.
            value: as in a model file: a number in SI, a text with its unit, a table or a part; None takes away what is there.

        Returns:
            A new model. Nothing that was derived from this one goes along.

        Raises:
            ModelError: an address that leads nowhere, or values that don't fit, all at once.
        """
        values = {address: value} if isinstance(address, str) else address
        changed = Model(**with_values(self, values))
        if self.source is not None:
            changed.remember(*self.source)
        return changed

    @property
    def source(self) -> tuple[str, str] | None:
        """The text of the file that the model, or what it was made of, came from, and its folder; None without one."""
        return self.__dict__.get("_source_text")

    def remember(self, text: str, folder: str | Path) -> None:
        """Keep the text of the file that the model came from: no part of the model, but of what `to_toml` writes."""
        self.__dict__["_source_text"] = (text, str(folder))

    def to_toml(self, path: str | Path) -> Path:
        """Write the model as a file that reads as the same model.

        Of a model that came from a file, or that `with_` made of one, comments, order and units stay, and only what differs is
        written anew; another model is written in SI.

        Args:
            path: of the file, such as "gearbox.toml".

        Raises:
            WriteError: the file can't be written. MissingExtraError: tomlkit is not installed.
        """
        from rotorgear.model.text import write_model  # what reads a model need not know how one is written

        return write_model(self, path, self.source)

    def __repr__(self) -> str:
        return f"Model({self.title!r}: {self._counts()})"

    def _repr_html_(self) -> str:
        return f"<b>{escape(self.title) or 'Model'}</b><br>{escape(self._counts())}"

    def _counts(self) -> str:
        """How many parts of each kind there are."""
        written = self.written
        tables = {name: getattr(written, name) for name in type(self).model_fields}
        return ", ".join(counted(len(value), key) for key, value in tables.items() if isinstance(value, dict) and value)

    @cached_property
    def layout(self) -> Layout:
        """What follows from the parts before any load."""
        return Layout(self)

    @cached_property
    def known_hash(self) -> list[tuple[tuple[object, ...], str]]:
        """The hash of a model that reads no files, once it has been asked for, behind its parts then (`model_hash.py`)."""
        return []

    @cached_property
    def states(self) -> dict[Hashable, State]:
        """The states that were asked for, by what they are about: several analyses of one state find it once."""
        return {}

    def torque_flow(self, direction: int | None = None) -> State:
        """Forces, working flanks and mesh stiffnesses of the torque flow, made once for each sense of rotation.

        Args:
            direction: +1 or -1, sense about +z in which the reference shaft turns. None: that of the operating speed.

        Raises:
            AnalysisError: a stiffness model that can't do its teeth.
            ConvergenceError: in a loop, mesh stiffness and torque split don't come to agree.
        """
        sense = direction or self.layout.direction
        if sense not in self.states:
            self.states[sense] = torque_flow(self.layout, sense)
        return self.states[sense]

    def mean_load(self, direction: int | None = None) -> State:
        """Old name of `torque_flow`."""
        warnings.warn("Model.mean_load is now Model.torque_flow", FutureWarning, stacklevel=2)
        return self.torque_flow(direction)


def without_overrides(data: dict[str, Any]) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """The tables of a file without the keys of single planets, such as [meshes."sun_planet#2"], and those keys by table."""
    if not data.get("carriers"):
        return data, {}
    given = dict(data)
    overrides = {}
    for table, parts in data.items():
        named = (
            [name for name, keys in parts.items() if MARK in name and isinstance(keys, dict)]
            if _is_table(parts)
            else []
        )
        if named:
            given[table] = {name: part for name, part in parts.items() if name not in named}
            overrides[table] = {name: parts[name] for name in named}
    return given, overrides


def _is_table(parts: Any) -> bool:
    return isinstance(parts, dict) and all(isinstance(name, str) for name in parts)


__all__ = ["MOTIONS", "SCHEMA_VERSION", "Model"]


# Stands for a part while everything else is written, with its number; no text of a model holds a null character.
_ELSEWHERE = "\0"
# Keys of a gear body that only a mesh has.
_OF_MESHES = ("connection", "damping_ratio", "mass_tolerance")


def model_hash(model: Model) -> str:
    """Return the SHA-256 of the canonical JSON of a model's fields, in SI units: 64 hexadecimal digits.

    Of a casing and of a gear body what its files hold counts, not where they lie.

    Canonical: keys in alphabetical order and no blanks, so that it does not matter how the file was written or in which order
    its tables stand; Python writes the shortest digits that give a float back.
    """
    if model.casings or any(gear.body.mesh is not None for gear in model.gears.values()):
        return _hash(model)  # it reads files, which may change
    # Parts are frozen, but not the tables that hold them: the hash is kept for these parts only.
    found: list[object] = []
    for name in type(model).model_fields:
        value = getattr(model, name)
        found += [*value.keys(), *value.values()] if isinstance(value, dict) else [value]
    parts = tuple(found)
    kept = model.known_hash
    if not kept or len(kept[0][0]) != len(parts) or any(map(is_not, kept[0][0], parts)):
        kept[:] = [(parts, _hash(model))]
    return kept[0][1]


def hashes_over(model: Model, places: Sequence[tuple[str, ...]]) -> Callable[[Sequence[Part]], str]:
    """What gives the `model_hash` of a model with other parts at some places; what else it is made of is written once.

    Everything beside these parts stays as it is in the model, whose hash is not taken from files again.

    Args:
        model: without planets. places: of parts whose fields a hash takes as they are, such as ("operation",) or
            ("meshes", "pair").
    """
    fields = _hashed_fields(model)
    for number, place in enumerate(places):
        value_at(fields, place[:-1])[place[-1]] = f"{_ELSEWHERE}{number}"
    mark = re.escape(_canonical(_ELSEWHERE)[:-1])
    before, *rest = re.split(f'{mark}([0-9]+)"', _canonical(fields))
    begun = hashlib.sha256(before.encode("utf-8"))
    pieces = [(int(number), text.encode("utf-8")) for number, text in zip(rest[::2], rest[1::2], strict=True)]

    def of(parts: Sequence[Part]) -> str:
        digest = begun.copy()
        for number, text in pieces:
            own = parts[number].model_dump(mode="json", exclude_none=True)
            digest.update(_canonical(own).encode("utf-8"))
            digest.update(text)
        return digest.hexdigest()

    return of


def _hash(model: Model) -> str:
    """The hash of the fields and files as they are now."""
    return hashlib.sha256(_canonical(_hashed_fields(model)).encode("utf-8")).hexdigest()


def _canonical(fields: Any) -> str:
    return json.dumps(fields, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def _hashed_fields(model: Model) -> dict[str, Any]:
    """The fields that a hash is taken of, with digests in place of files."""
    fields: dict[str, Any] = model.model_dump(mode="json", exclude_none=True)
    for casing in fields["casings"].values():
        files = {**casing["mesh"], **({"matrices": casing["matrices"]} if "matrices" in casing else {})}
        casing |= {"files": {name: _digest(Path(path)) for name, path in files.items()}, "mesh": [], "matrices": ""}
    # One planet that differs has those keys alone that it has otherwise.
    for gear in (gear for gear in fields["gears"].values() if "body" in gear):
        body = gear["body"]
        if "mesh" in body:
            body["mesh"] = _digest(Path(body["mesh"]))
        else:  # a gear without a mesh keeps the name that it had before there were any
            gear["body"] = {key: value for key, value in body.items() if key not in _OF_MESHES}
    # A model keeps the name that it had before there were keys which it does not give.
    for table, key, usual in (("shafts", "axis", [0.0, 0.0, 1.0]), ("gears", "spiral_angle", 0.0)):
        for part in fields[table].values():
            if part.get(key) == usual:
                del part[key]
    if not fields["casings"]:
        del fields["casings"]  # a model without them keeps the name that it had before there were any
    for table in ("scatter", "carriers"):
        if not fields[table]:
            del fields[table]
    return fields


def _digest(path: Path) -> str:
    """SHA-256 of what a file holds; of one that is not there, which no analysis gets past, its name."""
    try:
        return digest_of_named(path, MESH.most_bytes)
    except UnreadableError:
        return str(path)
