"""Modes of the turbo-alternator's geared pair with 63 elements, on its model file, against ROSS (its MultiRotor).

A rotor of ROSS has assembled its matrices when it is built, before `run_modal`: beside it stands `modal` of a `System` that has
done so. It keeps its undamped modes from one speed to the next, which ROSS does not: the time of its first call is printed too,
and the times from the model, and from its file, on.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import rotorgear as rg
from rotorgear.system.system import System
from validation.benchmarks.peers.comparison import assembled_system, median_times, print_frequencies, ross, verdict

FILE = Path(__file__).resolve().parents[3] / "models" / "geared_pair.toml"
REFINE = 9
SPEED = 1500 * np.pi / 30
MODES = 13
TURNS = 9
TARGET = 10.0
FIRST = ((0.1, 0.3), (4.24, 0.3), (1.16, 0.22), (0.3, 0.22))  # length and diameter of the segments in m
SECOND = ((0.3, 0.15), (5.0, 0.15), (0.1, 0.15))


def elements(segments: tuple[tuple[float, float], ...], steel: ross.Material) -> list[ross.ShaftElement]:
    """Each segment in equal elements."""
    return [
        ross.ShaftElement(L=length / REFINE, idl=0.0, odl=diameter, material=steel)
        for length, diameter in segments
        for _ in range(REFINE)
    ]


def ross_rotor() -> ross.MultiRotor:
    """The geared pair as ROSS builds it: six dofs a node, axial ones too."""
    steel = ross.Material(name="rotor_steel", rho=7800, E=207e9, G_s=79.5e9)
    angle = ross.Q_(22.5, "deg")
    wheel = ross.GearElement(
        n=4 * REFINE, m=726.4, Id=56.95, Ip=113.9, n_teeth=328, base_diameter=2 * 0.5086, pr_angle=angle
    )
    pinion = ross.GearElement(n=0, m=5, Id=0.002, Ip=0.004, n_teeth=23, base_diameter=2 * 0.03567, pr_angle=angle)
    first = ross.Rotor(
        elements(FIRST, steel),
        [
            ross.DiskElement(n=REFINE, m=525.7, Id=16.1, Ip=32.2),
            ross.DiskElement(n=2 * REFINE, m=116.04, Id=3.115, Ip=6.23),
            wheel,
        ],
        [ross.BearingElement(n=k * REFINE, kxx=183.9e6, kyy=200.4e6, cxx=3e3) for k in (0, 3)],
    )
    second = ross.Rotor(
        elements(SECOND, steel),
        [pinion, ross.DiskElement(n=2 * REFINE, m=7.45, Id=0.0745, Ip=0.149)],
        [ross.BearingElement(n=k * REFINE, kxx=10.1e6, kyy=41.6e6, cxx=3e3) for k in (1, 3)],
    )
    return ross.MultiRotor(
        first, second, coupled_nodes=(4 * REFINE, 0), gear_mesh_stiffness=1e8, orientation_angle=0.0, position="below"
    )


def own_modes(system: System, speed: float, estimate: bool) -> rg.ModalResult:
    """Modes at a speed. One more than compared: the rigid rotation."""
    return rg.modal(system, speed=speed, modes=MODES + 1, error_estimate=estimate)


def main() -> int:
    """Run both programs, print frequencies and times; 0 if they agree and the ratio of times is met."""
    rotor = ross_rotor()
    model = rg.load(FILE)
    system = assembled_system(model, REFINE)
    solve, whole, plain, full, assembled, total, first, assembly = median_times(
        (
            lambda speed: rotor.run_modal(speed, num_modes=2 * MODES),
            lambda speed: ross_rotor().run_modal(speed, num_modes=2 * MODES),
            lambda speed: own_modes(system, speed, False),
            lambda speed: own_modes(system, speed, True),
            lambda speed: own_modes(System(model, REFINE), speed, True),
            lambda speed: own_modes(System(rg.load(FILE), REFINE), speed, True),
            lambda speed: own_modes(assembled_system(model, REFINE), speed, False),
            lambda speed: assembled_system(model, REFINE),
        ),
        SPEED,
        TURNS,
    )
    theirs = rotor.run_modal(SPEED, num_modes=2 * MODES)
    ours = own_modes(system, SPEED, False)
    others = np.sort(theirs.wd) / (2 * np.pi)
    others = others[others > 1e-2][:MODES]  # should it list a rigid mode
    worst = print_frequencies("ROSS", others, np.sort(ours.frequency_hz[~ours.rigid])[:MODES])
    print(f"\n{rotor.ndof} dofs in ROSS, {ours.dofs} in rotorgear, {MODES} modes at 1500 rpm, processor time in s")
    print(f"ROSS {ross.__version__}   run_modal {solve:.4f}, with building the rotor {whole:.4f}")
    print(
        f"rotorgear   modal {plain:.4f}, with error estimate {full:.4f}, and assembly {assembled:.4f}, and file {total:.4f}"
    )
    print(f"            first modal of a system {first - assembly:.4f} (ratio {solve / (first - assembly):.1f})")
    print(f"            ratios {solve / plain:.1f}, {solve / full:.1f}, from building on {whole / total:.1f}")
    return verdict(worst, solve / plain, TARGET)


if __name__ == "__main__":
    sys.exit(main())
