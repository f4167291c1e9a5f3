"""Shafts whose bearings give way along the axis far more than the teeth that push them do under their load.

A helical mesh presses its flanks together by its deflection, and each of its shafts moves by z along its axis: along the flank
normal that is z sin(beta_b). Where it is many times the deflection, softness of bearings along the shaft decides what the drive
yields to its torque: a stiffness that is missing in the file, or bearings that do not carry along the axis well.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rotorgear.analysis.static.forces import bearing_forces
from rotorgear.analysis.static.solve import Equilibrated
from rotorgear.note import Note

# Bearings as stiff along as across give about 1.
_SOFT = 3.0
# Below this share of the axial force of a mesh, bearings carry what two meshes leave that nearly balance on their shaft.
_CARRIED = 0.1


def soft_along_shaft(equilibrium: Equilibrated) -> Iterator[Note]:
    """Yield a fact on each shaft that its bearings let move along its axis far beyond what its teeth give way."""
    lines = equilibrium.lines
    layout = equilibrium.system.layout
    force = bearing_forces(equilibrium)
    travel = _travels(equilibrium)
    contacts: dict[str, list[tuple[float, float, float]]] = {}
    approach = lines.vectors.T @ equilibrium.q - lines.gap
    for state, own, pressed, closed in zip(lines.states, equilibrium.force, approach, equilibrium.closed, strict=True):
        mesh = layout.mesh(state.contact.mesh)
        lean = abs(math.sin(mesh.pinion.base_helix_angle))
        for gear in mesh.gears if closed and lean and pressed > 0.0 else ():
            contacts.setdefault(gear.part.shaft, []).append((lean, float(own), float(pressed)))
    for shaft, pushed in contacts.items():
        holding = [
            name
            for name, bearing in equilibrium.system.model.bearings.items()
            if bearing.shaft == shaft and travel.get(name) and force[name][2]
        ]
        if not holding:
            continue
        carried = abs(sum(force[name][2] for name in holding))
        moved = min((travel[name] for name in holding), key=abs)
        times = max(abs(moved) * lean / pressed for lean, _, pressed in pushed)
        if times < _SOFT or carried < _CARRIED * max(lean * own for lean, own, _ in pushed):
            continue
        stiffness = sum(abs(force[name][2] / travel[name]) for name in holding)
        names = " and ".join(holding)
        size = f"{1e6 * moved:+.3g} um, {times:.1f} times, {1e-6 * stiffness:.3g} N/um of {names}"
        what = "moves along its axis so many times farther than its teeth give way (along the flank normal), on soft bearings"
        remedy = (
            "check their axial stiffness (force over way), or hold the shaft by angular-contact or preloaded bearings"
        )
        yield Note(f"shafts.{shaft}", what, remedy, size)


def _travels(equilibrium: Equilibrated) -> dict[str, float]:
    """Displacement of the shaft in each bearing that has a stiffness along it, against what the bearing stands on, in m."""
    system = equilibrium.system
    q = system.dofs.expand(equilibrium.q)
    found = {}
    for group in equilibrium.groups:
        table, _, name = group.part.partition(".")
        B = group.matrices.strain
        if table != "bearings" or name.endswith(".pedestal") or B is None:
            continue
        along = np.flatnonzero(B[0, :, -4])  # z of the shaft's node, which comes last
        if along.size:
            found[name] = float(B[0, along[0]] @ q[group.dofs[0]])
    for law in equilibrium.laws:
        node = system.nodes.at(*system.layout.place(law.part.part))
        along = np.flatnonzero(law.part.columns[6 * node + 2])
        if law.part.part.startswith("bearings.") and along.size:
            found[law.part.part.removeprefix("bearings.")] = float(law.d[along[0]])
    return found
