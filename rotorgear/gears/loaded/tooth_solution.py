"""Displacements and stresses inside the teeth for given forces on their flanks: what the condensed pitches leave out.

The motions of the cuts follow from the chain of pitches (`gear_compliance`), tooth by tooth and added up. Inside, every pitch
has the same stiffness: one sparse factorisation serves all. Lengths in normal modules, Young's modulus 1, as in `sector`; the
tooth stands on the +y axis at the middle of the face, and displacements are in its frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from rotorgear.errors import AnalysisError
from rotorgear.gears.tooth_fe.blank_section import BlankSection
from rotorgear.gears.tooth_fe.compliance_model import ComplianceKey, pitch_of, wheel_sector
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


def solve_teeth(key: ComplianceKey, loads: dict[int, np.ndarray], progress: Progress = silent) -> TeethSolution:
    """Displacements of all pitches near loaded teeth.

    Args:
        key: the gear.
        loads: forces (f,) along the outward normal at the flank nodes by tooth, in the order of the gear's compliance.
        progress: told how far it is.
    """
    mesh = pitch_of(key)[1]
    layers = key.size.face if key.width else 0
    near = min(_NEIGHBOURS, ((key.arc or key.geometry.teeth) - 1) // 2)
    teeth = np.arange(min(loads) - near, max(loads) + near + 1)
    pitch = whole_pitch(mesh, key.poisson_ratio, key.width, layers)
    moved = _moved_wheel if key.blank else _moved_pitches
    nodes, at_ends = moved(key, mesh, pitch, teeth, loads, part_of(progress, 0.0, 0.4))
    progress(0.4, "inside of the teeth")

    # Inside of each pitch: K_rr u_r = f_r - K_rh u_h, with the cuts and the inner circle moved.
    d = pitch.dimension
    n = len(pitch.points)

    def of(nodes: np.ndarray) -> np.ndarray:
        return np.asarray((d * nodes[:, None] + np.arange(d)).ravel())

    moved_dofs = of(nodes)
    rest = np.setdiff1d(np.arange(d * n), moved_dofs)
    K = pitch.stiffness
    factor = splu(sp.csc_matrix(K[rest][:, rest]), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    couple = K[rest][:, moved_dofs]
    told = part_of(progress, 0.7, 1.0)
    displacement = np.zeros((len(teeth), d * n))
    for i, number in enumerate(teeth.tolist()):
        told(i / len(teeth), f"tooth {number}")
        force = np.zeros(d * n)
        if number in loads:
            force[of(pitch.flank)] = (loads[number][:, None] * pitch.normal).ravel()
        displacement[i, moved_dofs] = at_ends[i]
        displacement[i, rest] = factor.solve(force[rest] - couple @ at_ends[i])
    return TeethSolution(teeth, displacement.reshape(len(teeth), n, d), pitch)


def _moved_pitches(
    key: ComplianceKey,
    mesh: PitchMesh,
    pitch: Pitch,
    teeth: np.ndarray,
    loads: dict[int, np.ndarray],
    progress: Progress,
) -> tuple[np.ndarray, np.ndarray]:
    """Nodes at the cuts and on the held circle of a pitch, and their displacements (teeth, ...) in a rim or a ring."""
    count = key.arc or key.geometry.teeth
    ring = key.arc == 0
    if key.width:
        sector = layered_sector(mesh, key.poisson_ratio, key.width, key.size.face, progress)
    else:
        sector = plane_sector(mesh, key.poisson_ratio)
    # One loaded tooth at a time, its chain of pitches moved to where it stands, all of them added up.
    cuts = np.zeros((len(teeth) + 1, sector.cut))
    for tooth, force in loads.items():
        moved = cut_motions(sector, force[:, None], count, ring=ring)[:, :, 0]
        place = np.arange(teeth[0], teeth[-1] + 2) - tooth + count // 2
        inside = np.ones(len(place), bool) if ring else (place >= 0) & (place < len(moved))
        cuts[inside] += moved[place[inside] % len(moved)]
    at_rest = np.zeros(pitch.dimension * len(pitch.inner))
    ends = [
        np.concatenate([pitch.left_frame(left), pitch.right_frame(right), at_rest]) for left, right in pairwise(cuts)
    ]
    return np.concatenate([pitch.left, pitch.right, pitch.inner]), np.array(ends)


def _moved_wheel(
    key: ComplianceKey,
    mesh: PitchMesh,
    pitch: Pitch,
    teeth: np.ndarray,
    loads: dict[int, np.ndarray],
    progress: Progress,
) -> tuple[np.ndarray, np.ndarray]:
    """The same on a wheel, whose inner circle moves with the blank."""
    assert key.blank is not None
    if not key.width:
        raise AnalysisError("The inside of the teeth of a wheel needs the model in space.")
    sector = wheel_sector(key, mesh, part_of(progress, 0.0, 0.6))
    blank = BlankSection(key.blank, key.face, key.inner_radius, key.poisson_ratio)
    moved = np.zeros((len(teeth), 2 * sector.cut + sector.middle))
    for tooth, force in loads.items():
        moved += wheel_motions(sector, blank, key.geometry.teeth, force, teeth - tooth, part_of(progress, 0.6, 1.0))

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
    return np.concatenate([pitch.left, pitch.right, pitch.inner]), np.array(ends)
