"""A response at a crawl against the loaded contact itself: harmonics 1 to 5 and peak to peak of the approach.

    python -m validation.benchmarks.crawl

The force of a single mesh is given by the torque, so that the approach at a crawl is the static transmission error of the loaded
contact at that force: solved here at 1024 positions, without any map. Errors of harmonics are relative to themselves, or to half
the largest one where that is more; peak to peak is that of the sum of all orders of the response.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.gears.loaded.mesh_cycle import mesh_cycle
from rotorgear.gears.loaded.tooth_contact import contact_problem

POSITIONS = 1024
TORQUE = 2000.0
CRAWL = 0.1  # rad/s: some 1e-4 of the lowest elastic mode


def spur_pair(torque: float, **flank: Any) -> rg.Model:
    """The pair 34/80 of docs/mesh.md; `flank` goes to both gears, by the gear's name where it is a table of both."""
    gears = {}
    for name, shaft, teeth in (("pinion", "input", 34), ("wheel", "output", 80)):
        own = {key: value[name] if isinstance(value, dict) and name in value else value for key, value in flank.items()}
        own = {key: value for key, value in own.items() if value is not None}
        gears[name] = {
            "shaft": shaft,
            "at": "100 mm",
            "kind": "spur",
            "teeth": teeth,
            "normal_module": "5 mm",
            "width": "54 mm",
            **own,
        }
    ends = [(shaft, end) for shaft in ("input", "output") for end in ("start", "end")]
    return rg.Model(
        operation={"input_shaft": "input", "output_shaft": "output", "torque": torque, "speed": "1000 rpm"},
        shafts={
            "input": {"position": [0.0, 0.0], "sections": [{"length": "200 mm", "outer_diameter": "80 mm"}]},
            "output": {"position": ["285 mm", 0.0], "sections": [{"length": "200 mm", "outer_diameter": "120 mm"}]},
        },
        gears=gears,
        meshes={"stage": {"pinion": "pinion", "gear": "wheel", "stiffness": "tooth_fe"}},
        bearings={
            f"{shaft}_{end}": {"shaft": shaft, "at": end, "stiffness": {"radial": "5e8 N/m", "axial": "1e8 N/m"}}
            for shaft, end in ends
        },
    )


def errors(model: rg.Model) -> tuple[np.ndarray, float, np.ndarray, float]:
    """Harmonics 1 to 5 (5,) and peak to peak of the contact in m, and the relative errors of the response."""
    mean = model.mean_load(1)
    state = mean.forces[0]
    mesh = model.layout.mesh(state.contact.mesh)
    load = state.normal_force * np.cos(state.contact.base_helix_angle)
    cycle = mesh_cycle(contact_problem(mesh.helix_teeth(0, state.torque_sense)), load, np.arange(POSITIONS) / POSITIONS)
    exact = np.abs(2.0 * np.fft.fft(cycle.deflection)[1:6]) / POSITIONS
    width = float(np.ptp(cycle.deflection))
    found = rg.response(model, speeds=[CRAWL], modal_damping=0.05, elements=1, method="direct")
    numbers = [int(order.rpartition(" ")[2].removesuffix("x")) for order in found.orders]
    approach = dict(zip(numbers, found.approach[:, 0, 0], strict=True))
    got = np.array([abs(approach.get(n, 0.0)) for n in range(1, 6)])
    u = np.arange(8 * POSITIONS) / (8 * POSITIONS)
    whole = sum((a * np.exp(2j * np.pi * n * u)).real for n, a in approach.items())
    scale = np.maximum(exact, 0.5 * exact.max())
    return exact, width, (got - exact) / scale, float(np.ptp(whole)) / width - 1.0


def main() -> None:
    """Print the table."""
    relief = {"tip_relief": "30 um", "tip_relief_diameter": {"pinion": "175 mm", "wheel": "405 mm"}}
    print("pair 34/80 spur          torque  h1 um  pp um  largest error of h1 to h5  error of pp")
    for name, flank in (("bare", {}), ("tip relief 30 um", relief)):
        for share in (0.5, 1.0, 2.0):
            exact, width, off, pp = errors(spur_pair(share * TORQUE, **flank))
            print(
                f"{name:24s} {share * TORQUE:6.0f}  {1e6 * exact[0]:5.3f}  {1e6 * width:5.2f}  "
                f"{100.0 * np.abs(off).max():23.2f} %  {100.0 * pp:9.2f} %"
            )


if __name__ == "__main__":
    main()
