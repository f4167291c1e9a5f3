"""How far apart the stiffest and the softest of a model lie, and which parts they are.

The largest diagonal ratio k_ii / m_ii is a lower bound of the largest omega^2, of its order for shafts and springs (Parlett, The
Symmetric Eigenvalue Problem, section 10.2). An assembled stiffness of doubles resolves omega^2 to about 1e-16 of it.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rotorgear.quantity import millimetres
from rotorgear.solvers.sparse.pencil import EPS
from rotorgear.system.groups import ElementGroup
from rotorgear.system.system import System

WARN_ABOVE = 1e12
# No elements of machines, however fine, come near this.
_HOPELESS = 1e26


def conditioning_warnings(
    system: System, speed: float | None, s: np.ndarray, rigid: np.ndarray, strain_energy: Mapping[str, np.ndarray]
) -> tuple[str, ...]:
    """Say where omega^2 spans more than `WARN_ABOVE`, from which part to which, and what that means for the modes.

    Args:
        system, speed: what was analysed; s, rigid: its modes (m,).
        strain_energy: share of each part in the strain energy of each mode, part -> (m,).
    """
    elastic = np.flatnonzero(~rigid & (np.abs(s) > 0.0))
    ratio = _squares(system, speed)
    if not elastic.size or not ratio.size:
        return ()
    # Damping moves |s| away from omega; the undamped scale of a mode is not below the lower of the two.
    softest = elastic[np.argmin(np.abs(s[elastic]))]
    span = float(ratio.max() / np.abs(s[softest]) ** 2)
    if span < WARN_ABOVE:
        return ()
    stiff = stiffest_part(system, speed or 0.0, int(np.argmax(ratio)))
    soft = max(strain_energy, key=lambda part: float(strain_energy[part][softest]), default="")
    where = f" (mostly {soft})" if soft else ""
    hertz = float(np.abs(s[softest])) / (2.0 * np.pi)
    verdict = "frequencies come from the strains of each element and keep their digits"
    if system.strain_factor(speed or 0.0) is None:
        verdict = f"a 6 x 6 stiffness is indefinite, so that the softest are good to {EPS * span:.0e} only"
    return (f"stiffnesses are {span:.0e} apart in omega^2: {stiff}, against {hertz:.3g} Hz{where}; {verdict}",)


def too_far_apart(system: System, speed: float | None) -> str:
    """Why no solver can tell the motions of a system apart: its parts are more decades apart than two doubles hold; else ""."""
    squares = _squares(system, speed)
    both = np.flatnonzero(squares > 0.0)
    ratio = squares[both]
    if not both.size or ratio.max() < _HOPELESS * ratio.min():
        return ""
    stiff = stiffest_part(system, speed or 0.0, int(both[np.argmax(ratio)]))
    soft = system.dofs.describe(int(both[np.argmin(ratio)]), system.nodes)
    decades = np.log10(ratio.max() / ratio.min())
    apart = f"{decades:.0f} decades apart in omega^2 ({stiff}, against {soft})"
    return f"the parts of the model are {apart}: leave out what is negligible"


def _squares(system: System, speed: float | None) -> np.ndarray:
    """k_ii / m_ii of each free dof, (n,); 0 where it has no inertia."""
    K = system.stiffness(speed or 0.0).diagonal()
    M = system.mass.diagonal()
    return np.where(M > 0.0, K / np.where(M > 0.0, M, 1.0), 0.0)


def stiffest_part(system: System, speed: float, dof: int) -> str:
    """Name the element that gives a free dof the most of its stiffness."""
    column = system.dofs.transform[:, [dof]].toarray()[:, 0]
    best = 0.0
    most: tuple[ElementGroup, int, int] | None = None
    for group in system.groups_at(speed):
        K = group.matrices.stiffness
        if K is None:
            continue
        share = np.diagonal(K, axis1=1, axis2=2) * column[group.dofs] ** 2
        k, local = np.unravel_index(np.argmax(share), share.shape)
        if share[k, local] > best:
            best = float(share[k, local])
            most = group, int(k), int(local)
    if most is None:
        return ""
    group, element, at = most
    kind, _, name = group.part.partition(".")
    if kind != "shafts":
        assert group.matrices.modulus is not None
        unit = "N/m" if kind == "meshes" or at % 6 < 3 else "N m/rad"
        return f"{group.part} has {float(np.max(np.abs(group.matrices.modulus[element]))):.3g} {unit}"
    ends = [int(dof) // 6 for dof in group.dofs[element, [0, 6]]]
    elements = system.nodes.elements[name]
    own = next(item for item in elements if [item.left, item.right] == ends)
    count = sum(item.piece == own.piece for item in elements)
    section = system.model.shafts[name].sections[own.section]
    what = f"section {own.section + 1} of shaft {name}"
    if abs(own.length * count - section.length) > 1e-9 * section.length:
        what = f"a segment of shaft {name} at z = {millimetres(system.nodes.z[own.left])}"
    cut = "" if count == 1 else f" in {count} elements"
    return f"{what} is {millimetres(own.length * count)} long{cut}"
