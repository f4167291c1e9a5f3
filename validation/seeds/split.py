"""The split-torque gearbox: speeds, torques, its modes against the printed list and against chance, two statements on modes."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np

import rotorgear as rg
from validation.cases.split_torque_lines.spectrum import excited, run
from validation.seeds import kept
from validation.seeds.rows import entries, loaded

MODEL = "split_torque"
TOLERANCE = 0.07
RANGE = 5000.0


def printed_frequencies() -> list[float]:
    """The 24 printed natural frequencies in Hz."""
    return [float(line["printed"]) for line in entries("split") if line["what"].startswith("natural frequency ")]


def quick() -> dict[str, float | str]:
    """Speeds, torques and frequencies."""
    sheet = rg.check(loaded(MODEL)).to_dict()
    speeds = {row["name"]: row["speed_rpm"] for row in sheet["shafts"]}
    hz = {row["name"]: row["mesh_frequency_hz"] for row in sheet["meshes"]}
    torques = {row["name"]: abs(row["torque_n_m"]) for row in sheet["torques"]}
    found: dict[str, float | str] = {
        "stage_1": hz["stage_1a"],
        "stage_2": hz["stage_2a"],
        "ratio": abs(speeds["input"] / speeds["output"]),
        "output_rpm": abs(speeds["output"]),
        "torque_in": torques["operation"],
        "torque_out": torques["operation.output_shaft"],
        "power": 2500.0,
    }
    turns = [abs(speeds[name]) / 60.0 for name in ("input", "branch_a", "output")]
    for name, printed in (("97.8", 97.8), ("285.1", 285.1)):
        nearest = min((n * f for f in turns for n in range(1, 21)), key=lambda f: abs(f - printed))
        found[f"shaft_{name}"] = nearest
    for item in excited().meshes["stage_2a"].transmission_error:
        found[f"ste_{item.harmonic}"] = 1e6 * item.amplitude
    for name, printed in (("4883", 4883.0), ("5356", 5356.0)):
        found[f"tone_{name}"] = _nearest_tone(printed, hz, turns)
    found["axial_fall"] = 100.0 * (1.0 - math.tan(math.radians(25.0)) / math.tan(math.radians(30.0)))
    return found


def _nearest_tone(printed: float, hz: dict[str, float], turns: list[float]) -> float:
    """The sum or difference of a mesh harmonic up to 3 and a shaft's frequency nearest to a printed line, in Hz."""
    meshes = [n * hz[name] for name in ("stage_1a", "stage_2a") for n in (1, 2, 3)]
    return min((f + sign * turn for f in meshes for turn in turns for sign in (-1, 1)), key=lambda f: abs(f - printed))


def _modes() -> dict[str, float | str]:
    """Modes beside the printed frequencies and chance."""
    result = rg.modal(loaded(MODEL), fmax=RANGE)
    printed = printed_frequencies()
    beside = rg.compare(result, printed, tolerance=TOLERANCE, known_to_hz=RANGE)
    found: dict[str, float | str] = {f"mode_{i}": "none within 7 %" for i in range(1, len(printed) + 1)}
    for match in beside.matches:
        number = printed.index(match.rig.frequency_hz) + 1
        found[f"mode_{number}"] = round(match.mode_frequency_hz, 1)
    elastic = result.frequency_hz[~result.rigid]
    near = [int(np.argmin(np.abs(result.frequency_hz - f))) for f in (368.7, 1818.0)]
    found |= {
        "modes": float(np.count_nonzero(elastic < RANGE)),
        "matched": float(len(beside.matches)),
        "random": round(beside.chance.expected_random_matches, 1),
        "as_many": f"{100.0 * beside.chance.probability_as_many:.0f} %",
        "branches": _branches(result, near[0]),
        "output_share": round(100.0 * _share(result, near[1], "output"), 0),
    }
    for number, name in ((6, "368"), (10, "838"), (15, "1818"), (22, "4410")):
        value = found[f"mode_{number}"]
        rig = {"368": 361.0, "838": 834.0, "1818": 1818.0, "4410": 4415.0}[name]
        found[f"error_{name}"] = abs(round(100.0 * (float(value) / rig - 1.0), 1))
    return found


def _lines() -> dict[str, float | str]:
    """Harmonics of the second stage in the acceleration at the output bearing over their first one, two stiffness models."""
    hz = {row["name"]: row["mesh_frequency_hz"] for row in rg.check(loaded(MODEL)).to_dict()["meshes"]}["stage_2a"]
    found: dict[str, float | str] = {}
    for model in ("potential_energy", "tooth_fe"):
        lines, _ = run(model)
        size = [
            float(lines.amplitude[np.abs(lines.frequency_hz - n * hz) < 0.01 * hz].max(initial=0.0))
            for n in range(1, 6)
        ]
        largest = int(np.argmax(size)) + 1
        found |= {
            f"fourth_{model}": size[3] / size[0],
            f"largest_{model}": f"harmonic {largest}, {largest * hz:.0f} Hz, {size[largest - 1] / size[0]:.3g} times",
        }
    return found


def _share(result: rg.ModalResult, mode: int, shaft: str) -> float:
    """Share of a shaft and what stands on it in the kinetic energy of a mode."""
    on_shaft = {f"shafts.{shaft}"}
    for table in ("gears", "disks"):
        on_shaft |= {f"{table}.{name}" for name, part in getattr(result.model, table).items() if part.shaft == shaft}
    return float(sum(values[mode] for name, values in result.kinetic_energy.items() if name in on_shaft))


def _branches(result: rg.ModalResult, mode: int) -> str:
    """Kinetic energies of both branches in the mode, in %."""
    shares = [100.0 * _share(result, mode, f"branch_{side}") for side in "ab"]
    return f"{shares[0]:.0f} % and {shares[1]:.0f} %" if all(map(math.isfinite, shares)) else "unknown"


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], dict[str, float | str]]] = {"modes": _modes, "lines": _lines}


@cache
def values() -> dict[str, float | str]:
    """What takes runs."""
    return kept.values("split", PIECES)
