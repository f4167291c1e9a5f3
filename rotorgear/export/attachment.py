"""How points of the parts' surfaces follow the nodes: the cross-section at s carries a point r away from its centre rigidly,

    u(point) = u(s) + theta(s) x r.

Between two nodes at a distance L, with xi = s/L, the deflection w is cubic and the slope theta quadratic: the exact static shapes
of a uniform Timoshenko element (Przemieniecki, Theory of Matrix Structural Analysis, 1968). In xz, with w = x, theta = theta_y,

    d = ((w2 - w1)/L - (theta1 + theta2)/2) / (1 + Phi)            Phi = 12 E I / (kappa G A L^2)
    theta(xi) = (1 - xi) theta1 + xi theta2 + 6 (xi - xi^2) d
    w(xi) = w1 + L [ (xi - xi^2/2) theta1 + xi^2/2 theta2 + (3 xi^2 - 2 xi^3) d + Phi xi d ]

and with w = y, theta = -theta_x in the other plane; z and theta_z are linear. Cones are interpolated with their mean section.
All this is in the frame of the shaft that carries the points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from rotorgear.elements.shaft_section import cowper
from rotorgear.export.surface import Surface
from rotorgear.model.model import Model
from rotorgear.model.parts.frame import Frame
from rotorgear.results.modal import NodeTable, body_name


@dataclass(frozen=True)
class Attachment:
    """What carries each of P points.

    Attributes:
        left: (P,) numbers of the nodes on the left; -1 for a point that stands on the ground.
        right: (P,) numbers of the nodes on the right, likewise.
        share: (P,) xi from 0 at the left to 1 at the right node.
        length: (P,) distance of the nodes in m.
        shear: (P,) Phi.
        arm: (P, 3) from the centre of the carrying cross-section to the point, in m.
        frame: (P,) numbers of the shafts in whose frame that is; -1 for the axes of the model.
    """

    left: np.ndarray
    right: np.ndarray
    share: np.ndarray
    length: np.ndarray
    shear: np.ndarray
    arm: np.ndarray
    frame: np.ndarray

    def displacement(self, shape: np.ndarray) -> np.ndarray:
        """Displacements (P, 3) of the points, each in its frame, from those of the nodes (p, 6), real or complex; m and rad."""
        standing = (self.left < 0)[:, None]
        first = np.where(standing, 0.0, shape[self.left])
        second = np.where(standing, 0.0, shape[self.right])
        xi = self.share[:, None]
        both = (1.0 - xi) * first + xi * second
        centre = both[:, :3].copy()
        turn = both[:, 3:].copy()
        # Planes xz (w = x, slope = theta_y) and yz (w = y, slope = -theta_x).
        for w, t, sign in ((0, 4, 1.0), (1, 3, -1.0)):
            slopes = sign * first[:, t], sign * second[:, t]
            centre[:, w], slope = self._bend(first[:, w], second[:, w], *slopes)
            turn[:, t - 3] = sign * slope
        return centre + np.cross(turn, self.arm)

    def _bend(self, w1: np.ndarray, w2: np.ndarray, t1: np.ndarray, t2: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Deflection and slope at the points."""
        xi = self.share
        L = self.length
        phi = self.shear
        chord = (w2 - w1) / np.where(L > 0.0, L, 1.0)
        d = (chord - 0.5 * (t1 + t2)) / (1.0 + phi)
        slope = (1.0 - xi) * t1 + xi * t2 + 6.0 * (xi - xi**2) * d
        rise = (xi - 0.5 * xi**2) * t1 + 0.5 * xi**2 * t2 + (3.0 * xi**2 - 2.0 * xi**3 + phi * xi) * d
        return w1 + L * rise, slope


def join_attachments(parts: Sequence[Attachment]) -> Attachment:
    """Several attachments as one, in their order."""
    names = Attachment.__dataclass_fields__
    return Attachment(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in names})


def nodes_in_order(nodes: NodeTable, shaft: str) -> np.ndarray:
    """Numbers of a shaft's nodes from left to right, one for each place."""
    numbers = nodes.on_shaft(shaft)
    _, first = np.unique(nodes.along[numbers], return_index=True)
    return numbers[first]


def in_space(model: Model, nodes: NodeTable, shapes: np.ndarray) -> np.ndarray:
    """Displacements and rotations (p, 6, ...) of the nodes along the axes of the model, from those in the frames of shafts."""
    turned = {name: shaft.frame.six for name, shaft in model.shafts.items() if shaft.frame.is_turned}
    found = shapes.copy() if turned else shapes
    for name, six in turned.items():
        own = np.array(nodes.shaft) == name
        found[own] = np.einsum("ij,pj...->pi...", six, shapes[own])
    return found


