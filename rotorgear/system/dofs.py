"""Degrees of freedom: which of the six of every node are free, how rigid stretches of shaft tie nodes together, and how teeth
move that stand on elastic gear bodies.

All displacements q_all (6 a node, then the internal ones of the elements) follow from the free ones by q_all = T q. Without
rigid sections and such bodies T only selects.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.elements.spring import rigid_transfer
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.model.parts.tables import Tables
from rotorgear.system.nodes import CASING, FOLLOWS, GEAR_BODY, Nodes

MOTION_DOFS = {"bending": (0, 1, 3, 4), "axial": (2,), "torsion": (5,)}
# Rows and columns are numbered as SuperLU takes them: others are checked and copied at each factorisation.
INDEX = np.int32
_FIXED = {"x": (0,), "y": (1,), "z": (2,), "tilt_x": (3,), "tilt_y": (4,), "torsion": (5,), "all": (0, 1, 2, 3, 4, 5)}


@dataclass(frozen=True)
class DofMap:
    """Map from the n free degrees of freedom to all a of them: 6 p of the nodes, then the internal ones of the elements.

    Attributes:
        transform: T, sparse, shape (a, n).
        column: for each of the a dofs its place among the n where T only selects, -1 where it is held.
        selects: whether T only selects.
        held: number of dofs held by supports, by motion of the model, and tied by rigid sections.
    """

    transform: sp.csr_array
    column: np.ndarray
    selects: bool
    held: dict[str, int]

    @property
    def n(self) -> int:
        """Number of free degrees of freedom."""
        return int(self.transform.shape[1])

    def expand(self, q: np.ndarray) -> np.ndarray:
        """All displacements from the free ones: (n, ...) -> (a, ...)."""
        if not self.selects:
            return self.transform @ q
        free = self.column >= 0
        everything = np.zeros((len(free), *q.shape[1:]), dtype=q.dtype)
        everything[free] = q
        return everything

    def names(self, nodes: Nodes) -> dict[str, str]:
        """Name -> SI unit of each free dof: that of the first node that it moves by one, else what it is and no unit."""
        of_nodes = dofs_of_nodes(nodes)
        T = sp.csc_array(self.transform[: len(of_nodes)])
        found = {}
        for k in range(self.n):
            column = slice(T.indptr[k], T.indptr[k + 1])
            moved = T.indices[column][T.data[column] == 1.0]
            first = of_nodes[min(moved)] if len(moved) else ""
            if first and first not in found:
                found[first] = "rad" if min(moved) % 6 > 2 else "m"
            else:
                found[f"{self.describe(k, nodes)} [{k}]"] = ""
        return found

    def describe_some(self, dofs: Sequence[int], nodes: Nodes) -> str:
        """Say which displacements some free dofs are: the first four, and how many more."""
        named = "; ".join(self.describe(dof, nodes) for dof in dofs[:4])
        return f"{named} and {len(dofs) - 4} more" if len(dofs) > 4 else named

    def describe(self, dof: int, nodes: Nodes) -> str:
        """Say which displacement a free dof is, for messages."""
        row = int(np.argmax(np.abs(self.transform[:, [dof]].toarray()[:, 0])))
        if row >= 6 * len(nodes):
            number = row - 6 * len(nodes)
            for (gear, _), own in nodes.teeth.items():
                if own == number:
                    return f"rotation of the teeth of gear '{gear}' against its shaft"
            for name, (first, end) in nodes.casings.items():
                if first <= number < end:
                    return f"dof {number - first + 1} of casing '{name}'"
            for name, (first, end) in nodes.bodies.items():
                if first <= number < end:
                    return f"elastic dof {number - first + 1} of gear '{name}'"
            return f"an internal {nodes.internal[number]} dof of a shaft element"
        node, k = divmod(row, 6)
        return f"{DOF_NAMES[k]} of shaft '{nodes.shaft[node]}' at z = {nodes.z[node]:.6g} m"


def dofs_of_nodes(nodes: Nodes) -> list[str]:
    """Names of the six motions of all nodes, such as "shafts.input(120 mm):tilt_x"."""
    counts: dict[str, int] = {}
    named = []
    for shaft, z in zip(nodes.shaft, nodes.z, strict=True):
        place = f"shafts.{shaft}({1e3 * z:.9g} mm)"
        # A gear with teeth apart, or two parts at one place, have nodes of one place.
        counts[place] = counts.get(place, 0) + 1
        named.append(place if counts[place] == 1 else f"{place}#{counts[place]}")
    return [f"{place}:{direction}" for place in named for direction in DOF_NAMES]


def map_dofs(layout: Layout, nodes: Nodes) -> DofMap:
    """Return the map of free degrees of freedom from motions, fixed supports, pedestals and rigid sections."""
    model = layout.model
    count = len(nodes)
    held = np.zeros((count, 6), dtype=bool)
    for motion, dofs in MOTION_DOFS.items():
        if not model.has(motion):
            held[:, dofs] = True
    by_motion = int(held.sum())
    for name, support in model.supports.items():
        node = nodes.at(*layout.place(f"supports.{name}"))
        for direction in support.fixed:
            held[node, _FIXED[direction]] = True
    for name, bearing in model.bearings.items():
        if bearing.pedestal is not None:
            K = np.array(bearing.pedestal.stiffness.as_rows(), dtype=bool)
            held[nodes.of_pedestal(name), ~((K.any(axis=0) | K.any(axis=1)) & (np.arange(6) < 3))] = True
    for name in layout.ring_seats:
        held[nodes.at(*layout.place(f"gears.{name}"))] = True  # it moves with its seat
    by_support = int(held.sum()) - by_motion
    follows = np.array([motion == FOLLOWS for motion in nodes.internal], dtype=bool)
    inside = np.array([motion not in (*model.motions, CASING, GEAR_BODY) for motion in nodes.internal], dtype=bool)
    by_motion += int((inside & ~follows).sum())
    groups = rigid_groups(model, nodes)
    counts = {"motions": by_motion, "supports": by_support, "rigid sections": sum(6 * (len(g) - 1) for g in groups)}
    follow = layout.planets if not model.has("bending") else ()
    if groups or nodes.feet or follow or layout.ring_seats:
        tied = _with_feet(_tied(nodes, held, inside, groups, counts), layout, nodes)
        tied = _with_rings(tied, layout, nodes)
        return _with_planets(tied, layout, nodes) if follow else tied
    free = np.flatnonzero(~np.concatenate([held.ravel(), inside]))
    size = held.size + inside.size
    column = np.full(size, -1, dtype=INDEX)
    column[free] = np.arange(free.size)
    starts = np.concatenate([np.zeros(1, dtype=INDEX), np.cumsum(column >= 0, dtype=INDEX)])
    T = sp.csr_array((np.ones(free.size), np.arange(free.size, dtype=INDEX), starts), shape=(size, free.size))
    return DofMap(T, column, True, counts)


def rigid_groups(model: Tables, nodes: Nodes) -> list[list[int]]:
    """List the runs of neighbouring nodes joined by rigid sections."""
    groups: list[list[int]] = []
    for name, elements in nodes.elements.items():
        sections = model.shafts[name].sections
        for element in (element for element in elements if sections[element.section].rigid):
            if groups and groups[-1][-1] == element.left:
                groups[-1].append(element.right)
            else:
                groups.append([element.left, element.right])
    return groups


def _tied(
    nodes: Nodes, held: np.ndarray, inside: np.ndarray, groups: list[list[int]], counts: dict[str, int]
) -> DofMap:
    """Build T where rigid groups move with their first node, within what holds any of their nodes."""
    of_node = {node: group for group in groups for node in group}
    rows = []
    cols = []
    values = []
    n = 0
    for first in range(len(nodes)):
        group = of_node.get(first, [first])
        if group[0] != first:
            continue
        transfer = [rigid_transfer(np.array([0.0, 0.0, nodes.z[node] - nodes.z[first]])) for node in group]
        constraints = np.vstack([carried[held[node]] for carried, node in zip(transfer, group, strict=True)])
        used = constraints != 0.0
        # Constraints that each hold a single dof leave a plain selection of the others.
        plain = np.all(used.sum(axis=1) == 1)
        free = np.eye(6)[:, ~used.any(axis=0)] if plain else la.null_space(constraints)
        for carried, node in zip(transfer, group, strict=True):
            block = carried @ free
            r, c = np.nonzero(block)
            rows.append(6 * node + r)
            cols.append(n + c)
            values.append(block[r, c])
        n += free.shape[1]
    internal = np.flatnonzero(~inside)
    rows.append(held.size + internal)
    cols.append(n + np.arange(internal.size))
    values.append(np.ones(internal.size))
    n += internal.size
    size = held.size + inside.size
    places = (np.concatenate(rows).astype(INDEX), np.concatenate(cols).astype(INDEX))
    T = sp.csr_array((np.concatenate(values), places), shape=(size, n))
    return DofMap(T, np.full(size, -1), False, counts)


def _with_rings(dofs: DofMap, layout: Layout, nodes: Nodes) -> DofMap:
    """The map with the rings in casings, which their seats carry rigidly."""
    size = dofs.transform.shape[0]
    follow = sp.csr_array((size, size))
    for name, (casing, number, arm) in layout.ring_seats.items():
        place = layout.place(f"gears.{name}")
        # A casing moves along the axes of the model.
        carried = layout.model.shafts[place.shaft].frame.six.T @ rigid_transfer(arm)
        rows = 6 * nodes.at(*place) + np.arange(6)
        at = (np.repeat(rows, 6), np.tile(nodes.of_seat(casing, number), 6))
        follow = follow + sp.csr_array(sp.coo_array((carried.ravel(), at), shape=(size, size)))
    if not layout.ring_seats:
        return dofs
    return DofMap(sp.csr_array(dofs.transform + follow @ dofs.transform), dofs.column, False, dofs.held)


def _with_planets(dofs: DofMap, layout: Layout, nodes: Nodes) -> DofMap:
    """The map of a model without bending, whose planets stay on their pins: they go onwards as their carrier turns."""
    size = dofs.transform.shape[0]
    rows = []
    columns = []
    values = []
    for planets in layout.planets:
        carrier = 6 * nodes.at(*layout.at(planets.shaft, planets.part.at)) + 5
        for planet in planets.planets:
            for node in nodes.on_shaft(planet):
                rows.append(6 * int(node) + 1)
                columns.append(carrier)
                values.append(planets.radius)
    follow = sp.csr_array(sp.coo_array((values, (rows, columns)), shape=(size, size)))
    T = sp.csr_array(dofs.transform + follow @ dofs.transform)
    return DofMap(T, dofs.column, False, dofs.held)


def _with_feet(dofs: DofMap, layout: Layout, nodes: Nodes) -> DofMap:
    """The map with the teeth on elastic gear bodies, which move with their node and with the body under them."""
    if not nodes.feet:
        return dofs
    T = dofs.transform
    size = T.shape[0]
    parts: list[sp.sparray] = [sp.csr_array(sp.eye_array(size))]
    for ((mesh, helix), name), first in nodes.feet.items():
        gear = layout.gear(name)
        contact = layout.mesh(mesh).contacts[helix]
        pinion = name == contact.pinion
        assert gear.wheel is not None, "feet are those of gears with an elastic body"
        foot = gear.wheel.foot(
            angle=contact.psi if pinion else contact.gear_psi,
            radius=gear.base_radius / np.cos(contact.pressure_angle),
            z=contact.contact_z - contact.pinion_place.z if pinion else contact.gear_contact_z - contact.gear_place.z,
        )
        node = 6 * nodes.at(*layout.place(f"gears.{name}")) + np.arange(6)
        rows = 6 * len(nodes) + first + np.arange(6)
        values = np.hstack([np.eye(6), foot])
        columns = np.concatenate([node, nodes.of_body(name)])
        place = (np.repeat(rows, len(columns)), np.tile(columns, 6))
        parts.append(sp.csr_array(sp.coo_array((values.ravel(), place), shape=(size, size))))
    return DofMap(sp.csr_array(sum(parts[1:], parts[0]) @ T), dofs.column, False, dofs.held)
