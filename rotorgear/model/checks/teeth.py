"""Checks of a gear's teeth: whether the tool leaves a tooth, and whether reliefs, allowances and measures fit it."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.errors import Problem, RotorgearError
from rotorgear.gears.geometry.flank_tolerance import FLANK_CLASSES
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.measure import ball_contact_diameter, ideal_ball_diameter, with_allowance
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.model.checks.flank import flank_problems
from rotorgear.model.checks.pairs import ball_diameter
from rotorgear.model.parts.gear import Gear
from rotorgear.quantity import millimetres


def tooth_problems(address: str, gear: Gear, geometry: GearGeometry) -> Iterator[Problem]:
    """Yield what is impossible in a tooth whose circles are in order."""
    try:
        outline = tooth_outline(geometry)
    except RotorgearError as error:
        yield Problem(address, "", str(error))
        return
    allowance = gear.allowance
    for key, value, most, what in (
        ("upper_thickness_allowance", allowance.upper, 0.0, "0 or a negative length"),
        ("lower_thickness_allowance", allowance.lower, allowance.upper, "a length not above the upper allowance"),
    ):
        if value > most:
            hint = "allowances make a tooth thinner, for the backlash"
            yield Problem(f"{address}.{key}", millimetres(value), what, hint)
    # An amount and the diameter where it starts come together, and the start lies on the involute, below the tip.
    start = gear.tip_relief_diameter
    if gear.tip_relief and start is None:
        yield Problem(f"{address}.tip_relief_diameter", "", "missing", "required: where the tip relief starts")
    if start is not None and not gear.tip_relief:
        yield Problem(f"{address}.tip_relief", "", "missing", "required: amount of the tip relief at the tip circle")
    low = 2.0 * outline.form_radius
    tip_form = outline.tip_form_roll_length(gear.flank.tip_rounding, gear.flank.tip_chamfer)
    high = 2.0 * math.hypot(geometry.base_radius, tip_form)
    if start is not None and not low <= start < high:
        limits = f"a diameter on the involute, from {millimetres(low)} to below {millimetres(high)}"
        yield Problem(f"{address}.tip_relief_diameter", millimetres(start), limits)
    yield from flank_problems(f"{address}.flank", gear.flank, outline, gear.width or 0.0)
    if gear.accuracy_grade is not None and gear.accuracy_grade > FLANK_CLASSES:
        yield Problem(
            f"{address}.accuracy_grade", str(gear.accuracy_grade), f"a class from 1 to {FLANK_CLASSES} of ISO 1328-1"
        )
    yield from _ball(address, gear, geometry)


def _ball(address: str, gear: Gear, geometry: GearGeometry) -> Iterator[Problem]:
    """The ball must touch the flanks of the thinnest tooth below its tip."""
    thinnest = with_allowance(geometry, gear.allowance.lower)
    key = "ball_diameter" if gear.ball_diameter is not None else "lower_thickness_allowance"
    try:
        touched = ball_contact_diameter(thinnest, ball_diameter(gear, geometry))
    except RotorgearError as error:
        yield Problem(f"{address}.{key}", "", str(error))
        return
    if gear.ball_diameter is not None and touched > geometry.effective_tip_diameter:
        wanted = f"a ball that touches the flanks below the tip, such as {1e3 * ideal_ball_diameter(geometry):.4g} mm"
        yield Problem(f"{address}.{key}", millimetres(gear.ball_diameter), wanted)
