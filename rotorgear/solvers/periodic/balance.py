"""Harmonic balance condensed to the local displacements, by the alternating frequency/time method.

    d(t) = Re sum_h c_h e^{i h w t},  h = 0 ... H;    r_h = c_h - d_0h - R_h(w) u_h = 0,    R_h = B^T Z(h w)^-1 B

u = k d + c d' - F at N instants of a period, back by the discrete Fourier transform. Cameron and Griffin, J. Applied Mechanics
56 (1989) 149; Krack and Gross, Harmonic Balance for Nonlinear Vibration Problems (Springer 2019).

Where a law changes sides between two instants, its force has a kink and its tangents a jump, which the sum over the instants
sees with an error of the orders 2 and 1 in the spacing. Both leading terms are known from the place of the switch and the size of
the jump (Euler and Maclaurin), and are taken off: tangents then change continuously as a switch passes an instant.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.solvers.periodic.plant import Plant
from rotorgear.solvers.periodic.samples import Samples, answered
from rotorgear.solvers.periodic.switches import switches_of


@dataclass(frozen=True)
class HarmonicGrid:
    """H harmonics at N instants of a base period, which comes `order` times in a turn of the reference."""

    harmonics: int
    instants: int
    order: float

    @property
    def doubled(self) -> HarmonicGrid:
        """Twice the harmonics and instants."""
        return replace(self, harmonics=2 * self.harmonics, instants=2 * self.instants)

    def frequency(self, speed: float) -> float:
        """Of the base period, rad/s."""
        return self.order * abs(speed)


def coefficients(y: np.ndarray, grid: HarmonicGrid, m: int) -> np.ndarray:
    """c (H + 1, m) from unknowns: all real parts, then the imaginary ones of h = 1 ... H."""
    H = grid.harmonics
    c = y[: (H + 1) * m].reshape(H + 1, m).astype(complex)
    c[1:] += 1j * y[(H + 1) * m :].reshape(H, m)
    return c


def unknowns(c: np.ndarray) -> np.ndarray:
    """The inverse of `coefficients`."""
    return np.concatenate([c.real.ravel(), c[1:].imag.ravel()])


def synthesised(c: np.ndarray, w: float, instants: int) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and velocities (N, m) of coefficients (H + 1, m) at equally spaced instants of a period."""
    half = np.zeros((instants // 2 + 1, c.shape[1]), complex)
    half[: len(c)] = 0.5 * instants * c
    half[0] *= 2.0
    rate = half * (1j * w * np.arange(len(half)))[:, None]
    return np.fft.irfft(half, instants, axis=0), np.fft.irfft(rate, instants, axis=0)


def samples_of(c: np.ndarray, plant: Plant, grid: HarmonicGrid, instants: int) -> Samples:
    """The motion of coefficients and the answers of the laws at equally spaced instants of its period."""
    w = grid.frequency(plant.speed)
    t = 2.0 * np.pi / w * np.arange(instants) / instants
    return answered(t, *synthesised(c, w, instants), plant.forces, plant.speed)


def balance(c: np.ndarray, plant: Plant, grid: HarmonicGrid, *, tangents: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients u (H + 1, m) of u = k d + c d' - F along a motion c, and their derivatives (H + 1, m, 2 H + 1, m) by c."""
    H = grid.harmonics
    N = grid.instants
    m = plant.m
    w = grid.frequency(plant.speed)
    laws = plant.forces
    now = samples_of(c, plant, grid, N)
    k = laws.reference_stiffness
    damping = laws.reference_damping
    rest = now.d @ k.T + now.v @ damping.T - now.F
    spectrum = np.fft.rfft(rest, axis=0)[: H + 1] / N
    switches = switches_of(c, now, plant, w)
    spectrum -= switches.of_forces(H)
    u = 2.0 * spectrum
    u[0] *= 0.5
    u[0] = u[0].real
    if not tangents:
        return u, np.zeros((0, m, 0, m), complex)
    a, b = laws.places
    in_d = np.fft.fft(k[a, b] - now.Kd, axis=0) / N
    in_v = np.fft.fft(damping[a, b] - now.Kv, axis=0) / N
    more_d, more_v = switches.of_tangents(2 * H)
    both = np.arange(-2 * H, 2 * H + 1)
    in_d[both] -= more_d
    in_v[both] -= more_v
    h = np.arange(H + 1)
    less = h[:, None] - h[None, :]
    more = h[:, None] + h[None, :]
    turn = (1j * w * h)[None, :, None]
    forward = in_d[less] + turn * in_v[less]
    backward = in_d[more] - turn * in_v[more]
    forward[0] *= 0.5
    backward[0] *= 0.5
    tangent = np.zeros((H + 1, m, 2 * H + 1, m), complex)
    real = forward + backward
    imaginary = 1j * (forward - backward)
    for i in range(len(a)):
        tangent[:, a[i], : H + 1, b[i]] = real[:, :, i]
        tangent[:, a[i], H + 1 :, b[i]] = imaginary[:, 1:, i]
    return u, tangent
