"""Displacements and stresses inside the teeth for given forces on their flanks: what the condensed pitches leave out.

One whole pitch has all its nodes; a helical one is a stack of equal layers, each turned by z tan(b_b)/r_b against the middle of
the face. The motions of its cuts follow from the chain of pitches (`gear_compliance`), tooth by tooth and added up. Inside, every
pitch has the same stiffness: one sparse factorisation serves all. Lengths in normal modules, Young's modulus 1, as in `sector`;
the tooth stands on the +y axis at the middle of the face, that of a ring on the -y axis, and displacements are in its frame.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.gears.tooth_fe import elasticity
from rotorgear.gears.tooth_fe.blank_section import BlankSection
from rotorgear.gears.tooth_fe.compliance_model import ComplianceKey, pitch_of, sector_of
from rotorgear.gears.tooth_fe.gear_compliance import cut_motions
from rotorgear.gears.tooth_fe.mesh import PitchMesh, scikit_fem
from rotorgear.gears.tooth_fe.sector import clockwise, layer_mesh
from rotorgear.gears.tooth_fe.wheel_compliance import wheel_motions
from rotorgear.gears.tooth_fe.wheel_sector import WheelSector, seat_frame
from rotorgear.progress import Progress, part_of, silent


@dataclass(frozen=True)
class Pitch:
    """All nodes of a pitch, plane by plane along the face (one plane for a spur gear in plane strain).

    Attributes:
        points: (n, d).
        cells: (c, e, k) nodes of the elements of each layer, in scikit-fem's order.
        stiffness: sparse (d n, d n).
        inner: nodes on the inner circle, plane by plane as in the plane mesh; so are the next three.
        left: nodes on the left cut.
        right: nodes on the right cut.
        flank: nodes on the loaded involute.
        fillet: nodes of the fillet and half the root on the loaded side.
        normal: (f, d) outward at the flank.
        turn: (planes, d, d) rotation of each plane against the middle of the face.
        layer_turn: (c, d, d) rotation of each layer against the first one.
        pitch_turn: (d, d) rotation of the next pitch.
        poisson_ratio: of the material.
        basis: of one layer, at its nodes.
    """

    points: np.ndarray
    cells: np.ndarray
    stiffness: sp.csc_array
    inner: np.ndarray
    left: np.ndarray
    right: np.ndarray
    flank: np.ndarray
    fillet: np.ndarray
    normal: np.ndarray
    turn: np.ndarray
    layer_turn: np.ndarray
    pitch_turn: np.ndarray
    poisson_ratio: float
    basis: Any = field(repr=False, compare=False)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self.points.shape[1]

    def in_tooth(self, u: np.ndarray, ahead: int = 0) -> np.ndarray:
        """Displacements of nodes in the tooth's frame from those in the frames of their planes, plane by plane.

        Those of the right cut are given in the frames of the pitch `ahead`, which is 1.
        """
        turn = self.turn @ self.pitch_turn if ahead else self.turn
        return np.einsum("pij,pnj->pni", turn, u.reshape(len(turn), -1, self.dimension)).ravel()

    def stress(self, displacement: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Equivalent stress (von Mises) and largest principal one (n,), means of the elements that meet at a node."""
        lam, mu = elasticity.lame(self.poisson_ratio)
        d = self.dimension
        n = len(self.points)
        gradients = np.stack([np.asarray(shape[0].grad) for shape in self.basis.basis])  # (k, d, e, q)
        mises = np.zeros(n)
        largest = np.zeros(n)
        count = np.zeros(n)
        for cells, turn in zip(self.cells, self.layer_turn, strict=True):
            u = displacement[cells] @ turn  # into the frame of the first layer
            du = np.einsum("kieq,ekj->eqij", gradients, u)
            strain = np.zeros((*du.shape[:2], 3, 3))  # plane strain has stress along the face too: always 3 x 3
            strain[..., :d, :d] = 0.5 * (du + du.swapaxes(-1, -2))
            trace = np.trace(strain, axis1=-2, axis2=-1)
            stress = 2.0 * mu * strain + lam * trace[..., None, None] * np.eye(3)
            deviator = stress - np.trace(stress, axis1=-2, axis2=-1)[..., None, None] / 3.0 * np.eye(3)
            np.add.at(mises, cells, np.sqrt(1.5 * np.sum(deviator**2, axis=(-2, -1))))
            np.add.at(largest, cells, np.linalg.eigvalsh(stress)[..., -1])
            np.add.at(count, cells, 1.0)
        return mises / count, largest / count


