"""Prints the pairs a to d of four gearboxes by teeth, beside ISO 6336-1: python -m validation.benchmarks.seed_pairs

a 29/113 m_n 2.75, b 26/125 m_n 4.25 (alpha_n 25 deg, beta 30 deg, herringbone, faces 65 and 85 mm a helix), c 34/80 m_n 5
(alpha_n 20, beta 20.86, 54 mm) and d 30/72 m_n 5 (alpha_n 20, beta 33.27, 54 mm); no profile shift, standard centre distance,
200 N/mm of face at the base circle for a and b, 1000 N m a helix on the pinion for c and d. All numbers are per helix.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np

import rotorgear as rg

PAIRS = (
    ("a", 29, 113, 2.75, 25.0, 30.0, 65.0),
    ("a", 29, 113, 2.75, 25.0, 30.0, 32.5),
    ("b", 26, 125, 4.25, 25.0, 30.0, 85.0),
    ("b", 26, 125, 4.25, 25.0, 30.0, 42.5),
    ("c", 34, 80, 5.0, 20.0, 20.86, 54.0),
    ("d", 30, 72, 5.0, 20.0, 33.27, 54.0),
)
LINE_LOAD = 200e3
TORQUE = 1000.0


def model(first: int, second: int, module: float, alpha: float, beta: float, width: float) -> rg.Model:
    """A herringbone pair on two points."""
    gear = {
        "at": 0.0,
        "kind": "herringbone",
        "normal_module": module * 1e-3,
        "normal_pressure_angle": math.radians(alpha),
        "helix_angle": math.radians(beta),
        "width": width * 1e-3,
        "gap": 0.02,
    }
    distance = 0.5e-3 * module * (first + second) / math.cos(math.radians(beta))
    section = [{"length": 0.5, "outer_diameter": 0.05}]
    return rg.Model(
        shafts={
            "one": {"position": (0.0, 0.0), "start": -0.25, "sections": section},
            "two": {"position": (distance, 0.0), "start": -0.25, "sections": section},
        },
        gears={
            "pinion": {**gear, "shaft": "one", "teeth": first, "hand": "right"},
            "wheel": {**gear, "shaft": "two", "teeth": second, "hand": "left"},
        },
        meshes={"pair": {"pinion": "pinion", "gear": "wheel", "stiffness": "tooth_fe"}},
    )


def main(preset: str = "default") -> None:
    """Print the table."""
    print("pair   b mm  T N m   F_bt N  k/b   pp/b  STE pp um  staggered um  tangent/b  ISO c_gamma  seconds")
    for name, first, second, module, alpha, beta, width in PAIRS:
        own = model(first, second, module, alpha, beta, width)
        radius = own.gears["pinion"].teeth * 0.5e-3 * module / math.cos(math.radians(beta))  # type: ignore[operator]
        transverse = math.atan(math.tan(math.radians(alpha)) / math.cos(math.radians(beta)))
        torque = 2.0 * (LINE_LOAD * width * 1e-3 * radius * math.cos(transverse) if name in "ab" else TORQUE)
        start = time.perf_counter()
        found = rg.mesh(own, torque=torque, preset=preset, estimate=False)
        seconds = time.perf_counter() - start
        iso = rg.mesh(own, torque=torque, stiffness="iso")
        assert found.load is not None
        assert found.tangent is not None
        assert found.transmission_error is not None
        e = found.transmission_error
        half = 0.5 * (e + np.roll(e, len(e) // 2))
        per = 1e-9 / (2.0 * found.face_width)
        print(
            f"{name:4} {width:6.1f} {0.5 * torque:6.0f} {0.5 * found.load.base_force_n:8.0f} {per * found.mean_stiffness:6.2f}"
            f" {per * found.peak_to_peak_stiffness:5.2f} {1e6 * (e.max() - e.min()):10.3f}"
            f" {1e6 * (max(half) - min(half)):13.3f} {per * found.tangent.mean():10.2f} {per * iso.mean_stiffness:12.2f}"
            f" {seconds:6.1f} s"
        )
    print(found.body)


if __name__ == "__main__":
    main(*sys.argv[1:])
