"""What the stated errors of motions are worth, statistic by statistic, on trains that are none of the models of the repository.

python -m validation.benchmarks.motion_errors transient  periodic motions, starts and run-ups: stated over true error
python -m validation.benchmarks.motion_errors chaos      chaotic motions: how often other steps lie within the stated error
python -m validation.benchmarks.motion_errors settled    sweeps and harmonic balance against shooting

Behind these, names of some cases; `--tuned` takes those that the choices were made on, in place of the judges.
True errors of transients are differences from the exponential method with 5120 steps in a mesh period. Rows whose error is less
than ten times what that one differs from 1280 steps by, or below 1e-7, are not judged: there the ratio is that of the reference.
A run that says that motions of other steps part is judged by whether the reference lies within what it states.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import rotorgear as rg
from rotorgear.results.transient import is_shown

ROOT = Path(__file__).resolve().parents[2]
LOW = 0.5
HIGH = 3.0
NEVER = 0.3
RESOLVED = 1e-7
# Statistics further apart, relative, are those of different motions.
OTHER_MOTION = 0.05
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


def train(
    gears: dict[str, Gear],
    meshes: list[Mesh],
    ratio: float,
    torque: float,
    damping: str = "adhesive",
    ripple: float = 0.0,
) -> rg.Model:
    """A torsional train whose first mesh comes with `ratio` times the frequency of its pair alone, driven by its first shaft.

    `damping`: of its contacts. `ripple`: of the torque, three times a turn.
    """
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
    if ripple:
        text = text.replace(f'torque = "{torque} N m"', "")
        text += f'[loads.drive]\nshaft = "{shafts[0]}"\nkind = "input"\ntorque = {torque}\nripple = {ripple}\nripple_order = 3\n'
        text += f'[loads.driven]\nshaft = "{shafts[-1]}"\nkind = "output"\n'
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
contact_damping = "{damping}"
phase = {mesh.phase!r}
backlash = {mesh.backlash!r}
stiffness_variation = [{{ harmonic = 1, amplitude = {mesh.variation!r} }}]
transmission_error = [{{ harmonic = 1, amplitude = {mesh.error!r}, phase = "0.3 rad" }}]
"""
    return rg.loads(text)


def pair(
    ratio: float, *, inertias: float, z: float, variation: float, error: float, torque: float = 20.0, **others: Any
) -> rg.Model:
    """Two gears whose inertias are so far apart."""
    gears = {"p": Gear("a", 23, 0.036, 8e-4), "w": Gear("b", 37, 0.036 * 37 / 23, 8e-4 * inertias)}
    return train(gears, [Mesh("p", "w", 2.2e8, z, 4e-5, variation, error)], ratio, torque, **others)


def idler(ratio: float, *, z: float, variation: float, error: float, torque: float = 25.0, **others: Any) -> rg.Model:
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
    return train(gears, meshes, ratio, torque, **others)


def two_to_three(
    ratio: float, *, z: float, variation: float, error: float, torque: float = 25.0, **others: Any
) -> rg.Model:
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
    return train(gears, meshes, ratio, torque, **others)


def four_in_a_row(
    ratio: float, *, z: float, variation: float, error: float, torque: float = 15.0, **others: Any
) -> rg.Model:
    """Four gears in a row, the second one heavy; the meshes differ in stiffness and backlash."""
    teeth = {"g1": 19, "g2": 67, "g3": 31, "g4": 53}
    inertia = {"g1": 3e-4, "g2": 2.6e-2, "g3": 1.1e-3, "g4": 9e-3}
    gears = {name: Gear("abcd"[i], z_, 0.0015 * z_, inertia[name]) for i, (name, z_) in enumerate(teeth.items())}
    meshes = [
        Mesh("g1", "g2", 1.6e8, z, 6e-5, variation, error, 0.9),
        Mesh("g2", "g3", 2.9e8, 1.3 * z, 3e-5, 0.6 * variation, 0.7 * error, 2.6),
        Mesh("g3", "g4", 2.1e8, 0.8 * z, 8e-5, 1.1 * variation, 1.3 * error, 4.1),
    ]
    return train(gears, meshes, ratio, torque, **others)


