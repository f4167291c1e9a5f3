"""Short journal bearing (Ocvirk): the film carries by the pressure where it is squeezed, and is empty where it opens.

With the gap h = c - x cos t - y sin t at the angle t, the Reynolds equation of a bearing that is short (side flow only) has

    (h^3 p')' = 12 mu (dh/dt + omega/2 dh/dtheta) = -12 mu u . n,    u = v + omega/2 (y, -x),    n = (cos t, sin t)

so that the pressure over the length L is in proportion to u . n / h^3, and positive on the half circle about u. Its sum is

    F = A u,    A = mu R L^3 int n n^T / h^3 dt over u . n > 0

and, as the integrand of F vanishes at both ends of the half circle, dF/dv = A and dF/dd = B + A du/dd with
B = 3 mu R L^3 int (u . n) n n^T / h^4 dt. Beyond `contact` of the clearance the journal lies on the shell, an elastic wall.

DuBois and Ocvirk, NACA report 1157 (1953); Childs, Turbomachinery Rotordynamics, chapter 3 (Wiley 1993).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import ForceLaw, parameter
from rotorgear.forces.shell import CLEARANCE, LENGTH, RADIUS, SPEED, VISCOSITY, WALL, add_wall, place_in_shell, schedule
from rotorgear.solvers.time.compiled import force_function

# Gauss points over the half circle: A to 1e-9 up to an eccentricity of 0.95.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Force of the journal on the film and the shell, along x and y."""
    c = p[CLEARANCE]
    half = 0.5 * s[SPEED]
    ux = v[0] + half * d[1]
    uy = v[1] - half * d[0]
    squeeze = np.hypot(ux, uy)
    place = place_in_shell(d, p)
    size = p[VISCOSITY] * p[RADIUS] * p[LENGTH] ** 3
    middle = np.arctan2(uy, ux)
    axx = 0.0
    axy = 0.0
    ayy = 0.0
    bxx = 0.0
    bxy = 0.0
    byy = 0.0
    # A film that nothing squeezes is taken as the mean of both halves.
    for side in range(2 if squeeze == 0.0 else 1):
        for i in range(_NODES.size):
            angle = middle + side * np.pi + 0.5 * np.pi * _NODES[i]
            nx = np.cos(angle)
            ny = np.sin(angle)
            h = c - place.x * nx - place.y * ny
            weight = size * 0.5 * np.pi * _WEIGHTS[i] / h**3 * (0.5 if squeeze == 0.0 else 1.0)
            axx += weight * nx * nx
            axy += weight * nx * ny
            ayy += weight * ny * ny
            slope = 3.0 * weight * (ux * nx + uy * ny) / h
            bxx += slope * nx * nx
            bxy += slope * nx * ny
            byy += slope * ny * ny
    film = np.array([axx * ux + axy * uy, axy * ux + ayy * uy])
    # B of the clamped place, and A du/dd of the journal itself, which turns on however far it is pressed.
    k = np.array([bxx, bxy, bxy, byy])
    energy[0] = add_wall(d, place, p[WALL], film, k, F, Kd)
    Kd[0] -= half * axy
    Kd[1] += half * axx
    Kd[2] -= half * ayy
    Kd[3] += half * axy
    Kv[0] = axx
    Kv[1] = axy
    Kv[2] = axy
    Kv[3] = ayy
    energy[1] = half * (film[0] * d[1] - film[1] * d[0])
    energy[2] = film[0] * ux + film[1] * uy
    energy[3] = place.touches


@dataclass(frozen=True)
class JournalBearing(ForceLaw):
    """Plain cylindrical journal bearing, short, with a film that cavitates."""

    title: ClassVar[str] = "short journal bearing"
    components: ClassVar[int] = 2
    # The film takes its energy from the rotation of the journal, and whirls it where that is too much.
    passive: ClassVar[bool] = False
    shaft_ratio: ClassVar[str] = "order"
    carries_at_rest: ClassVar[bool] = False

    viscosity: float = parameter("Pa s", "dynamic viscosity mu", above=0.0)
    radius: float = parameter("m", "radius R of the journal", above=0.0)
    length: float = parameter("m", "length L of the bearing", above=0.0)
    clearance: float = parameter("m", "radial clearance c", above=0.0)
    order: float = parameter("rad/rad", "turns of the journal for each turn of the reference", 1.0)
    contact: float = parameter(
        "", "eccentricity over c at which the journal lies on the shell", 0.95, above=0.0, below=1.0
    )
    wall: float = parameter("N/m", "stiffness of the shell", 1e9, least=0.0)

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """Speed of the journal."""
        return 1

    def beyond(self, d: Any, speed: float) -> str:
        """A journal that turns deeper in its shell than its clearance: no film is left, and the wall stands for nothing real."""
        eccentricity = float(np.hypot(*d)) / self.clearance
        if not speed or eccentricity <= 1.0:
            return ""
        return (
            f"the journal turns {eccentricity:.3g} clearances from the middle, pressed into its shell, where no film carries it; "
            "check load, viscosity, clearance and speed"
        )

    @classmethod
    def examples(cls) -> tuple[JournalBearing, ...]:
        """A bearing of a fan."""
        return (cls(0.02, 25e-3, 25e-3, 50e-6),)
