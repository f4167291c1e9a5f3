"""Checks of a gear's flank modifications: amounts with their places, teeth that exist, depths that are no tooth any more."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.gears.geometry.outline import ToothOutline
from rotorgear.model.parts.flank import Flank
from rotorgear.model.parts.topography import Topography
from rotorgear.quantity import millimetres

# Deeper modifications, as a share of the normal module, are a slip of the unit.
_DEEPEST = 0.2


def flank_problems(address: str, flank: Flank, outline: ToothOutline, width: float) -> Iterator[Problem]:
    """Yield what is missing or impossible in the modifications of one gear with a face `width` (m)."""
    # A root relief starts on the involute: between the form circle, where the root fillet ends, and the tip circle.
    start = flank.root_relief_diameter
    keys = ("root_relief", "root_relief_diameter")
    yield from _pair(address, flank.root_relief, start, keys, "where the root relief starts")
    low = 2.0 * outline.form_radius
    high = 2.0 * outline.tip_radius
    if start is not None and not low < start <= high:
        limits = f"a diameter on the involute, above {millimetres(low)} to {millimetres(high)}"
        yield Problem(f"{address}.root_relief_diameter", millimetres(start), limits)
    # Both ends of the face are relieved: beyond half of it they would overlap.
    length = flank.end_relief_length
    keys = ("end_relief", "end_relief_length")
    yield from _pair(address, flank.end_relief, length, keys, "the length of the end relief along the face")
    if length > 0.5 * width:
        limits = f"up to half of the face, {millimetres(0.5 * width)}"
        yield Problem(f"{address}.end_relief_length", millimetres(length), limits)
    deepest = _DEEPEST * outline.geometry.normal_module
    for key in ("root_relief", "crowning", "profile_crowning", "profile_slope", "end_relief", "helix_slope", "bias"):
        if abs(getattr(flank, key)) > deepest:
            limits = f"up to {_DEEPEST:g} normal modules, {millimetres(deepest)}"
            yield Problem(f"{address}.{key}", millimetres(getattr(flank, key)), limits)
    teeth = outline.geometry.teeth
    for number in flank.pitch_errors:
        if not number.isdigit() or int(number) >= teeth:
            yield Problem(f"{address}.pitch_errors", f"'{number}'", f"the number of a tooth, from '0' to '{teeth - 1}'")
    yield from _tip_problems(address, flank, outline)
    if flank.topography is not None:
        yield from _topography_problems(f"{address}.topography", flank.topography, outline, deepest)


def _tip_problems(address: str, flank: Flank, outline: ToothOutline) -> Iterator[Problem]:
    """A tip is rounded or chamfered, and keeps an involute and a tip."""
    if flank.tip_rounding and flank.tip_chamfer:
        yield Problem(
            f"{address}.tip_chamfer", "", "the tip is rounded or chamfered: give one of tip_rounding and tip_chamfer"
        )
    if flank.tip_chamfer >= outline.tip_radius - outline.form_radius:
        limits = f"less than the height of the involute, {millimetres(outline.tip_radius - outline.form_radius)}"
        yield Problem(f"{address}.tip_chamfer", millimetres(flank.tip_chamfer), limits)
    thickness = outline.tip_radius * 2.0 * float(outline.involute(outline.tip_roll_length)[1])
    most = 0.5 * thickness / outline.rounding_share
    if flank.tip_rounding > most:
        limits = f"up to {millimetres(most)}, where both rounded edges meet in the middle of the tip"
        yield Problem(f"{address}.tip_rounding", millimetres(flank.tip_rounding), limits)


def _topography_problems(
    address: str, topography: Topography, outline: ToothOutline, deepest: float
) -> Iterator[Problem]:
    """Measured points lie on the flank, of teeth that exist, and are no slip of the unit."""
    teeth = outline.geometry.teeth
    grids = topography.grids
    for grid in grids:
        if grid.tooth is not None and grid.tooth >= teeth:
            yield Problem(f"{address}.tooth", str(grid.tooth), f"the number of a tooth, from 0 to {teeth - 1}")
        worst = max(abs(value) for row in grid.deviation for value in row)
        if worst > deepest:
            limits = f"deviations up to {_DEEPEST:g} normal modules, {millimetres(deepest)} (is its unit right?)"
            yield Problem(f"{address}.deviation", millimetres(worst), limits)
        if topography.by == "diameter":
            low = 2.0 * outline.geometry.base_radius
            high = 2.0 * outline.tip_radius
        else:
            low = 0.0
            high = outline.tip_roll_length
        # Measurements run a little past the tip; a grid of another gear, or in another unit, lies far beside.
        if grid.places[0] < low * (1.0 - 1e-9) or grid.places[-1] > 1.1 * high:
            what = "diameters" if topography.by == "diameter" else "roll lengths"
            limits = f"{what} of the flank, from {millimetres(low)} to {millimetres(high)}"
            yield Problem(
                f"{address}.{topography.by}", f"{millimetres(grid.places[0])} to {millimetres(grid.places[-1])}", limits
            )


def _pair(address: str, amount: float, place: object, keys: tuple[str, str], what: str) -> Iterator[Problem]:
    """An amount and its place come together."""
    if amount and not place:
        yield Problem(f"{address}.{keys[1]}", "", "missing", f"required: {what}")
    if place and not amount:
        yield Problem(f"{address}.{keys[0]}", "", "missing", "required: its amount")
