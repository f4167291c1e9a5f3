"""Rigid members: flanks of rigid meshes stay in touch exactly, v . q = 0, and ends of rigid couplings move as one body.

Each such condition is solved for the dof that it takes away, the largest rotation in it or else the largest displacement (direct
elimination; T. J. R. Hughes, The Finite Element Method, 1987, section 2.12): the others keep their meaning. The force F along a
flank normal, or in a coupling, then does no work, and is what is missing for equilibrium before the condition,
T^T (f - sum of f_e) = T^T v F.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from rotorgear.elements.gear_mesh import contact_vector
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.state import MeshForce, contact_geometry
from rotorgear.system.dofs import MOTION_DOFS, DofMap
from rotorgear.system.groups import mesh_dofs, relative_motion
from rotorgear.system.nodes import Nodes

# What is left of a condition below this share of it is rounding: the conditions before it have it already.
_NOTHING = 1e-9
# A rotation is solved for where its lever is no smaller beside the displacements, in m.
_LEVER = 1e-4
_TORSION = 5


@dataclass(frozen=True)
class Conditions:
    """What rigid members keep at zero.

    Attributes:
        parts: address of the mesh or coupling of each of m conditions.
        components: 0 of a mesh, whose condition is the approach of a contact, else the number of the relative displacement in
            x y z tilt_x tilt_y torsion.
        rows: v over all dofs, (m, a).
        before: T (a, n + m) without these conditions.
    """

    parts: tuple[str, ...]
    components: tuple[int, ...]
    rows: sp.csr_array
    before: sp.csr_array

    @property
    def of_meshes(self) -> list[int]:
        """Numbers of the conditions that are contacts."""
        return [k for k, part in enumerate(self.parts) if part.startswith("meshes.")]

    def forces(self, missing: np.ndarray) -> np.ndarray:
        """Forces (m,) that make up for what is missing for equilibrium over all dofs, (a,): along v, as a spring there would."""
        if not self.parts:
            return np.zeros(0)
        acts = (self.before.T @ self.rows.T).toarray()
        # Moments and forces side by side: each condition in its own unit.
        size = np.linalg.norm(acts, axis=0)
        size[size == 0.0] = 1.0
        return np.asarray(np.linalg.lstsq(acts / size, self.before.T @ missing)[0] / size)

    def load(self, part: str, component: int, missing: np.ndarray) -> float:
        """The load in a rigid coupling along or about an axis."""
        found = zip(self.parts, self.components, self.forces(missing), strict=True)
        return float(sum(force for name, k, force in found if (name, k) == (part, component)))


def conditions(layout: Layout, nodes: Nodes, dofs: DofMap, rigid: Sequence[MeshForce]) -> Conditions:
    """The conditions of contacts of rigid meshes and of rigid couplings, on a map of dofs that does not know them."""
    parts: list[str] = []
    components: list[int] = []
    rows: list[np.ndarray] = []

    def add(part: str, component: int, columns: np.ndarray, values: np.ndarray) -> None:
        row = np.zeros(dofs.transform.shape[0])
        np.add.at(row, columns, values)
        parts.append(part)
        components.append(component)
        rows.append(row)

    for name, coupling in layout.model.couplings.items():
        if coupling.rigid:
            columns, relative = relative_motion(layout, nodes, f"couplings.{name}")
            for motion in layout.model.motions:
                for k in MOTION_DOFS[motion]:
                    add(f"couplings.{name}", k, columns, relative[k])
    for force in rigid:
        columns = mesh_dofs(layout, nodes, force)[0][:12]
        add(f"meshes.{force.contact.mesh}", 0, columns, contact_vector(contact_geometry(force)))
    whole = sp.csr_array(np.array(rows).reshape(len(rows), dofs.transform.shape[0]))
    return Conditions(tuple(parts), tuple(components), whole, dofs.transform)


def without_rigid(dofs: DofMap, kept: Conditions) -> DofMap:
    """The map of the dofs that are left.

    Raises:
        AnalysisError: a condition that the others hold already, or of which nothing can move.
    """
    if not kept.parts:
        return dofs
    T = sp.csc_array(dofs.transform)
    for part, row in zip(kept.parts, kept.rows.toarray(), strict=True):
        condition = T.T @ row
        size = np.abs(condition)
        if not size.max(initial=0.0) > _NOTHING * np.abs(row).max(initial=0.0):
            raise AnalysisError(
                f"{part}: a rigid member that closes a loop of rigid members, or stands between shafts that are held: nothing "
                "says what it carries; give it, or another one of the loop, a stiffness"
            )
        # A rotation goes first: displacements of the shafts keep their place among the dofs.
        main = np.asarray(abs(T).argmax(axis=0)).ravel()
        turns = np.where((main % 6 == _TORSION) & (size > _LEVER * size.max()), size, 0.0)
        taken = int(np.argmax(turns if turns.any() else size))
        left = np.delete(np.arange(len(size)), taken)
        follow = sp.csc_array(-condition[left][None] / condition[taken])
        T = sp.csc_array(T[:, left] + T[:, [taken]] @ follow)
    held = {**dofs.held, "rigid members": len(kept.parts)}
    return replace(dofs, transform=sp.csr_array(T), column=np.full(len(dofs.column), -1), selects=False, held=held)