class Skeleton:
    """The nodes of a model, each shaft on the axis where it is shown.

    Args:
        model: the model.
        nodes: its nodes; only their z counts.
        frames: of all shafts, as they are shown.
    """

    def __init__(self, model: Model, nodes: NodeTable, frames: dict[str, Frame]) -> None:
        self.model = model
        self.nodes = nodes
        self.frames = frames
        self._frame = {name: number for number, name in enumerate(frames)}
        self._numbers = {name: nodes_in_order(nodes, name) for name in model.shafts}
        self._shear = {name: self._shear_numbers(name) for name in model.shafts}

    def positions(self) -> np.ndarray:
        """Where the nodes are shown, (p, 3) in m; casings, which have no axis, where they are; gear bodies on their shaft."""
        shown = self.nodes.position.copy()
        for shaft, frame in self.frames.items():
            own = np.array(self.nodes.shaft) == shaft
            shown[own] = frame.at(self.nodes.along[own])
        for gear in self.model.layout.elastic_bodies:
            numbers = self.nodes.of_casing(body_name(gear))
            shaft = self.model.layout.gear(gear).shaft
            shown[numbers] += self.frames[shaft].origin - self.model.shafts[shaft].frame.origin
        return shown

    def placed(self, shaft: str, surface: Surface, z: float = 0.0) -> Surface:
        """A surface about the axis x = y = 0, with its middle at z, on a shaft."""
        return replace(surface, points=self.frames[shaft].outside(surface.points + np.array([0.0, 0.0, z])))

    def along(self, shaft: str, points: np.ndarray) -> Attachment:
        """Each point rides on the cross-section at its own z; beyond the ends on that of the end."""
        return self.rigid(shaft, self.frames[shaft].inside(points)[:, 2], points)

    def rigid(self, shaft: str, z: float | np.ndarray, points: np.ndarray) -> Attachment:
        """All points ride on the cross-section at z, or each on that at its value of z."""
        numbers = self._numbers[shaft]
        places = self.nodes.along[numbers]
        at = np.clip(np.broadcast_to(z, len(points)), places[0], places[-1])
        arm = self.frames[shaft].inside(points) - at[:, None] * np.array([0.0, 0.0, 1.0])
        if len(numbers) == 1:
            return self._fixed_to(np.full(len(at), numbers[0]), arm, shaft)
        k = np.clip(np.searchsorted(places, at, side="right") - 1, 0, len(places) - 2)
        length = places[k + 1] - places[k]
        frame = np.full(len(at), self._frame[shaft])
        return Attachment(
            numbers[k], numbers[k + 1], (at - places[k]) / length, length, self._shear[shaft][k], arm, frame
        )

    def on_pedestal(self, bearing: str, points: np.ndarray) -> Attachment:
        """All points move with the node of a bearing's pedestal."""
        node = self.nodes.pedestal.index(bearing)
        shaft = self.nodes.shaft[node]
        arm = (points - self.positions()[node]) @ self.frames[shaft].axes
        return self._fixed_to(np.full(len(points), node), arm, shaft)

    def on_casing(self, casing: str, points: np.ndarray) -> Attachment:
        """Each point moves with the nearest one of a casing's surface; all stand still where that is not known."""
        numbers = self.nodes.of_casing(casing)
        if not len(numbers):
            return self.on_ground(points)
        nearest = cKDTree(self.positions()[numbers]).query(points)[1]
        return self._fixed_to(numbers[nearest], np.zeros_like(points))

    def on_ground(self, points: np.ndarray) -> Attachment:
        """All points stand still."""
        return self._fixed_to(np.full(len(points), -1), np.zeros_like(points))

    def _fixed_to(self, nodes: np.ndarray, arm: np.ndarray, shaft: str = "") -> Attachment:
        """Points that move rigidly with one node each, arms in the frame of a shaft, or along the axes of the model."""
        zeros = np.zeros(len(nodes))
        return Attachment(nodes, nodes, zeros, zeros, zeros, arm, np.full(len(nodes), self._frame.get(shaft, -1)))

    def _shear_numbers(self, shaft: str) -> np.ndarray:
        """Phi between each two neighbouring nodes of a shaft."""
        part = self.model.shafts[shaft]
        places = self.nodes.along[self._numbers[shaft]]
        if not part.sections or not part.shear_deformation:
            return np.zeros(max(len(places) - 1, 0))
        ends = part.start + np.cumsum([section.length for section in part.sections])
        which = np.minimum(np.searchsorted(ends, 0.5 * (places[:-1] + places[1:])), len(part.sections) - 1)
        phi = []
        for k, length in zip(which, np.diff(places), strict=True):
            section = part.sections[k]
            outer, bore, outer_end, bore_end = section.stiffness_diameters()
            outer = 0.5 * (outer + outer_end)  # a cone counts with its mean diameters
            bore = 0.5 * (bore + bore_end)
            material = self.model.material_of(shaft, section)
            kappa = section.shear_coefficient or float(cowper(material.nu, bore / outer))
            # E/G (12 / kappa L^2) I/A with I/A = (d_o^2 + d_i^2)/16
            phi.append(12.0 * material.youngs_modulus * (outer**2 + bore**2) / (16.0 * kappa * material.g * length**2))
        return np.array(phi)
