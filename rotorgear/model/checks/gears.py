"""Checks of gears and disks by themselves: what each kind needs, teeth that a tool leaves, reliefs, and bodies that can be."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.errors import Problem, RotorgearError
from rotorgear.files.numbers import is_count
from rotorgear.gears.geometry.flank_tolerance import FLANK_CLASSES
from rotorgear.gears.geometry.geometry import GearGeometry, impossible_teeth
from rotorgear.gears.geometry.measure import ball_contact_diameter, ideal_ball_diameter, with_allowance
from rotorgear.gears.geometry.outline import ToothOutline, tooth_outline
from rotorgear.model.layout.gear_layout import inertia_is_given
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.gear import DEPTHS, Flank, Gear, GearBody
from rotorgear.model.parts.problems import missing, not_default, told
from rotorgear.model.parts.shaft import Disk
from rotorgear.model.parts.tables import Tables
from rotorgear.model.parts.topography import Topography
from rotorgear.quantity import millimetres

# Relative: inertias that are written with six digits, each rounded by up to 5e-6.
_SIX_DIGITS = 1e-5
# deg
_LARGEST_PRESSURE_ANGLE = 45.0
_LARGEST_HELIX_ANGLE = 60.0
_OF_TEETH = (
    *("normal_module", "normal_pressure_angle", "helix_angle", "profile_shift"),
    *("addendum_factor", "dedendum_factor", "tip_diameter", "cutter_teeth"),
)
_OF_BEVELS = ("outer_module", "mean_normal_module", "spiral_angle")
_BEVEL_KEYS = (
    *("shaft", "at", "kind", "teeth", "width", "hand", "normal_pressure_angle", "clocking", "material"),
    *("mass", "polar_inertia", "diametral_inertia"),
    *_OF_BEVELS,
)
# The ideal ball is rounded up to a multiple of this (m), or of a quarter of a smaller module.
_BALL_STEP = 0.25e-3
# Deeper modifications, as a share of the normal module, are a slip of the unit.
_DEEPEST = 0.2
_NOTHING = "nothing here"


def degrees(angle: float | None) -> str:
    """Write an angle in rad as an engineer reads it."""
    return f"{math.degrees(angle or 0.0):.9g} deg"


def pressure_angle_problems(address: str, angle: float | None) -> Iterator[Problem]:
    """A pressure angle, normal or transverse, lies between 0 and 45 deg."""
    if angle is not None and not 0.0 < angle < math.radians(_LARGEST_PRESSURE_ANGLE):
        yield Problem(address, degrees(angle), f"an angle between 0 and {_LARGEST_PRESSURE_ANGLE:g} deg")


def _stand(address: str, gear: Gear) -> Iterator[Problem]:
    """A gear stands on a shaft; a ring may stand in a casing instead."""
    if gear.casing is not None and gear.shaft:
        yield Problem(address, "casing and shaft", "one of the two ways to say where it stands")
    elif gear.casing is not None and not gear.internal:
        yield Problem(
            f"{address}.casing", f"'{gear.casing}' of an external gear", "shaft and at: only rings stand in casings"
        )


def gear_problems(model: Tables) -> Iterator[Problem]:
    """Yield what is missing or impossible in the teeth of each gear by itself."""
    for name, gear in model.gears.items():
        address = f"gears.{name}"
        yield from _stand(address, gear)
        if gear.is_bevel:
            yield from _bevel_gear(address, gear)
            continue
        yield from _ring(address, gear)
        for key in not_default(gear, _OF_BEVELS):
            yield Problem(f"{address}.{key}", "a value", _NOTHING, "kind = 'bevel' has it")
        if not gear.lumped:
            yield from _toothed_gear(address, gear)
            continue
        for key in not_default(gear, _OF_TEETH):
            why = "a gear has teeth with a module or a base_radius, not both"
            yield Problem(f"{address}.{key}", "a value", _NOTHING, why)
        yield from _helix(address, gear, "base_helix_angle")
        yield from pressure_angle_problems(f"{address}.transverse_pressure_angle", gear.transverse_pressure_angle)
        if gear.kind == "herringbone" and gear.width is None:
            yield missing(f"{address}.width", "width of one helix, which with the gap places the two helices")
        if not inertia_is_given(gear) and gear.body.mesh is None:
            yield missing(f"{address}.mass", "mass and moments of inertia of a gear that is given by its base radius")


def _ring(address: str, gear: Gear) -> Iterator[Problem]:
    """What rings have that other gears have not, and the other way round."""
    body = gear.body
    if not gear.internal:
        yield from told(
            address,
            ("cutter_teeth", gear.cutter_teeth, f"{gear.cutter_teeth}", _NOTHING, "of a ring; a rack cuts other gears"),
            (
                "body.outer_diameter",
                body.outer_diameter,
                millimetres(body.outer_diameter or 0.0),
                _NOTHING,
                "of a ring",
            ),
        )
        return
    rim = "the rim is all that a ring has around its teeth"
    for key in not_default(
        body, (key for key in type(body).model_fields if key not in ("rim_thickness", "outer_diameter"))
    ):
        yield Problem(f"{address}.body.{key}", "a value", _NOTHING, rim)
    measured = gear.flank.topography is not None
    yield from told(
        address,
        ("integral", gear.integral, "true of a ring", "false", "no shaft is inside a ring"),
        ("body", body.outer_diameter and body.rim_thickness, "rim_thickness and outer_diameter", "one of the two"),
        ("flank.topography", measured, "a file", _NOTHING, "measured flanks of rings are not read"),
    )


def _toothed_gear(address: str, gear: Gear) -> Iterator[Problem]:
    if gear.teeth is None and gear.normal_module is None:
        ways = "teeth, normal_module and width, or base_radius with mass and moments of inertia"
        yield Problem(address, "neither teeth nor a base radius", ways)
        return
    absent = [key for key in ("teeth", "normal_module", "width") if getattr(gear, key) is None]
    found = [missing(f"{address}.{key}", Gear.model_fields[key].description or "a value") for key in absent]
    for key in not_default(gear, ("base_helix_angle", "transverse_pressure_angle")):
        angle = degrees(getattr(gear, key))
        found.append(Problem(f"{address}.{key}", angle, _NOTHING, "it follows from the teeth"))
    found += _helix(address, gear, "helix_angle")
    found += pressure_angle_problems(f"{address}.normal_pressure_angle", gear.normal_pressure_angle)
    yield from found
    geometry = None if found else gear.geometry
    if geometry and (wrong := list(impossible_teeth(geometry))):
        yield from (Problem(address, "", text) for text in wrong)
    elif geometry:
        yield from _teeth(address, gear, geometry)


def _bevel_gear(address: str, gear: Gear) -> Iterator[Problem]:
    """A bevel gear has teeth, one module, a width, and given inertias; all else that a gear may have is of cylindrical ones."""
    for key in not_default(gear, (key for key in type(gear).model_fields if key not in _BEVEL_KEYS)):
        yield Problem(f"{address}.{key}", "a value", _NOTHING, "it is not known of a bevel gear")
    for key in ("teeth", "width"):
        if getattr(gear, key) is None:
            yield missing(f"{address}.{key}", Gear.model_fields[key].description or "a value")
    modules = (gear.outer_module, gear.mean_normal_module)
    spiral = gear.spiral_angle
    steep = not 0.0 <= spiral < math.radians(_LARGEST_HELIX_ANGLE)
    limits = f"an angle from 0 to below {_LARGEST_HELIX_ANGLE:g} deg"
    yield from told(
        address,
        ("mean_normal_module", not any(modules), "", "missing", "required, or outer_module"),
        ("", all(modules), "outer_module and mean_normal_module", "one of the two"),
        ("spiral_angle", steep, degrees(spiral), limits, "hand = 'left' or 'right' says which way it winds"),
        ("hand", spiral > 0.0 and gear.hand is None, "", "missing", "required: 'right' or 'left'"),
        ("hand", spiral == 0.0 and gear.hand, f"'{gear.hand}'", _NOTHING, "teeth without a spiral angle have no hand"),
    )
    yield from pressure_angle_problems(f"{address}.normal_pressure_angle", gear.normal_pressure_angle)
    if not inertia_is_given(gear):
        yield missing(f"{address}.mass", "mass and moments of inertia of a bevel gear")


def _helix(address: str, gear: Gear, key: str) -> Iterator[Problem]:
    angle = getattr(gear, key)
    spur = gear.kind == "spur"
    if not spur and angle is None:
        yield missing(f"{address}.{key}", f"an angle such as '20 deg' for a {gear.kind} gear")
    steep = not spur and angle is not None and not 0.0 < angle < math.radians(_LARGEST_HELIX_ANGLE)
    limits = f"an angle between 0 and {_LARGEST_HELIX_ANGLE:g} deg"
    one = gear.kind != "herringbone"
    gap = millimetres(gear.gap)
    yield from told(
        address,
        (key, spur and angle, degrees(angle), _NOTHING, "a spur gear has no helix; kind = 'helical' has"),
        ("hand", spur and gear.hand, f"'{gear.hand}'", _NOTHING, "a spur gear has no hand; kind = 'helical' has"),
        (key, steep, degrees(angle), limits, "hand = 'left' or 'right' says which way it winds"),
        ("hand", not spur and gear.hand is None, "", "missing", "required: 'right' or 'left'"),
        ("gap", one and gear.gap, gap, _NOTHING, "only a herringbone gear has a gap between two helices"),
        ("nodes", one and gear.nodes == 2, "2", _NOTHING, "only a herringbone gear has two nodes"),
    )


def ball_diameter(gear: Gear, geometry: GearGeometry) -> float:
    """Diameter (m) of the balls a gear is measured over: given, or the ideal one rounded up."""
    if gear.ball_diameter is not None:
        return gear.ball_diameter
    step = min(_BALL_STEP, geometry.normal_module / 4.0)
    return step * math.ceil(ideal_ball_diameter(geometry) / step - 1e-9)


def _teeth(address: str, gear: Gear, geometry: GearGeometry) -> Iterator[Problem]:
    """What is impossible in a tooth whose circles are in order."""
    try:
        outline = tooth_outline(geometry)
    except RotorgearError as error:
        yield Problem(address, "", str(error))
        return
    outer = gear.body.outer_diameter
    if outer is not None and outer <= 2.0 * outline.root_radius:
        limit = f"more than the root diameter, {millimetres(2.0 * outline.root_radius)}"
        yield Problem(f"{address}.body.outer_diameter", millimetres(outer), limit)
    allowance = gear.allowance
    thinner = "allowances make a tooth thinner, for the backlash"
    below = "a length not above the upper allowance"
    upper = millimetres(allowance.upper)
    lower = millimetres(allowance.lower)
    yield from told(
        address,
        ("upper_thickness_allowance", allowance.upper > 0.0, upper, "0 or a negative length", thinner),
        ("lower_thickness_allowance", allowance.lower > allowance.upper, lower, below, thinner),
    )
    # The relief starts on the involute, below the tip.
    keys = ("tip_relief", "tip_relief_diameter")
    yield from _pair(address, gear, keys, "where the tip relief starts", "amount of the tip relief at the tip circle")
    start = gear.tip_relief_diameter
    form = 2.0 * outline.form_radius
    tip_form = outline.tip_form_roll_length(gear.flank.tip_rounding, gear.flank.tip_chamfer)
    tip = 2.0 * math.hypot(geometry.base_radius, tip_form)
    if start is not None and not (tip < start <= form if gear.internal else form <= start < tip):
        side = "above" if gear.internal else "below"
        limits = f"a diameter on the involute, from {millimetres(form)} to {side} {millimetres(tip)}"
        yield Problem(f"{address}.tip_relief_diameter", millimetres(start), limits)
    yield from _flank(f"{address}.flank", gear.flank, outline, gear.width or 0.0)
    if gear.accuracy_grade is not None and gear.accuracy_grade > FLANK_CLASSES:
        limits = f"a class from 1 to {FLANK_CLASSES} of ISO 1328-1"
        yield Problem(f"{address}.accuracy_grade", str(gear.accuracy_grade), limits)
    # The ball must touch the flanks of the thinnest tooth below its tip.
    key = "ball_diameter" if gear.ball_diameter is not None else "lower_thickness_allowance"
    try:
        touched = ball_contact_diameter(with_allowance(geometry, allowance.lower), ball_diameter(gear, geometry))
    except RotorgearError as error:
        yield Problem(f"{address}.{key}", "", str(error))
        return
    if gear.ball_diameter is not None and geometry.sign * touched > geometry.effective_tip_diameter:
        wanted = f"a ball that touches the flanks below the tip, such as {1e3 * ideal_ball_diameter(geometry):.4g} mm"
        yield Problem(f"{address}.{key}", millimetres(gear.ball_diameter), wanted)


def _pair(address: str, part: Gear | Flank, keys: tuple[str, str], place: str, amount: str) -> Iterator[Problem]:
    """The amount, which may be given as 0, and the place of a relief come together; `place` and `amount` say what is missing."""
    given = [getattr(part, key) for key in keys]
    if given[0] and not given[1]:
        yield missing(f"{address}.{keys[1]}", place)
    if given[1] and keys[0] not in part.model_fields_set:
        yield missing(f"{address}.{keys[0]}", amount)


def _flank(address: str, flank: Flank, outline: ToothOutline, width: float) -> Iterator[Problem]:
    """What is missing or impossible in the modifications of one gear with a face `width` (m)."""
    # A root relief starts on the involute: between the form circle, where the root fillet ends, and the tip circle.
    keys = ("root_relief", "root_relief_diameter")
    yield from _pair(address, flank, keys, "where the root relief starts", "its amount")
    start = flank.root_relief_diameter
    form = 2.0 * outline.form_radius
    tip = 2.0 * outline.tip_radius
    ring = outline.geometry.is_internal
    if start is not None and not (tip <= start < form if ring else form < start <= tip):
        limits = f"a diameter on the involute, {'below' if ring else 'above'} {millimetres(form)} to {millimetres(tip)}"
        yield Problem(f"{address}.root_relief_diameter", millimetres(start), limits)
    # Both ends of the face are relieved: beyond half of it they would overlap.
    keys = ("end_relief", "end_relief_length")
    yield from _pair(address, flank, keys, "the length of the end relief along the face", "its amount")
    length = flank.end_relief_length
    half = f"up to half of the face, {millimetres(0.5 * width)}"
    deepest = _DEEPEST * outline.geometry.normal_module
    deep = f"up to {_DEEPEST:g} normal modules, {millimetres(deepest)}"
    depths = {key: getattr(flank, key) for key in DEPTHS}
    teeth = abs(outline.geometry.teeth)
    number = f"the number of a tooth, from '0' to '{teeth - 1}'"
    # A tip is rounded or chamfered, and keeps an involute and a tip.
    height = abs(outline.tip_radius - outline.form_radius)
    thickness = outline.tip_radius * 2.0 * float(outline.involute(outline.tip_roll_length)[1])
    most = 0.5 * thickness / outline.rounding_share
    either = "the tip is rounded or chamfered: give one of tip_rounding and tip_chamfer"
    low_chamfer = f"less than the height of the involute, {millimetres(height)}"
    low_rounding = f"up to {millimetres(most)}, where both rounded edges meet in the middle of the tip"
    unknown = [item for item in flank.pitch_errors if not is_count(item) or int(item) >= teeth]
    yield from told(
        address,
        ("end_relief_length", length > 0.5 * width, millimetres(length), half),
        *((key, abs(depth) > deepest, millimetres(depth), deep) for key, depth in depths.items()),
        *(("pitch_errors", True, f"'{item}'", number) for item in unknown),
        ("tip_chamfer", flank.tip_rounding and flank.tip_chamfer, "", either),
        ("tip_chamfer", flank.tip_chamfer >= height, millimetres(flank.tip_chamfer), low_chamfer),
        ("tip_rounding", flank.tip_rounding > most, millimetres(flank.tip_rounding), low_rounding),
    )
    if flank.topography is not None:
        yield from _topography(f"{address}.topography", flank.topography, outline, deepest)


def _topography(address: str, topography: Topography, outline: ToothOutline, deepest: float) -> Iterator[Problem]:
    """Measured points lie on the flank, of teeth that exist, and are no slip of the unit."""
    teeth = outline.geometry.teeth
    by_diameter = topography.by == "diameter"
    low = 2.0 * outline.geometry.base_radius if by_diameter else 0.0
    high = 2.0 * outline.tip_radius if by_diameter else outline.tip_roll_length
    what = "diameters" if by_diameter else "roll lengths"
    limits = f"{what} of the flank, from {millimetres(low)} to {millimetres(high)}"
    deep = f"deviations up to {_DEEPEST:g} normal modules, {millimetres(deepest)} (is its unit right?)"
    for grid in topography.grids:
        worst = max(abs(value) for row in grid.deviation for value in row)
        places = f"{millimetres(grid.places[0])} to {millimetres(grid.places[-1])}"
        # Measurements run a little past the tip; a grid of another gear, or in another unit, lies far beside.
        beside = grid.places[0] < low * (1.0 - 1e-9) or grid.places[-1] > 1.1 * high
        number = f"the number of a tooth, from 0 to {teeth - 1}"
        yield from told(
            address,
            ("tooth", grid.tooth is not None and grid.tooth >= teeth, str(grid.tooth), number),
            ("deviation", worst > deepest, millimetres(worst), deep),
            (topography.by, beside, places, limits),
        )


def inertia_problems(layout: Layout) -> Iterator[Problem]:
    """Yield what is missing or impossible in the mass and inertias of gears and disks on their shafts."""
    for name, gear in layout.model.gears.items():
        if gear.body.mesh is None:  # else its mesh has them; reading it waits for an analysis
            yield from _body(layout, f"gears.{name}", name, gear)
    for name, disk in layout.model.disks.items():
        yield from _body(layout, f"disks.{name}", name, disk)


def _body(layout: Layout, address: str, name: str, part: Gear | Disk) -> Iterator[Problem]:
    """Mass and inertias: all that the motions of the model need, or the sizes to compute them from."""
    model = layout.model
    found: list[Problem] = []
    if inertia_is_given(part):
        needs = {
            "mass": {"bending", "axial"},
            "polar_inertia": {"torsion", "bending"},
            "diametral_inertia": {"bending"},
        }
        for key, motions in needs.items():
            if getattr(part, key) is None and motions & set(model.motions):
                found.append(missing(f"{address}.{key}", "a value beside the other inertias, 0 if it has none"))
        if isinstance(part, Disk):
            why = "a disk has sizes or given inertias, not both"
            sizes = not_default(part, ("outer_diameter", "width", "bore"))
            found += [Problem(f"{address}.{key}", millimetres(getattr(part, key)), _NOTHING, why) for key in sizes]
        elif part.body != GearBody():
            why = "a gear has a body or given inertias, not both"
            found.append(Problem(f"{address}.body", "a table", _NOTHING, why))
    elif isinstance(part, Disk):  # the sizes of a gear are those of its teeth, which are checked with them
        wanted = "outer_diameter and width, or mass and moments of inertia"
        lacking = [key for key in ("outer_diameter", "width") if getattr(part, key) is None]
        found += [missing(f"{address}.{key}", wanted) for key in lacking]
    yield from found
    if found:
        return
    try:
        body = layout.disk_body(name) if isinstance(part, Disk) else layout.gear(name).body
    except (ValueError, RotorgearError) as error:
        own_bore = part.bore if isinstance(part, Disk) else part.body.bore
        bored = own_bore is None and "bore" in str(error)
        hint = "where no bore is given it is the shaft's diameter there" if bored else ""
        yield Problem(address, "", str(error), hint)
        return
    if not model.has("bending"):
        return
    polar = f"{body.polar_inertia:.6g} kg m^2"
    diametral = f"{body.diametral_inertia:.6g} kg m^2"
    if body.polar_inertia > 2.0 * body.diametral_inertia * (1.0 + _SIX_DIGITS) and body.diametral_inertia > 0.0:
        limit = f"at most twice the diametral one, {2 * body.diametral_inertia:.6g} kg m^2"
        yield Problem(f"{address}.polar_inertia", polar, limit, "a flat disk has that, no body has more")
    elif isinstance(part, Gear) and part.node_count == 2:
        least = body.mass * part.helix_offset**2
        if body.diametral_inertia - least < -1e-9 * body.diametral_inertia:
            limit = f"at least mass x ((gap + width)/2)^2 = {least:.6g} kg m^2"
            hint = "it is that of the whole gear about its middle; or nodes = 1"
            yield Problem(f"{address}.diametral_inertia", diametral, limit, hint)
