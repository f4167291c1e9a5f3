"""Loads inside shafts and couplings at named points: forces that an element's strains, inertia and damping put on its end.

Cut at a node, the part at larger z acts on the other one with the forces that the element beside the cut needs at that end,

    L = r (B^T (D s + V s') + M a + G v - f),    s = B q, s' = B v,

with f the load along the element, such as its weight. Strains s, not displacements, make the forces: those of stiff parts are
small differences. By the equations of motion the elements on both sides of a node, and each part that a cut leaves, give the
same load to rounding, whatever the mesh; a stress D s alone would keep the error of its shape functions (T. J. R. Hughes,
The Finite Element Method, 1987, section 1.10: consistent fluxes).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.operation import ModelDamping
from rotorgear.model.parts.tables import Tables
from rotorgear.system.groups import ElementGroup, relative_motion
from rotorgear.system.loads import weight_accelerations
from rotorgear.system.nodes import Nodes
from rotorgear.system.system import System

# Of the load that a point reads: its unit.


@dataclass(frozen=True)
class Cut:
    """Where a point reads a load.

    Attributes:
        name: of the point. part: address of the part that is cut.
        dofs: numbers (12,) of the dofs of its element at both ends.
        row: (12,) the load from the forces at these dofs.
        component: number of the load in Fx Fy Fz Mx My Mz.
        rigid: whether it is a rigid coupling, whose load equilibrium alone gives.
    """

    name: str
    part: str
    dofs: np.ndarray
    row: np.ndarray
    component: int = 0
    rigid: bool = False

    def element(self, groups: Sequence[ElementGroup]) -> tuple[int, int]:
        """Number of the group among some that holds its element, and number of the element in it."""
        for number, group in enumerate(groups):
            if group.part == self.part and group.dofs.shape[1] >= len(self.dofs):
                found = np.flatnonzero(np.all(group.dofs[:, : len(self.dofs)] == self.dofs, axis=1))
                if found.size:
                    return number, int(found[0])
        raise KeyError(f"{self.part} has no element there")

    def load(self, force: np.ndarray) -> float:
        """The load from the forces (d,) on all dofs of its element, of which those at the ends come first."""
        return float(self.row @ force[: len(self.row)])


def read_loads(model: Tables) -> dict[str, str]:
    """The points that read a load, in the order of the model, with its unit."""
    return {
        name: point.load_unit
        for name, point in model.points.items()
        if point.quantity is not None and point.load is not None
    }


def cuts(layout: Layout, nodes: Nodes) -> tuple[Cut, ...]:
    """The cuts at all points that read a load, in the order of the model."""
    return tuple(_cut(layout, nodes, name) for name in read_loads(layout.model))


def _cut(layout: Layout, nodes: Nodes, name: str) -> Cut:
    point = layout.model.points[name]
    assert point.load is not None, "checked"
    k = point.load
    row = np.zeros(12)
    if point.on_coupling:
        assert point.on is not None
        dofs, relative = relative_motion(layout, nodes, point.on)
        # A unit of relative displacement by the second end alone does the work of the load.
        row[6:] = np.linalg.inv(relative[:, 6:])[:, k]
        rigid = k in layout.model.couplings[point.on.removeprefix("couplings.")].rigid_directions
        return Cut(name, point.on, dofs, row, k, rigid)
    place = layout.place(f"points.{name}")
    node = nodes.at(*place)
    sections = layout.model.shafts[place.shaft].sections
    beside = {
        side: element
        for element in nodes.elements[place.shaft]
        for side, end in (("right", element.left), ("left", element.right))
        if end == node and not sections[element.section].rigid
    }
    side = point.side or ("right" if "right" in beside else "left")
    element = beside[side]
    # The left end of an element feels the reaction of the load.
    row[k if side == "right" else 6 + k] = -1.0 if side == "right" else 1.0
    ends = np.concatenate([6 * end + np.arange(6) for end in (element.left, element.right)])
    return Cut(name, f"shafts.{place.shaft}", ends, row)


def weight_in(group: ElementGroup, number: int, accelerations: np.ndarray) -> np.ndarray:
    """Weight (d,) along an element of a group in a field of accelerations over all dofs, (a,)."""
    M = group.matrices.mass
    return np.zeros(group.dofs.shape[1]) if M is None else M[number] @ accelerations[group.dofs[number]]


@dataclass(frozen=True)
class LoadRows:
    """Loads of p points as L = q_rows q + v_rows v + a_rows a - weight: rows (p, n) at a reference speed, weight (p,).

    `per_speed`: what q_rows and v_rows grow by for each rad/s of it.
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    weight: np.ndarray
    per_speed: tuple[np.ndarray, np.ndarray]

    def at(self, speed: float) -> LoadRows:
        """The rows at a reference speed in rad/s, from those at standstill."""
        q, v = self.per_speed
        return replace(self, q=self.q + speed * q, v=self.v + speed * v)

    def within(self, basis: np.ndarray) -> LoadRows:
        """The rows on the coordinates of a basis (n, r)."""
        q, v = (rows @ basis for rows in self.per_speed)
        return replace(self, q=self.q @ basis, v=self.v @ basis, a=self.a @ basis, per_speed=(q, v))

    def braked(self, modes: np.ndarray, d: np.ndarray, P: np.ndarray) -> LoadRows:
        """The rows with damping P diag(d) P^T of modes (n, m), P = M modes: it brakes as accelerations modes d P^T v would."""
        return replace(self, v=self.v + ((self.a @ modes) * d) @ P.T)

    def amplitudes(self, w: np.ndarray, q: np.ndarray, speed: float | np.ndarray = 0.0) -> np.ndarray:
        """Complex amplitudes (p, o) of displacements q (n, o) at frequencies w (o,), at this much more speed, in rad/s."""
        v = 1j * w * q
        found = self.q @ q + self.v @ v - w**2 * (self.a @ q)
        by_q, by_v = self.per_speed
        return np.asarray(found + speed * (by_q @ q + by_v @ v))


