"""What rolling bearings share: Hertz and line contact of elements with their raceways, their rows, and a cage that turns.

Point contact: Q = c_p delta^(3/2), with chi from  1 - 2/(chi^2 - 1) (K/E - 1) - F(rho) = 0  and the approach

    delta = K [4.5 sum_rho Q^2 / (E (pi chi E')^2)]^(1/3),   E' = Y/(1 - nu^2),   K, E of modulus sqrt(1 - 1/chi^2)

Hamrock and Dowson, Ball Bearing Lubrication (Wiley 1981), ch. 3; ISO/TS 16281:2008 prints it with 1.48 in place of
pi/sqrt(4.5) = 1.481.
Line contact: q = 35948 L^(8/9) delta^(10/9) in N and mm for steel, both rings together (ISO/TS 16281).

Largest pressures: p = 3 Q/(2 pi a b) on an ellipse of the half axes a = chi b, b = [2 E/(pi chi)]^(1/3) [3 Q/(sum_rho E')]^(1/3);
p = sqrt(Q sum_rho E'/(2 pi L)) on a line (Harris, Rolling Bearing Analysis, ch. 6; both bodies of one material).

A row of the side +1 takes a push of the shaft towards +z; its lines of contact run outward and towards +z, so that they meet
the axis on the side of -z. In O arrangement (back to back) the two rows meet it outside of the pair, which then resists tilting
most, in X arrangement (face to face) inside; in tandem both take the same push.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Iterator
from dataclasses import KW_ONLY, dataclass
from typing import ClassVar

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from rotorgear.forces.law import ForceLaw, Repeats, parameter
from rotorgear.solvers.time.compiled import schedule_function

# 35948 N/mm^(8/9+10/9) in SI: lengths and deflections in m.
LINE_CONTACT = 35948.0 * 1e3 ** (8.0 / 9.0) * 1e3 ** (10.0 / 9.0)
# E' of steel in Pa.
_STEEL = 210e9 / (1.0 - 0.3**2)


def point_contact(ellipses: Iterable[tuple[float, float]], modulus: float) -> float:
    """Return c_p in N/m^1.5 of a ball between both raceways, from `contact_ellipses` and E' in Pa."""
    total = 0.0
    for sum_rho, chi in ellipses:
        m = 1.0 - 1.0 / chi**2
        total += ellipk(m) * (sum_rho / (chi**2 * ellipe(m))) ** (1.0 / 3.0)
    return float(np.pi / np.sqrt(4.5) * modulus * total**-1.5)


def point_pressure(load: np.ndarray, ellipses: Iterable[tuple[float, float]], modulus: float) -> list[np.ndarray]:
    """Return the largest pressures in Pa at the inner and the outer ring under loads in N; the rest as for `point_contact`."""
    found = []
    for sum_rho, chi in ellipses:
        b = np.cbrt(2.0 * ellipe(1.0 - 1.0 / chi**2) / (np.pi * chi) * 3.0 * load / (sum_rho * modulus))
        area = np.pi * chi * b**2
        found.append(np.divide(1.5 * load, area, out=np.zeros_like(area), where=area > 0.0))
    return found


def line_pressure(load: np.ndarray, length: float, roller_diameter: float, gamma: float) -> list[np.ndarray]:
    """Return the largest pressures in Pa of a steel roller at the inner and the outer ring; gamma = D_w cos(alpha)/D_pw."""
    return [
        np.sqrt(load * 2.0 / roller_diameter / (1.0 - side * gamma) * _STEEL / (2.0 * np.pi * length))
        for side in (1.0, -1.0)
    ]