def whole_pitch(mesh: PitchMesh, poisson_ratio: float, width: float, layers: int) -> Pitch:
    """A pitch of face `width` in a number of layers; 0 layers: plane strain, unit width."""
    skfem = scikit_fem()
    p = len(mesh.points)
    d = 3 if layers else 2

    # Fillet: from the foot of the involute down the loaded column, then along the root to the cut.
    column, high = mesh.lattice[mesh.flank[0]]
    low = mesh.lattice[mesh.right[-1], 1]  # the row where the tooth begins
    across, row = mesh.lattice.T
    fillet = np.flatnonzero(((across == column) & (row >= low) & (row <= high)) | ((row == low) & (across >= column)))

    # Planes and layers turn with the helix about the middle of the face; quadratic elements have a plane in their middle.
    if layers:
        height = width / layers
        elements, place_of = layer_mesh(mesh, height)
        basis, at_nodes = _bases(elements, skfem.ElementHex2())
        first = place_of[elements.dofs.element_dofs].T
        z = 0.5 * height * np.arange(2 * layers + 1) - 0.5 * width
    else:
        height = 0.0
        basis, at_nodes = _bases(mesh.mesh, skfem.ElementQuad2())
        first = mesh.cells.T
        z = np.zeros(1)
    number = np.arange(layers or 1)
    cells = first[None] + 2 * p * number[:, None, None]
    turn = np.array([clockwise(mesh.twist * h, d) for h in z])
    layer_turn = turn[0] @ np.array([clockwise(mesh.twist * height * i, d) for i in number])
    points = np.einsum("pij,nj->pni", turn[:, :2, :2], mesh.points)
    if layers:
        points = np.concatenate([points, np.broadcast_to(z[:, None, None], (*points.shape[:2], 1))], -1)
    points = points.reshape(-1, d)

    # Every layer has the element matrices of the first one, turned: K = R K_1 R^T node by node.
    e, k = first.shape
    blocks = elasticity.element_matrices(basis, poisson_ratio).reshape(e, k, d, k, d)
    K = sp.csc_array((d * len(points), d * len(points)))
    for of_layer, R in zip(cells, layer_turn, strict=True):
        turned = np.einsum("ij,eajbl,ml->eaibm", R, blocks, R, optimize=True).reshape(e, d * k, d * k)
        K = K + elasticity.assembled(turned, elasticity.component_dofs(of_layer.T, d), d * len(points))

    def planes(nodes: np.ndarray) -> np.ndarray:
        return np.asarray((nodes[None] + p * np.arange(len(z))[:, None]).ravel())

    return Pitch(
        points=points,
        cells=cells,
        stiffness=K,
        inner=planes(mesh.inner),
        left=planes(mesh.left),
        right=planes(mesh.right),
        flank=planes(mesh.flank),
        fillet=planes(fillet),
        normal=np.einsum("pij,nj->pni", turn, mesh.helicoid_normal if layers else mesh.normal).reshape(-1, d),
        turn=turn,
        layer_turn=layer_turn,
        pitch_turn=clockwise(mesh.pitch_angle, d),
        poisson_ratio=poisson_ratio,
        basis=at_nodes,
    )


def _bases(mesh: Any, element: Any) -> tuple[Any, Any]:
    """Scalar bases with Gauss points, and with the nodes of the element as points."""
    skfem = scikit_fem()
    places = np.array(element.doflocs, float).T
    at_nodes = skfem.Basis(mesh, element, quadrature=(places, np.ones(places.shape[1])))
    return skfem.Basis(mesh, element, intorder=4), at_nodes


# Pitches to either side of the loaded teeth that are solved too.
_NEIGHBOURS = 2


