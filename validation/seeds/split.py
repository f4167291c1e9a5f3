"""The split-torque gearbox: speeds, torques, its modes against the printed list and against chance, two statements on modes."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

import rotorgear as rg
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import pair_geometry
from validation.cases.split_torque_lines.spectrum import excited, run
from validation.seeds import misprints
from validation.seeds.models import loaded
from validation.seeds.pair16 import mean_stiffness

MODEL = "split_torque"
TOLERANCE = 0.07
RANGE = 5000.0
# The printed natural frequencies in Hz.
PRINTED = (
    27.1, 97.8, 138.5, 142.3, 285.1, 368.7, 559.6, 624.9, 695.8, 838.5, 897.4, 1023.0, 1194.1, 1452.3, 1818.0, 2003.0, 2262.0,
    2414.0, 2881.0, 3213.0, 3896.0, 4410.0, 4657.0, 4957.3,
)  # fmt: skip
# Printed: rig, simulation (Hz).
RIG = {"368": (361.0, 368.7), "838": (834.0, 838.5), "1818": (1818.0, 1818.0), "4410": (4415.0, 4410.0)}
TONES = (4410.0, 4883.0, 5356.0)


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
    for name, printed in (("97", 97.8), ("285", 285.1), ("step", TONES[1] - TONES[0])):
        found[f"shaft_{name}"] = min((n * f for f in turns for n in range(1, 21)), key=lambda f: abs(f - printed))
        # An unbalance shakes its shaft once a turn.
        found[f"once_{name}"] = min(turns, key=lambda f: abs(f - printed))
    found |= {
        # Nearest printed natural frequency to that of any shaft, in %.
        "once_distance": 100.0 * min(abs(f / turn - 1.0) for f in PRINTED for turn in turns),
        "step_1": TONES[1] - TONES[0],
        "step_2": TONES[2] - TONES[1],
        "tones_over_stage": hz["stage_1a"] / TONES[0],
        "branch_torque": abs(torques["operation"]) * 113.0 / 29.0 / 2.0,
        "dense_low": float(sum(f < 1000.0 for f in PRINTED)),
        "dense_high": sum(f > 1000.0 for f in PRINTED) / 4.0,
        "printed_modes": float(len(PRINTED)),
    }
    for name, (rig, simulated) in RIG.items():
        found[f"printed_error_{name}"] = 100.0 * abs(simulated / rig - 1.0)
    found["largest_printed_error"] = max(float(found[f"printed_error_{name}"]) for name in RIG)
    for item in excited().meshes["stage_2a"].transmission_error:
        found[f"ste_{item.harmonic}"] = 1e6 * item.amplitude
    for name, printed in (("4883", 4883.0), ("5356", 5356.0)):
        found[f"tone_{name}"] = _nearest_tone(printed, hz, turns)
    stiffness = [_stiffness(helix) for helix in (30.0, 25.0)]
    found["stiffness_change"] = 100.0 * (stiffness[1] / stiffness[0] - 1.0)
    printed, ours = misprints.split_tilt()
    found |= {"tilt_printed": printed, "tilt": ours}
    found["axial_fall"] = 100.0 * (1.0 - math.tan(math.radians(25.0)) / math.tan(math.radians(30.0)))
    return found


def _stiffness(helix_deg: float) -> float:
    """Mean stiffness of a helix of the second stage by the rule of the 16-dof pairs, at its face width."""
    gears = (GearGeometry(z, 4.25e-3, math.radians(25.0), math.radians(helix_deg)) for z in (26, 125))
    return mean_stiffness(helix_deg, pair_geometry(*gears, 0.085), 0.085)


def _nearest_tone(printed: float, hz: dict[str, float], turns: list[float]) -> float:
    """The sum or difference of a mesh harmonic up to 3 and a shaft's frequency nearest to a printed line, in Hz."""
    meshes = [n * hz[name] for name in ("stage_1a", "stage_2a") for n in (1, 2, 3)]
    return min((f + sign * turn for f in meshes for turn in turns for sign in (-1, 1)), key=lambda f: abs(f - printed))


def _modes() -> dict[str, float | str]:
    """Modes beside the printed frequencies and chance."""
    result = rg.modal(loaded(MODEL), fmax=RANGE)
    printed = list(PRINTED)
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
        "as_many": round(100.0 * beside.chance.probability_as_many, 1),
        "branches": _branches(result, near[0]),
        "branch_ratio": _branch_ratio(result, near[0]),
        "branch_ratio_rig": _branch_ratio(result, int(np.argmin(np.abs(result.frequency_hz - 361.0)))),
        "dense_low_found": float(np.count_nonzero(elastic < 1000.0)),
        "dense_high_found": float(np.count_nonzero((elastic > 1000.0) & (elastic < RANGE))) / 4.0,
        "output_share": round(100.0 * _share(result, near[1], "output"), 0),
    }
    for number, name in ((6, "368"), (10, "838"), (15, "1818"), (22, "4410")):
        rig = RIG[name][0]
        nearest = float(elastic[np.argmin(np.abs(elastic - rig))])
        found |= {
            f"error_{name}": abs(100.0 * (float(found[f"mode_{number}"]) / rig - 1.0)),
            f"nearest_{name}": nearest,
            f"nearest_error_{name}": abs(100.0 * (nearest / rig - 1.0)),
            f"partners_{name}": float(np.count_nonzero(np.abs(elastic / rig - 1.0) < TOLERANCE)),
        }
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
            f"largest_{model}": largest * hz,
        }
    return found


def _share(result: rg.ModalResult, mode: int, shaft: str) -> float:
    """Share of a shaft and what stands on it in the kinetic energy of a mode."""
    on_shaft = {f"shafts.{shaft}"}
    for table in ("gears", "disks"):
        on_shaft |= {f"{table}.{name}" for name, part in getattr(result.model, table).items() if part.shaft == shaft}
    return float(sum(values[mode] for name, values in result.kinetic_energy.items() if name in on_shaft))


def _branch_ratio(result: rg.ModalResult, mode: int) -> float:
    """Kinetic energy of the branch that moves more over that of the other."""
    shares = [_share(result, mode, f"branch_{side}") for side in "ab"]
    return max(shares) / min(shares)


def _branches(result: rg.ModalResult, mode: int) -> str:
    """Kinetic energies of both branches in the mode, in %."""
    shares = [100.0 * _share(result, mode, f"branch_{side}") for side in "ab"]
    return f"{shares[0]:.0f} % and {shares[1]:.0f} %" if all(map(math.isfinite, shares)) else "unknown"


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], dict[str, float | str]]] = {"modes": _modes, "lines": _lines}
