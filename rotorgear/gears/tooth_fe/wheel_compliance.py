"""Compliance of a wheel's flanks: pitches joined to each other and to their blank, harmonic by harmonic round the gear.

With x the motions of a cut and of the seat's middle in the first pitch, those of pitch k are x e^(i n k a), a = 2 pi / z.
The pitch gives
    E^H (S_hh - S_hf S_ff^-1 S_fh) E,   E = (x_left; x_right; x_middle) / x = (1 0; e^(i n a) 0; 0 1),
and the blank's harmonics m = n + j z, which look alike to z equal pitches, give sum_j (2 pi / z) P_m^H K_m P_m, with P_m the m-th
Fourier coefficient of the seat's motion along the circle. On a helical gear that motion turns with the teeth: e^(-i m tau z).
Reference: cyclic symmetry as in D. L. Thomas, International Journal for Numerical Methods in Engineering 14 (1979) 81.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.gears.tooth_fe.blank_section import BlankSection
from rotorgear.gears.tooth_fe.wheel_sector import SEATS, WheelSector, seat_shapes
from rotorgear.progress import Progress, silent

# Harmonics n + j z of the blank that a harmonic n of the pitches takes in: |j| up to this.
_ALIASES = 2
# Gauss points of each seat element for its Fourier coefficients: exact to rounding up to the harmonics above.
_POINTS = 12


def wheel_flexibility(
    sector: WheelSector, blank: BlankSection, teeth: int, reach: int, progress: Progress = silent
) -> tuple[np.ndarray, float]:
    """Flexibility (2 reach + 1, f, f) of the flanks of a wheel loaded on one tooth, and its asymmetry by rounding."""
    h = 2 * sector.cut + sector.middle
    G = np.zeros((2 * reach + 1, sector.flank, sector.flank))
    G[reach] = la.inv(sector.stiffness[h:, h:])  # S_ff^-1: the loaded tooth with its cuts and its seat at rest
    for harmonic in _harmonics(sector, blank, teeth, progress):
        # Positive definite and Hermitian: G_n = W^H W with W = L^-1 load.
        W = la.solve_triangular(harmonic.factor, harmonic.load, lower=True, check_finite=False)
        G_n = W.conj().T @ W
        for o in range(-reach, reach + 1):
            phase = harmonic.share * harmonic.turn**o
            G[reach + o] += phase.real * G_n.real - phase.imag * G_n.imag

    mirrored = G[::-1].transpose(0, 2, 1)
    asymmetry = float(np.abs(G - mirrored).max()) / float(np.abs(G).max())
    return 0.5 * (G + mirrored), asymmetry


def wheel_motions(
    sector: WheelSector,
    blank: BlankSection,
    teeth: int,
    force: np.ndarray,
    pitches: np.ndarray,
    progress: Progress = silent,
) -> np.ndarray:
    """Motions (k, 2 c + m) of left cut, right cut and seat of pitches (k,) for flank forces (f,) on pitch 0."""
    c = sector.cut
    moved = np.zeros((len(pitches), 2 * c + sector.middle))
    for harmonic in _harmonics(sector, blank, teeth, progress):
        x = -la.cho_solve((harmonic.factor, True), harmonic.load @ force, check_finite=False)
        phase = harmonic.share * harmonic.turn ** pitches[:, None]
        moved[:, :c] += (phase * x[:c]).real
        moved[:, c : 2 * c] += (phase * harmonic.turn * x[:c]).real
        moved[:, 2 * c :] += (phase * x[c:]).real
    return moved


@dataclass(frozen=True)
class _Harmonic:
    """One harmonic n of the joined pitches.

    Attributes:
        turn: e^(i n a).
        share: of this harmonic in a load on one pitch: 1/z, or 2/z where n stands for z - n too.
        factor: Cholesky's L of the system of one cut and the seat's middle (c + m, c + m).
        load: (c + m, f) what unit forces on the flank put on it.
    """

    turn: complex
    share: float
    factor: np.ndarray
    load: np.ndarray


def _harmonics(sector: WheelSector, blank: BlankSection, teeth: int, progress: Progress) -> Iterator[_Harmonic]:
    """The harmonics n = 0 ... z/2; n and z - n are conjugate."""
    c = sector.cut
    h = 2 * c + sector.middle
    S = sector.stiffness
    factor = la.cho_factor(S[h:, h:], lower=True, check_finite=False)
    load = la.cho_solve(factor, S[h:, :h]).T
    K = S[:h, :h] - S[:h, h:] @ load.T
    circle = _Circle(sector, blank, teeth)
    for n in range(teeth // 2 + 1):
        progress(2.0 * n / teeth, f"harmonic {n} of {teeth // 2} round the wheel")
        turn = np.exp(2j * np.pi * n / teeth)
        back = np.conj(turn)
        system = np.zeros((c + sector.middle, c + sector.middle), complex)
        system[:c, :c] = K[:c, :c] + K[c : 2 * c, c : 2 * c] + turn * K[:c, c : 2 * c] + back * K[c : 2 * c, :c]
        system[:c, c:] = K[:c, 2 * c :] + back * K[c : 2 * c, 2 * c :]
        system[c:, :c] = system[:c, c:].conj().T
        system[c:, c:] = K[2 * c :, 2 * c :]
        circle.add(system, n)
        alone = n == 0 or 2 * n == teeth
        yield _Harmonic(
            turn=complex(turn),
            share=(1.0 if alone else 2.0) / teeth,
            factor=la.cholesky(system, lower=True, check_finite=False),
            load=np.concatenate([load[:c] + back * load[c : 2 * c], load[2 * c :]]),
        )


class _Circle:
    """The blank as seen by the unknowns (cut, middle) of one pitch."""

    def __init__(self, sector: WheelSector, blank: BlankSection, teeth: int) -> None:
        self._sector = sector
        self._teeth = teeth
        self._z = blank.z
        self._along = sector.along(blank.z)
        self._K = blank.stiffnesses(teeth // 2 + _ALIASES * teeth)
        # Radial, tangential and axial unknowns of the seat that there are: node, function along the face, component.
        self._used = np.argwhere(sector.seat >= 0)
        place = sector.seat[sector.seat >= 0]
        self._column = np.where(self._used[:, 0] == 0, place, sector.cut + place)

    def add(self, system: np.ndarray, n: int) -> None:
        """Add the blank's stiffness for the harmonic n of the pitches."""
        teeth = self._teeth
        node, function, component = self._used.T
        total = np.zeros((len(self._used), len(self._used)), complex)
        for j in range(-_ALIASES, _ALIASES + 1):
            m = n + j * teeth
            coefficient = self._fourier(m, n)
            spiral = np.exp(-1j * m * self._sector.twist * self._z)
            # V = i a_p of the amplitude a_p e^(i m p): V sin(m p) is the real part of -i V e^(i m p).
            kind = np.array([1.0, 1j, 1.0])
            value = (spiral[:, None] * self._along[:, function]) * (coefficient[node] * kind[component])
            P = np.zeros((len(self._z), 3, len(self._used)), complex)
            P[:, component, np.arange(len(self._used))] = value
            flat = P.reshape(-1, len(self._used))
            K = self._K(abs(m))
            if m < 0:  # cos and sin of -m p: the tangential amplitude changes its sign
                sign = np.tile([1.0, -1.0, 1.0], len(self._z))
                K = sign[:, None] * K * sign
            total += 2.0 * np.pi / teeth * (flat.conj().T @ (K @ flat))
        system[np.ix_(self._column, self._column)] += total

    def _fourier(self, m: int, n: int) -> np.ndarray:
        """Coefficients (2 SEATS,) of e^(i m p) for a unit motion of the end and of each middle node of the seat."""
        t, weight = np.polynomial.legendre.leggauss(_POINTS)
        share = ((np.arange(SEATS)[:, None] + 0.5 * (t + 1.0)) / SEATS - 0.5).ravel()
        weight = np.tile(0.5 * weight / SEATS, SEATS)
        angle = 2.0 * np.pi / self._teeth
        values = (weight * np.exp(-1j * m * angle * share)) @ seat_shapes(share)
        # The other end of the seat is that of the next pitch.
        values[0] += values[-1] * np.exp(1j * n * angle)
        return np.asarray(values[:-1])
