"""What the stated errors of motions are worth, statistic by statistic, on trains that are none of the models of the repository.

python -m validation.benchmarks.motion_errors            periodic motions, starts and run-ups: stated over true error
python -m validation.benchmarks.motion_errors chaos      chaotic motions: how often other steps lie within the stated error

True errors are differences from the exponential method with 5120 steps in a mesh period. Rows whose error is less than ten times
what that one differs from 1280 steps by, or below 1e-7, are not judged: there the ratio is that of the reference.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import rotorgear as rg

ROOT = Path(__file__).resolve().parents[2]
LOW = 0.5
HIGH = 3.0
NEVER = 0.3
RESOLVED = 1e-7
REFERENCE = 5120
COARSER = 1280
STEPS = (40, 80, 160)
OTHER_STEPS = (70, 90, 110, 130, 150, 170, 190, 210)
# What a result prints of a contact and of a channel.
_OF_CONTACT = (
    "mean force",
    "rms force",
    "largest force",
    "contact loss",
    "coast contact",
    "transmission error",
    "approach",
)
_OF_CHANNEL = ("mean", "rms", "largest", "smallest")


class Gear(NamedTuple):
    """A gear: its shaft, teeth, base radius in m and inertia in kg m^2."""

    shaft: str
    teeth: int
    radius: float
    inertia: float


class Mesh(NamedTuple):
    """A mesh of gears p and g: N/m, damping ratio, backlash in m, variation, transmission error in m, phase in rad."""

    p: str
    g: str
    k: float
    z: float
    backlash: float
    variation: float
    error: float
    phase: float = 0.0


class Case(NamedTuple):
    """A model, and for how many periods of its first mesh it settles and counts; `to` of its speed a run-up ends at."""

    model: rg.Model
    discard: int
    counted: int
    to: float = 1.0

    @property
    def options(self) -> dict[str, Any]:
        """Times and speeds."""
        mesh = next(iter(self.model.meshes))
        speed = abs(float(self.model.operating_speed or 0.0))
        period = 1.0 / abs(float(self.model.layout.mesh_frequency(mesh, speed) or 1.0))
        found = {"discard": self.discard * period, "time": self.counted * period}
        return found if self.to == 1.0 else {**found, "speed": speed, "speed_to": self.to * speed}


def train(gears: dict[str, Gear], meshes: list[Mesh], ratio: float, torque: float) -> rg.Model:
    """A torsional train whose first mesh comes with `ratio` times the frequency of its pair alone, driven by its first shaft."""
    p, g = gears[meshes[0].p], gears[meshes[0].g]
    natural = float(np.sqrt(meshes[0].k * (p.radius**2 / p.inertia + g.radius**2 / g.inertia)))
    shafts = list(dict.fromkeys(gear.shaft for gear in gears.values()))
    text = f"""schema_version = 1
motions = ["torsion"]
[operation]
input_shaft = "{shafts[0]}"
output_shaft = "{shafts[-1]}"
speed = "{ratio * natural / p.teeth!r} rad/s"
torque = "{torque} N m"
"""
    for shaft in shafts:
        inertia = sum(gear.inertia for gear in gears.values() if gear.shaft == shaft)
        text += f'[shafts.{shaft}]\n[supports.{shaft}]\nshaft = "{shaft}"\nat = "start"\n'
        text += f"damping = {{ torsion = {0.002 * natural * inertia!r} }}\n"
    for name, gear in gears.items():
        text += f"""[gears.{name}]
shaft = "{gear.shaft}"
at = "start"
kind = "spur"
teeth = {gear.teeth}
base_radius = {gear.radius!r}
mass = 1.0
polar_inertia = {gear.inertia!r}
diametral_inertia = {0.5 * gear.inertia!r}
"""
    for number, mesh in enumerate(meshes):
        text += f"""[meshes.m{number + 1}]
