"""Compliance of a gear's flanks: displacement along the flank normal on tooth o for a unit normal force on tooth 0.

The pitches of a gear are equal superelements (`sector`), joined at their cuts:
    [S_cc S_cf; S_fc S_ff] [c; f] = [reaction; p],   f = S_ff^-1 (p - S_fc c),   (S_cc - S_cf S_ff^-1 S_fc) c = -S_cf S_ff^-1 p.
So one factorisation of S_ff and of the chain of cuts serves all loads. Bodies: "rim", an arc of a few pitches whose two end
cuts and inner circle are held; "ring", all pitches round the gear, held at the inner circle only.

Numbers are for a Young's modulus and a normal module of 1: divide by E (plane strain, unit width) or by E m_n (3D).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.gears.tooth_fe.sector import Sector


@dataclass(frozen=True)
class GearCompliance:
    """Nodal flexibility of one gear.

    Attributes:
        flexibility: (2 m + 1, n, n); entry m + o: displacement on tooth o (rows) for forces on tooth 0 (columns). Tooth 1 is the
            next one clockwise, on the side of the loaded flank. Reciprocal: entry m - o is the transpose of m + o.
        roll: (r,) roll lengths of the flank nodes in normal modules, rising.
        height: (h,) places of the planes along the face in normal modules from its middle; one plane of 0 in two dimensions.
        flank_start: roll length where the involute begins.
        flank_end: roll length where it ends, at the tip.
        base_radius: in normal modules.
        unknowns: degrees of freedom of the whole finite-element model, before condensation.
        asymmetry: largest relative difference from reciprocity before it was made exact.
    """

    flexibility: np.ndarray
    roll: np.ndarray
    height: np.ndarray
    flank_start: float
    flank_end: float
    base_radius: float
    unknowns: int
    asymmetry: float

    @property
    def reach(self) -> int:
        """Teeth to either side of the loaded one whose response is known."""
        return len(self.flexibility) // 2

    def response(self, tooth: int) -> np.ndarray:
        """Flexibility (n, n) of tooth `tooth` for loads on tooth 0; zero beyond the reach."""
        if abs(tooth) > self.reach:
            return np.zeros(self.flexibility.shape[1:])
        return np.asarray(self.flexibility[self.reach + tooth])


def chained(sector: Sector, teeth: int, reach: int, *, ring: bool) -> tuple[np.ndarray, float]:
    """Flexibility (2 reach + 1, n, n) of a chain of `teeth` pitches loaded on its middle one, and its asymmetry.

    A ring closes on itself; a rim is held at both ends.
    """
    factor, carried = _condensed_flank(sector)
    held_cuts = la.cho_solve(
        factor, np.eye(sector.flank)
    )  # S_ff^-1: flexibility of the loaded tooth with its cuts at rest
    cuts = _cut_motions(sector, carried, carried.T, teeth, ring)
    middle = teeth // 2
    G = np.zeros((2 * reach + 1, sector.flank, sector.flank))
    for o in range(-reach, reach + 1):
        left = middle + o
        right = (left + 1) % len(cuts) if ring else left + 1
        if left >= 0 and left + 1 < len(cuts) + ring:
            G[reach + o] = (held_cuts if o == 0 else 0.0) - carried @ np.vstack([cuts[left], cuts[right]])

    # Maxwell: entry -o is the transpose of entry o. Rounding breaks it; the contact needs it exact, for a symmetric matrix.
    mirrored = G[::-1].transpose(0, 2, 1)
    asymmetry = float(np.abs(G - mirrored).max()) / float(np.abs(G).max())
    return 0.5 * (G + mirrored), asymmetry


def cut_motions(sector: Sector, force: np.ndarray, teeth: int, *, ring: bool) -> np.ndarray:
    """Motions (cuts, c, k) of the cuts between pitches for k sets of flank forces (f, k) on the middle one."""
    factor, carried = _condensed_flank(sector)
    h = 2 * sector.cut
    return _cut_motions(sector, carried, sector.stiffness[:h, h:] @ la.cho_solve(factor, force), teeth, ring)


def _condensed_flank(sector: Sector) -> tuple[tuple[np.ndarray, bool], np.ndarray]:
    """Factorisation of S_ff, and S_ff^-1 S_fc."""
    h = 2 * sector.cut
    factor = la.cho_factor(sector.stiffness[h:, h:], lower=True, check_finite=False)
    return factor, la.cho_solve(factor, sector.stiffness[h:, :h])


def _cut_motions(sector: Sector, carried: np.ndarray, load: np.ndarray, teeth: int, ring: bool) -> np.ndarray:
    """Motions (cuts, c, n) of all cuts for the loads on the middle pitch; the held end cuts of a rim do not move."""
    c = sector.cut
    S = sector.stiffness
    K = S[: 2 * c, : 2 * c] - S[: 2 * c, 2 * c :] @ carried
    B = K[:c, c:]
    diagonal = K[c:, c:] + K[:c, :c]
    if ring:
        return _closed(diagonal, B, -load, teeth)

    # A rim: block-tridiagonal, right neighbours B. The loaded pitch stands between cuts m and m + 1.
    middle = teeth // 2
    moved = np.zeros((teeth + 1, c, load.shape[1]))
    rhs = np.zeros_like(moved)
    rhs[middle] = -load[:c]
    rhs[middle + 1] = -load[c:]
    factors: list[tuple[np.ndarray, bool]] = []
    for cut in range(1, teeth):  # block elimination from the left
        pivot = diagonal
        if factors:
            pivot = diagonal - B.T @ la.cho_solve(factors[-1], B)
            rhs[cut] -= B.T @ la.cho_solve(factors[-1], rhs[cut - 1])
        factors.append(la.cho_factor(pivot, lower=True, check_finite=False))
    for cut in range(teeth - 1, 0, -1):  # back substitution from the right
        right = rhs[cut] - (B @ moved[cut + 1] if cut + 1 < teeth else 0.0)
        moved[cut] = la.cho_solve(factors[cut - 1], right)
    return moved


def _closed(diagonal: np.ndarray, B: np.ndarray, load: np.ndarray, teeth: int) -> np.ndarray:
    """The cuts of a closed ring by its cyclic symmetry: one complex system of one cut for each harmonic round the gear."""
    c = len(B)
    middle = teeth // 2
    moved = np.zeros((teeth, c, load.shape[1]))
    for harmonic in range(teeth // 2 + 1):
        angle = 2.0 * np.pi * harmonic / teeth
        turn = np.exp(1j * angle)
        system = diagonal + B * turn + B.T * np.conj(turn)
        rhs = load[:c] * np.exp(-1j * angle * middle) + load[c:] * np.exp(-1j * angle * (middle + 1))
        amplitude = np.linalg.solve(system, rhs)
        # Real motions: harmonics h and z - h are conjugate, so only those up to z/2 are solved and the others counted double.
        weight = 1.0 if harmonic == 0 or 2 * harmonic == teeth else 2.0
        for k in range(teeth):
            moved[k] += weight / teeth * (amplitude * np.exp(1j * angle * k)).real
    return moved
