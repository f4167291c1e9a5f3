"""Response of one rotor of a train to unbalance at the antinodes of a shape, at any speed.

Each speed is factored and solved anew, so that a peak can be followed to any accuracy. The orbit of a node is the ellipse of
Re((X, Y) e^{iwt}); its major semi-axis is (|X + iY| + |X - iY|)/2.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.response.mesh import MARGIN, at_speed, damped_modes, plan_up_to
from rotorgear.analysis.response.plant import Plant
from rotorgear.analysis.standards.rules import trial_unbalance
from rotorgear.analysis.static.mean_state import about_mean
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.model.model import Model
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.modal import NodeTable
from rotorgear.system.contacts import contact_lines
from rotorgear.system.damped_range import damped_up_to
from rotorgear.system.loads import weight_loads

# Where the shape is smaller than this share of its largest deflection there is no antinode.
_SEEN = 0.1
_TANGENTS = 9


def plant_up_to(
    model: Model, direction: int, ends: tuple[float, float], frequency: float
) -> tuple[Plant, tuple[str, ...]]:
    """The model about its mean state as a plant, meshed for a frequency, and sentences on what was left out.

    Args:
        model: the model. direction: sense of the input shaft.
        ends: lowest and highest speed of the input shaft in rad/s, positive; frequency: highest in rad/s.
    """
    low, top = ends
    speed = direction * top
    tangents = direction * np.linspace(low or 0.1 * top, top, _TANGENTS)
    state, first = about_mean(model, [float(x) for x in tangents], speed)
    plan = plan_up_to(model, at_speed(state, speed), MARGIN * frequency / (2.0 * np.pi), None, None)
    system = linear_system(model, [speed], plan, state=first.with_tangents(state))
    zeta = model.damping.modal_ratio
    damping = (*damped_modes(system, damped_up_to(system, frequency), speed), zeta) if zeta else None
    return Plant(system, contact_lines(system), damping), first.notes


class UnbalanceResponse:
    """Response of a plant to unbalance at the antinodes of a shape's deflection on one shaft.

    Each antinode takes the mass of the rotor that is nearer to it than to the others.

    Args:
        plant: of the model; shaft: name of the rotor; direction: sense of the input shaft.
        shape: its nodes, and the displacements of all of them, (p, 6) complex.
        rpm: speed of the shaft that the unbalance is for.

    Attributes:
        z: (a,) places of the antinodes in m.
        unbalance: (a,) in kg m; empty where there is no antinode.
        nodes: numbers of the shaft's nodes.
    """

    def __init__(
        self, plant: Plant, shaft: str, direction: int, shape: tuple[NodeTable, np.ndarray], rpm: float
    ) -> None:
        system = plant.system
        self.plant = plant
        self.ratio = abs(system.train.ratio(shaft))
        self.nodes = system.nodes.on_shaft(shaft)
        there = shape[0].on_shaft(shaft)
        moved = shape[1][there, :2]
        size = np.linalg.norm(np.abs(moved), axis=1)
        padded = np.concatenate([[-1.0], size, [-1.0]])
        inner = np.flatnonzero((size >= padded[:-2]) & (size > padded[2:]) & (size >= _SEEN * size.max(initial=0.0)))
        z = shape[0].position[there[inner], 2]
        # Deflections lie on one side or the other of the axis: the sign of the projection on the largest one.
        side = np.where(np.real(moved[inner] @ moved[int(np.argmax(size))].conj()) >= 0.0, 1.0, -1.0)
        at = np.array([system.nodes.at(shaft, place) for place in z], dtype=int)
        kept = np.unique(at, return_index=True)[1]
        self.z = z[kept]
        weights = weight_loads(system, (1.0, 0.0, 0.0))
        places = np.array([system.nodes.z[node] for node in self.nodes])
        nearest = np.argmin(np.abs(places[:, None] - self.z), axis=1) if kept.size else np.zeros(0, int)
        mass = [weights[6 * self.nodes[nearest == k]].sum() for k in range(len(kept))]
        self.unbalance = np.array([trial_unbalance(one, rpm) for one in mass])
        sense = direction * system.train.sense(shaft)
        load = np.zeros(system.dofs.transform.shape[0], complex)
        load[6 * at[kept]] = self.unbalance * side[kept]
        load[6 * at[kept] + 1] = -1j * sense * self.unbalance * side[kept]
        self._load = system.dofs.transform.T @ load
        self._direction = direction
        self._rows = system.dofs.transform.tocsr()

    def orbits(self, speed: float, nodes: Sequence[int] | np.ndarray) -> np.ndarray:
        """Major axis of the orbit of nodes in m, peak to peak, at a speed of the input shaft in rad/s, positive."""
        w = self.ratio * speed
        q = self.plant.dynamics(self._direction * speed).solve(w, (w**2 * self._load)[:, None])
        numbers = np.asarray(nodes)
        x = (self._rows[6 * numbers, :] @ q)[:, 0]
        y = (self._rows[6 * numbers + 1, :] @ q)[:, 0]
        return np.asarray(np.abs(x + 1j * y) + np.abs(x - 1j * y))

    def rpm(self, speed: float) -> float:
        """Speed of the shaft in rpm at one of the input shaft in rad/s."""
        return self.ratio * speed * RPM_PER_RAD_S
