"""Displacements and stresses inside the teeth for given forces on their flanks: what the condensed pitches leave out.

The motions of the cuts follow from the chain of pitches (`gear_compliance`), tooth by tooth and added up. Inside, every pitch
has the same stiffness: one sparse factorisation serves all. Lengths in normal modules, Young's modulus 1, as in `sector`; the
tooth stands on the +y axis at the middle of the face, and displacements are in its frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from rotorgear.gears.tooth_fe.compliance_model import ComplianceKey, pitch_of
from rotorgear.gears.tooth_fe.gear_compliance import cut_motions
from rotorgear.gears.tooth_fe.pitch import Pitch, whole_pitch
from rotorgear.gears.tooth_fe.sector import layered_sector, plane_sector
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
    count = key.arc or key.geometry.teeth
    ring = key.arc == 0
    if layers:
        sector = layered_sector(mesh, key.poisson_ratio, key.width, layers, part_of(progress, 0.0, 0.3))
    else:
        sector = plane_sector(mesh, key.poisson_ratio)

    # Motions of the cuts: one loaded tooth at a time, its chain of pitches moved to where it stands, all of them added up.
    near = min(_NEIGHBOURS, (count - 1) // 2)
    teeth = np.arange(min(loads) - near, max(loads) + near + 1)
    cuts = np.zeros((len(teeth) + 1, sector.cut))
    for tooth, force in loads.items():
        moved = cut_motions(sector, force[:, None], count, ring=ring)[:, :, 0]
        place = np.arange(teeth[0], teeth[-1] + 2) - tooth + count // 2
        inside = np.ones(len(place), bool) if ring else (place >= 0) & (place < len(moved))
        cuts[inside] += moved[place[inside] % len(moved)]
    progress(0.4, "inside of the teeth")

    # Inside of each pitch: K_rr u_r = f_r - K_rh u_h, with the cuts moved and the inner circle at rest.
    pitch = whole_pitch(mesh, key.poisson_ratio, key.width, layers)
    d = pitch.dimension
    n = len(pitch.points)

    def of(nodes: np.ndarray) -> np.ndarray:
        return np.asarray((d * nodes[:, None] + np.arange(d)).ravel())

    moved_dofs = np.concatenate([of(pitch.left), of(pitch.right)])
    rest = np.setdiff1d(np.arange(d * n), np.concatenate([moved_dofs, of(pitch.inner)]))
    K = pitch.stiffness
    factor = splu(sp.csc_matrix(K[rest][:, rest]), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    couple = K[rest][:, moved_dofs]
    told = part_of(progress, 0.7, 1.0)
    displacement = np.zeros((len(teeth), d * n))
    for i, number in enumerate(teeth.tolist()):
        told(i / len(teeth), f"tooth {number}")
        at_cuts = np.concatenate([pitch.left_frame(cuts[i]), pitch.right_frame(cuts[i + 1])])
        force = np.zeros(d * n)
        if number in loads:
            force[of(pitch.flank)] = (loads[number][:, None] * pitch.normal).ravel()
        displacement[i, moved_dofs] = at_cuts
        displacement[i, rest] = factor.solve(force[rest] - couple @ at_cuts)
    return TeethSolution(teeth, displacement.reshape(len(teeth), n, d), pitch)
