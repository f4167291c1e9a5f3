"""Loaded contact of all shipped models at five times their load: python -m validation.benchmarks.overload [models]

Every mesh of gears with teeth is solved at 64 positions under 1 and 5 times the load that the torque flow gives it; where none
flows, 300 N for each millimetre of face stand for it. Printed are the residual of the contact conditions, as a share of the
approach, the least eigenvalue of the tangent compliance, which is positive where the energy is convex, and the largest pressure.
It ends with 1 where a position has no solution or a residual above 1e-9.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import rotorgear as rg
from rotorgear.errors import RotorgearError
from rotorgear.gears.loaded.loaded_contact import tangent_compliance
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, loaded_cycle
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.model.layout.mesh_layout import MeshLayout

MODELS = Path(__file__).parents[2] / "models"
POSITIONS = 64
FACTORS = (1.0, 5.0)
LINE_LOAD = 3e5
MOST_RESIDUAL = 1e-9


def least_eigenvalue(cycle: MeshCycle) -> float:
    """Smallest eigenvalue of all tangent compliances (m/N): positive where the energy of the contact is convex."""
    return min(
        float(np.linalg.eigvalsh(tangent_compliance(contact, state.force))[0])
        for contact, state in zip(cycle.contacts, cycle.states, strict=True)
    )


def loads(model: rg.Model) -> list[tuple[MeshLayout, ToothPair, float]]:
    """Each mesh of gears with teeth, one helix of it, and F_bt (N) of that helix."""
    found = []
    torque = model.operation is not None and bool(model.torque_flow(1).applied)
    for name in model.meshes:
        mesh = model.layout.mesh(name)
        if mesh.pinion.geometry is None or mesh.gear.geometry is None:
            continue
        forces = model.torque_flow(1).of_mesh(name) if torque else ()
        force = max((abs(one.normal_force) * np.cos(one.contact.base_helix_angle) for one in forces), default=0.0)
        sense = forces[0].torque_sense if forces else 1
        found.append((mesh, mesh.working_teeth(sense), float(force or LINE_LOAD * mesh.width)))
    return found


def main(words: list[str]) -> int:
    """Print the table."""
    print(
        "model                     mesh      F_bt N   factor  residual  least eigenvalue, m/N  p_max, MPa", flush=True
    )
    good = True
    for path in sorted(MODELS.glob("*.toml")):
        if words and path.stem not in words:
            continue
        for mesh, teeth, force in loads(rg.load(path)):
            for factor in FACTORS:
                row = f"{path.stem:25s} {mesh.name:9s} {force:7.0f} {factor:8g}"
                try:
                    cycle = loaded_cycle(teeth, factor * force, np.arange(POSITIONS) / POSITIONS)[1]
                except RotorgearError as error:
                    print(f"{row}  {error}", flush=True)
                    good = False
                    continue
                residual = cycle.residual / float(cycle.deflection.mean())
                good &= residual <= MOST_RESIDUAL
                print(
                    f"{row} {residual:9.1e} {least_eigenvalue(cycle):23.1e} {1e-6 * cycle.pressure.max():11.0f}",
                    flush=True,
                )
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
