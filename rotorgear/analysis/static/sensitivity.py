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

_TOGETHER = 32  # loads that are solved for at once


def sensitivities(
    equilibrium: Equilibrated,
) -> tuple[tuple[str, ...], tuple[str, ...], np.ndarray, tuple[Note, ...]]:
    """Names and units of k parameters, the derivative of the c contact forces by them (k, c), and notes on what is missing."""
    lines = equilibrium.lines
    active = np.where(equilibrium.closed, lines.stiffness, 0.0)
    resists = np.where(equilibrium.closed, lines.tilt_stiffness, 0.0)
    # Name, unit, df - dK q, and the part of dF that does not go through dq.
    terms: list[tuple[str, str, np.ndarray, np.ndarray]] = []
    # Behind the flank that they are told of, index errors close what they open before it.
    opens = np.array([-1.0 if state.behind != state.turned else 1.0 for state in lines.states])
    masks = {mesh: np.array([name == mesh for name in lines.names], float) for mesh in lines.names}
    for mesh, own in masks.items():
        mine = own * active * opens
        terms.append((f"meshes.{mesh}.index_error", "N/m", _sum(lines.vectors, mine), -mine))
    for mesh in masks:
        second = [s.contact.mesh == mesh and s.contact.helix == 1 for s in lines.states]
        if any(second):
            mine = np.array(second) * active * opens
            terms.append((f"meshes.{mesh}.helix_index_error", "N/m", _sum(lines.vectors, mine), -mine))
    for mesh, own in masks.items():
        mine = own * equilibrium.force
        right = -(_sum(lines.vectors, mine) + _sum(lines.tilt, own * equilibrium.moment))
        terms.append((f"meshes.{mesh}.stiffness", "N", right, mine))
    terms += [(part, "N", right, np.zeros(len(active))) for part, right in _stiffness_terms(equilibrium).items()]
    turning = lines.turned.T @ equilibrium.q
    layout = equilibrium.system.layout
    tilting = lines.tilted.T @ equilibrium.q
    cylindrical = {state.contact.mesh for state in lines.states if state.contact.cone is None}
    for mesh, own in masks.items():
        # What turns about an axis leaves the other axis of a bevel pair, and a planet has its place from its carrier.
        if mesh not in cylindrical or layout.mesh(mesh).carrier is not None:
            continue
        right = -(_sum(lines.turned, own * equilibrium.force) + _sum(lines.vectors, own * active * turning))
        right -= _sum(lines.tilted, own * equilibrium.moment)
        right -= _sum(lines.tilt, own * resists * tilting)
        terms.append((f"meshes.{mesh}.centre_line_angle", "N/rad", right, own * active * turning))

    pressed, left = _approaches(equilibrium, [(name, right) for name, _, right, _ in terms])
    kept = [(name, unit, direct) for name, unit, _, direct in terms if name in pressed]
    approach = np.array([pressed[name] for name, *_ in kept]).reshape(len(kept), len(active))
    force = active * approach + np.array([direct for *_, direct in kept]).reshape(approach.shape)
    return tuple(name for name, *_ in kept), tuple(unit for _, unit, _ in kept), force, left


def _sum(columns: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Columns (n, c) times weights (c,), few of which are not zero."""
    used = np.flatnonzero(weights)
    return np.asarray(columns[:, used] @ weights[used])


def _approaches(
    equilibrium: Equilibrated, loads: list[tuple[str, np.ndarray]]
) -> tuple[dict[str, np.ndarray], tuple[Note, ...]]:
    """What named loads (n,) add to the approach of each contact, (c,), and notes on those without a derivative."""
    found: dict[str, np.ndarray] = {}
    left = []
    # Many at once; where one of them really pushes a free motion, which round-off of a stiffness term does not, one by one.
    waiting = [loads[at : at + _TOGETHER] for at in range(0, len(loads), _TOGETHER)]
    while waiting:
        block = waiting.pop(0)
        try:
            dq = equilibrium.solver.solve(np.column_stack([right for _, right in block]))
        except AnalysisError:
            if len(block) == 1:
                left.append(Note(block[0][0], "the derivative by it", "it would set the free motions going"))
            else:
                waiting = [[one] for one in block] + waiting
            continue
        found |= zip([name for name, _ in block], (equilibrium.lines.vectors.T @ dq).T, strict=True)
    return found, tuple(left)


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
