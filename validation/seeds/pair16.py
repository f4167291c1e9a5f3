"""The herringbone pair of 16 dofs: contact ratios, ripple of the stiffness, dynamic factor of both pairs and what it hangs on.

`pair` makes such a pair of any teeth by the rules of the model files: masses of solid discs, the mean stiffness of the contact
lines, their ripple 2 sinc(n eps_alpha) sinc(n eps_beta), m_e of the half gears.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import PairGeometry, pair_geometry
from rotorgear.gears.stiffness.dynamic_factor import simple_dynamic_factor
from validation.seeds.models import loaded

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
SETS = 120
_HARMONICS = 6
# Printed: peak to peak of the stiffness, largest and mean force (N) of each pair.
PEAKS = {"a": 4.6533e8, "b": 3.2299e8}
FORCES = {"a": (8600.0, 7000.0), "b": (9750.0, 8259.0)}


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


def spread(teeth: tuple[int, int], helix_deg: float, width: float, impact: float, count: int = SETS) -> np.ndarray:
    """K_v (count,) over random sets of what the text does not give; the same sets for every pair."""
    chance = np.random.default_rng(4)
    sets: list[dict[str, Any]] = [
        {
            "stiffness": chance.uniform(0.7, 1.4),
            "support": chance.uniform(0.5, 5.0),
            "damping_ratio": chance.uniform(0.03, 0.17),
            "share": chance.uniform(0.1, 0.6),
            "start": chance.uniform(0.0, 1.0),
            "flipped": bool(chance.integers(2)),
        }
        for _ in range(count)
    ]
    result = rg.sweep(
        loaded(MODEL),
        {"set": list(range(count))},
        steps=STEPS,
        discard=SETTLE,
        sample=COUNT,
        exponents=0,
        change=lambda _, at: pair(teeth, helix_deg, width, impact, **sets[round(at[0])]),
    )
    return result.largest_force[:, 0, 0] / result.mean_force[:, 0, 0]


def quick() -> dict[str, float | str]:
    """What follows without a run."""
    found: dict[str, float | str] = {
        "impact_drop": 100.0 * (1.0 - 1920.0 / 2230.0),
        "printed_drop": 100.0 * (1.0 - 0.18 / 0.23),
        "pp_printed_drop": 100.0 * (1.0 - 3.2299 / 4.6533),
        "sum_a": 1.59 + 1.13,
        "sum_b": 1.34 + 1.74,
        **_regression(),
    }
    for name, (teeth, helix, _) in PAIRS.items():
        found |= {f"{key}_{name}": value for key, value in _of_teeth(name, teeth, helix).items()}
    found["pp_drop"] = 100.0 * (1.0 - float(found["pp_b"]) / float(found["pp_a"]))
    for name, (largest, mean) in FORCES.items():
        stiffness = float(loaded(FILES[name]).meshes["left"].stiffness)  # type: ignore[arg-type]
        found |= {
            f"kv_forces_{name}": largest / mean,
            f"mean_printed_{name}": mean,
            # The peaks are printed as N/mm.
            f"unit_{name}": 1e3 * PEAKS[name] / (2.0 * stiffness),
        }
    found["implied_ratio"] = float(found["implied_torque_b"]) / float(found["implied_torque_a"])
    found["simple_ratio"] = float(found["simple_b"]) / float(found["simple_a"])
    found["centre_ratio"] = float(found["centre_b"]) / float(found["centre_a"])
    for number, (helix, width, _) in enumerate(CASES, 1):
        mesh = geometry((34, 80), helix, 1e-3 * width)[2]
        found |= {
            f"case{number}_helix": helix,
            f"case{number}_width": width,
            f"case{number}_eps": mesh.total_contact_ratio,
            f"case{number}_pp": _peak_to_peak(helix, mesh, 1e-3 * width),
        }
        found |= {f"case{number}_{key}": value for key, value in _other_teeth(helix, 1e-3 * width).items()}
    found["width_step"] = float(found["case4_eps"]) - float(found["case2_eps"])
    return found


def _other_teeth(helix_deg: float, width: float) -> dict[str, float]:
    """Lowest and highest contact ratio and peak to peak of k over numbers of teeth, which table 3 does not give."""
    meshes = [geometry((one, two), helix_deg, width)[2] for one in range(20, 42, 3) for two in range(60, 111, 10)]
    ratios = [mesh.total_contact_ratio for mesh in meshes]
    peaks = [_peak_to_peak(helix_deg, mesh, width) for mesh in meshes]
    return {
        "eps_low": min(ratios),
        "eps_high": max(ratios),
        # The mean stiffness of the random sets: 0.7 to 1.4 times that of the rule.
        "pp_low": 0.7 * min(peaks),
        "pp_high": 1.4 * max(peaks),
    }


def _regression() -> dict[str, float]:
    """C1, C2 of K_v = 1 + C1/eps^C2 by least squares of the logarithms over the printed table 3."""
    ratio, factor = np.array(PRINTED_CASES).T
    slope, level = np.polyfit(np.log(ratio), np.log(factor - 1.0), 1)
    off = float(np.abs(1.0 + math.exp(level) * ratio**slope - factor).max())
    return {"c1": math.exp(level), "c2": -float(slope), "c_off": off}


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
        "zeta": _damping_ratio(name, one),
        "implied_torque": 2.0 * FORCES[name][1] * _normal_arm(one),
        **_readings(name, one, teeth),
        "simple": simple_dynamic_factor(velocity, teeth[0], teeth[1] / teeth[0], load, narrow.overlap_ratio, 6).value,
    }


def _normal_arm(gear: GearGeometry) -> float:
    """Arm (m) of a force along the flank normal about the axis."""
    return gear.base_radius * math.cos(gear.base_helix_angle)


def _readings(name: str, pinion: GearGeometry, teeth: tuple[int, int]) -> dict[str, float]:
    """Mean force (N) by statics of 2000 N m: on the pinion or on the gear, shared by both helices or on one; the one nearest."""
    on_pinion = 1000.0 / _normal_arm(pinion)
    readings = [factor * on_pinion * share for factor in (1.0, teeth[0] / teeth[1]) for share in (1.0, 2.0)]
    return {
        "mean_static": on_pinion,
        "mean_nearest": min(readings, key=lambda force: abs(force - FORCES[name][1])),
    }


def _damping_ratio(name: str, pinion: GearGeometry) -> float:
    """c / (2 sqrt(k m_e)) of the file, m_e by the account's formula from the rotations of the halves."""
    base = loaded(FILES[name])
    inertia = [base.gears[f"{one}_left"].polar_inertia or 0.0 for one in ("pinion", "gear")]
    radii = (pinion.base_radius, pinion.base_radius * PAIRS[name][0][1] / PAIRS[name][0][0])
    k = float(base.meshes["left"].stiffness)  # type: ignore[arg-type]
    m_e = inertia[0] * inertia[1] / (inertia[0] * radii[1] ** 2 + inertia[1] * radii[0] ** 2)
    return (base.meshes["left"].damping or 0.0) / (2.0 * math.sqrt(k * m_e))


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
    found["fe_ratio"] = found["fe_mean_b"] / found["fe_mean_a"]
    for name in FILES:
        # The swept assumption: contact lines at 0.7 to 1.4 times the stiffness of the rule, or loaded teeth.
        pp = quick()[f"pp_{name}"]
        found[f"pp_low_{name}"] = min(0.7 * float(pp), found[f"fe_pp_{name}"])
        found[f"pp_high_{name}"] = max(1.4 * float(pp), found[f"fe_pp_{name}"])
    return found | {"fe_drop": 100.0 * (1.0 - found["fe_pp_b"] / found["fe_pp_a"])}


