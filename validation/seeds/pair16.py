"""The herringbone pair of 16 dofs: contact ratios, ripple of the stiffness, dynamic factor of both pairs and what it hangs on.

`pair` makes such a pair of any teeth by the rules of the model files: masses of solid discs, the mean stiffness of the contact
lines, their ripple 2 sinc(n eps_alpha) sinc(n eps_beta), m_e of the half gears.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import PairGeometry, pair_geometry
from rotorgear.gears.stiffness.dynamic_factor import simple_dynamic_factor
from validation.seeds import kept
from validation.seeds.rows import loaded

MODEL = "herringbone_pair_16dof"
# Printed: teeth, helix angle in deg, impact force in N.
PAIRS = {"a": ((34, 80), 20.86, 2230.0), "b": ((30, 72), 33.27, 1920.0)}
# Printed: helix angle in deg, width in mm, impact force in N.
PRINTED_CASES = ((2.50, 1.25), (2.90, 1.20), (3.20, 1.16), (3.10, 1.17))
CASES = ((15.0, 50.0, 2500.0), (25.0, 50.0, 2100.0), (35.0, 50.0, 1800.0), (25.0, 60.0, 1900.0))
FILES = {"a": MODEL, "b": "herringbone_pair_16dof_b"}
STEPS = 200
SETTLE = 250
COUNT = 60
_HARMONICS = 6


def geometry(teeth: tuple[int, int], helix_deg: float, width: float) -> tuple[GearGeometry, GearGeometry, PairGeometry]:
    """Both gears of module 5 mm and 20 deg, and their mesh over a width in m."""
    one, two = (GearGeometry(z, 5e-3, math.radians(20.0), math.radians(helix_deg)) for z in teeth)
    return one, two, pair_geometry(one, two, width)


def pair(
    teeth: tuple[int, int],
    helix_deg: float,
    width: float,
    impact: float,
    *,
    share: float = 0.33,
    start: float = 0.0,
    flipped: bool = False,
    stiffness: float = 1.0,
    support: float = 1.0,
    damping_ratio: float = 0.109,
) -> rg.Model:
    """A pair by the rules of the model files; the rest are factors on, or other values of, what those assume."""
    one, two, mesh = geometry(teeth, helix_deg, width)
    data = loaded(MODEL).model_dump(exclude_none=True)
    mass, inertia = _halves(one, two, width)
    for i, (name, gear) in enumerate(zip(("pinion", "gear"), (one, two), strict=True)):
        for side in ("left", "right"):
            data["gears"][f"{name}_{side}"] |= {
                "teeth": gear.teeth,
                "helix_angle": gear.helix_angle,
                "width": width,
                "mass": mass[i],
                "polar_inertia": inertia[i],
                "diametral_inertia": 0.5 * inertia[i],
            }
            held = data["supports"][f"{name}_{side}"]
            for key in ("stiffness", "damping"):
                held[key]["radial"] *= support
            held["stiffness"]["torsion"] = inertia[i] * (2.0 * math.pi) ** 2
            held["damping"]["torsion"] = 2.12e-6 * held["stiffness"]["torsion"]
            if name == "gear":
                data["shafts"][f"gear_{side}"]["position"] = (mesh.centre_distance, 0.0)
    data["loads"]["output_left"]["torque"] = 1000.0 * teeth[1] / teeth[0]
    k = stiffness * mean_stiffness(helix_deg, mesh, width)
    m_e = 1.0 / (one.base_radius**2 / inertia[0] + two.base_radius**2 / inertia[1])
    for side in ("left", "right"):
        data["meshes"][side] |= {
            "stiffness": k,
            "damping": 2.0 * damping_ratio * math.sqrt(k * m_e),
            "stiffness_variation": [
                {"harmonic": n + 1, "amplitude": abs(a), "phase": 0.0 if (a > 0.0) != flipped else math.pi}
                for n, a in enumerate(ripple(mesh))
            ],
            "corner_impact": {"force": impact, "duration": share, "at": start},
        }
    return rg.Model(**data)


def _halves(one: GearGeometry, two: GearGeometry, width: float) -> tuple[list[float], list[float]]:
    """Mass (kg) and polar inertia (kg m^2) of half a pinion and half a gear."""
    discs = [7850.0 * math.pi * g.reference_diameter**2 * width / 4.0 for g in (one, two)]
    mass = [discs[0], 0.7 * discs[1]]
    return mass, [
        factor * m * g.reference_diameter**2 / 8.0 for factor, m, g in zip((1.0, 1.3), mass, (one, two), strict=True)
    ]


def mean_stiffness(helix_deg: float, mesh: PairGeometry, width: float) -> float:
    """k_m of one helix (N/m): 0.861 x 14 N/(um mm) cos(beta) (0.75 eps_alpha + 0.25) b."""
    return 0.861 * 14e9 * math.cos(math.radians(helix_deg)) * (0.75 * mesh.transverse_contact_ratio + 0.25) * width


def ripple(mesh: PairGeometry) -> list[float]:
    """Amplitudes of k over its mean, from the length of the contact lines, with their sign."""
    return [
        2.0 * float(np.sinc(n * mesh.transverse_contact_ratio) * np.sinc(n * mesh.overlap_ratio))
        for n in range(1, _HARMONICS + 1)
    ]


def run(model: rg.Model) -> tuple[float, float, float]:
    """K_v (largest force over mean force), mean and largest force (N) of the left helix in steady motion."""
    speed = model.operating_speed or 0.0
    period = 2.0 * math.pi / ((speed or 0.0) * (model.gears["pinion_left"].teeth or 1))
    result = rg.transient(
        model, steps=STEPS, records=STEPS, discard=SETTLE * period, time=COUNT * period, error_estimate=False
    )
    force = result.mesh_force[result.counted, 0]
    return float(force.max() / force.mean()), float(force.mean()), float(force.max())


def spread(teeth: tuple[int, int], helix_deg: float, impact: float, count: int = 40) -> np.ndarray:
    """K_v (count,) over random sets of what the text does not give; the same sets for every pair."""
    chance = np.random.default_rng(4)
    found = []
    for _ in range(count):
        draw: dict[str, Any] = {
            "stiffness": chance.uniform(0.7, 1.4),
            "support": chance.uniform(0.5, 5.0),
            "damping_ratio": chance.uniform(0.03, 0.17),
            "share": chance.uniform(0.1, 0.6),
            "start": chance.uniform(0.0, 1.0),
            "flipped": bool(chance.integers(2)),
        }
        found.append(run(pair(teeth, helix_deg, 0.054, impact, **draw))[0])
    return np.array(found)


def quick() -> dict[str, float | str]:
    """What follows without a run."""
    found: dict[str, float | str] = {
        "impact_drop": 100.0 * (1.0 - 1920.0 / 2230.0),
        "printed_drop": 100.0 * (1.0 - 0.18 / 0.23),
        **_regression(),
    }
    for name, (teeth, helix, _) in PAIRS.items():
        found |= {f"{key}_{name}": value for key, value in _of_teeth(name, teeth, helix).items()}
    found["pp_drop"] = 100.0 * (1.0 - float(found["pp_b"]) / float(found["pp_a"]))
    for number, (helix, width, _) in enumerate(CASES, 1):
        mesh = geometry((34, 80), helix, 1e-3 * width)[2]
        found |= {
            f"case{number}_helix": helix,
            f"case{number}_width": width,
            f"case{number}_eps": mesh.total_contact_ratio,
            f"case{number}_pp": _peak_to_peak(helix, mesh, 1e-3 * width),
        }
    return found


def _regression() -> dict[str, float]:
    """C1, C2 of K_v = 1 + C1/eps^C2 by least squares of the logarithms over the printed table 3."""
    ratio, factor = np.array(PRINTED_CASES).T
    slope, level = np.polyfit(np.log(ratio), np.log(factor - 1.0), 1)
    return {"c1": math.exp(level), "c2": -float(slope)}


def _of_teeth(name: str, teeth: tuple[int, int], helix: float) -> dict[str, float]:
    one, _, mesh = geometry(teeth, helix, 0.054)
    narrow = geometry(teeth, helix, 0.050)[2]
    velocity = 2000.0 * math.pi / 60.0 * one.reference_diameter
    load = 1.1 * 2.0 * 2000.0 / one.reference_diameter / 0.050
    return {
        "eps_alpha": mesh.transverse_contact_ratio,
        "eps_beta": mesh.overlap_ratio,
        "eps_beta_50": narrow.overlap_ratio,
        "eps": narrow.total_contact_ratio,
        "centre": 1e3 * mesh.centre_distance,
        "pp": _peak_to_peak(helix, mesh, 0.054),
        "eps_printed_formula": 0.5 * mesh.transverse_contact_ratio,
        "hz": 2000.0 / 60.0 * teeth[0],
        "torque": 2.0 * (loaded(FILES[name]).loads["input_left"].torque or 0.0),
        "simple": simple_dynamic_factor(velocity, teeth[0], teeth[1] / teeth[0], load, narrow.overlap_ratio, 6).value,
    }


def _peak_to_peak(helix_deg: float, mesh: PairGeometry, width: float) -> float:
    """Of k(t) of one helix in N/m."""
    angle = np.linspace(0.0, 2.0 * np.pi, 721)
    wave = sum(a * np.cos((n + 1) * angle) for n, a in enumerate(ripple(mesh)))
    return float(np.ptp(wave)) * mean_stiffness(helix_deg, mesh, width)


def _loaded_teeth() -> dict[str, float]:
    """Mean and peak to peak of the stiffness of a helix along the flank normal (N/m), by finite elements."""
    found = {}
    for name, file in FILES.items():
        teeth = rg.mesh(loaded(file), "left", stiffness="tooth_fe", torque=1000.0, estimate=False)
        normal = 1.0 / math.cos(teeth.base_helix_angle) ** 2
        found[f"fe_mean_{name}"] = normal * teeth.mean_stiffness
        found[f"fe_pp_{name}"] = normal * teeth.peak_to_peak_stiffness
    return found | {"fe_drop": 100.0 * (1.0 - found["fe_pp_b"] / found["fe_pp_a"])}


def _of_pair(name: str) -> dict[str, float]:
    teeth, helix, impact = PAIRS[name]
    factor, mean, largest = run(loaded(FILES[name]))
    found = {
        "kv": factor,
        "mean": mean,
        "max": largest,
        "kv_shifted": run(pair(teeth, helix, 0.054, impact, start=0.5))[0],
        "kv_flipped": run(pair(teeth, helix, 0.054, impact, flipped=True))[0],
        "kv_no_impact": run(pair(teeth, helix, 0.054, 1e-9))[0],
    }
    return {f"{key}_{name}": value for key, value in found.items()}


def _cases() -> dict[str, float]:
    """K_v of the three cases of table 3."""
    return {
        f"case{number}_kv": run(pair((34, 80), helix, 1e-3 * width, impact))[0]
        for number, (helix, width, impact) in enumerate(CASES, 1)
    }


def _sample(name: str) -> dict[str, list[float]]:
    return {f"sample_{name}": spread(*PAIRS[name]).tolist()}


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], Mapping[str, Any]]] = {
    **{f"pair_{name}": partial(_of_pair, name) for name in PAIRS},
    **{f"sets_{name}": partial(_sample, name) for name in PAIRS},
    "teeth": _loaded_teeth,
    "cases": _cases,
}


@cache
def values() -> dict[str, float | str]:
    """What takes runs."""
    found = kept.values("pair16", PIECES)
    samples = {name: np.array(found.pop(f"sample_{name}")) for name in PAIRS}
    for name, sample in samples.items():
        found |= {f"kv_low_{name}": float(np.quantile(sample, 0.1)), f"kv_high_{name}": float(np.quantile(sample, 0.9))}
    found["dynamic_drop"] = 100.0 * (1.0 - (found["kv_b"] - 1.0) / (found["kv_a"] - 1.0))
    found["share_lower"] = 100.0 * float(np.mean(samples["b"] < samples["a"]))
    return found