def three_to_two(
    ratio: float, *, z: float, variation: float, error: float, torque: float = 40.0, **others: Any
) -> rg.Model:
    """Two stages whose mesh frequencies are as 2 to 3, the second one faster."""
    gears = {
        "g1": Gear("a", 21, 0.031, 5e-4),
        "g2": Gear("b", 34, 0.031 * 34 / 21, 6e-3),
        "g3": Gear("b", 51, 0.07, 1.2e-2),
        "g4": Gear("c", 23, 0.07 * 23 / 51, 9e-4),
    }
    meshes = [
        Mesh("g1", "g2", 2.4e8, z, 4.5e-5, variation, error, 1.1),
        Mesh("g3", "g4", 1.7e8, 0.7 * z, 5.5e-5, 1.2 * variation, 0.9 * error, 2.9),
    ]
    return train(gears, meshes, ratio, torque, **others)


def bending() -> rg.Model:
    """Spur gears off the middle of two shafts that bend and twist, of unequal stiffness in their bearings."""
    text = """schema_version = 1
[operation]
input_shaft = "a"
output_shaft = "b"
speed = "5100 rpm"
torque = "45 N m"
[damping]
rayleigh_alpha = "90 1/s"
rayleigh_beta = "0.6 us"
"""
    for shaft, x, width, teeth in (("a", 0, 32, 27), ("b", 108, 48, 45)):
        text += f"""[shafts.{shaft}]
position = ["{x} mm", "0 mm"]
start = "0 mm"
material = "steel"
sections = [{{ length = "210 mm", outer_diameter = "{width} mm" }}]
[gears.{shaft}_gear]
shaft = "{shaft}"
at = "70 mm"
kind = "spur"
teeth = {teeth}
normal_module = "3 mm"
normal_pressure_angle = "20 deg"
width = "30 mm"
body = {{ bore = "{width} mm" }}
[bearings.{shaft}_left]
shaft = "{shaft}"
at = "10 mm"
stiffness = {{ radial = "{1.3 if x else 0.9}e8 N/m", axial = "4e7 N/m" }}
damping = {{ radial = "600 N s/m", axial = "600 N s/m" }}
[bearings.{shaft}_right]
shaft = "{shaft}"
at = "200 mm"
stiffness = {{ radial = "{2.1 if x else 1.6}e8 N/m" }}
damping = {{ radial = "500 N s/m" }}
"""
    text += """[unbalances.of_a]
shaft = "a"
at = "150 mm"
magnitude = "20 g mm"
[meshes.stage]
pinion = "a_gear"
gear = "b_gear"
stiffness = "4.2e8 N/m"
damping_ratio = 0.04
backlash = "70 um"
transmission_error = [{ harmonic = 1, amplitude = "2.5 um" }, { harmonic = 2, amplitude = "0.6 um" }]
stiffness_variation = [{ harmonic = 1, amplitude = 0.12 }]
"""
    return rg.loads(text)


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
# Models that no choice was made on: they judge.
JUDGES: dict[str, Case] = {
    "pair 1:30, both flanks": Case(pair(0.6, inertias=30.0, z=0.03, variation=0.2, error=3e-6, torque=6.0), 150, 40),
    "pair 1:4, letting go": Case(
        pair(1.15, inertias=4.0, z=0.06, variation=0.15, error=2e-6, damping="non-adhesive"), 80, 40
    ),
    "pair 1:100, light damping": Case(pair(1.8, inertias=100.0, z=0.004, variation=0.05, error=8e-7), 500, 40),
    "pair 1:7, a start": Case(pair(0.7, inertias=7.0, z=0.001, variation=0.1, error=2e-6, torque=30.0), 0, 50),
    "pair with a ripple": Case(
        pair(0.5, inertias=9.0, z=0.05, variation=0.12, error=1.5e-6, ripple=0.4, damping="non-adhesive"), 115, 46
    ),
    "3:2 train": Case(three_to_two(0.8, z=0.05, variation=0.14, error=1.5e-6, damping="non-adhesive"), 200, 42),
    "3:2 train, contact kept": Case(three_to_two(0.37, z=0.05, variation=0.06, error=6e-7, torque=110.0), 150, 42),
    "four in a row": Case(four_in_a_row(0.65, z=0.06, variation=0.12, error=1.5e-6), 250, 40),
    "four in a row, letting go": Case(
        four_in_a_row(1.3, z=0.07, variation=0.1, error=1e-6, torque=30.0, damping="non-adhesive"), 250, 40
    ),
    "bending shafts": Case(bending(), 60, 27),
    "run-up, four in a row": Case(four_in_a_row(0.4, z=0.05, variation=0.12, error=1.5e-6), 0, 200, 2.2),
    "run-down, 3:2 train": Case(
        three_to_two(1.1, z=0.05, variation=0.13, error=1.5e-6, damping="non-adhesive"), 0, 220, 0.5
    ),
}
CHAOTIC_JUDGES: dict[str, Case] = {
    "pair 1:15": Case(pair(0.75, inertias=15.0, z=0.02, variation=0.22, error=4.5e-6, torque=8.0), 200, 90),
    "four in a row": Case(four_in_a_row(0.85, z=0.012, variation=0.25, error=4e-6, torque=6.0), 200, 90),
    "3:2 train": Case(three_to_two(0.95, z=0.01, variation=0.25, error=4e-6, torque=12.0), 200, 84),
    "2:3 train, letting go": Case(
        two_to_three(0.8, z=0.012, variation=0.28, error=5e-6, torque=8.0, damping="non-adhesive"), 200, 90
    ),
}
CHAOTIC: dict[str, Case] = {
    "unequal inertias 1:40": Case(pair(0.9, inertias=40.0, z=0.03, variation=0.2, error=4e-6, torque=10.0), 200, 80),
    "idler": Case(idler(0.9, z=0.012, variation=0.25, error=4e-6, torque=10.0), 200, 80),
    "2:3 train": Case(two_to_three(1.0, z=0.01, variation=0.25, error=4e-6, torque=10.0), 200, 84),
}


