"""Energies of a system as quadratic forms over a few shapes: what modes need, and what says which excitation takes part in them.

With shapes V (all dofs) every form is V^T A V, summed element by element; stiffness from strains, so that nothing cancels.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rotorgear.model.model import Model
from rotorgear.system.groups import ElementGroup
from rotorgear.system.system import System

STIFFNESS = 0
MASS = 1
GYROSCOPIC = 2


@dataclass(frozen=True)
class FormNames:
    """Which form stands where: the first three are K, M and the skew W G; then meshes, then three for each shaft."""

    meshes: tuple[str, ...]
    shafts: tuple[str, ...]

    @classmethod
    def of(cls, model: Model) -> FormNames:
        """Those of a model."""
        return cls(tuple(model.meshes), tuple(model.shafts))

    def __len__(self) -> int:
        return 3 + len(self.meshes) + 3 * len(self.shafts)

    def mesh(self, name: str) -> int:
        """Twice the strain energy of a mesh."""
        return 3 + self.meshes.index(name)

    def kinetic(self, shaft: str) -> int:
        """Kinetic energy of a shaft and what is on it, over that of unit velocities: its mass matrix."""
        return 3 + len(self.meshes) + 3 * self.shafts.index(shaft)

    def bending(self, shaft: str) -> int:
        """The same of its bending alone."""
        return self.kinetic(shaft) + 1

    def swept(self, shaft: str) -> int:
        """M J of its bending, skew, J (x, y) = (y, -x): i q^H M J q is the area swept about +z."""
        return self.kinetic(shaft) + 2


def forms_of(system: System, speed: float, V: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return all forms (a, r, r) over shapes V (n, r) of the free dofs at a reference speed in rad/s."""
    names = FormNames.of(system.model)
    q = np.asarray(system.dofs.expand(V))
    turned = _turned(q, len(system.nodes))
    found = np.zeros((len(names), V.shape[1], V.shape[1]))
    for group in system.groups_at(speed):
        m = group.matrices
        local = q[group.dofs]  # (e, d, r)
        if m.strain is not None and m.modulus is not None:
            strains = m.strain @ local
            K = _summed(strains, m.modulus @ strains)
            found[STIFFNESS] += K
            table, _, name = group.part.partition(".")
            if table == "meshes":
                found[names.mesh(name)] += K
        if m.gyroscopic is not None and group.spin and speed:
            found[GYROSCOPIC] += speed * group.spin * _summed(local, m.gyroscopic @ local)
        if m.mass is not None:
            M = _summed(local, m.mass @ local)
            found[MASS] += M
            if group.shaft in names.shafts:
                found[names.kinetic(group.shaft)] += M
                _add_bending(found, names, group, local, turned[group.dofs])
    return found


def _add_bending(
    found: NDArray[np.float64],
    names: FormNames,
    group: ElementGroup,
    local: NDArray[np.float64],
    turned: NDArray[np.float64],
) -> None:
    dofs = np.array([motion == "bending" for motion in group.dof_motions])
    if not dofs.any():
        return
    assert group.matrices.mass is not None
    own = group.matrices.mass[:, dofs][:, :, dofs]
    found[names.bending(group.shaft)] += _summed(local[:, dofs], own @ local[:, dofs])
    swept = _summed(local[:, dofs], own @ turned[:, dofs])
    found[names.swept(group.shaft)] += 0.5 * (swept - swept.T)


def _turned(q: NDArray[np.float64], nodes: int) -> NDArray[np.float64]:
    """J q: (y, -x) in place of (x, y) of every node, tilts the same; what bends inside an element sweeps nothing by itself."""
    out = np.zeros_like(q)
    for first in (0, 3):
        x = np.arange(nodes) * 6 + first
        out[x] = q[x + 1]
        out[x + 1] = -q[x]
    return out


def _summed(left: NDArray[np.float64], right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum over elements e of left_e^T right_e, (e, d, r) each."""
    r = left.shape[-1]
    return np.asarray(left.reshape(-1, r).T @ right.reshape(-1, r))
