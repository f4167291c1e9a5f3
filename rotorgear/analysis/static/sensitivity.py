"""How contact forces change with index errors, stiffnesses and centre lines, by direct differentiation of K q = f.

    K dq = df - dK q,    dF_i = k_i (v_i . dq + dv_i . q - de_i) + dk_i (v_i . q - e_i)

for every parameter at once, with the factors of K that are there; the moments of meshes that resist a tilt of their flanks add
the same terms with v_t. Stiffnesses are scaled as a whole: the derivative is that
for 100 % of it. Haftka and Gurdal, Elements of Structural Optimization, 3rd ed., chapter 7 (Kluwer 1992).
"""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.static.solve import Equilibrated
from rotorgear.errors import AnalysisError
from rotorgear.note import Note


def sensitivities(
    equilibrium: Equilibrated,
) -> tuple[tuple[str, ...], tuple[str, ...], np.ndarray, tuple[Note, ...]]:
    """Names and units of k parameters, the derivative of the c contact forces by them (k, c), and notes on what is missing."""
    lines = equilibrium.lines
    active = np.where(equilibrium.closed, lines.stiffness, 0.0)
    resists = np.where(equilibrium.closed, lines.tilt_stiffness, 0.0)
    count = len(active)
    names: list[str] = []
    units: list[str] = []
    rights: list[np.ndarray] = []  # df - dK q
    directs: list[np.ndarray] = []  # the part of dF that does not go through dq

    def add(name: str, unit: str, right: np.ndarray, direct: np.ndarray) -> None:
        names.append(name)
        units.append(unit)
        rights.append(right)
        directs.append(direct)

    meshes = list(dict.fromkeys(lines.names))
    for mesh in meshes:
        mine = np.array([name == mesh for name in lines.names]) * active
        add(f"meshes.{mesh}.index_error", "N/m", lines.vectors @ mine, -mine)
    for mesh in meshes:
        second = [s.contact.mesh == mesh and s.contact.helix == 1 for s in lines.states]
        if any(second):
            mine = np.array(second) * active
            add(f"meshes.{mesh}.helix_index_error", "N/m", lines.vectors @ mine, -mine)
    for mesh in meshes:
        own = np.array([name == mesh for name in lines.names], float)
        mine = own * equilibrium.force
        right = -(lines.vectors @ mine + lines.tilt @ (own * equilibrium.moment))
        add(f"meshes.{mesh}.stiffness", "N", right, mine)
    for part, right in _stiffness_terms(equilibrium).items():
        add(part, "N", right, np.zeros(count))
    for mesh in meshes:
        mine = np.array([name == mesh for name in lines.names], float)
        turning = lines.turned.T @ equilibrium.q
        right = -(lines.turned @ (mine * equilibrium.force) + lines.vectors @ (mine * active * turning))
        right -= lines.tilted @ (mine * equilibrium.moment)
        right -= lines.tilt @ (mine * resists * (lines.tilted.T @ equilibrium.q))
        add(f"meshes.{mesh}.centre_line_angle", "N/rad", right, mine * active * turning)

    # Round-off of a stiffness term on the free motions is no load; a term that really pushes one has no derivative.
    kept = []
    dropped = []
    columns = []
    for k, right in enumerate(rights):
        try:
            columns.append(equilibrium.solver.solve(right[:, None])[:, 0])
            kept.append(k)
        except AnalysisError:
            dropped.append(names[k])
    dq = np.array(columns).T if columns else np.zeros((len(equilibrium.q), 0))
    force = (active[:, None] * (lines.vectors.T @ dq)).T + np.array(directs)[kept]
    left = tuple(Note(name, "the derivative by it", "it would set the free motions going") for name in dropped)
    return tuple(names[k] for k in kept), tuple(units[k] for k in kept), force, left


def _stiffness_terms(equilibrium: Equilibrated) -> dict[str, np.ndarray]:
    """-K_part q of every shaft, bearing, support and coupling: part.stiffness -> (n,)."""
    system = equilibrium.system
    q = system.dofs.expand(equilibrium.q)
    terms: dict[str, np.ndarray] = {}
    for group in equilibrium.groups:
        K = group.matrices.stiffness
        if K is None or group.part.startswith("meshes."):
            continue
        inner = np.zeros_like(q)
        np.add.at(inner, group.dofs, np.einsum("eij,ej->ei", K, q[group.dofs]))
        name = f"{group.part}.stiffness"
        terms[name] = terms.get(name, 0.0) - system.dofs.transform.T @ inner
    return {name: term for name, term in terms.items() if np.any(term)}