def contact_ellipses(
    ball_diameter: float, pitch_diameter: float, inner_radius: float, outer_radius: float, contact_angle: float
) -> Iterator[tuple[float, float]]:
    """Yield sum_rho in 1/m and chi of the contacts with the inner and the outer ring; groove radii and diameters in m."""
    gamma = ball_diameter * np.cos(contact_angle) / pitch_diameter
    for groove, along in ((inner_radius, gamma / (1.0 - gamma)), (outer_radius, -gamma / (1.0 + gamma))):
        total = 2.0 + along - 0.5 * ball_diameter / groove
        difference = (along + 0.5 * ball_diameter / groove) / total
        # Ratio of the axes of the contact ellipse, at least 1.
        chi = 1.0 + 1e-9
        if difference > 1e-9:
            chi = float(brentq(_ellipse, chi, 1e4, args=(float(difference),), xtol=1e-13, rtol=1e-13))
        yield 2.0 / ball_diameter * total, chi


def _ellipse(chi: float, difference: float) -> float:
    """What the ratio chi of the axes leaves of the equation above for a difference F(rho) of the curvatures."""
    m = 1.0 - 1.0 / chi**2
    return float(1.0 - 2.0 / (chi**2 - 1.0) * (ellipk(m) / ellipe(m) - 1.0) - difference)


def rows_of(arrangement: str, distance: float) -> tuple[tuple[float, float], ...]:
    """Place along the shaft from the middle of the bearing in m, and side, of each row.

    Args:
        arrangement: "single", "O", "X", "tandem" or "four-point". distance: of the two rows of a pair in m.
    """
    half = 0.5 * distance
    return {
        "single": ((0.0, 1.0),),
        "O": ((-half, 1.0), (half, -1.0)),
        "X": ((-half, -1.0), (half, 1.0)),
        "tandem": ((-half, 1.0), (half, 1.0)),
        "four-point": ((0.0, 1.0), (0.0, -1.0)),
    }[arrangement]


# Of the parameters, at the begin of those of every bearing; and of the state.
ORDER, PHASE = range(2)
CAGE, CAGE_SPEED = range(2)
TURN = 2.0 * np.pi


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the angle of the first element, and the speed of the cage."""
    s[CAGE] = p[ORDER] * angle + p[PHASE]
    s[CAGE_SPEED] = p[ORDER] * speed


@dataclass(frozen=True)
class RollingElements(ForceLaw):
    """A bearing with five relative displacements, whose elements turn with the cage."""

    conserves: ClassVar[bool] = True
    uses_velocity: ClassVar[bool] = False
    components: ClassVar[int] = 5

    _: KW_ONLY
    clearance: float = parameter("m", "radial internal clearance s (whole play along a diameter)", 0.0)
    order: float = parameter("rad/rad", "turns of the cage for each turn of the reference", 0.0)
    phase: float = parameter("rad", "angle of a rolling element at angle 0", 0.0)
    reference: tuple[float, ...] = parameter(
        "N/m, N m/rad", "linear stiffness to expand about, along each displacement", (0.0,) * 5
    )

    @property
    @abstractmethod
    def elements(self) -> int:
        """Number Z of elements of a row."""

    def state_size(self) -> int:
        """Angle and speed of the cage."""
        return 2

    def reference_stiffness(self) -> np.ndarray:
        """The linear stiffness that is given with the bearing."""
        return np.diag(self.reference[: self.components])

    def repeats(self) -> tuple[Repeats, ...]:
        """The cage, which repeats with nothing else."""
        return (Repeats(abs(self.order), common=False),) if self.order else ()

    def cycle(self) -> float:
        """From one element to the next."""
        return TURN / (self.elements * abs(self.order)) if self.order else 0.0

    def places(self, angle: float, rows: tuple[tuple[float, float], ...]) -> tuple[np.ndarray, ...]:
        """Of each element the number of its row, its angle in rad, and place and side of its row, (z,) each."""
        one = np.mod(self.order * angle + self.phase + TURN * np.arange(self.elements) / self.elements, TURN)
        place, side = np.repeat(np.array(rows), self.elements, axis=0).T
        return np.repeat(np.arange(1, len(rows) + 1), self.elements), np.tile(one, len(rows)), place, side
