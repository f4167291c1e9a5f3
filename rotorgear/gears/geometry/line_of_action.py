"""Where two involute flanks touch: along the line of action, and at a tip corner just before and after it.

On the line of action xi_1 + xi_2 = T1T2. Beyond its ends a tip corner P of one gear touches the flank of its mate off the line:
with t = sqrt(r_P^2 / r_b^2 - 1) and the angle of P about the mate's axis from the centre line, the mate's flank through P would
cut the line of action at xi_eff = r_b (a_w - angle + t - atan t), so the gap there is xi_1 + xi_2,eff - T1T2.
Reference: ISO 21771-1 for the line of action; the corner is plane kinematics. Lengths in m, angles in rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.geometry.pair import PairGeometry


@dataclass(frozen=True)
class LineOfAction:
    """Line of action of a pair in the transverse plane; index 0 is the pinion, 1 the gear.

    Radii, roll lengths and distances of a ring with its teeth inside are negative, as in ISO 21771: T1T2 too, and the same
    formulas hold.

    Attributes:
        base_radius: r_b of both gears.
        form: roll lengths of both gears where the involute begins.
        tip: roll lengths of both gears where it ends: at the tip, or below its rounding or chamfer.
        centre_distance: a_w.
        pressure_angle: a_wt, the working transverse pressure angle.
        base_pitch: p_bt, transverse.
        base_helix_angle: b_b.
    """

    base_radius: tuple[float, float]
    form: tuple[float, float]
    tip: tuple[float, float]
    centre_distance: float
    pressure_angle: float
    base_pitch: float
    base_helix_angle: float

    @property
    def length(self) -> float:
        """T1T2, between the base tangent points."""
        return self.centre_distance * math.sin(self.pressure_angle)

    @property
    def pitch_point(self) -> float:
        """Roll length of the pinion at the pitch point."""
        return self.base_radius[0] * math.tan(self.pressure_angle)

    @property
    def start(self) -> float:
        """Roll length of the pinion where contact begins: at the gear's tip, or where its own involute begins."""
        return max(self.length - self.tip[1], self.form[0])

    @property
    def end(self) -> float:
        """Roll length of the pinion where contact ends: at its own tip, or where the gear's involute begins."""
        return min(self.tip[0], self.length - self.form[1])

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio of the involutes that are there: that of the tip circles unless a tip reaches below one."""
        return max(self.end - self.start, 0.0) / self.base_pitch

    @property
    def interference(self) -> bool:
        """Whether a tip reaches below the involute of its mate."""
        # A tip that ends at the form circle, as many are designed to, must not count as interference by rounding.
        slack = 1e-9 * abs(self.length)
        return self.length - self.tip[1] < self.form[0] - slack or self.length - self.form[1] < self.tip[0] - slack

    def corner(self, gear: int, excess: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where the tip corner of a gear stands to its mate's flank.

        Args:
            gear: whose tip it is; the pinion's leaves contact, the gear's comes into it.
            excess: (k,) how far the nominal contact is beyond that tip on the line of action.

        Returns:
            The gap (k,) along the line of action, and the roll length (k,) on the mate.
        """
        base = self.base_radius[gear]
        mate = self.base_radius[1 - gear]
        tip = self.tip[gear]
        excess = np.asarray(excess, float)

        # P on the tip circle, as an angle about its own axis from the centre line, and as seen from the mate's axis.
        angle = self.pressure_angle - math.atan(tip / base) - excess / base
        radius = math.copysign(math.hypot(tip, base), base)
        across = radius * np.sin(angle)
        along = self.centre_distance - radius * np.cos(angle)

        # The mate's involute through P. Below its base circle there is none: P is then taken to touch at its foot, t = 0.
        t = np.sqrt(np.maximum((across**2 + along**2) / mate**2 - 1.0, 0.0))
        seen = np.arctan2(math.copysign(1.0, mate) * across, math.copysign(1.0, mate) * along)
        effective = mate * (self.pressure_angle + seen + t - np.arctan(t))
        return tip + excess + effective - self.length, mate * t


def generated_line(
    first: GearGeometry, second: GearGeometry, pair: PairGeometry, tip_breaks: tuple[float, float] = (0.0, 0.0)
) -> LineOfAction:
    """Line of action of a pair, from the form circles of its generated teeth to their tip form circles.

    Args:
        first, second: pinion and gear; pair: their geometry at the centre distance.
        tip_breaks: roll lengths (m) that rounded or chamfered tips take off the involutes.

    Raises:
        AnalysisError: teeth that can't be made.
    """
    outlines = [tooth_outline(g) for g in (first, second)]
    return LineOfAction(
        base_radius=(first.base_radius, second.base_radius),
        form=(outlines[0].form_roll_length, outlines[1].form_roll_length),
        tip=(outlines[0].tip_roll_length - tip_breaks[0], outlines[1].tip_roll_length - tip_breaks[1]),
        centre_distance=pair.centre_distance,
        pressure_angle=pair.working_transverse_pressure_angle,
        base_pitch=first.transverse_base_pitch,
        base_helix_angle=first.base_helix_angle,
    )
