"""Statics of the train in torsion: which force each contact carries.

Shafts twist by 1/(GJ); meshes, couplings and the webs of elastic gears give with their own stiffness. The train's free rotation
is held at one node of each connected group, which takes no torque where the loads balance.
"""

from __future__ import annotations

from collections.abc import Sequence

from rotorgear.errors import AnalysisError
from rotorgear.model.layout.applied_torques import AppliedTorque
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.mesh_layout import Contact
from rotorgear.model.layout.places import Place
from rotorgear.model.parts.tables import Tables

# Places on a shaft nearer than this to each other (relative, and of a millimetre) are one.
_SAME_PLACE = 1e-9


class _Network:
    """Nodes in torsion by number and the springs between them. Places that a rigid stretch of shaft joins are one node."""

    def __init__(self, model: Tables, places: Sequence[Place]) -> None:
        from rotorgear.elements.shaft import torsional_flexibility

        self.size = 0
        self.springs: list[tuple[int, int, float]] = []
        self._nodes: dict[str, list[tuple[float, int]]] = {}
        for shaft in model.shafts:
            nodes = self._nodes[shaft] = []
            for z in sorted({z for name, z in places if name == shaft}):
                give = torsional_flexibility(*_stretch(model, shaft, nodes[-1][0], z)) if nodes else 0.0
                if nodes and (give == 0.0 or z - nodes[-1][0] <= _SAME_PLACE * max(1e-3, abs(z))):
                    nodes.append((z, self.size - 1))
                    continue
                if nodes:
                    self.springs.append((self.size - 1, self.size, 1.0 / give))
                nodes.append((z, self.size))
                self.size += 1

    def node(self, shaft: str, z: float) -> int:
        """Number of the node at a place that the network was built with."""
        return next(number for place, number in self._nodes[shaft] if place == z)

    def branch(self, node: int, stiffness: float) -> int:
        """Number of a new node that hangs on another one by a spring (N m/rad)."""
        self.springs.append((node, self.size, stiffness))
        self.size += 1
        return self.size - 1

    def first_node(self, shaft: str) -> int | None:
        """Number of the first node of a shaft; None where nothing acts on it."""
        return self._nodes[shaft][0][1] if self._nodes[shaft] else None


def contact_forces(layout: Layout, applied: Sequence[AppliedTorque], lines: Sequence[Contact]) -> list[float]:
    """Signed normal force of each contact in N: positive where the pinion is turned positively into the gear.

    Args:
        layout: of a checked model.
        applied: torques that balance in each group.
        lines: the contacts.

    Raises:
        AnalysisError: stiffnesses that differ too much to be solved together.
    """
    import numpy as np

    couplings = [
        (layout.places(f"couplings.{name}"), coupling.stiffness.as_rows()[5][5])
        for name, coupling in layout.model.couplings.items()
        if coupling.turns_both
    ]
    ends = [(Place(line.pinion_shaft, line.pinion_z), Place(line.gear_shaft, line.gear_z)) for line in lines]
    places = [place for pair in (*ends, *(pair for pair, _ in couplings)) for place in pair]
    network = _Network(layout.model, [*places, *(Place(item.shaft, item.z) for item in applied)])
    network.springs += [(network.node(*first), network.node(*second), k) for (first, second), k in couplings]
    elastic = {
        (name, place): network.branch(network.node(*place), 1.0 / torsion.flexibility)
        for name, torsion in layout.elastic_gears.items()
        for place in layout.gear(name).places
    }
    for name, wheel in layout.elastic_bodies.items():
        place = layout.place(f"gears.{name}")
        elastic[name, place] = network.branch(network.node(*place), 1.0 / float(wheel.rim_flexibility[5, 5]))

    def teeth_of(gear: str, place: Place) -> int:
        return elastic[gear, place] if (gear, place) in elastic else network.node(*place)

    teeth = [
        (teeth_of(line.pinion, pinion), teeth_of(line.gear, gear))
        for line, (pinion, gear) in zip(lines, ends, strict=True)
    ]

    # Each contact is squeezed along its flank normal by r_b cos(beta_b) times the twist of its two nodes: delta = S q.
    squeeze = np.zeros((len(lines), network.size))
    for row, line, (pinion, gear) in zip(squeeze, lines, teeth, strict=True):
        row[pinion] += line.pinion_base_radius * np.cos(line.base_helix_angle)
        row[gear] += line.gear_base_radius * np.cos(line.base_helix_angle)
    stiffness = np.array([line.stiffness for line in lines])
    # K = sum of the springs + S^T diag(k) S
    K = np.zeros((network.size, network.size))
    for first, second, k in network.springs:
        K[first, first] += k
        K[second, second] += k
        K[first, second] -= k
        K[second, first] -= k
    K = K + (squeeze.T * stiffness) @ squeeze
    torques = np.zeros(network.size)
    for item in applied:
        torques[network.node(item.shaft, item.z)] += item.torque
    # Shafts that turn together have one rotation that strains nothing: K q = torques is solved with one node of each held.
    held: dict[int, int] = {}
    for shaft, group in layout.train.group.items():
        node = network.first_node(shaft)
        if node is not None:
            held.setdefault(group, node)
    free = np.setdiff1d(np.arange(network.size), list(held.values()))
    twist = np.zeros(network.size)
    try:
        twist[free] = np.linalg.solve(K[np.ix_(free, free)], torques[free])
    except np.linalg.LinAlgError:
        raise AnalysisError(
            "The torque flow can't be solved: the stiffnesses of meshes, couplings and shafts in torsion differ by more "
            "than numbers can hold. Check the smallest and the largest of them."
        ) from None
    return [float(force) for force in stiffness * (squeeze @ twist)]


def _stretch(
    model: Tables, shaft: str, left: float, right: float
) -> tuple[list[float], list[tuple[float, float, float, float]], list[float]]:
    """Lengths, end diameters and shear moduli of the flexible segments of a shaft between two places."""
    lengths = []
    diameters = []
    moduli = []
    z = model.shafts[shaft].start
    for section in model.shafts[shaft].sections:
        low = max(left, z)
        high = min(right, z + section.length)
        if high > low and not section.rigid:
            outer, bore, outer_end, bore_end = section.stiffness_diameters()
            first = (low - z) / section.length
            last = (high - z) / section.length
            lengths.append(high - low)
            diameters.append(
                (
                    outer + (outer_end - outer) * first,
                    bore + (bore_end - bore) * first,
                    outer + (outer_end - outer) * last,
                    bore + (bore_end - bore) * last,
                )
            )
            moduli.append(model.material_of(shaft, section).g)
        z += section.length
    return lengths, diameters, moduli
