"""Torsional trains that nothing holds: at random, chains of given inertias with errors in all meshes, and an idler under load."""

from __future__ import annotations

from typing import Any

import numpy as np

import rotorgear as rg


def free_train(seed: int) -> rg.Model:
    """A free train of 2 to 8 shafts whose inertias lie up to 1e4 apart, with lengths and masses of 1e-3 to 1e3 times the usual.

    One in three holds bodies without inertia, one in four a split path, one in four nothing that damps; one in five carries no
    torque, and of the others one in four a torque that pulses. Base radii go as teeth.
    """
    rng = np.random.default_rng(seed)
    length, mass = 10.0 ** rng.uniform(-3.0, 3.0, 2)
    split = rng.random() < 0.25
    count = int(rng.integers(4, 9)) if split else int(rng.integers(2, 9))
    inertia = 1e-3 * 10.0 ** rng.uniform(0.0, 4.0, count) * mass * length**2
    if rng.random() < 1 / 3:
        inertia[rng.random(count) < 0.4] = 0.0
        inertia[int(rng.integers(count))] = 1e-2 * mass * length**2
    teeth = rng.integers(17, 60, count)
    joined = [(i, i + 1) for i in range(count - 1)]
    springs = rng.random(count - 1) < 0.25
    if split:  # shafts 1 and 2 are equal, and both lead from 0 to 3
        teeth[2] = teeth[1]
        joined[:3] = [(0, 1), (0, 2), (1, 3), (2, 3)]
        springs = np.concatenate([np.zeros(4, bool), springs[3:]])
    springs[0] = False
    stiffness = 10.0 ** rng.uniform(7.5, 9.0, len(joined)) * mass
    damped = rng.random() < 0.75
    torque = 0.0 if rng.random() < 0.2 else float(rng.uniform(10.0, 50.0))
    text: dict[str, Any] = {
        "schema_version": 1,
        "title": f"Free train {seed}",
        "motions": ["torsion"],
        "operation": {"input_shaft": "s0", "speed": float(rng.uniform(50.0, 500.0))},
        "shafts": {f"s{i}": {} for i in range(count)},
        "gears": {
            f"g{i}": {
                "shaft": f"s{i}",
                "at": "start",
                "kind": "spur",
                "teeth": int(teeth[i]),
                "base_radius": 1.5e-3 * length * int(teeth[i]),
                "mass": float(inertia[i]) / length**2,
                "polar_inertia": float(inertia[i]),
                "diametral_inertia": 0.5 * float(inertia[i]),
            }
            for i in range(count)
        },
        "meshes": {},
        "couplings": {},
    }
    for (i, j), k, sprung in zip(joined, stiffness, springs, strict=True):
        if sprung:
            at = {"from_shaft": f"s{i}", "to_shaft": f"s{j}", "from_at": "start", "to_at": "start"}
            text["couplings"][f"c{i}{j}"] = at | {"stiffness": {"torsion": float(1e-4 * k * length**2)}}
        else:
            text["meshes"][f"m{i}{j}"] = {
                "pinion": f"g{i}",
                "gear": f"g{j}",
                "stiffness": float(k),
                "centre_line_angle": 0.0,
                "pressure_angle": 0.349,
                "phase": float(rng.uniform(0.0, 6.0)),
                "damping": float(3e2 * mass) if damped else 0.0,
                "stiffness_variation": [{"harmonic": 1, "amplitude": 0.1}],
                "transmission_error": [{"harmonic": 1, "amplitude": 1e-6 * length}],
            }
            if rng.random() < 0.5:
                text["meshes"][f"m{i}{j}"]["backlash"] = 5e-5 * length
    if torque:
        size = torque * mass * length**2
        if rng.random() < 0.25:
            text["loads"] = {
                "drive": {
                    "shaft": "s0",
                    "at": "start",
                    "kind": "input",
                    "torque": size,
                    "ripple": 0.3,
                    "ripple_order": 2.0,
                },
                "brake": {"shaft": f"s{count - 1}", "at": "start", "kind": "output"},
            }
        else:
            text["operation"] |= {"output_shaft": f"s{count - 1}", "torque": size}
    return rg.Model.model_validate(text)


def chain(inertias: list[float], mass: float = 1.0, **mesh: Any) -> rg.Model:
    """Gears of 20, 30, 40 ... teeth in a row under 20 N m, with inertias in kg m^2, all times a factor of mass.

    Each mesh has 2e8 N/m, 4e3 N s/m and an error of 1 um, all in phase; `mesh` changes that.
    """
    count = len(inertias)
    gear = {"at": "start", "kind": "spur"}
    common = {
        "stiffness": 2e8 * mass,
        "damping": 4e3 * mass,
        "centre_line_angle": 0.0,
        "pressure_angle": 0.349,
        "phase": 0.0,
        "transmission_error": [{"harmonic": 1, "amplitude": 1e-6}],
    }
    return rg.Model.model_validate(
        {
            "schema_version": 1,
            "title": "Chain of gears",
            "motions": ["torsion"],
            "operation": {
                "input_shaft": "s0",
                "output_shaft": f"s{count - 1}",
                "speed": 500.0,
                "torque": 20.0 * mass,
            },
            "shafts": {f"s{i}": {} for i in range(count)},
            "gears": {
                f"g{i}": gear
                | {
                    "shaft": f"s{i}",
                    "teeth": 20 + 10 * i,
                    "base_radius": 1.5e-3 * (20 + 10 * i),
                    "mass": 1e3 * J * mass,
                    "polar_inertia": J * mass,
                    "diametral_inertia": 0.5 * J * mass,
                }
                for i, J in enumerate(inertias)
            },
            "meshes": {f"m{i}": common | {"pinion": f"g{i}", "gear": f"g{i + 1}"} | mesh for i in range(count - 1)},
        }
    )


def train(**mesh: Any) -> rg.Model:
    """Three gears in a row, in torsion only."""

    def gear(teeth: int, shaft: str) -> dict[str, Any]:
        sizes = {"teeth": teeth, "base_radius": 1e-3 * teeth, "mass": 1.0}
        inertias = {"polar_inertia": 1e-6 * teeth**2, "diametral_inertia": 5e-7 * teeth**2}
        return {"shaft": shaft, "at": "start", "kind": "spur", **sizes, **inertias}

    shared = {"centre_line_angle": 0.3, "pressure_angle": 0.349, "phase": 0.4, "damping_ratio": 0.05, "backlash": 1e-4}
    shared |= {"transmission_error": [{"harmonic": 1, "amplitude": 1e-6}]}
    return rg.Model(
        schema_version=1,
        motions=["torsion"],
        operation={"input_shaft": "a", "output_shaft": "c", "speed": 120.0, "power": 5e3},
        shafts={name: {} for name in "abc"},
        gears={"pinion": gear(23, "a"), "idler": gear(31, "b"), "wheel": gear(57, "c")},
        meshes={
            "one": {"pinion": "pinion", "gear": "idler", "stiffness": 3e8, **shared, **mesh},
            "two": {"pinion": "idler", "gear": "wheel", "stiffness": 4e8, **shared, **mesh},
        },
    )
