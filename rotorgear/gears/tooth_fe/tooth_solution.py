"""Displacements and stresses inside the teeth for given forces on their flanks: what the condensed pitches leave out.

The motions of the cuts follow from the chain of pitches (`gear_compliance`), tooth by tooth and added up. Inside, every pitch
has the same stiffness: one sparse factorisation serves all. Lengths in normal modules, Young's modulus 1, as in `sector`; the
tooth stands on the +y axis at the middle of the face, and displacements are in its frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from rotorgear.errors import AnalysisError
from rotorgear.gears.tooth_fe.blank_section import BlankSection
from rotorgear.gears.tooth_fe.compliance_model import ComplianceKey, pitch_of, wheel_sector
from rotorgear.gears.tooth_fe.elasticity import node_dofs
from rotorgear.gears.tooth_fe.gear_compliance import cut_motions
from rotorgear.gears.tooth_fe.mesh import PitchMesh
from rotorgear.gears.tooth_fe.pitch import Pitch, whole_pitch
from rotorgear.gears.tooth_fe.sector import layered_sector, plane_sector
from rotorgear.gears.tooth_fe.wheel_compliance import wheel_motions
from rotorgear.gears.tooth_fe.wheel_sector import seat_frame
from rotorgear.progress import Progress, part_of, silent

# Pitches to either side of the loaded teeth that are solved too.
_NEIGHBOURS = 2


@dataclass(frozen=True)
class TeethSolution:
    """Displacements in the teeth near the loaded ones.

    Attributes:
        teeth: (t,) numbers of the pitches.
        displacement: (t, n, d) of the nodes of each pitch, in the frame of its own tooth.
        pitch: the pitch itself.
    """

    teeth: np.ndarray
    displacement: np.ndarray
    pitch: Pitch


@dataclass(frozen=True)
class ToothInside:
    """What the solutions of one gear share, whatever its loads are.

    Attributes:
        mesh: of a pitch in its section.
        sector: superelement of the pitch.
        pitch: with all its nodes.
        moved: dofs at the cuts and the inner circle, whose motions the chain of pitches gives.
        rest: the other dofs.
        factor: factorisation of K_rr; couple: K_rh.
    """

    mesh: PitchMesh
    sector: Any
    pitch: Pitch
    moved: np.ndarray
    rest: np.ndarray
    factor: Any
    couple: Any


def tooth_inside(key: ComplianceKey, progress: Progress = silent) -> ToothInside:
    """Superelement and factorisation of a pitch of a gear, for any loads."""
    mesh = pitch_of(key)[1]
    layers = key.size.face if key.width else 0
    pitch = whole_pitch(mesh, key.poisson_ratio, key.width, layers)
    told = part_of(progress, 0.0, 0.6)
    sector: Any
    if key.blank:
        if not key.width:
            raise AnalysisError("The inside of the teeth of a wheel needs the model in space.")
        sector = wheel_sector(key, mesh, told)
    elif key.width:
        sector = layered_sector(mesh, key.poisson_ratio, key.width, layers, told)
    else:
        sector = plane_sector(mesh, key.poisson_ratio)
    d = pitch.dimension
    moved = node_dofs(np.concatenate([pitch.left, pitch.right, pitch.inner]), d)
    rest = np.setdiff1d(np.arange(d * len(pitch.points)), moved)
    K = pitch.stiffness
    factor = splu(sp.csc_matrix(K[rest][:, rest]), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    progress(1.0, "inside of the teeth")
    return ToothInside(mesh, sector, pitch, moved, rest, factor, K[rest][:, moved])


def solve_teeth(
    key: ComplianceKey, loads: dict[int, np.ndarray], progress: Progress = silent, inside: ToothInside | None = None
) -> TeethSolution:
    """Displacements of all pitches near loaded teeth.

    Args:
        key: the gear.
        loads: forces (f,) along the outward normal at the flank nodes by tooth, in the order of the gear's compliance.
        progress: told how far it is.
        inside: of this gear, from `tooth_inside`, where several loads are solved one after the other.
    """
    inside = inside or tooth_inside(key, part_of(progress, 0.0, 0.4))
    pitch = inside.pitch
    near = min(_NEIGHBOURS, ((key.arc or key.geometry.teeth) - 1) // 2)
    teeth = np.arange(min(loads) - near, max(loads) + near + 1)
    if key.blank:
        at_ends = _moved_wheel(key, inside, teeth, loads, part_of(progress, 0.4, 0.7))
    else:
        at_ends = _moved_pitches(key, inside, teeth, loads)

    # Inside of each pitch: K_rr u_r = f_r - K_rh u_h, with the cuts and the inner circle moved.
    d = pitch.dimension
    n = len(pitch.points)
    told = part_of(progress, 0.7, 1.0)
    displacement = np.zeros((len(teeth), d * n))
    for i, number in enumerate(teeth.tolist()):
        told(i / len(teeth), f"tooth {number}")
        force = np.zeros(d * n)
        if number in loads:
            force[node_dofs(pitch.flank, d)] = (loads[number][:, None] * pitch.normal).ravel()
        displacement[i, inside.moved] = at_ends[i]
        displacement[i, inside.rest] = inside.factor.solve(force[inside.rest] - inside.couple @ at_ends[i])
    return TeethSolution(teeth, displacement.reshape(len(teeth), n, d), pitch)


def _moved_pitches(
    key: ComplianceKey,
    inside: ToothInside,
    teeth: np.ndarray,
    loads: dict[int, np.ndarray],
) -> np.ndarray:
    """Displacements (teeth, ...) at the cuts and on the held circle of each pitch in a rim or a ring."""
    pitch = inside.pitch
    sector = inside.sector
    count = key.arc or key.geometry.teeth
    ring = key.arc == 0
    # One loaded tooth at a time, its chain of pitches moved to where it stands, all of them added up.
    cuts = np.zeros((len(teeth) + 1, sector.cut))
    for tooth, force in loads.items():
        moved = cut_motions(sector, force[:, None], count, ring=ring)[:, :, 0]
        place = np.arange(teeth[0], teeth[-1] + 2) - tooth + count // 2
        there = np.ones(len(place), bool) if ring else (place >= 0) & (place < len(moved))
        cuts[there] += moved[place[there] % len(moved)]
    at_rest = np.zeros(pitch.dimension * len(pitch.inner))
    ends = [
        np.concatenate([pitch.left_frame(left), pitch.right_frame(right), at_rest]) for left, right in pairwise(cuts)
    ]
    return np.array(ends)


def _moved_wheel(
    key: ComplianceKey,
    inside: ToothInside,
    teeth: np.ndarray,
    loads: dict[int, np.ndarray],
    progress: Progress,
) -> np.ndarray:
    """The same on a wheel, whose inner circle moves with the blank."""
    assert key.blank is not None
    pitch = inside.pitch
    mesh = inside.mesh
    sector = inside.sector
    blank = BlankSection(key.blank, key.face, key.inner_radius, key.poisson_ratio)
    moved = np.zeros((len(teeth), 2 * sector.cut + sector.middle))
    for tooth, force in loads.items():
        moved += wheel_motions(sector, blank, key.geometry.teeth, force, teeth - tooth, progress)

    # A cut begins with the seat's end in every plane, in polar components.
    planes = 2 * key.size.face + 1
    left, right = (
        part.reshape(len(teeth), planes, -1, 3)
        for part in (moved[:, : sector.cut], moved[:, sector.cut : 2 * sector.cut])
    )
    middle = moved[:, 2 * sector.cut :].reshape(len(teeth), planes, -1, 3)
    seat = np.concatenate([left[:, :, :1], middle, right[:, :, :1]], axis=2)
    shapes, polar = seat_frame(mesh)
    inner = np.einsum("is,tpsk,ijk->tpij", shapes, seat, polar)
    ends = [
        np.concatenate(
            [
                pitch.left_frame(left[i, :, 1:].ravel()),
                pitch.right_frame(right[i, :, 1:].ravel()),
                pitch.plane_frame(inner[i].ravel()),
            ]
        )
        for i in range(len(teeth))
    ]
    return np.array(ends)