class ToothInside:
    """The inside of the teeth of one gear, for any loads.

    Attributes:
        key: the gear.
        pitch: a pitch with all its nodes.
    """

    def __init__(self, key: ComplianceKey, progress: Progress = silent) -> None:
        """Superelement and factorisation of a pitch."""
        self.key = key
        self._mesh = pitch_of(key)[1]
        self.pitch = whole_pitch(self._mesh, key.poisson_ratio, key.width, key.size.face if key.width else 0)
        if key.blank and not key.width:
            raise AnalysisError("The inside of the teeth of a wheel needs the model in space.")
        self._sector = sector_of(key, self._mesh, part_of(progress, 0.0, 0.6))
        # Cuts and inner circle, whose motions the chain of pitches gives, and all other degrees of freedom.
        pitch = self.pitch
        d = pitch.dimension
        self._moved = elasticity.node_dofs(np.concatenate([pitch.left, pitch.right, pitch.inner]), d)
        self._rest = np.setdiff1d(np.arange(d * len(pitch.points)), self._moved)
        rows = pitch.stiffness[self._rest]
        self._factor = elasticity.factorised(rows[:, self._rest])
        self._couple = rows[:, self._moved]
        progress(1.0, "inside of the teeth")

    def solve(self, loads: dict[int, np.ndarray], progress: Progress = silent) -> tuple[np.ndarray, np.ndarray]:
        """Displacements of all pitches near loaded teeth.

        Args:
            loads: forces (f,) along the outward normal at the flank nodes by tooth, in the order of the gear's compliance.
            progress: told how far it is.

        Returns:
            Numbers (t,) of the pitches, and displacements (t, n, d) of the nodes of each, in the frame of its own tooth.
        """
        pitch = self.pitch
        near = min(_NEIGHBOURS, ((self.key.arc or abs(self.key.geometry.teeth)) - 1) // 2)
        teeth = np.arange(min(loads) - near, max(loads) + near + 1)
        if self.key.blank:
            at_ends = self._moved_wheel(teeth, loads, part_of(progress, 0.0, 0.5))
        else:
            at_ends = self._moved_pitches(teeth, loads)

        # Inside of each pitch: K_rr u_r = f_r - K_rh u_h, with the cuts and the inner circle moved.
        d = pitch.dimension
        n = len(pitch.points)
        told = part_of(progress, 0.5, 1.0)
        displacement = np.zeros((len(teeth), d * n))
        for i, number in enumerate(teeth.tolist()):
            told(i / len(teeth), f"tooth {number}")
            force = np.zeros(d * n)
            if number in loads:
                force[elasticity.node_dofs(pitch.flank, d)] = (loads[number][:, None] * pitch.normal).ravel()
            displacement[i, self._moved] = at_ends[i]
            displacement[i, self._rest] = self._factor.solve(force[self._rest] - self._couple @ at_ends[i])
        return teeth, displacement.reshape(len(teeth), n, d)

    def _moved_pitches(self, teeth: np.ndarray, loads: dict[int, np.ndarray]) -> list[np.ndarray]:
        """Displacements at the cuts and on the held circle of each pitch in a rim or a ring."""
        pitch = self.pitch
        count = self.key.arc or abs(self.key.geometry.teeth)
        ring = self.key.arc == 0
        # One loaded tooth at a time, its chain of pitches moved to where it stands, all of them added up.
        cuts = np.zeros((len(teeth) + 1, self._sector.cut))
        for tooth, force in loads.items():
            moved = cut_motions(self._sector, force[:, None], count, ring=ring)[:, :, 0]
            place = np.arange(teeth[0], teeth[-1] + 2) - tooth + count // 2
            there = np.ones(len(place), bool) if ring else (place >= 0) & (place < len(moved))
            cuts[there] += moved[place[there] % len(moved)]
        at_rest = np.zeros(pitch.dimension * len(pitch.inner))
        return [
            np.concatenate([pitch.in_tooth(left), pitch.in_tooth(right, 1), at_rest]) for left, right in pairwise(cuts)
        ]

    def _moved_wheel(self, teeth: np.ndarray, loads: dict[int, np.ndarray], progress: Progress) -> list[np.ndarray]:
        """The same on a wheel, whose inner circle moves with the blank."""
        key = self.key
        sector = self._sector
        assert key.blank is not None
        assert isinstance(sector, WheelSector)
        blank = BlankSection(key.blank, key.face, key.inner_radius, key.poisson_ratio)
        moved = np.zeros((len(teeth), 2 * sector.cut + sector.middle))
        for tooth, force in loads.items():
            moved += wheel_motions(sector, blank, key.geometry.teeth, force, teeth - tooth, progress)

        # A cut begins with the seat's end in every plane, in polar components.
        left, right, middle = (
            part.reshape(len(teeth), 2 * key.size.face + 1, -1, 3)
            for part in np.split(moved, [sector.cut, 2 * sector.cut], axis=1)
        )
        seat = np.concatenate([left[:, :, :1], middle, right[:, :, :1]], axis=2)
        shapes, polar = seat_frame(self._mesh)
        inner = np.einsum("is,tpsk,ijk->tpij", shapes, seat, polar)
        in_tooth = self.pitch.in_tooth
        return [
            np.concatenate([in_tooth(left[i, :, 1:]), in_tooth(right[i, :, 1:], 1), in_tooth(inner[i])])
            for i in range(len(teeth))
        ]
