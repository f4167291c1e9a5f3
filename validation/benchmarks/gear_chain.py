"""A chain of geared shafts: what each step of an analysis takes over the number of shafts.

Each shaft carries one helical gear between two bearings and meshes with the next. `large_model` runs this for several lengths,
each in a process of its own; alone,  python -m validation.benchmarks.gear_chain 50  prints one as JSON.
"""

from __future__ import annotations

import os

os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"))

import json
import resource
import sys
import time

import rotorgear as rg
from rotorgear.system.system import System

DISTANCE = 0.1  # m, of neighbouring axes
SPEED = "3000 rpm"
MODES = 24


def chain(shafts: int) -> rg.Model:
    """The model; bearings stiffen by a hundredth from shaft to shaft, so that no two shafts are the same."""
    numbers = range(shafts)
    return rg.Model(
        title=f"Chain of {shafts} geared shafts",
        operation={"input_shaft": "s0", "output_shaft": f"s{shafts - 1}", "speed": SPEED, "power": "10 kW"},
        shafts={
            f"s{k}": {"position": [0.0, DISTANCE * k], "sections": [{"length": 0.3, "outer_diameter": 0.04}]}
            for k in numbers
        },
        gears={
            f"g{k}": {
                "shaft": f"s{k}",
                "at": 0.15,
                "kind": "helical",
                "teeth": 48,
                "normal_module": 0.002,
                "helix_angle": 0.2838,  # cos = 48 x 2 mm/100 mm
                "hand": "right" if k % 2 else "left",
                "width": 0.03,
            }
            for k in numbers
        },
        meshes={f"m{k}": {"pinion": f"g{k - 1}", "gear": f"g{k}", "stiffness": 3e8} for k in numbers[1:]},
        bearings={
            f"b{k}_{end}": {"shaft": f"s{k}", "at": end, "stiffness": {"radial": 1e8 * (1.0 + 0.01 * k), "axial": 1e8}}
            for k in numbers
            for end in ("start", "end")
        },
    )


def measured(shafts: int) -> dict[str, float]:
    """Processor seconds of each step, dofs, and memory in MB."""
    seconds = {}
    last = time.process_time()

    def lap(name: str) -> None:
        nonlocal last
        now = time.process_time()
        seconds[name] = now - last
        last = now

    model = chain(shafts)
    lap("model")
    model.torque_flow()
    system = System(model, 2)
    _ = system.mass, system.stiffness(), system.strain_factor()
    lap("matrices")
    result = rg.modal(system, modes=MODES)
    lap("modes")
    rg.modal(model, modes=MODES, speed=SPEED)
    lap("at speed")
    rg.campbell(model, stop=SPEED, modes=12)
    lap("Campbell")
    return {"dofs": result.dofs, **seconds, "MB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0}


if __name__ == "__main__":
    print(json.dumps(measured(int(sys.argv[1]))))
