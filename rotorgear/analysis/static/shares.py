"""How several meshes of one gear, and the two helices of a herringbone, share the load.

Meshes share where one gear drives them all, or is driven by all. With normal forces F_i at one base radius, the share of a
mesh is F_i / sum F, and the sharing factor of n meshes is K_gamma = n max F_i / sum F (ISO 6336-1, for planets).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.static.solve import Equilibrated
from rotorgear.results.static import Share

# A share moves with an index error in a loop; a derivative below this share of the mesh stiffness is rounding.
_DECIDED = 1e-7


def share_rows(
    equilibrium: Equilibrated, parameters: Sequence[str], derivative: np.ndarray
) -> tuple[tuple[Share, ...], np.ndarray]:
    """Return the shares of all groups of meshes, and their derivatives (k, g).

    Args:
        equilibrium: with its contacts. parameters, derivative: of the contact forces, (k, c), as `sensitivities` has them.
    """
    rows: list[Share] = []
    changes: list[np.ndarray] = []
    names = np.array(equilibrium.lines.names)
    contacts = {mesh: names == mesh for mesh in equilibrium.lines.names}
    by = dict(zip(parameters, derivative, strict=True))
    for gear, meshes in _groups(equilibrium).items():
        force = np.array([equilibrium.force[contacts[mesh]].sum() for mesh in meshes])
        total = force.sum()
        if not total:
            continue
        change = np.array([derivative[:, contacts[mesh]].sum(axis=1) for mesh in meshes])  # (meshes, k)
        share = force / total
        moved = (change - share[:, None] * change.sum(axis=0)) / total
        # A gap in both helices moves the sum of their forces in a loop only; between the helices it is no matter of the branch.
        gaps = [by[f"meshes.{mesh}.index_error"] for mesh in meshes]
        stiff = max(sum(abs(gap[own].sum()) for own in contacts.values()) for gap in gaps)
        loop = stiff > _DECIDED * float(equilibrium.lines.stiffness.max())
        for mesh, part, row in zip(meshes, share, moved, strict=True):
            rows.append(Share(gear, mesh, float(part), float(len(meshes) * part), "stiffness" if loop else "loads"))
            changes.append(row)
    return tuple(rows), np.array(changes).T.reshape(len(derivative), len(rows))


def _groups(equilibrium: Equilibrated) -> dict[str, list[str]]:
    """Gear -> its meshes on the driving side, or on the driven side, where there are several."""
    sides: dict[tuple[str, bool], list[str]] = {}
    for state in equilibrium.lines.states:
        contact = state.contact
        for gear, drives in ((contact.pinion, state.pinion_drives), (contact.gear, not state.pinion_drives)):
            meshes = sides.setdefault((gear, drives), [])
            if contact.mesh not in meshes:
                meshes.append(contact.mesh)
    return {gear: meshes for (gear, _), meshes in sides.items() if len(meshes) > 1}


def helix_shares(equilibrium: Equilibrated) -> np.ndarray:
    """Share of each contact in the force of its mesh, (c,); 0 where the mesh carries nothing."""
    names = np.array(equilibrium.lines.names)
    total = np.array([equilibrium.force[names == name].sum() for name in names])
    return np.where(total > 0.0, equilibrium.force / np.where(total > 0.0, total, 1.0), 0.0)


def load_shares(equilibrium: Equilibrated) -> dict[tuple[str, str], float]:
    """Share of each mesh in the load of a gear that it shares: (gear, mesh) -> share."""
    names = np.array(equilibrium.lines.names)
    found: dict[tuple[str, str], float] = {}
    for gear, meshes in _groups(equilibrium).items():
        force = np.array([equilibrium.force[names == mesh].sum() for mesh in meshes])
        if force.sum():
            found |= {(gear, mesh): float(f / force.sum()) for mesh, f in zip(meshes, force, strict=True)}
    return found