def printed(result: rg.TransientResult) -> list[str]:
    """The statistics that a result prints."""
    return [name for name in result.quantity if is_shown(name)]


class Row(NamedTuple):
    """A statistic of a run: stated over true error, and whether the run states a scatter."""

    run: str
    statistic: str
    ratio: float
    scatter: bool


def rows(case: Case) -> Iterator[Row]:
    """What the transients of a case state."""

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
            scatter = "part from" in found.error_source
            if error > (RESOLVED if scatter else max(RESOLVED, 10.0 * doubt)):
                yield Row(words, name, float(found.quantity_error[number] / size / error), scatter)


def summary(name: str, found: list[float]) -> str:
    """A line of ratios."""
    q = np.array(found)
    within = 100.0 * np.mean((q >= LOW) & (q <= HIGH))
    below = 100.0 * np.mean(q < NEVER)
    return f"{name:26}  {q.size:5}  {within:6.1f}  {below:6.1f}  {q.min():8.2f}  {np.median(q):6.2f}"


HEAD = "                             rows  % .5-3  % <.3   smallest  median"


def transients(cases: dict[str, Case]) -> Iterator[str]:
    """A line a case, a line a statistic, and a line of all."""
    yield HEAD
    found: list[Row] = []
    for name, case in cases.items():
        own = list(rows(case))
        found += own
        steady = [row for row in own if not row.scatter]
        if steady:
            yield summary(name, [row.ratio for row in steady])
        if parted := [row for row in own if row.scatter]:
            covered = 100.0 * np.mean([row.ratio >= 1.0 for row in parted])
            yield f"{name:26}  {len(parted):5}  scatter: {covered:.1f} % within what is stated"
        yield from (f"  below: {row.run}, {row.statistic}: {row.ratio:.2f}" for row in steady if row.ratio < NEVER)
    yield ""
    steady = [row for row in found if not row.scatter]
    for kind in dict.fromkeys((*_OF_CONTACT, *_OF_CHANNEL)):
        if own_kind := [row.ratio for row in steady if row.statistic.startswith(kind)]:
            yield summary(kind, own_kind)
    yield summary("all", [row.ratio for row in steady])
    if parted := [row.ratio >= 1.0 for row in found if row.scatter]:
        yield f"{'scatter':26}  {len(parted):5}  {100.0 * np.mean(parted):.1f} % within what is stated"


