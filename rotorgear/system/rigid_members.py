"""Rigid members: flanks of rigid meshes stay in touch exactly, v . q = 0, so that one dof of each contact follows from others.

Each condition is solved for the dof that it takes away, the largest rotation in it (direct elimination; T. J. R. Hughes, The
Finite Element Method, 1987, section 2.12): the others keep their meaning. The force F along the flank normal then does no work,
and is what is missing for equilibrium before the condition, T^T (f - sum of f_e) = T^T v F.
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
from rotorgear.system.dofs import DofMap
from rotorgear.system.groups import mesh_dofs
from rotorgear.system.nodes import Nodes

# What is left of a condition below this share of it is rounding: the conditions before it have it already.
_NOTHING = 1e-9
_TORSION = 5


@dataclass(frozen=True)
class RigidContacts:
    """Contacts whose flanks do not give.

    Attributes:
        names: mesh of each of m contacts.
        rows: v over all dofs, (m, a): the approach of the flanks.
        before: T (a, n + m) without these conditions.
    """

    names: tuple[str, ...]
    rows: sp.csr_array
    before: sp.csr_array

    def forces(self, missing: np.ndarray) -> np.ndarray:
        """Forces (m,) along the flank normals that make up for what is missing for equilibrium over all dofs, (a,)."""
        if not self.names:
            return np.zeros(0)
        acts = (self.before.T @ self.rows.T).toarray()
        return np.asarray(np.linalg.lstsq(acts, self.before.T @ missing)[0])


def rigid_contacts(layout: Layout, nodes: Nodes, dofs: DofMap, rigid: Sequence[MeshForce]) -> RigidContacts:
    """The contacts of rigid meshes on a map of dofs that does not know them."""
    rows = np.zeros((len(rigid), dofs.transform.shape[0]))
    for row, force in zip(rows, rigid, strict=True):
        np.add.at(row, mesh_dofs(layout, nodes, force)[0][:12], contact_vector(contact_geometry(force)))
    return RigidContacts(tuple(force.contact.mesh for force in rigid), sp.csr_array(rows), dofs.transform)


def without_rigid(dofs: DofMap, contacts: RigidContacts) -> DofMap:
    """The map of the dofs that are left.

    Raises:
        AnalysisError: a mesh whose condition the others hold already, or which nothing can turn.
    """
    if not contacts.names:
        return dofs
    T = sp.csc_array(dofs.transform)
    for name, row in zip(contacts.names, contacts.rows.toarray(), strict=True):
        condition = T.T @ row
        size = np.abs(condition)
        if not size.max(initial=0.0) > _NOTHING * np.abs(row).max(initial=0.0):
            raise AnalysisError(
                f"meshes.{name}: a rigid mesh that closes a loop of rigid meshes, or between shafts that are held: nothing says "
                "what it carries; give it, or another mesh of the loop, a stiffness"
            )
        # A rotation goes first: displacements of the shafts keep their place among the dofs.
        main = np.asarray(abs(T).argmax(axis=0)).ravel()
        turns = np.where((main % 6 == _TORSION) & (size > _NOTHING * size.max()), size, 0.0)
        taken = int(np.argmax(turns if turns.any() else size))
        kept = np.delete(np.arange(len(size)), taken)
        follow = sp.csc_array(-condition[kept][None] / condition[taken])
        T = sp.csc_array(T[:, kept] + T[:, [taken]] @ follow)
    held = {**dofs.held, "rigid meshes": len(contacts.names)}
    return replace(dofs, transform=sp.csr_array(T), column=np.full(len(dofs.column), -1), selects=False, held=held)
