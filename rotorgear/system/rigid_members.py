"""Rigid members: flanks of rigid meshes stay in touch exactly, v . q = 0, and so do both sides of a coupling or a bearing in its
rigid directions.

Each such condition is solved for the dof that it takes away (direct elimination; T. J. R. Hughes, The Finite Element Method,
1987, section 2.12): the shaft's own in a bearing, else the largest rotation in it or the largest displacement. The others keep
their meaning. The force F along a flank normal or a direction does no work, and is what is missing for equilibrium before the
condition, T^T (f - sum of f_e) = T^T v F.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from rotorgear.elements.gear_mesh import contact_vector
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.state import MeshForce, contact_geometry
from rotorgear.model.parts.fields import DOF_NAMES
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
        parts: address of the mesh, coupling or bearing of each of m conditions.
        components: 0 of a mesh, whose condition is the approach of a contact, else the number of the relative displacement in
            x y z tilt_x tilt_y torsion.
        rows: v over all dofs, (m, a).
        own: number of the dof of a shaft in its bearing, (m,); -1 elsewhere.
        before: T (a, n + m) without these conditions.
    """

    parts: tuple[str, ...]
    components: tuple[int, ...]
    rows: sp.csr_array
    own: tuple[int, ...]
    before: sp.csr_array

    @property
    def none(self) -> Conditions:
        """None of them."""
        return replace(self, parts=(), components=(), rows=self.rows[[]], own=())

    @property
    def of_meshes(self) -> list[int]:
        """Numbers of the conditions that are contacts."""
        return [k for k, part in enumerate(self.parts) if part.startswith("meshes.")]

    @property
    def of_bearings(self) -> list[int]:
        """Numbers of the conditions that are directions of bearings."""
        return [k for k, part in enumerate(self.parts) if part.startswith("bearings.")]

    def forces(self, missing: np.ndarray) -> np.ndarray:
        """Forces (m,) that make up for what is missing for equilibrium over all dofs, (a,): along v, as a spring there would."""
        return self.from_missing @ (self.before.T @ missing)

    @cached_property
    def from_missing(self) -> np.ndarray:
        """P (m, n + m): the forces by what is missing at the dofs before these conditions."""
        acts = (self.before.T @ self.rows.T).toarray()
        # Moments and forces side by side: each condition in its own unit.
        size = np.linalg.norm(acts, axis=0)
        size[size == 0.0] = 1.0
        return np.asarray(np.linalg.pinv(acts / size) / size[:, None])

    def load(self, part: str, component: int, missing: np.ndarray) -> float:
        """The load in a rigid coupling along or about an axis."""
        found = zip(self.parts, self.components, self.forces(missing), strict=True)
        return float(sum(force for name, k, force in found if (name, k) == (part, component)))


def conditions(layout: Layout, nodes: Nodes, dofs: DofMap, rigid: Sequence[MeshForce]) -> Conditions:
    """The conditions of rigid directions and of contacts of rigid meshes, on a map of dofs that does not know them."""
    parts: list[str] = []
    components: list[int] = []
    own: list[int] = []
    rows: list[np.ndarray] = []

    def add(part: str, component: int, columns: np.ndarray, values: np.ndarray, shaft: int = -1) -> None:
        row = np.zeros(dofs.transform.shape[0])
        np.add.at(row, columns, values)
        parts.append(part)
        components.append(component)
        own.append(shaft)
        rows.append(row)

    moving = [k for motion in layout.model.motions for k in MOTION_DOFS[motion]]
    for address, part in layout.model.parts_of("bearings", "couplings"):
        directions = [k for k in moving if k in part.rigid_directions]
        if not directions:
            continue
        columns, relative = relative_motion(layout, nodes, address)
        for k in directions:
            # The dofs of the shaft stand last in a bearing.
            add(address, k, columns, relative[k], int(columns[k - 6]) if address.startswith("bearings.") else -1)
    for force in rigid:
        columns = mesh_dofs(layout, nodes, force)[0][:12]
        add(f"meshes.{force.contact.mesh}", 0, columns, contact_vector(contact_geometry(force)))
    whole = sp.csr_array(np.array(rows).reshape(len(rows), dofs.transform.shape[0]))
    return Conditions(tuple(parts), tuple(components), whole, tuple(own), dofs.transform)


def followers(kept: Conditions) -> sp.csc_array:
    """E (n + m, n): the dofs before the conditions from those that are left.

    Raises:
        AnalysisError: a condition that the others hold already, or of which nothing can move.
    """
    rows = (kept.rows @ kept.before).toarray()
    sizes = np.abs(kept.rows).max(axis=1).toarray().ravel()
    E = sp.csc_array(sp.eye_array(kept.before.shape[1]))
    for part, component, own, row, whole in zip(kept.parts, kept.components, kept.own, rows, sizes, strict=True):
        condition = E.T @ row
        size = np.abs(condition)
        if not size.max(initial=0.0) > _NOTHING * whole:
            which = "" if part.startswith("meshes.") else f" in {DOF_NAMES[component]}"
            raise AnalysisError(
                f"{part}: a rigid member{which} that closes a loop of rigid members, or stands between shafts that are held: "
                "nothing says what it carries; give it, or another one of the loop, a stiffness"
            )
        taken = _taken(kept, E, size, own)
        left = np.delete(np.arange(len(size)), taken)
        values = -condition[left] / condition[taken]
        others = E[:, left]
        E = sp.csc_array(others + E[:, [taken]] @ sp.csc_array(values[None])) if values.any() else others
    return E


def _taken(kept: Conditions, E: sp.csc_array, size: np.ndarray, own: int) -> int:
    """Number of the dof that a condition with these sizes (n,) of its entries is solved for."""
    # What stands on others follows them: casings keep the motions of their seats.
    by_shaft = size * abs(kept.before[[own], :] @ E).toarray().ravel() if own >= 0 else np.zeros(len(size))
    if by_shaft.max(initial=0.0) > _LEVER * size.max():
        return int(np.argmax(by_shaft))
    # A rotation goes first: displacements of the shafts keep their place among the dofs.
    main = np.asarray(abs(sp.csc_array(kept.before @ E)).argmax(axis=0)).ravel()
    turns = np.where((main % 6 == _TORSION) & (size > _LEVER * size.max()), size, 0.0)
    return int(np.argmax(turns if turns.any() else size))


def without_rigid(dofs: DofMap, kept: Conditions, E: sp.csc_array) -> DofMap:
    """The map of the dofs that are left, by their `followers`."""
    if not kept.parts:
        return dofs
    T = sp.csr_array(dofs.transform @ E)
    held = {**dofs.held, "rigid members": len(kept.parts)}
    # A direction of a bearing on the ground takes its own dof away, and nothing follows.
    if not dofs.selects or E.nnz > E.shape[1]:
        return replace(dofs, transform=T, column=np.full(len(dofs.column), -1), selects=False, held=held)
    column = np.full(len(dofs.column), -1, dtype=dofs.column.dtype)
    column[np.diff(T.indptr) > 0] = T.indices
    return replace(dofs, transform=T, column=column, held=held)
