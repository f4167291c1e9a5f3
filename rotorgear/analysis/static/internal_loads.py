"""Loads inside shafts and couplings in an equilibrium.

Displacements of a stiff part are far larger than its strains, and these are left with what rounding leaves of a difference. So
the strains are refined, not the displacements: with the forces f_e of all elements as they are, what is missing for equilibrium
deforms the structure once more,

    K dq = f - sum over e of f_e,    f_e <- f_e + B^T D (B dq),

and each round keeps all digits of the strains B dq of its own small displacements (iterative refinement; N. J. Higham, Accuracy
and Stability of Numerical Algorithms, 2nd ed., 2002, chapter 12).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.static.forces import element_forces, inner
from rotorgear.analysis.static.solve import Equilibrated, law_group
from rotorgear.results.internal_load import InternalLoad
from rotorgear.solvers.sparse.pencil import EPS
from rotorgear.system.internal_loads import Cut, cuts, read_loads, weight_in
from rotorgear.system.loads import weight_accelerations

_ROUNDS = 3
# Rounding of a sum of forces, in units of that of its largest one.
_SUMS = 16.0


def internal_loads(equilibrium: Equilibrated) -> tuple[np.ndarray, np.ndarray]:
    """Loads (p,) of the points that read one, in N or N m, and their rounding (p,)."""
    system = equilibrium.system
    every = cuts(system.layout, system.nodes)
    if not every:
        return np.zeros(0), np.zeros(0)
    groups = [*equilibrium.groups, *(law_group(law.part, law.stiffness) for law in equilibrium.laws)]
    at = [cut.element(equilibrium.groups) for cut in every]
    beside = _weights(equilibrium, every, at)
    forces = list(element_forces(equilibrium))
    loads = np.zeros(len(every))
    change = np.zeros(len(every))
    for _ in range(_ROUNDS):
        missing = equilibrium.loads.copy()
        for dofs, force in forces:
            np.add.at(missing, dofs, -force)
        dq = equilibrium.solver.solve((system.dofs.transform.T @ missing)[:, None], carried=True)[:, 0]
        moved = system.dofs.expand(dq)
        forces = [
            (dofs, force + _on_the_same(dofs, group.dofs, inner(group, moved)))
            for (dofs, force), group in zip(forces, groups, strict=True)
        ]
        before = loads
        loads = np.array([cut.load(forces[g][1][e]) for cut, (g, e) in zip(every, at, strict=True)]) - beside
        loads = _in_rigid(equilibrium, every, forces, loads)
        change = np.abs(loads - before)
    largest = max(float(np.abs(force).max(initial=0.0)) for _, force in forces)
    return loads, change + _SUMS * EPS * largest


def _in_rigid(
    equilibrium: Equilibrated, every: Sequence[Cut], forces: list[tuple[np.ndarray, np.ndarray]], loads: np.ndarray
) -> np.ndarray:
    """Loads (p,) with those in rigid couplings, which the forces of all elements lack for equilibrium."""
    if not any(cut.rigid for cut in every):
        return loads
    missing = equilibrium.loads.copy()
    for dofs, force in forces:
        np.add.at(missing, dofs, -force)
    kept = equilibrium.system.conditions
    found = [
        kept.load(cut.part, cut.component, missing) if cut.rigid else load
        for cut, load in zip(every, loads, strict=True)
    ]
    return np.array(found)


def _on_the_same(wanted: np.ndarray, dofs: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Forces (e, d) on other dofs (e, f): those of a law stand on all dofs."""
    if wanted.shape == dofs.shape:
        return force
    found = np.zeros(wanted.shape)
    np.add.at(found, (0, dofs[0]), force[0])
    return found


def _weights(equilibrium: Equilibrated, every: Sequence[Cut], at: Sequence[tuple[int, int]]) -> np.ndarray:
    """What the weight along its element adds to the load of each cut, (p,)."""
    system = equilibrium.system
    gravity = system.model.operation.gravity if system.model.operation else None
    if not gravity:
        return np.zeros(len(every))
    field = weight_accelerations(system, gravity)
    return np.array(
        [cut.load(weight_in(equilibrium.groups[g], e, field)) for cut, (g, e) in zip(every, at, strict=True)]
    )


def load_rows_of(found: Equilibrated, finer: Equilibrated) -> tuple[InternalLoad, ...]:
    """The loads in an equilibrium, with errors by one on twice the elements."""
    loads, rounding = internal_loads(found)
    there, _ = internal_loads(finer)
    rows = []
    for k, (name, unit) in enumerate(read_loads(found.system.model).items()):
        point = found.system.model.points[name]
        rows.append(
            InternalLoad(
                point=name,
                quantity=point.quantity or "",
                axis="xyzxyz"[point.load or 0],
                load=float(loads[k]),
                unit=unit,
                error=float(abs(there[k] - loads[k]) + rounding[k]),
            )
        )
    return tuple(rows)
