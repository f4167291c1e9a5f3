"""Which keys of a model the numbers of an analysis depend on: each is changed by a little, and the analysis run again."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.model.address import tables_of

# Keys that say what a part does, beside those that say where it is and how large: those act in all analyses.
KINDS = {
    "operation": ("speed", "torque", "power", "gravity"),
    "damping": ("rayleigh_alpha", "rayleigh_beta", "modal_ratio"),
    "shafts": ("internal_damping",),
    "gears": ("tip_relief", "flank.crowning", "upper_thickness_allowance", "ball_diameter", "body.damping_ratio"),
    "meshes": (
        "damping",
        "damping_ratio",
        "backlash",
        "transmission_error",
        "stiffness_variation",
        "corner_impact",
        "index_error",
        "friction_coefficient",
        "misalignment",
        "application_factor",
        "stiffness",
        "regularisation_depth",
    ),
    "bearings": ("stiffness", "damping", "rolling", "journal", "pedestal.damping"),
    "supports": ("stiffness", "damping"),
    "couplings": ("damping",),
    "nonlinear_elements": ("parameters", "stiffness", "damping"),
    "loads": ("torque", "power", "force", "moment", "ripple", "speed_power", "step_to", "history"),
    "unbalances": ("magnitude",),
    "casings": ("damping_ratio",),
    "scatter": ("sigma",),
}
STEP = 0.01
# What the request of a verb says in place of the file.
REQUESTED = {"critical": "operation.speed", "orbits": "operation.speed"}
# A number that moves by less is rounding.
SAME = 1e-9


def speed_of(model: rg.Model) -> float:
    """The operating speed, or any."""
    return (model.operation.speed if model.operation else None) or 100.0


def _places(model: rg.Model) -> dict[str, Any]:
    table = next(name for name in ("gears", "disks", "bearings") if getattr(model, name))
    place = f"{table}.{next(reversed(getattr(model, table)))}:{'y' if model.has('bending') else 'torsion'}"
    return {"inputs": [place], "outputs": [place], "elements": 1}


def _sorted(values: np.ndarray) -> np.ndarray:
    return np.sort(values.real) + 1j * np.sort(values.imag)


def _modal(model: rg.Model, speed: float | None) -> Any:
    return rg.modal(model, modes=12, speed=speed, elements=1, error_estimate=False)


def _response(model: rg.Model) -> Any:
    return rg.response(model, speeds=[speed_of(model)], elements=1, method="direct")


Verb = tuple[Callable[[rg.Model], Any], Callable[[Any], list[np.ndarray]]]
VERBS: dict[str, Verb] = {
    "modal": (lambda model: _modal(model, None), lambda found: [_sorted(found.eigenvalues)]),
    "modal at speed": (lambda model: _modal(model, speed_of(model)), lambda found: [_sorted(found.eigenvalues)]),
    "static": (
        lambda model: rg.static(model, elements=1),
        lambda found: [
            found.displacement,
            found.mesh_force,
            *found.bearing_force.values(),
            *found.support_force.values(),
        ],
    ),
    "frf": (lambda model: rg.frf(model, [170.0, 317.0], **_places(model)), lambda found: [found.receptance]),
    "response": (
        _response,
        lambda found: [found.mesh_force, found.mean_force, found.bearing_force, found.displacement, found.approach],
    ),
    "transient": (
        lambda model: rg.transient(model, time=0.02, steps=60, elements=1, error_estimate=False, method="newmark"),
        lambda found: [found.values, found.mesh_force],
    ),
}


def _sweep(model: rg.Model) -> Any:
    """One point in few modes, a turn or some periods of the mesh: what moves it does so there."""
    turns = bool(model.unbalances or model.loads)
    periods = {"discard": 0, "sample": 1} if turns else {"discard": 20, "sample": 10}
    as_given = {"over": {"as given": [0.0]}, "change": lambda same, _: same}
    return rg.sweep(model, **as_given, exponents=0, modes=4, **periods)


def _orbits(model: rg.Model) -> Any:
    ends = [speed_of(model), 1.01 * speed_of(model)]
    excite = next(iter(model.meshes), None)
    return rg.orbits(model, {"operation.speed": ends}, excite=excite, harmonics=3, points=2, elements=1)


LONG_VERBS: dict[str, Verb] = {
    "critical": (
        lambda model: rg.critical(model, start=0.0, stop=3.0 * speed_of(model), mesh_orders=[1], elements=1),
        lambda found: [_sorted(np.array([one.speed + 1j * one.frequency_hz for one in found.speeds]))],
    ),
    "state space": (
        lambda model: rg.state_space(model, fmax=400.0, **_places(model)),
        lambda found: [found.receptance(np.array([170.0, 317.0]))],
    ),
    "sweep": (_sweep, lambda found: [found.section]),
    "orbits": (_orbits, lambda found: [found.approach_extremes, found.force_harmonics, found.place_harmonics]),
    "campbell": (
        lambda model: rg.campbell(model, modes=8, points=2, elements=1, error_estimate=False),
        lambda found: [_sorted(np.nan_to_num(found.eigenvalues[k])) for k in range(len(found.speeds))],
    ),
}


def keys_of(model: rg.Model) -> Iterator[tuple[str, dict[str, float]]]:
    """Yield each key that the file gives, with its numbers by their addresses."""
    whole = model.model_dump(exclude_defaults=True)
    known = tables_of(model)
    for table, keys in KINDS.items():
        given = whole.get(table) or {}
        parts = (
            {table: given} if table in ("operation", "damping") else {f"{table}.{name}": p for name, p in given.items()}
        )
        for address, part in parts.items():
            for key in keys:
                value: Any = part
                for step in key.split("."):
                    value = value.get(step) if isinstance(value, dict) else None
                numbers = dict(_numbers(value, f"{address}.{key}"))
                if numbers and known:
                    yield f"{address}.{key}", numbers


def _numbers(value: Any, address: str) -> Iterator[tuple[str, float]]:
    if isinstance(value, dict):
        for key, entry in value.items():
            yield from _numbers(entry, f"{address}.{key}")
    elif isinstance(value, list | tuple):
        for k, entry in enumerate(value):
            yield from _numbers(entry, f"{address}[{k}]")
    elif isinstance(value, float) and value and math.isfinite(value):
        yield address, value


def moved(one: list[np.ndarray], other: list[np.ndarray]) -> bool:
    """Whether any number is another by more than rounding."""
    for a, b in zip(one, other, strict=True):
        if a.shape != b.shape or (a.size and np.abs(a - b).max() > SAME * np.abs(a).max()):
            return True
    return False


def used(
    model: rg.Model, verb: str, doubted: Callable[[Any, str], bool] = lambda result, key: False
) -> tuple[Any, dict[str, bool]]:
    """The result of a verb, and of each key of the model whether the numbers of that result depend on it.

    Keys of which `doubted(result, key)` says that they are not used are changed all at once first: what does not move then
    depends on none of them. Where it moves, they are changed one by one, as all others are.

    Raises:
        RotorgearError: the verb does not take the model, or has nothing to tell of it.
    """
    run, read = (VERBS | LONG_VERBS)[verb]
    result = run(model)
    numbers = read(result)
    if not any(array.size for array in numbers):
        raise rg.AnalysisError("the result tells of contacts only, and there is none")
    changes = {}
    for key, values in keys_of(model):
        if key == REQUESTED.get(verb):
            continue
        for factor in (1.0 + STEP, 1.0 - STEP):
            change = {address: factor * value for address, value in values.items()}
            try:
                model.with_(change)
            except rg.ModelError:
                continue
            changes[key] = change
            break
    together = {key: change for key, change in changes.items() if doubted(result, key)}
    found = {}
    if len(together) > 1:
        try:
            other = model.with_({address: value for change in together.values() for address, value in change.items()})
        except rg.ModelError:
            pass
        else:
            if not moved(numbers, read(run(other))):
                found = dict.fromkeys(together, False)
    for key, change in changes.items():
        if key not in found:
            found[key] = moved(numbers, read(run(model.with_(change))))
    return result, {key: found[key] for key in changes}