pinion = "{mesh.p}"
gear = "{mesh.g}"
stiffness = {mesh.k!r}
centre_line_angle = "{40 * number} deg"
pressure_angle = "20 deg"
damping_ratio = {mesh.z!r}
contact_damping = "adhesive"
phase = {mesh.phase!r}
backlash = {mesh.backlash!r}
stiffness_variation = [{{ harmonic = 1, amplitude = {mesh.variation!r} }}]
transmission_error = [{{ harmonic = 1, amplitude = {mesh.error!r}, phase = "0.3 rad" }}]
"""
    return rg.loads(text)


def pair(ratio: float, *, inertias: float, z: float, variation: float, error: float, torque: float = 20.0) -> rg.Model:
    """Two gears whose inertias are so far apart."""
    gears = {"p": Gear("a", 23, 0.036, 8e-4), "w": Gear("b", 37, 0.036 * 37 / 23, 8e-4 * inertias)}
    return train(gears, [Mesh("p", "w", 2.2e8, z, 4e-5, variation, error)], ratio, torque)


def idler(ratio: float, *, z: float, variation: float, error: float, torque: float = 25.0) -> rg.Model:
    """Three gears in a row."""
    gears = {
        "g1": Gear("a", 26, 0.04, 1.2e-3),
        "g2": Gear("b", 41, 0.04 * 41 / 26, 4.1e-3),
        "g3": Gear("c", 29, 0.04 * 29 / 26, 6e-3),
    }
    meshes = [
        Mesh("g1", "g2", 2e8, z, 5e-5, variation, error, 0.4),
        Mesh("g2", "g3", 2.6e8, z, 6.5e-5, 0.8 * variation, 1.2 * error, 1.9),
    ]
    return train(gears, meshes, ratio, torque)


def two_to_three(ratio: float, *, z: float, variation: float, error: float, torque: float = 25.0) -> rg.Model:
    """Two stages whose mesh frequencies are as 3 to 2."""
    gears = {
        "g1": Gear("a", 28, 0.04, 1.2e-3),
        "g2": Gear("b", 42, 0.06, 4.1e-3),
        "g3": Gear("b", 28, 0.045, 1.9e-3),
        "g4": Gear("c", 44, 0.045 * 44 / 28, 6e-3),
    }
    meshes = [
        Mesh("g1", "g2", 2e8, z, 5e-5, variation, error, 0.4),
        Mesh("g3", "g4", 2.6e8, z, 6.5e-5, 0.8 * variation, 1.2 * error, 1.9),
    ]
    return train(gears, meshes, ratio, torque)


def flexible() -> rg.Model:
    """Flexible shafts, as in the model of that name, at another speed, load and excitation."""
    return rg.load(ROOT / "models" / "flexible_pair.toml").with_(
        {"operation.speed": "4200 rpm", "operation.torque": "140 N m", "meshes.stage.backlash": "90 um"}
    )


CASES: dict[str, Case] = {
    "unequal inertias 1:12": Case(pair(0.85, inertias=12.0, z=0.05, variation=0.1, error=1.5e-6), 60, 40),
    "unequal inertias 1:60": Case(pair(1.4, inertias=60.0, z=0.04, variation=0.06, error=1e-6), 60, 40),
    "light damping, a start": Case(pair(1.3, inertias=5.0, z=0.002, variation=0.08, error=1e-6), 0, 60),
    "2:3 train": Case(two_to_three(0.7, z=0.04, variation=0.12, error=1.5e-6), 200, 42),
    "2:3 train, contact kept": Case(two_to_three(0.5, z=0.06, variation=0.05, error=5e-7, torque=80.0), 100, 42),
    "idler": Case(idler(0.55, z=0.05, variation=0.12, error=1.5e-6), 200, 40),
    "idler, contact kept": Case(idler(1.6, z=0.05, variation=0.06, error=8e-7, torque=60.0), 100, 40),
    "flexible shafts": Case(flexible(), 30, 20),
    "run-up of a pair": Case(pair(0.45, inertias=3.0, z=0.03, variation=0.17, error=2e-6), 0, 200, 2.6),
    "run-down of a pair": Case(pair(1.2, inertias=3.0, z=0.03, variation=0.17, error=2e-6), 0, 300, 0.4),
    "run-up of a 2:3 train": Case(two_to_three(0.4, z=0.04, variation=0.12, error=1.5e-6), 0, 200, 2.5),
}
CHAOTIC: dict[str, Case] = {
    "unequal inertias 1:40": Case(pair(0.9, inertias=40.0, z=0.03, variation=0.2, error=4e-6, torque=10.0), 200, 80),
    "idler": Case(idler(0.9, z=0.012, variation=0.25, error=4e-6, torque=10.0), 200, 80),
    "2:3 train": Case(two_to_three(1.0, z=0.01, variation=0.25, error=4e-6, torque=10.0), 200, 84),
}


def printed(result: rg.TransientResult) -> list[str]:
    """The statistics that a result prints."""
    shown = [name for name in result.channel if not name.startswith(("gears.", "bearings.")) or " force " in name]
    of_contacts = [f"{what} {name}" for name in result.contact for what in _OF_CONTACT]
    return [*of_contacts, *(f"{what} {name}" for name in shown for what in _OF_CHANNEL)]


def value_of(result: rg.TransientResult, name: str) -> float:
    """A statistic, over the size that its error is relative to."""
    number = result.quantity.index(name)
    return float(result.quantity_value[number] / (result.quantity_scale[number] or 1.0))


def ratios(case: Case) -> Iterator[tuple[str, str, float]]:
    """Run, statistic, stated over true error."""

    def exact(steps: int) -> rg.TransientResult:
        return rg.transient(case.model, method="exponential", steps=steps, error_estimate=False, **case.options)

    truth, check = exact(REFERENCE), exact(COARSER)
    runs: list[tuple[str, dict[str, Any]]] = [
        (f"{method}, {steps} steps", {"method": method, "steps": steps})
        for method in ("exponential", "newmark")
        for steps in STEPS
    ]
    for words, options in [*runs, ("automatic step", {}), ("accuracy 0.001", {"accuracy": 1e-3})]:
        found = rg.transient(case.model, **options, **case.options)
        for name in printed(found):
            number = truth.quantity.index(name)
            size = found.quantity_scale[number]
            if not 0.0 < size < np.inf:
                continue
            error = abs(found.quantity_value[number] - truth.quantity_value[number]) / size
            # Second order: the reference is this much nearer to the truth than its check.
            doubt = abs(truth.quantity_value[number] - check.quantity_value[number]) / size / 15.0
            if error > max(RESOLVED, 10.0 * doubt):
                yield words, name, float(found.quantity_error[number] / size / error)


def summary(name: str, found: list[float]) -> str:
    """A line of ratios."""
    q = np.array(found)
    within = 100.0 * np.mean((q >= LOW) & (q <= HIGH))
    return (
        f"{name:26}  {q.size:5}  {within:6.1f}  {100.0 * np.mean(q < NEVER):6.1f}  {q.min():8.2f}  {np.median(q):6.2f}"
    )


def periodic(names: list[str]) -> Iterator[str]:
    """A line a case, a line a statistic, and a line of all."""
    yield "                             rows  % .5-3  % <.3   smallest  median"
    every: list[float] = []
    kinds: dict[str, list[float]] = {}
    for name in names or CASES:
        own = []
        for words, statistic, ratio in ratios(CASES[name]):
            own.append(ratio)
            kinds.setdefault(
                next(kind for kind in (*_OF_CONTACT, *_OF_CHANNEL) if statistic.startswith(kind)), []
            ).append(ratio)
            if ratio < NEVER:
                yield f"  below: {words}, {statistic}: {ratio:.2f}"
        every += own
        if own:
            yield summary(name, own)
    yield ""
    for kind, found in kinds.items():
        yield summary(kind, found)
    yield summary("all", every)


def chaos(names: list[str]) -> Iterator[str]:
    """How often the difference to other steps lies within the error that a run states."""
    total: list[bool] = []
    for name in names or CHAOTIC:
        case = CHAOTIC[name]
        own = rg.transient(case.model, **case.options)
        covered = []
        for steps in OTHER_STEPS:
            other = rg.transient(case.model, steps=steps, error_estimate=False, **case.options)
            for what in printed(own):
                number = own.quantity.index(what)
                off = abs(own.quantity_value[number] - other.quantity_value[number])
                if off > RESOLVED * own.quantity_scale[number]:
                    covered.append(bool(off <= own.quantity_error[number]))
        total += covered
        yield f"{name:26}  {100.0 * np.mean(covered):.1f} % of {len(covered)} within what is stated ({own.error_source})"
    yield f"{'all':26}  {100.0 * np.mean(total):.1f} %"


if __name__ == "__main__":
    chosen = sys.argv[1:]
    for line in chaos(chosen[1:]) if chosen[:1] == ["chaos"] else periodic(chosen):
        print(line, flush=True)
