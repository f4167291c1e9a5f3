"""A name for a model that changes with every value in it."""

from __future__ import annotations

import hashlib
import json
from operator import is_not
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rotorgear.model.model import Model

# Keys of a gear body that only a mesh has.
_OF_MESHES = ("connection", "damping_ratio", "mass_tolerance")


def model_hash(model: Model) -> str:
    """Return the SHA-256 of the canonical JSON of a model's fields, in SI units: 64 hexadecimal digits.

    Of a casing and of a gear body what its files hold counts, not where they lie.

    Canonical: keys in alphabetical order and no blanks, so that it does not matter how the file was written or in which order
    its tables stand; Python writes the shortest digits that give a float back.
    """
    reads_files = model.casings or any(gear.body.mesh is not None for gear in model.gears.values())
    if reads_files:
        return _hash(model)
    # Parts are frozen, but not the tables that hold them: the hash is kept for these parts only.
    parts = _parts(model)
    kept = model.known_hash
    if not kept or len(kept[0][0]) != len(parts) or any(map(is_not, kept[0][0], parts)):
        kept[:] = [(parts, _hash(model))]
    return kept[0][1]


def _parts(model: Model) -> tuple[object, ...]:
    """Names and parts of all tables, and what stands beside them."""
    found: list[object] = []
    for name in type(model).model_fields:
        value = getattr(model, name)
        found += [*value.keys(), *value.values()] if isinstance(value, dict) else [value]
    return tuple(found)


def _hash(model: Model) -> str:
    """The hash of the fields and files as they are now."""
    fields = model.model_dump(mode="json", exclude_none=True)
    for casing in fields["casings"].values():
        files = {**casing["mesh"], **({"matrices": casing["matrices"]} if "matrices" in casing else {})}
        casing |= {"files": {name: _digest(Path(path)) for name, path in files.items()}, "mesh": [], "matrices": ""}
    for gear in fields["gears"].values():
        body = gear["body"]
        if "mesh" in body:
            body["mesh"] = _digest(Path(body["mesh"]))
        else:  # a gear without a mesh keeps the name that it had before there were any
            gear["body"] = {key: value for key, value in body.items() if key not in _OF_MESHES}
    if not fields["casings"]:
        del fields["casings"]  # a model without them keeps the name that it had before there were any
    if not fields["scatter"]:
        del fields["scatter"]
    text = json.dumps(fields, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def _digest(path: Path) -> str:
    """SHA-256 of what a file holds; of one that is not there, which no analysis gets past, its name."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return str(path)