def _pairs() -> dict[str, float]:
    """Forces and factors of both pairs, and by how much the part above 1 falls."""
    found = _of_pair("a") | _of_pair("b")
    return found | {"dynamic_drop": 100.0 * (1.0 - (found["kv_b"] - 1.0) / (found["kv_a"] - 1.0))}


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
    """K_v of the four cases of table 3, of the set of the model files and the lowest and highest of random sets."""
    found = {}
    for number, (helix, width, impact) in enumerate(CASES, 1):
        sample = spread((34, 80), helix, 1e-3 * width, impact, 20)
        found |= {
            f"case{number}_kv": run(pair((34, 80), helix, 1e-3 * width, impact))[0],
            f"case{number}_kv_low": float(sample.min()),
            f"case{number}_kv_high": float(sample.max()),
        }
    return found


def _sets() -> dict[str, float | str]:
    """K_v over random sets: deciles and ends of each pair, and the share of the sets in which it falls from A to B."""
    samples = {name: spread(teeth, helix, 0.054, impact) for name, (teeth, helix, impact) in PAIRS.items()}
    found: dict[str, float | str] = {}
    for name, sample in samples.items():
        found |= {
            f"kv_low_{name}": float(np.quantile(sample, 0.1)),
            f"kv_high_{name}": float(np.quantile(sample, 0.9)),
            f"kv_least_{name}": float(sample.min()),
            f"kv_most_{name}": float(sample.max()),
            f"kv_range_{name}": f"{sample.min():.3f} to {sample.max():.3f}",
        }
    share = float(np.mean(samples["b"] < samples["a"]))
    # Two standard errors of a share of so many draws.
    error = 200.0 * math.sqrt(share * (1.0 - share) / SETS)
    return found | {"share_lower": f"{100.0 * share:.0f} +- {error:.0f}"}


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], Mapping[str, Any]]] = {
    "pairs": _pairs,
    "sets": _sets,
    "teeth": _loaded_teeth,
    "cases": _cases,
}
