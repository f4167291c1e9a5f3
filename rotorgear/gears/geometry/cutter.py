"""Pinion-type cutter that shapes the teeth of a ring, and the root fillet that it leaves.

The cutter has z_0 teeth, no profile shift and a tip that reaches the ring's nominal root circle: it generates the ring at the
centre distance a_0 of the two without backlash, so r_a0 = r_f - a_0 with all three positive. Its tip edges are rounded by a
circle of radius rho_0 in the transverse section, which touches tip circle and flank. A point of that circle with the normal n
cuts when n passes through the pitch point: the cutter has then turned by some angle, and the ring by z_0/z of it.
Reference: ISO 21771-1 for the generating pair; F. L. Litvin, A. Fuentes, Gear Geometry and Applied Theory, chapter on internal
involute gears. Lengths in m, angles in rad; all radii, distances and roll lengths here are positive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry, involute
from rotorgear.gears.geometry.pair import working_pressure_angle_from_shifts

# Usual cutters have fewer teeth than half of the ring's, lest they cut its tips on their way in, and no more than these.
_MOST_TEETH = 30


@dataclass(frozen=True)
class Cutter:
    """The cutter of a ring.

    Attributes:
        ring: what it makes.
        teeth: z_0.
        base_radius: r_b0.
        tip_radius: r_a0.
        tip_rounding: rho_0.
        centre_distance: a_0 while it makes the root.
        pressure_angle: working transverse pressure angle of cutter and ring.
    """

    ring: GearGeometry
    teeth: int
    base_radius: float
    tip_radius: float
    tip_rounding: float
    centre_distance: float
    pressure_angle: float

    @property
    def _centre(self) -> float:
        """Radius of the centre of the tip's rounding."""
        return self.tip_radius - self.tip_rounding

    @property
    def _centre_roll(self) -> float:
        """Roll length of that centre."""
        return math.sqrt((self._centre - self.base_radius) * (self._centre + self.base_radius))

    @property
    def form_roll_length(self) -> float:
        """Roll length of the cutter where its involute meets the rounding."""
        return self._centre_roll + self.tip_rounding

    @property
    def ring_form_roll_length(self) -> float:
        """Roll length of the ring that this point cuts, where the fillet begins: that of the cutter and a_0 sin a_w0."""
        return self.form_roll_length + self.centre_distance * math.sin(self.pressure_angle)

    @property
    def centre_angle(self) -> float:
        """Angle from the middle of the cutter's tooth to the centre of its tip's rounding; negative where two would overlap."""
        half = math.pi / 2 / self.teeth + involute(self.ring.transverse_pressure_angle)
        roll = self.form_roll_length / self.base_radius
        return half - roll + math.atan(self._centre_roll / self.base_radius)

    def fillet(self, share: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """Radii (n,) and angles (n,) of the ring's fillet from its tooth's middle; share is 0 at the flank, 1 at the root."""
        # Direction of the normal from that of the rounding's centre: where flank and rounding touch, down to 0 at the crest.
        first = math.atan2(self.base_radius, self._centre_roll)
        turned = self.centre_angle + first * (1.0 - np.asarray(share, float))
        lean = turned - self.centre_angle
        # From the centre along the normal to the pitch circle: the pitch point is there when the point cuts.
        working = self.base_radius / math.cos(self.pressure_angle)
        along = np.sqrt(working**2 - (self._centre * np.sin(lean)) ** 2) - self._centre * np.cos(lean)

        def place(distance: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
            x = self._centre * math.cos(self.centre_angle) + distance * np.cos(turned)
            y = self._centre * math.sin(self.centre_angle) + distance * np.sin(turned)
            return np.hypot(x, y), np.arctan2(y, x)

        _, pitch_point = place(along)
        radius, angle = place(self.tip_rounding)
        # The cutter has turned by -pitch_point, and the ring by z_0/z of it.
        x = radius * np.cos(angle - pitch_point) + self.centre_distance
        y = radius * np.sin(angle - pitch_point)
        gap = np.arctan2(y, x) + pitch_point * self.teeth / abs(self.ring.teeth)
        return np.hypot(x, y), math.pi / abs(self.ring.teeth) - gap


def cutter(ring: GearGeometry) -> Cutter:
    """The cutter of a ring: of the teeth that it names, or of half the ring's, 30 at most.

    The rounding is that of the ring's root_radius_factor, or of ISO 53; a larger one than the tip has room for is the full
    radius.

    Raises:
        AnalysisError: no cutter of so many teeth makes this ring.
    """
    from scipy.optimize import brentq  # here: it loads much, and models without rings have no need of it

    teeth = ring.cutter_teeth or max(min(round(abs(ring.teeth) / 2), _MOST_TEETH), 1)
    if teeth >= abs(ring.teeth):
        raise AnalysisError(
            f"A cutter of {teeth} teeth does not go into a ring of {abs(ring.teeth)}: give fewer cutter_teeth."
        )
    remedy = "give cutter_teeth of another cutter, less dedendum or another profile shift"
    # No tip of its own, for the tip follows: r_a0 reaches the ring's root.
    plain = GearGeometry(teeth, ring.normal_module, ring.normal_pressure_angle, ring.helix_angle)
    try:
        angle = working_pressure_angle_from_shifts(plain, ring)
    except AnalysisError:
        raise AnalysisError(
            f"No cutter of {teeth} teeth makes this ring: its profile shift of {ring.profile_shift:g} is too large."
        ) from None
    distance = (abs(ring.base_radius) - plain.base_radius) / math.cos(angle)
    tip = 0.5 * abs(ring.root_diameter) - distance
    if tip <= plain.base_radius or plain.transverse_thickness(2.0 * tip) <= 0.0:
        raise AnalysisError(f"A cutter of {teeth} teeth has no tip that reaches the root of this ring: {remedy}.")

    def of(rounding: float) -> Cutter:
        return Cutter(ring, teeth, plain.base_radius, tip, rounding, distance, angle)

    module = ring.normal_module
    wanted = ring.root_radius_factor
    if wanted is None:
        wanted = (ring.dedendum_factor - ring.addendum_factor) / (1.0 - math.sin(ring.normal_pressure_angle))
    # The involute reaches from its base circle on: a larger rounding would begin below it.
    most = min(max(wanted, 0.0) * module, (1.0 - 1e-9) * (tip - plain.base_radius))
    rounding = most if of(most).centre_angle >= 0.0 else float(brentq(lambda rho: of(rho).centre_angle, 0.0, most))
    return of(rounding)
