"""Compliance of a wheel's flanks: pitches joined to each other and to their blank, harmonic by harmonic round the gear.

With x the motions of a cut and of the seat's middle in the first pitch, those of pitch k are x e^(i n k a), a = 2 pi / z.
The pitch gives
    E^H (S_hh - S_hf S_ff^-1 S_fh) E,   E = (x_left; x_right; x_middle) / x = (1 0; e^(i n a) 0; 0 1),
and the blank's harmonics m = n + j z, which look alike to z equal pitches, give sum_j (2 pi / z) P_m^H K_m P_m, with P_m the m-th
Fourier coefficient of the seat's motion along the circle. On a helical gear that motion turns with the teeth: e^(-i m tau z).
Reference: cyclic symmetry as in D. L. Thomas, International Journal for Numerical Methods in Engineering 14 (1979) 81.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
from scipy.linalg.blas import zherk

from rotorgear.gears.tooth_fe.blank_section import BlankSection
from rotorgear.gears.tooth_fe.wheel_sector import SEATS, WheelSector, seat_shapes
from rotorgear.progress import Progress, silent

# Harmonics n + j z of the blank that a harmonic n of the pitches takes in: |j| up to this.
_ALIASES = 2
# Gauss points of each seat element for its Fourier coefficients: exact to rounding up to the harmonics above.
_POINTS = 12
# With seats at rest pitches feel each other less by a factor of 2.5 and more from one to the next: half as many further on,
# 1e-12 of the compliance is left on a seat three modules deep.
_ANGLES = 65
_HARMONICS_TOGETHER = 8


def wheel_flexibility(
    sector: WheelSector, blank: BlankSection, teeth: int, reach: int, progress: Progress = silent
) -> tuple[np.ndarray, float]:
    """Flexibility (2 reach + 1, f, f) of the flanks of a wheel loaded on one tooth, and its asymmetry by rounding.

    The rest of the cuts is eliminated before the seats: pitches that feel each other through their cuts only, on seats at rest,
    are alike after some pitches, whatever goes round the wheel.
    """
    pitch = _JoinedPitches.of(sector)
    circle = _Circle(sector, blank, teeth)
    total = _HermitianSum(sector.flank, reach)
    on_seats = _on_seats(pitch, circle.column, min(teeth, _ANGLES), total)
    u = len(circle.column)
    last = teeth // 2
    for first in range(0, last + 1, _HARMONICS_TOGETHER):
        some = np.arange(first, min(first + _HARMONICS_TOGETHER, last + 1))
        for n, reduced in zip(some, on_seats(2.0 * np.pi * some / teeth), strict=True):
            progress(2.0 * n / teeth, f"harmonic {n} of {last} round the wheel")
            system = reduced[:, :u] + circle.stiffness(int(n))
            factor = la.cholesky(system, lower=True, check_finite=False)
            carried = la.solve_triangular(factor, reduced[:, u:], lower=True, check_finite=False)
            total.add(zherk(1.0, carried, trans=2, lower=1), *_turn_and_share(int(n), teeth))
    G = total.matrices()
    held = la.inv(sector.stiffness[-sector.flank :, -sector.flank :])  # S_ff^-1: with its cuts and its seat at rest
    G[reach] += 0.5 * (held + held.T)
    return G, float(np.abs(held - held.T).max()) / float(np.abs(G).max())


def wheel_motions(
    sector: WheelSector,
    blank: BlankSection,
    teeth: int,
    force: np.ndarray,
    pitches: np.ndarray,
    progress: Progress = silent,
) -> np.ndarray:
    """Motions (k, 2 c + m) of left cut, right cut and seat of pitches (k,) for flank forces (f,) on pitch 0."""
    pitch = _JoinedPitches.of(sector)
    circle = _Circle(sector, blank, teeth)
    on_seat = np.ix_(circle.column, circle.column)
    c = sector.cut
    moved = np.zeros((len(pitches), 2 * c + sector.middle))
    for n in range(teeth // 2 + 1):  # harmonics n and z - n are conjugate
        progress(2.0 * n / teeth, f"harmonic {n} of {teeth // 2} round the wheel")
        turn, share = _turn_and_share(n, teeth)
        system, load = pitch.at(turn)
        system[on_seat] += circle.stiffness(n)
        factor = la.cholesky(system, lower=True, check_finite=False)
        x = -la.cho_solve((factor, True), load @ force, check_finite=False)
        phase = share * turn ** pitches[:, None]
        moved[:, :c] += (phase * x[:c]).real
        moved[:, c : 2 * c] += (phase * turn * x[:c]).real
        moved[:, 2 * c :] += (phase * x[c:]).real
    return moved


def _turn_and_share(n: int, count: int) -> tuple[complex, float]:
    """e^(i n a) of the n-th harmonic round `count` pitches, a = 2 pi / count, and its share in a load on one pitch."""
    alone = n == 0 or 2 * n == count
    return complex(np.exp(2j * np.pi * n / count)), (1.0 if alone else 2.0) / count


@dataclass(frozen=True)
class _JoinedPitches:
    """Equal pitches joined at their cuts, without a blank, in the unknowns (cut, middle of the seat) of one.

    Where the right cut moves by e^(i t) times the left one, E^H K E = K_0 + K_c cos t + i K_s sin t, and so the loads.

    Attributes:
        stiffness: (3, c + m, c + m) K_0, K_c, K_s of pitches with free flanks.
        load: (3, c + m, f) what unit forces on the flank put on them, which has e^(-i t).
    """

    stiffness: np.ndarray
    load: np.ndarray

    @classmethod
    def of(cls, sector: WheelSector) -> _JoinedPitches:
        """With the flank condensed."""
        c = sector.cut
        h = 2 * c + sector.middle
        S = sector.stiffness
        factor = la.cho_factor(S[h:, h:], lower=True, check_finite=False)
        of_pitch = la.cho_solve(factor, S[h:, :h]).T
        K = S[:h, :h] - S[:h, h:] @ of_pitch.T
        size = c + sector.middle
        own = np.concatenate([np.arange(c), np.arange(2 * c, h)])  # left cut and middle
        right = slice(c, 2 * c)
        stiffness = np.zeros((3, size, size))
        stiffness[0] = K[np.ix_(own, own)]
        stiffness[0, :c, :c] += K[right, right]
        stiffness[0, c:, :c] = stiffness[0, :c, c:].T
        ahead = np.zeros((size, size))  # times e^(i t), and its transpose times e^(-i t)
        ahead[:, :c] = K[own, right]
        stiffness[1] = ahead + ahead.T
        stiffness[2] = ahead - ahead.T
        load = np.zeros((3, size, sector.flank))
        load[0] = of_pitch[own]
        load[1, :c] = of_pitch[right]
        load[2] = -load[1]
        return cls(stiffness, load)

    def at(self, turn: complex) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness (c + m, c + m) and load (c + m, f), where the right cut moves by `turn` times the left one."""
        found = []
        for even, cosine, sine in (self.stiffness, self.load):
            values = np.empty(even.shape, complex)
            values.real = even + turn.real * cosine
            values.imag = turn.imag * sine
            found.append(values)
        return found[0], found[1]


