"""Modal analysis of one rotor with 200 elements, against ROSS: two disks on a shaft (Friswell et al. 2010, example 5.9.2).

A rotor of ROSS has assembled its matrices when it is built, before `run_modal`: beside it stands `modal` of a `System` that has
done so. It keeps its undamped modes from one speed to the next, which ROSS does not: the time of its first call is printed too,
and the times from the model on.
"""

from __future__ import annotations

import sys

import numpy as np

import rotorgear as rg
from rotorgear.system.system import System
from validation.benchmarks.peers.comparison import assembled_system, median_times, print_frequencies, ross, verdict

ELEMENTS = 200
LENGTH = 1.5
SPEED = 100.0
MODES = 22
TURNS = 5
TARGET = 40.0
DISKS = ((67, 0.28), (133, 0.35))  # node and outer diameter in m
STIFFNESS = {"x": 1e6, "y": 0.8e6}
DAMPING = 100.0


def ross_rotor() -> ross.Rotor:
    """The rotor as ROSS builds it, six dofs a node."""
    steel = ross.Material("rotor_steel", rho=7810, E=211e9, G_s=81.2e9)
    shaft = [ross.ShaftElement(L=LENGTH / ELEMENTS, idl=0, odl=0.05, material=steel) for _ in range(ELEMENTS)]
    disks = [ross.DiskElement.from_geometry(n=n, material=steel, width=0.07, i_d=0.05, o_d=d) for n, d in DISKS]
    bearings = [ross.BearingElement(n=n, kxx=STIFFNESS["x"], kyy=STIFFNESS["y"], cxx=DAMPING) for n in (0, ELEMENTS)]
    return ross.Rotor(shaft, disks, bearings)


def own_model() -> rg.Model:
    """The same rotor; the places of the disks cut the shaft into three sections of elements of one length."""
    step = LENGTH / ELEMENTS
    counts = np.diff([0, *(node for node, _ in DISKS), ELEMENTS])
    sections = [{"length": float(n) * step, "outer_diameter": 0.05, "elements": int(n)} for n in counts]
    disks = {
        f"disk_{node}": {"shaft": "rotor", "at": node * step, "outer_diameter": d, "bore": 0.05, "width": 0.07}
        for node, d in DISKS
    }
    bearings = {
        at: {"shaft": "rotor", "at": at, "stiffness": STIFFNESS, "damping": {"radial": DAMPING}}
        for at in ("start", "end")
    }
    return rg.Model(
        materials={"rotor_steel": {"youngs_modulus": 211e9, "shear_modulus": 81.2e9, "density": 7810.0}},
        shafts={"rotor": {"material": "rotor_steel", "sections": sections}},
        disks=disks,
        bearings=bearings,
    )


def own_modes(system: System, speed: float, estimate: bool) -> rg.ModalResult:
    """Modes at a speed. Two more than compared: the rigid ones."""
    return rg.modal(system, speed=speed, modes=MODES + 2, error_estimate=estimate)


def main() -> int:
    """Run both programs, print frequencies and times; 0 if they agree and the ratio of times is met."""
    rotor = ross_rotor()
    model = own_model()
    system = assembled_system(model, 1)
    solve, whole, plain, full, assembled, total, first, assembly = median_times(
        (
            lambda speed: rotor.run_modal(speed, num_modes=2 * MODES),
            lambda speed: ross_rotor().run_modal(speed, num_modes=2 * MODES),
            lambda speed: own_modes(system, speed, False),
            lambda speed: own_modes(system, speed, True),
            lambda speed: own_modes(System(model, 1), speed, True),
            lambda speed: own_modes(System(own_model(), 1), speed, True),
            lambda speed: own_modes(assembled_system(model, 1), speed, False),
            lambda speed: assembled_system(model, 1),
        ),
        SPEED,
        TURNS,
    )
    theirs = rotor.run_modal(SPEED, num_modes=2 * MODES)
    ours = own_modes(system, SPEED, False)
    elastic = np.sort(ours.natural_frequency_hz[~ours.rigid])
    others = np.sort(theirs.wn) / (2 * np.pi)
    others = others[others > 1e-2][:MODES]  # should it list a rigid mode
    worst = print_frequencies("ROSS", others, elastic[:MODES])
    print(f"\n{ours.dofs} dofs, {MODES} modes at {SPEED:g} rad/s, processor time in s")
    print(f"ROSS {ross.__version__}   run_modal {solve:.4f}, with building the rotor {whole:.4f}")
    print(
        f"rotorgear    modal {plain:.4f}, with error estimate {full:.4f}, and assembly {assembled:.4f}, and model {total:.4f}"
    )
    print(f"            first modal of a system {first - assembly:.4f} (ratio {solve / (first - assembly):.1f})")
    print(f"            ratios {solve / plain:.1f}, {solve / full:.1f}, from building on {whole / total:.1f}")
    return verdict(worst, solve / plain, TARGET)


if __name__ == "__main__":
    sys.exit(main())
