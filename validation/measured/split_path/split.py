"""Share of a path that is ahead by a clocking error, by statics of two equal paths of an assumed stiffness."""

from __future__ import annotations

from typing import Any

import rotorgear as rg

TORQUE = 367.0
CLOCKING = 1.2e-3
RADIUS = 0.06
# Teeth that are stiff beside the shafts of the paths.
TEETH = 1e12


def measure(quantity: str, mode: str) -> float:
    """Share in % with a stiffness of so many kN m/rad in each path."""
    found = rg.static(two_paths(1e3 * float(mode)))
    shares = [100.0 * row.share for row in found.shares if row.gear == "input"]
    return max(shares)


def two_paths(stiffness: float) -> rg.Model:
    """An input gear between two equal paths, each of two gears and the shaft between them, and an output gear."""
    gear: dict[str, Any] = {"kind": "spur", "teeth": 40, "base_radius": RADIUS, "at": "start"}
    gear |= {"mass": 1.0, "polar_inertia": 1e-3, "diametral_inertia": 1e-3}
    names = ("input", "a_in", "b_in", "a_out", "b_out", "output")
    mesh: dict[str, Any] = {"stiffness": TEETH, "pressure_angle": "20 deg"}
    return rg.Model(
        title="Two paths",
        motions=("torsion",),
        operation={"input_shaft": "input", "output_shaft": "output", "speed": "1000 rpm", "torque": TORQUE},
        shafts={name: {} for name in names},
        gears={name: {**gear, "shaft": name} for name in names},
        meshes={
            "a_first": {**mesh, "pinion": "input", "gear": "a_in", "centre_line_angle": "60 deg"},
            "b_first": {**mesh, "pinion": "input", "gear": "b_in", "centre_line_angle": "-60 deg"},
            "a_second": {**mesh, "pinion": "a_out", "gear": "output", "centre_line_angle": "-60 deg"},
            "b_second": {
                **mesh,
                "pinion": "b_out",
                "gear": "output",
                "centre_line_angle": "60 deg",
                "index_error": CLOCKING * RADIUS,
            },
        },
        couplings={
            f"path_{path}": {"from_shaft": f"{path}_in", "to_shaft": f"{path}_out", "stiffness": {"torsion": stiffness}}
            for path in "ab"
        },
    )
