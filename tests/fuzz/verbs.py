"""What is done with each mutant, and what counts as a fault: anything but a result of finite numbers or a sentence."""

from __future__ import annotations

import dataclasses
import math
import random
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import rotorgear as rg

Verb = Callable[[rg.Model], Any]


def _speed(model: rg.Model) -> float:
    speed = model.operating_speed
    return speed if speed else 100.0


def _gear(model: rg.Model) -> Any:
    return rg.gear(model) if model.gears else None


def _mesh(model: rg.Model) -> Any:
    return rg.mesh(model, next(iter(model.meshes)), stiffness="tooth_fe", preset="preview") if model.meshes else None


def _place(model: rg.Model) -> str | None:
    """A place where a force may act: the first disk, gear or bearing."""
    for table in ("disks", "gears", "bearings"):
        for name in getattr(model, table):
            return f"{table}.{name}:y"
    return None


def _frf(model: rg.Model) -> Any:
    place = _place(model)
    return rg.frf(model, inputs=[place], outputs=[place], fmax=500.0, points=5, elements=1) if place else None


def _state_space(model: rg.Model) -> Any:
    place = _place(model)
    return rg.state_space(model, inputs=[place], outputs=[place], fmax=500.0, elements=1) if place else None


def _bearing(model: rg.Model) -> Any:
    """The sheet of the first bearing with a law; a refusal where there is none is as good."""
    return rg.bearing(model, next(iter(model.bearings)), speed=_speed(model)) if model.bearings else None


def _scatter(model: rg.Model) -> Any:
    if not model.bearings:
        return None
    return rg.scatter(model, "bearings.*.stiffness", sigma=0.1, samples=4, modes=4, elements=1)


def _orbits(model: rg.Model) -> Any:
    speed = _speed(model)
    return rg.orbits(model, {"operation.speed": [speed, 1.01 * speed]}, harmonics=4, points=4, elements=1)


def _sweep(model: rg.Model) -> Any:
    return rg.sweep(model, {"operation.speed": [_speed(model)]}, discard=2, sample=9)


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
    "frf": _frf,
    "state space": _state_space,
    "bearing": _bearing,
    "scatter": _scatter,
    "sensors": lambda model: rg.sensors(model, count=4, elements=1),
    "orbits": _orbits,
    "sweep": _sweep,
    "transient": lambda model: rg.transient(model, steps=20, error_estimate=False, time=0.01),
}


def _small_mesh(model: rg.Model) -> Any:
    if not model.meshes:
        return None
    return rg.mesh(model, next(iter(model.meshes)), positions=8, stiffness="tooth_fe", preset="preview")


def _report(model: rg.Model) -> Any:
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder, "page.html")
        try:
            return rg.report(model, page).to_dict() and None
        finally:
            left = [path.name for path in Path(folder).iterdir() if path != page]
            assert not left, f"half-written: {left}"


# Each on small models, as often as the counts of the whole say.
LONG: dict[str, Verb] = {
    "report": _report,
    "sweep": _sweep,
    "orbits": _orbits,
    "scatter": _scatter,
    "transient": lambda model: rg.transient(model, steps=20, error_estimate=False, time=0.01),
    "response": lambda model: rg.response(model, points=5),
    "mesh": _small_mesh,
}
# How often a verb is drawn beside the quick ones: those of seconds rarely, so that thousands of files are a matter of an hour.
WEIGHTS: dict[str, float] = {
    "modal at speed": 8.0,
    "campbell": 8.0,
    "response": 4.0,
    "frf": 8.0,
    "state space": 8.0,
    "bearing": 8.0,
    "sensors": 4.0,
    "critical": 0.5,
    "mesh": 0.5,
    "scatter": 0.2,
    "orbits": 0.2,
    "sweep": 0.2,
    "transient": 0.2,
}


def drawn(seed: int) -> dict[str, Verb]:
    """The quick verbs and one more for a seed, by weight."""
    verb = random.Random(f"verb {seed}").choices(list(WEIGHTS), list(WEIGHTS.values()))[0]
    return QUICK | {verb: ALL[verb]}


# Numbers of each result that must be finite wherever it is returned; others have NaN as a word for "not there".
FINITE: dict[str, tuple[str, ...]] = {
    "modal": ("eigenvalues", "shapes", "backward_error"),
    "modal at speed": ("eigenvalues", "shapes", "backward_error"),
    "campbell": ("speeds",),
    "static": ("displacements",),
    "response": ("speeds", "mesh_force"),
    "transient": ("time", "values", "mesh_force"),
    "frf": ("receptance",),
    "state space": ("mass_matrix", "velocity_terms", "stiffness_matrix", "input_matrix", "output_matrix"),
    "scatter": ("z",),
    "sensors": ("mode_hz",),
    "orbits": ("value", "period", "mean_force", "largest_force"),
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