def chaos(cases: dict[str, Case]) -> Iterator[str]:
    """How often the difference to other steps lies within the error that a run states."""
    total: list[bool] = []
    for name, case in cases.items():
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


def _at(found: rg.OrbitsResult, value: float) -> int:
    """The point at a value: a branch may begin at either end of its range."""
    return int(np.argmin(np.abs(found.value - value)))


def _of_orbits(found: rg.OrbitsResult, i: int) -> np.ndarray:
    """`_OF_CONTACT` of a point, (c, 7)."""
    shares = (found.apart, found.back)
    moved = (found.peak_to_peak_transmission_error, found.peak_to_peak_approach)
    return np.column_stack([x[i] for x in (found.mean_force, found.rms_force, found.largest_force, *shares, *moved)])


def _of_sweep(found: rg.SweepResult) -> np.ndarray:
    """`_OF_CONTACT` of the first point, (c, 7)."""
    shares = (found.apart, found.back)
    moved = (found.peak_to_peak_transmission_error, found.peak_to_peak_approach)
    return np.column_stack([x[0, 0] for x in (found.mean_force, found.rms_force, found.largest_force, *shares, *moved)])


def settled(cases: dict[str, Case]) -> Iterator[str]:
    """Sweeps and harmonic balance against shooting, where all of them come to one motion."""
    yield HEAD
    total: dict[str, list[float]] = {}
    for name, case in cases.items():
        speed = float(case.model.operating_speed or 0.0)
        over = {"operation.speed": [speed, 1.001 * speed]}

        def orbits(over: Any = over, case: Case = case, **options: Any) -> rg.OrbitsResult:
            return rg.orbits(case.model, over, points=2, step=0.5, from_transient=True, **options)

        try:
            exact = orbits(method="shooting")
        except rg.RotorgearError as refusal:
            yield f"{name:26}  no reference: {refusal}"
            continue
        truth = _of_orbits(exact, _at(exact, speed))
        shared = [exact.statistic.index(what) for what in _OF_CONTACT]
        whole = np.ones(len(truth))
        size = np.hypot(truth[:, 0], truth[:, 1])
        scale = np.column_stack([size, truth[:, 1], truth[:, 2], whole, whole, *truth[:, 5:].T])
        sweep = rg.sweep(case.model, {"operation.speed": [speed]}, sample=60)
        runs = [("sweep", _of_sweep(sweep), sweep.statistics_error[0, 0])]
        for harmonics in (10, 20, 40):
            found = orbits(method="harmonic balance", harmonics=harmonics)
            i = _at(found, speed)
            runs.append((f"{harmonics} harmonics", _of_orbits(found, i), found.statistics_error[i]))
        for words, values, errors in runs:
            off = np.abs(values - truth) / scale
            if off.max() > OTHER_MOTION:
                yield f"{name}, {words}: another motion"
                continue
            judged = off > RESOLVED
            ratio = (errors[:, shared] / scale)[judged] / off[judged]
            total.setdefault("sweep" if words == "sweep" else "harmonic balance", []).extend(ratio)
            if ratio.size:
                yield summary(f"{name}, {words}", list(ratio))
    yield ""
    yield from (summary(kind, found) for kind, found in total.items())


if __name__ == "__main__":
    what, *chosen = sys.argv[1:] or ["transient"]
    tuned = "--tuned" in chosen
    chosen = [name for name in chosen if name != "--tuned"]
    of_chaos = CHAOTIC if tuned else CHAOTIC_JUDGES
    of_transients = CASES if tuned else JUDGES
    every = of_chaos if what == "chaos" else of_transients
    if what == "settled":
        every = {name: case for name, case in every.items() if case.to == 1.0 and case.discard}
    run = {"transient": transients, "chaos": chaos, "settled": settled}[what]
    for line in run({name: case for name, case in every.items() if name in chosen or not chosen}):
        print(line, flush=True)
