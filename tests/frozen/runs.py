"""What is frozen: verbs with settings that differ from their defaults, over all shipped models and small ones of other kinds."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import rotorgear as rg
from tests.fuzz.verbs import ALL

SHIPPED = Path(__file__).resolve().parents[2] / "models"
Run = Callable[[rg.Model], Any]


@dataclass(frozen=True)
class Case:
    """One run: its name "model verb", and how the model is made and asked."""

    name: str
    model: Callable[[], rg.Model]
    run: Run


def _speed(model: rg.Model) -> float:
    speed = model.operation.speed if model.operation else None
    return float(speed or 100.0)


def _at(share: float) -> Run:
    return lambda model: rg.modal(model, modes=8, speed=share * _speed(model), elements=2)


def _update(share: float) -> Run:
    """The model learns from its own lowest lines, a per cent off."""

    def run(model: rg.Model) -> Any:
        speed = share * _speed(model)
        lines = rg.modal(model, modes=6, speed=speed, elements=1).frequency_hz
        wanted = [1.01 * float(f) for f in lines if f > 1.0]
        free = "meshes.*.stiffness" if not model.bearings else "bearings.*.stiffness"
        return rg.update(model, wanted[:4], free=free, speed=speed, elements=1)

    return run


def _first_gear(model: rg.Model) -> str:
    return f"gears.{next(iter(model.gears))}.teeth" if model.gears else "operation.speed"


VERBS: dict[str, Run] = ALL | {
    "modal forward": _at(1.0),
    "modal backward": _at(-1.0),
    "modal undamped": lambda model: rg.modal(model, modes=8, elements=2, undamped=True),
    "static backward": lambda model: rg.static(model, speed=-_speed(model), elements=1),
    "campbell backward": lambda model: rg.campbell(model, modes=4, points=3, stop=-_speed(model), elements=1),
    "critical map": lambda model: rg.critical_map(model, stiffness=[1e7, 1e8], elements=1),
    "response backward": lambda model: rg.response(model, speeds=[-_speed(model)], elements=1),
    "standards": lambda model: rg.standards(model, elements=1),
    "update": _update(0.0),
    "update forward": _update(1.0),
    "update backward": _update(-1.0),
    "transient estimated": lambda model: rg.transient(model, time=0.003),
    "transient backward": lambda model: rg.transient(
        model, speed=-_speed(model), steps=40, error_estimate=False, time=0.003
    ),
    "sweep of two": lambda model: rg.sweep(
        model, {"operation.speed": [0.9 * _speed(model), _speed(model)]}, discard=4, sample=8
    ),
    "casings": lambda model: [rg.casing(model, name) for name in model.casings] or None,
}
# They take longer than all else, and none of what they do is theirs alone.
_SLOW = {("split_torque_casing", "scatter"), ("split_torque_journals", "orbits"), ("elastic_wheel", "orbits")}


def _other_models() -> Iterator[tuple[str, Callable[[], rg.Model]]]:
    """Small models of kinds that no shipped one has, or has in another state."""
    everything = Path(__file__).resolve().parents[1] / "sound"
    for path in sorted(everything.glob("*.toml")):
        yield f"sound_{path.stem}", lambda path=path: rg.load(path)

    def changed(name: str, values: dict[str, Any]) -> Callable[[], rg.Model]:
        return lambda: rg.load(SHIPPED / f"{name}.toml").with_(values)

    yield "overhung_parallel", changed("overhung_pinion", {_only_mesh("overhung_pinion") + ".tilt": False})
    yield "geared_tilt", changed("relieved_pair", {_only_mesh("relieved_pair") + ".stiffness": "iso"})
    yield "helical_tilt", changed("helical_pair", {_only_mesh("helical_pair") + ".tilt": True})


def _only_mesh(name: str) -> str:
    with (SHIPPED / f"{name}.toml").open("rb") as file:
        return f"meshes.{next(iter(tomllib.load(file)['meshes']))}"


def cases() -> list[Case]:
    """All runs."""
    models = [(path.stem, lambda path=path: rg.load(path)) for path in sorted(SHIPPED.glob("*.toml"))]
    models += _other_models()
    return [
        Case(f"{name} {verb}", model, run)
        for name, model in models
        for verb, run in VERBS.items()
        if (name, verb) not in _SLOW
    ]