def load_rows(system: System, speed: float = 0.0) -> LoadRows:
    """Rows of all points that read a load on the free dofs of a system, at a reference speed in rad/s.

    Raises:
        AnalysisError: a rigid coupling, which has no strains.
    """
    every = cuts(system.layout, system.nodes)
    for cut in every:
        if cut.rigid:
            raise AnalysisError(
                f"points.{cut.name}: the load in a rigid coupling is known in statics only; read it in the shaft or coupling "
                "beside it, or give this one a stiffness"
            )
    groups = system.groups_at(speed) if every else []
    T = system.dofs.transform
    gravity = system.model.operation.gravity if system.model.operation else None
    field = weight_accelerations(system, gravity) if gravity else np.zeros(T.shape[0])
    rows = np.zeros((5, len(every), system.n))
    weight = np.zeros(len(every))
    for p, cut in enumerate(every):
        number, e = cut.element(groups)
        group = groups[number]
        of_element = _of_element(group, e, cut.row, system.model.damping)
        rows[:, p] = np.asarray(T[group.dofs[e], :].T @ of_element.T).T
        weight[p] = cut.load(weight_in(group, e, field))
    q, v, a, *per_speed = rows
    return LoadRows(q, v, a, weight, (per_speed[0], per_speed[1])).at(speed)


def _of_element(group: ElementGroup, e: int, ends: np.ndarray, damping: ModelDamping) -> np.ndarray:
    """A load as rows (5, d) on the d dofs of an element: on q, v and a, and on q and v for each rad/s of the reference speed."""
    m = group.matrices
    d = group.dofs.shape[1]
    row = np.zeros(d)
    row[: len(ends)] = ends
    mass = np.zeros(d) if m.mass is None else row @ m.mass[e]
    turning = np.zeros(d) if m.gyroscopic is None else group.spin * (row @ m.gyroscopic[e])
    if m.strain is None:
        return np.array([np.zeros(d), damping.rayleigh_alpha * mass, mass, np.zeros(d), turning])
    B = m.strain[e]
    none = np.zeros((len(B), len(B)))
    D, V, Z, by_speed = (
        none if A is None else A[e] for A in (m.modulus, m.viscosity, m.circulation, m.circulation_per_speed)
    )
    stress = row @ B.T
    return np.array(
        [
            stress @ (D + Z) @ B,
            stress @ (V + damping.rayleigh_beta * D) @ B + damping.rayleigh_alpha * mass,
            mass,
            group.spin * (stress @ by_speed @ B),
            turning,
        ]
    )
