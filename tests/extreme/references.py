"""Exact references at 40 digits: textbook element matrices, exact continua, and eigenvalues, all in mpmath.

Nothing here uses the package. One plane of bending has the dofs (w, theta) a node. Both planes of an isotropic rotor are one
complex plane, w = x + i y, in which a spin W adds -i W G to the velocity terms and a clockwise orbit has Im(s) < 0.
Przemieniecki, Theory of Matrix Structural Analysis (1968), section 11.3; Nelson, ASME J. Mech. Des. 102 (1980) 793.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import mpmath as mp

DIGITS = 40


@dataclass(frozen=True)
class Segment:
    """A uniform piece of shaft: one element. Lengths in m, material in SI."""

    length: float
    outer: float
    inner: float = 0.0
    E: float = 206e9
    nu: float = 0.3
    rho: float = 7850.0

    def section(self) -> tuple[mp.mpf, mp.mpf, mp.mpf, mp.mpf]:
        """A, I, G and kappa G A."""
        d = mp.mpf(self.outer)
        b = mp.mpf(self.inner)
        nu = mp.mpf(self.nu)
        area = mp.pi / 4 * (d**2 - b**2)
        inertia = mp.pi / 64 * (d**4 - b**4)
        G = mp.mpf(self.E) / (2 * (1 + nu))
        ratio = (b / d) ** 2
        kappa = 6 * (1 + nu) * (1 + ratio) ** 2 / ((7 + 6 * nu) * (1 + ratio) ** 2 + (20 + 12 * nu) * ratio)
        return area, inertia, G, kappa * G * area


@dataclass(frozen=True)
class Body:
    """A rigid body at a node: mass, polar and diametral inertia."""

    mass: float = 0.0
    polar: float = 0.0
    diametral: float = 0.0


@dataclass(frozen=True)
class Spring:
    """Stiffness and damping to ground at a node."""

    radial: float = 0.0
    axial: float = 0.0
    torsion: float = 0.0
    tilt: float = 0.0
    damping: float = 0.0


@dataclass(frozen=True)
class Rotor:
    """One shaft, one element a segment; bodies and springs by number of node."""

    segments: Sequence[Segment]
    springs: dict[int, Spring] = field(default_factory=dict)
    bodies: dict[int, Body] = field(default_factory=dict)

    def bending(self) -> tuple[mp.matrix, mp.matrix, mp.matrix, mp.matrix]:
        """M, C, G and K of the complex plane (or of one plane without G)."""
        n = 2 * (len(self.segments) + 1)
        M, C, G, K = (mp.zeros(n) for _ in range(4))
        for k, segment in enumerate(self.segments):
            translation, rotation, stiffness = bending_element(segment)
            rows = range(2 * k, 2 * k + 4)
            for A, part in ((M, translation + rotation), (G, 2 * rotation), (K, stiffness)):
                add(A, rows, part)
        for node, body in self.bodies.items():
            M[2 * node, 2 * node] += body.mass
            M[2 * node + 1, 2 * node + 1] += body.diametral
            G[2 * node + 1, 2 * node + 1] += body.polar
        for node, spring in self.springs.items():
            K[2 * node, 2 * node] += spring.radial
            K[2 * node + 1, 2 * node + 1] += spring.tilt
            C[2 * node, 2 * node] += spring.damping
        return M, C, G, K

    def torsion(self) -> tuple[mp.matrix, mp.matrix]:
        """M and K of torsion."""
        bodies = {k: b.polar for k, b in self.bodies.items()}
        springs = {k: s.torsion for k, s in self.springs.items()}
        return self._bar(
            lambda s: (2 * mp.mpf(s.rho) * s.section()[1], 2 * s.section()[2] * s.section()[1]), bodies, springs
        )

    def axial(self) -> tuple[mp.matrix, mp.matrix]:
        """M and K of axial motion."""
        return self._bar(
            lambda s: (mp.mpf(s.rho) * s.section()[0], mp.mpf(s.E) * s.section()[0]),
            {k: b.mass for k, b in self.bodies.items()},
            {k: s.axial for k, s in self.springs.items()},
        )

    def _bar(self, rates, bodies, springs) -> tuple[mp.matrix, mp.matrix]:
        n = len(self.segments) + 1
        M = mp.zeros(n)
        K = mp.zeros(n)
        for k, segment in enumerate(self.segments):
            inertia, stiffness = rates(segment)
            L = mp.mpf(segment.length)
            add(M, (k, k + 1), inertia * L / 6 * mp.matrix([[2, 1], [1, 2]]))
            add(K, (k, k + 1), stiffness / L * mp.matrix([[1, -1], [-1, 1]]))
        for A, values in ((M, bodies), (K, springs)):
            for node, value in values.items():
                A[node, node] += mp.mpf(value)
        return M, K

    def frequencies(self) -> list[mp.mpf]:
        """All undamped omega in rad/s at standstill in ascending order; bending counts in both planes."""
        M, _, _, K = self.bending()
        plane = undamped(M, K)
        return sorted([*plane, *plane, *undamped(*self.torsion()), *undamped(*self.axial())])

    def whirls(self, speed: float) -> list[mp.mpc]:
        """Eigenvalues s of bending at a speed: those with Im s >= 0 of x and y, in ascending |s|."""
        M, C, G, K = self.bending()
        roots = quadratic_roots(M, C - mp.mpc(0, 1) * mp.mpf(speed) * G, K)
        # s of the complex plane with Im < 0 stands for its conjugate: the backward whirls.
        found = [mp.mpc(s.real, abs(s.imag)) for s in roots]
        if speed == 0.0:  # a real root belongs to both planes
            found += [s for s in found if s.imag < mp.mpf(10) ** (8 - DIGITS) * abs(s)]
        return sorted(found, key=abs)


def bending_element(segment: Segment) -> tuple[mp.matrix, mp.matrix, mp.matrix]:
    """Translational and rotary inertia and stiffness of a Timoshenko element, dofs w1 theta1 w2 theta2."""
    area, inertia, _, shear = segment.section()
    L = mp.mpf(segment.length)
    EI = mp.mpf(segment.E) * inertia
    p = 12 * EI / (shear * L**2)
    q = mp.mpf(1)
    m1 = q * 13 / 35 + q * 7 / 10 * p + p**2 / 3
    m2 = (q * 11 / 210 + q * 11 / 120 * p + p**2 / 24) * L
    m3 = q * 9 / 70 + q * 3 / 10 * p + p**2 / 6
    m4 = -(q * 13 / 420 + q * 3 / 40 * p + p**2 / 24) * L
    m5 = (q / 105 + p / 60 + p**2 / 120) * L**2
    m6 = -(q / 140 + p / 60 + p**2 / 120) * L**2
    translation = mp.matrix([[m1, m2, m3, m4], [m2, m5, -m4, m6], [m3, -m4, m1, -m2], [m4, m6, -m2, m5]])
    r1 = q * 6 / 5
    r2 = (q / 10 - p / 2) * L
    r3 = (q * 2 / 15 + p / 6 + p**2 / 3) * L**2
    r4 = (-q / 30 - p / 6 + p**2 / 6) * L**2
    rotation = mp.matrix([[r1, r2, -r1, r2], [r2, r3, -r2, r4], [-r1, -r2, r1, -r2], [r2, r4, -r2, r3]])
    stiff = mp.matrix([[12, 6 * L, -12, 6 * L], [6 * L, (4 + p) * L**2, -6 * L, (2 - p) * L**2],
                       [-12, -6 * L, 12, -6 * L], [6 * L, (2 - p) * L**2, -6 * L, (4 + p) * L**2]])  # fmt: skip
    rho = mp.mpf(segment.rho)
    return (
        rho * area * L / (1 + p) ** 2 * translation,
        rho * inertia / ((1 + p) ** 2 * L) * rotation,
        EI / ((1 + p) * L**3) * stiff,
    )


def add(A: mp.matrix, rows: Sequence[int], part: mp.matrix) -> None:
    """Add a small matrix at some rows and columns."""
    for i, r in enumerate(rows):
        for j, c in enumerate(rows):
            A[r, c] += part[i, j]


def undamped(M: mp.matrix, K: mp.matrix) -> list[mp.mpf]:
    """Omega of K v = omega^2 M v, M positive definite, ascending; what is negative by rounding is 0."""
    lower = mp.inverse(mp.cholesky(M))
    values = mp.eigsy(lower * K * lower.T, eigvals_only=True)
    return [mp.sqrt(max(value, mp.mpf(0))) for value in values]


def quadratic_roots(M: mp.matrix, D: mp.matrix, K: mp.matrix) -> list[mp.mpc]:
    """All s of det(s^2 M + s D + K) = 0, from the companion matrix."""
    n = M.rows
    inverse = mp.inverse(M)
    A = mp.zeros(2 * n)
    A[:n, n:] = mp.eye(n)
    A[n:, :n] = -inverse * K
    A[n:, n:] = -inverse * D
    return list(mp.eig(A, left=False, right=False))


def timoshenko_pinned(segment: Segment, highest: int) -> list[mp.mpf]:
    """Omega in rad/s of a uniform pinned Timoshenko beam with up to `highest` half waves, both branches, ascending.

    With k = n pi / L: rho I w^2 psi = (E I k^2 + S) psi - S k W and rho A w^2 W = S k^2 W - S k psi; n = 0 only shears.
    """
    area, inertia, _, shear = segment.section()
    rho = mp.mpf(segment.rho)
    M = mp.diag([rho * area, rho * inertia])
    found = [mp.sqrt(shear / (rho * inertia))]
    for number in range(1, highest + 1):
        k = number * mp.pi / mp.mpf(segment.length)
        K = mp.matrix([[shear * k**2, -shear * k], [-shear * k, mp.mpf(segment.E) * inertia * k**2 + shear]])
        found += undamped(M, K)
    return sorted(found)
