"""What is done with each mutant, and what counts as a fault: anything but a result of finite numbers or a sentence."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import rotorgear as rg

Verb = Callable[[rg.Model], Any]


def _speed(model: rg.Model) -> float:
    speed = model.operation.speed if model.operation else None
    return speed if speed else 100.0


def _gear(model: rg.Model) -> Any:
    return rg.gear(model) if model.gears else None


def _mesh(model: rg.Model) -> Any:
    return rg.mesh(model, next(iter(model.meshes)), stiffness="tooth_fe", preset="preview") if model.meshes else None


# Meshes of fixed size where the verb allows it: the sizes of refined ones are the user's.
QUICK: dict[str, Verb] = {
    "check": lambda model: rg.check(model),
    "modal": lambda model: rg.modal(model, modes=6, elements=1),
    "static": lambda model: rg.static(model, elements=1),
    "gear": _gear,
}
ALL: dict[str, Verb] = {
    "check": lambda model: rg.check(model),
    "modal": lambda model: rg.modal(model, modes=8),
    "modal at speed": lambda model: rg.modal(model, modes=8, speed=_speed(model)),
    "campbell": lambda model: rg.campbell(model, modes=6, points=5),
    "critical": lambda model: rg.critical(model),
    "static": lambda model: rg.static(model),
    "response": lambda model: rg.response(model, points=5),
    "gear": _gear,
    "mesh": _mesh,
    "transient": lambda model: rg.transient(model, steps=20, error_estimate=False, time=0.01),
}
# Numbers of each result that must be finite wherever it is returned; others have NaN as a word for "not there".
FINITE: dict[str, tuple[str, ...]] = {
    "modal": ("eigenvalues", "shapes", "backward_error"),
    "modal at speed": ("eigenvalues", "shapes", "backward_error"),
    "campbell": ("speeds",),
    "static": ("displacements",),
    "response": ("speeds", "mesh_force"),
    "transient": ("time", "values", "mesh_force"),
}


def not_finite(verb: str, result: Any) -> str:
    """The first number that is none; "" where all are in order."""
    if result is None:
        return ""
    for name in FINITE.get(verb, ()):
        value = getattr(result, name, None)
        if isinstance(value, np.ndarray) and value.dtype.kind in "fc" and not np.all(np.isfinite(value)):
            return name
    if verb in ("check", "gear"):
        return next(_none_finite(result, ""), "")
    return ""


def _none_finite(value: Any, name: str) -> Iterator[str]:
    if isinstance(value, float) and not math.isfinite(value):
        yield name
    elif isinstance(value, dict):
        for key, entry in value.items():
            yield from _none_finite(entry, f"{name}.{key}")
    elif isinstance(value, list | tuple):
        for entry in value:
            yield from _none_finite(entry, name)
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            if field.name != "model":
                yield from _none_finite(getattr(value, field.name), f"{name}.{field.name}")