def _on_seats(
    pitch: _JoinedPitches, seat: np.ndarray, count: int, total: _HermitianSum
) -> Callable[[np.ndarray], np.ndarray]:
    """Eliminate the rest of the cuts at `count` angles; what loads move with seats at rest is added to `total`.

    Returns:
        A function of angles (a,) from pitch to pitch: stiffness (u, u) beside load (u, f) that is left on the seat's unknowns, as
        a sum over pitches k of R_k e^(i k angle), (a, u, u + f).
    """
    r = len(pitch.load[0]) - len(seat)
    order = np.concatenate([np.setdiff1d(np.arange(len(pitch.load[0])), seat), seat])  # the seat's unknowns come last
    ordered = _JoinedPitches(pitch.stiffness[:, order[:, None], order], pitch.load[:, order])
    u = len(seat)
    samples = np.empty((count // 2 + 1, u, u + pitch.load.shape[2]), complex)
    for j, sample in enumerate(samples):
        turn, share = _turn_and_share(j, count)
        system, load = ordered.at(turn)
        factor = la.cholesky(system[:r, :r], lower=True, check_finite=False)
        right = np.hstack([system[:r, r:], load[:r]])
        carried = la.solve_triangular(factor, right, lower=True, overwrite_b=True, check_finite=False)
        total.add(zherk(1.0, carried[:, u:], trans=2, lower=1), turn, share)
        sample[:, :u] = system[r:, r:]
        sample[:, u:] = load[r:]
        sample -= carried[:, :u].conj().T @ carried
    # R(-angle) is conjugate to R(angle), so that all R_k are real.
    reduced = np.fft.irfft(np.conjugate(samples, out=samples), count, axis=0).reshape(count, -1)
    numbers = np.arange(count)
    pitches = np.where(numbers > count // 2, numbers - count, numbers)

    def at(angles: np.ndarray) -> np.ndarray:
        phase = angles[:, None] * pitches
        found = np.empty((len(angles), reduced.shape[1]), complex)
        found.real = np.cos(phase) @ reduced
        found.imag = np.sin(phase) @ reduced
        return found.reshape(len(angles), u, -1)

    return at


class _HermitianSum:
    """Sum over harmonics of share turn^o G_n for pitches o apart, of matrices whose lower triangles are given.

    Those of -o are the transposes, and the real part is symmetric, the imaginary one antisymmetric.
    """

    def __init__(self, size: int, reach: int) -> None:
        self._reach = reach
        self._real = np.zeros((reach + 1, size, size))
        self._imag = np.zeros((reach + 1, size, size))

    def add(self, matrix: np.ndarray, turn: complex, share: float) -> None:
        """Add a harmonic's matrix (f, f)."""
        real = np.ascontiguousarray(matrix.real.T)
        imag = np.ascontiguousarray(matrix.imag.T)
        for o in range(self._reach + 1):
            phase = share * turn**o
            self._real[o] += phase.real * real
            if o:
                self._imag[o] += phase.imag * imag

    def matrices(self) -> np.ndarray:
        """Real parts (2 reach + 1, f, f) of the sums for pitches -reach ... reach apart."""
        reach = self._reach
        found = np.empty((2 * reach + 1, *self._real.shape[1:]))
        for o in range(reach + 1):
            # Kept with rows and columns exchanged: the upper triangle.
            real = np.triu(self._real[o]) + np.triu(self._real[o], 1).T
            imag = np.triu(self._imag[o], 1).T - np.triu(self._imag[o], 1)
            found[reach + o] = real - imag
            found[reach - o] = found[reach + o].T
        return found


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
        # Where they stand in the system of one cut and the middle (u,).
        self.column = np.where(self._used[:, 0] == 0, place, sector.cut + place)

    def stiffness(self, n: int) -> np.ndarray:
        """The blank's stiffness (u, u) in the seat's unknowns for the harmonic n of the pitches."""
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
        return total

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
