"""Values that the physics of a machine makes unlikely: address, value, usual range and the likely slip of a unit.

The ranges are wide: they are judged by ratios that do not depend on the size of the machine (slenderness, sag under the weight,
speed of sound, load per width, eccentricity, shear stress), and a value outside is some ten times off whatever is built.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import chain, pairwise
from typing import Any

from pydantic import BaseModel

from rotorgear.model.checks.names import TABLES
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.parts.bearings.geometry import UNIT, Judged
from rotorgear.model.parts.fields import unit_of
from rotorgear.model.parts.gear import DEPTHS
from rotorgear.model.parts.load import LoadHistory
from rotorgear.model.parts.shaft import Section
from rotorgear.model.parts.supports import Bearing, StiffnessMatrix
from rotorgear.note import Note
from rotorgear.quantity import GRAVITY, RPM_PER_RAD_S, millimetres

# Densities of solids in kg/m^3, and the units that slip.
_SOLID = (1.4e3, 2.3e4)
_DENSITIES = {"g/cm^3": 1e3, "kg/mm^3": 1e9, "t/mm^3": 1e12}
# Usual stiffness of a bearing.
_SPRING = "1e6 to 1e10 N/m"
# A bore and the shaft in it are one diameter but for this share.
_SEAT = 0.02
# A file with this many spacings or more is sampled; one wider than this many of the usual ones means that rows are missing.
_MANY = 20
_GAP = 10.0
# Size of an element over the thickness of the wall that it is in, up to which the stated error of a mesh is that of a plate.
_PLATE = 8.0
# Two turns: more is no angle of a drawing, nor a phase that one would write.
_ANGLE = 4.0 * math.pi


def implausible(layout: Layout) -> Iterator[Note]:
    """Yield a fact on every value of a model that is far from all that is built."""
    judged = chain(
        _materials(layout),
        _shafts(layout),
        _gears(layout),
        *(_mesh(f"meshes.{mesh.name}", mesh) for mesh in layout.meshes),
        *(_bearing(layout, f"bearings.{name}", bearing) for name, bearing in layout.model.bearings.items()),
        _couplings(layout),
        _bodies(layout),
        _boxes(layout),
        _operation(layout),
    )
    return _facts(judged)


def implausible_speed(layout: Layout, address: str, speed: float) -> Iterator[Note]:
    """Yield a fact on a speed (rad/s) of the input shaft that is beyond all that is built."""
    return _facts(_speed(layout, address, speed))


def _facts(judged: Iterable[Judged]) -> Iterator[Note]:
    for address, value, (low, high), got, usual, slips in judged:
        if not low <= value <= high:
            slip = slips if isinstance(slips, str) else slips[value > high]
            yield Note(address, f"usual is {usual.format(low, high)}", slip, got)


def _mass_of(layout: Layout, shaft: str) -> float:
    """Mass of a shaft and of what stands on it, in kg."""
    total = 0.0
    for section in layout.model.shafts[shaft].sections:
        outer, bore, outer_end, bore_end = section.mass_diameters()
        area = 0.125 * math.pi * (outer**2 + outer_end**2 - bore**2 - bore_end**2)
        total += layout.model.material_of(shaft, section).density * section.length * area
    return total + sum(body.mass for _, place, body in layout.bodies if place.shaft == shaft)


def _thickest(sections: Iterable[Section]) -> float:
    """Largest outer diameter (m) at the left ends of some sections; 0 without any."""
    return max((section.outer_diameter for section in sections), default=0.0)


def _thinnest(sections: Iterable[Section]) -> float:
    """Least outer diameter (m) of the sections that can bend; 0 without any."""
    return min((section.outer_diameter for section in sections if not section.rigid), default=0.0)


def _materials(layout: Layout) -> Iterator[Judged]:
    """By the speed of sound, of rubber to beryllium."""
    for name, material in layout.model.materials.items():
        E = material.youngs_modulus
        key = "youngs_modulus"
        got = f"{E:.6g} N/m^2"
        low = "MPa meant?" if E > 5e3 else "GPa meant?"
        slips: str | tuple[str, str] = (low, "is its unit right, and that of the density?")
        if material.density < 50.0:
            known = [unit for unit, factor in _DENSITIES.items() if _SOLID[0] <= factor * material.density <= _SOLID[1]]
            if not known:  # without mass on purpose
                continue
            key = "density"
            got = f"{material.density:.6g} kg/m^3"
            slips = f"{known[0]} meant?"
        sound = math.sqrt(E / material.density)
        got = f"{got}, with which sound runs at {sound:.3g} m/s"
        yield f"materials.{name}.{key}", sound, (300.0, 14e3), got, "{:g} to {:g} m/s", slips


def _shafts(layout: Layout) -> Iterator[Judged]:
    """Length over the largest diameter, and the largest diameter over the smallest."""
    usual = (0.05, 200.0)
    for name, shaft in layout.model.shafts.items():
        largest = [max(section.outer_diameter, section.outer_diameter_end or 0.0) for section in shaft.sections]
        if not largest:
            continue
        thick = max(largest)
        thin = min(largest)
        slender = shaft.length / thick
        got = f"{shaft.length:.4g} m long and up to {thick:.4g} m thick, {slender:.3g} diameters"
        yield f"shafts.{name}", slender, usual, got, "{:g} to {:g} diameters", "is a length or diameter in mm?"
        if usual[0] <= slender <= usual[1]:
            address = f"shafts.{name}.sections[{largest.index(thick)}].outer_diameter"
            got = f"{thick:.4g} m beside {thin:.4g} m"
            yield address, thick / thin, (0.0, 60.0), got, "up to {1:g} times as much", "mm meant?"


def _gears(layout: Layout) -> Iterator[Judged]:
    for gear in layout.gears:
        address = f"gears.{gear.name}"
        module = gear.part.normal_module
        width = gear.part.width
        diameter = 2.0 * gear.base_radius
        if module is not None:
            got = f"{module:.4g} m"
            yield f"{address}.normal_module", module, (0.05e-3, 0.1), got, "0.05 to 100 mm", "mm meant?"
        if width and diameter:
            got = f"{width:.4g} m on a base diameter of {diameter:.4g} m"
            yield f"{address}.width", width / diameter, (0.01, 5.0), got, "{:g} to {:g} of it", (UNIT, "mm meant?")
        if module is not None and width:
            got = f"{width:.4g} m, {width / module:.3g} modules"
            slips = ("is the module in inches, or the width in another unit?", UNIT)
            yield f"{address}.width", width / module, (0.8, 300.0), got, "5 to 60 modules", slips
        if module is not None:
            depths = {f"flank.{key}": getattr(gear.part.flank, key) for key in DEPTHS}
            for key, depth in {"tip_relief": gear.part.tip_relief, **depths}.items():
                got = f"{depth:.4g} m at a module of {module:.4g} m"
                yield f"{address}.{key}", abs(depth) / module, (0.0, 0.1), got, "up to {1:g} of it", "um meant?"
        thin = _thinnest(gear.shaft_part.sections)
        if thin and diameter:
            got = f"{diameter:.4g} m of its base circle on a shaft of {thin:.4g} m"
            yield address, diameter / thin, (0.0, 60.0), got, "up to {1:g} times as much", "mm meant?"


def _mesh(address: str, mesh: MeshLayout) -> Iterator[Judged]:
    part = mesh.part
    given = mesh.given_mean
    if given is not None and not mesh.is_rigid:
        # Over the width in N/m^2 (ISO 6336-1: 1.4e10 to 2.5e10 for steel), or alone in N/m.
        width = mesh.width * mesh.helices
        usual = (5e8 * width, 3e11 * width) if width else (1e5, 1e12)
        slips = ("N/um or N/(mm um) meant?", UNIT)
        yield f"{address}.stiffness", given, usual, f"{given:.4g} N/m", "{:.2g} to {:.2g} N/m", slips
    module = mesh.pinion.part.normal_module
    if module:
        for item in part.transmission_error:
            share = item.amplitude / module
            got = f"{item.amplitude:.4g} m at a module of {module:.4g} m"
            yield f"{address}.transmission_error", share, (0.0, 0.2), got, "up to {1:g} of it", "um meant?"
        for key in ("backlash", "index_error"):
            gap = getattr(part, key) or 0.0
            got = f"{gap:.4g} m"
            yield f"{address}.{key}", abs(gap), (0.0, module), got, "below the module", "um or mm meant?"
    friction = part.friction_coefficient
    yield f"{address}.friction_coefficient", friction, (0.0, 1.0), f"{friction:.4g}", "0.02 to 0.1", "percent meant?"
    oil = part.lubricant_viscosity
    if oil:
        slips = (UNIT, "mPa s (cP) meant?")
        yield f"{address}.lubricant_viscosity", oil, (5e-5, 3.0), f"{oil:.4g} Pa s", "{:g} to {:g} Pa s", slips
    ratio = part.damping_ratio
    yield f"{address}.damping_ratio", ratio, (0.0, 0.5), f"{ratio:.4g}", "0.02 to 0.2", "percent meant?"


def _bearing(layout: Layout, address: str, bearing: Bearing) -> Iterator[Judged]:
    mass = _mass_of(layout, bearing.shaft)
    sharing = sum(other.shaft == bearing.shaft for other in layout.model.bearings.values())
    weight = GRAVITY * mass / sharing if layout.model.has("bending") else 0.0
    matrix = bearing.stiffness or (bearing.table[0].stiffness if bearing.table else None)
    if matrix is not None:
        yield from _stiffness(f"{address}.stiffness", matrix, weight)
    if bearing.pedestal is not None:
        yield from _stiffness(f"{address}.pedestal.stiffness", bearing.pedestal.stiffness, weight, given=True)
    diameters = [section.outer_diameter for section in layout.model.shafts[bearing.shaft].sections]
    for kind, geometry in bearing.geometries.items():
        for key, value, usual, got, words, slips in geometry.judged():
            yield f"{address}.{kind}.{key}", value, usual, got, words, slips
        if diameters:  # the size of what surrounds the shaft against the shaft
            size = geometry.surrounds
            fits = (geometry.fits[0] * min(diameters), geometry.fits[1] * max(diameters))
            got = f"{size:.4g} m on a shaft of {min(diameters):.4g} to {max(diameters):.4g} m"
            slips = (UNIT, "mm meant?")
            yield f"{address}.{kind}.{geometry.ring}", size, fits, got, "{:.2g} to {:.2g} m", slips
    rolling = bearing.rolling
    bore = rolling.seat if rolling is not None else None
    if rolling is not None and bore is not None and diameters:
        shaft = layout.model.shafts[bearing.shaft]
        seat = min(shaft.diameters_at(shaft.station(bearing.at)), key=lambda d: abs(d - bore), default=bore)
        key = "bore" if rolling.designation is None else "designation"
        got = f"a bore of {millimetres(bore)} on a shaft of {millimetres(seat)} there"
        slip = "is it the bearing of this place?"
        yield f"{address}.rolling.{key}", seat / bore, (1.0 - _SEAT, 1.0 + _SEAT), got, "within 2 % of it", slip
    if bearing.stiffness is not None and bearing.damping is not None:
        # Damping across the shaft against that which is critical with its stiffness and the mass of the rotor.
        stiffness = max(bearing.stiffness.as_rows()[i][i] for i in range(2))
        damping = max(bearing.damping.as_rows()[i][i] for i in range(2))
        if stiffness > 0.0 and mass:
            ratio = damping / (2.0 * math.sqrt(stiffness * mass))
            got = f"{damping:.4g} N s/m, {ratio:.3g} of the critical damping"
            yield f"{address}.damping", ratio, (0.0, 1e3), got, "up to {1:g} of it", UNIT


def _stiffness(address: str, matrix: StiffnessMatrix, weight: float, *, given: bool = False) -> Iterator[Judged]:
    """Stiffness across the shaft against the weight on it; `given`: directions without one are rigid."""
    rows = matrix.as_rows()
    across = [rows[i][i] for i in range(2) if i not in matrix.rigid and (rows[i][i] or not given)]
    if not (matrix.rigid or any(any(row) for row in rows)):
        if not given:
            yield address, 0.0, (1.0, 1.0), "0 in all directions", _SPRING, "it holds nothing; leave it out"
    elif across:
        softest = min(across)
        yield address, max(across), (-math.inf, 1e12), f"{max(across):.4g} N/m", _SPRING, UNIT
        if max(across) > 0.0:
            sag = f"{softest:.4g} N/m, on which its rotor sags by {1e3 * weight / (softest or 1.0):.3g} mm"
            got = sag if softest else "no stiffness across"
            yield address, weight, (0.0, 1e-3 * softest), got, _SPRING, "N/mm or N/um meant?"


def _couplings(layout: Layout) -> Iterator[Judged]:
    """Twist of couplings under the torque of the operating point."""
    operation = layout.model.operation
    if operation is None:
        return
    speed = abs(operation.speed or 0.0)
    torque = operation.torque or (operation.power / speed if operation.power and speed else 0.0)
    for name, coupling in layout.model.couplings.items():
        stiffness = coupling.torsional_stiffness
        ratio = abs(float(layout.train.ratio(coupling.from_shaft)))
        if 0.0 < stiffness < math.inf and ratio:
            twist = torque / ratio / stiffness
            what = f"which the whole torque of the operating point would twist by {twist:.3g} rad"
            got = f"{stiffness:.4g} N m/rad, {what}"
            yield f"couplings.{name}.stiffness", twist, (0.0, 0.5), got, "up to {1:g} rad", "kN m/rad meant?"


def _bodies(layout: Layout) -> Iterator[Judged]:
    """Radii of gyration of bodies, and eccentricities of unbalances."""
    for address, _, body in layout.bodies:
        mass = body.mass
        polar = body.polar_inertia
        if mass and polar:
            radius = math.sqrt(polar / mass)
            got = f"{polar:.4g} kg m^2 on {mass:.4g} kg, a radius of gyration of {radius:.3g} m"
            yield f"{address}.polar_inertia", radius, (1e-3, 10.0), got, "{:g} to {:g} m", "kg mm^2 or g meant?"
    for name, unbalance in layout.model.unbalances.items():
        mass = _mass_of(layout, unbalance.shaft)
        if mass:
            size = unbalance.magnitude
            off = 1e3 * size / mass
            got = f"{size:.4g} kg m, which puts its rotor off by {off:.3g} mm"
            yield f"unbalances.{name}.magnitude", off, (0.0, 1.0), got, "up to {1:g} mm", "g mm meant?"


def _boxes(layout: Layout) -> Iterator[Judged]:
    """Elements of boxes beside their walls."""
    for name, casing in layout.model.casings.items():
        if casing.box is not None:
            size = casing.box.largest_element
            got = f"elements of up to {millimetres(size)} in walls of {millimetres(casing.box.wall)}"
            slip = "the error of such a mesh is larger than is stated; give a smaller element"
            yield f"casings.{name}.box.element", size / casing.box.wall, (0.0, _PLATE), got, "up to {1:g} walls", slip


def _operation(layout: Layout) -> Iterator[Judged]:
    """Gravity, damping, speed, weight, torques and forces, and angles."""
    model = layout.model
    if model.operation and any(model.operation.gravity or ()):
        size = math.sqrt(sum(x * x for x in model.operation.gravity or ()))
        slips = ("is it in g?", "mm/s^2 meant?")
        yield "operation.gravity", size, (1.5, 300.0), f"{size:.4g} m/s^2", "9.81 m/s^2", slips
    ratio = model.damping.modal_ratio
    alpha = model.damping.rayleigh_alpha
    beta = model.damping.rayleigh_beta
    yield "damping.modal_ratio", ratio, (0.0, 0.5), f"{ratio:.4g}", "0.005 to 0.05", "percent meant?"
    yield "damping.rayleigh_beta", beta, (0.0, 1e-2), f"{beta:.4g} s", "up to {1:g} s", "us meant?"
    yield "damping.rayleigh_alpha", alpha, (0.0, 1e4), f"{alpha:.4g} 1/s", "up to {1:g} 1/s", UNIT
    yield from _speed(layout, "operation.speed", model.operating_speed or 0.0)
    # Stress of the thickest section of a shaft under its own weight in the middle between its ends.
    for name, shaft in model.shafts.items():
        thick = _thickest(shaft.sections)
        if thick:
            mass = _mass_of(layout, name)
            stress = 8.0 * GRAVITY * mass * shaft.length / (math.pi * thick**3)
            got = f"{mass:.4g} kg with what it carries, under which it would have {1e-6 * stress:.3g} MPa"
            yield f"shafts.{name}", stress, (0.0, 3e8), got, "up to 300 MPa", "is a mass in g, or a density off?"
    yield from _loads(layout)
    for name, load in model.loads.items():
        if load.history is not None:
            sections = model.shafts[load.shaft].sections if load.shaft is not None else ()
            yield from _history(f"loads.{name}.history", load.history, _thinnest(sections))
    for address, part in model.parts_of(*TABLES):
        yield from _angles(address, part)


def _speed(layout: Layout, address: str, speed: float) -> list[Judged]:
    """What a speed of the input shaft does to shafts, gears and bearings: the first that is beyond all that is built is told."""
    return [item for item in _speeds(layout, address, speed) if item[1] > item[2][1]][:1]


def _speeds(layout: Layout, address: str, speed: float) -> Iterator[Judged]:
    """Speeds of shafts, gears and bearings."""
    model = layout.model
    speeds = {name: abs(speed * layout.train.ratio(name)) for name in model.shafts}

    def row(shaft: str, value: float, most: float, what: str, usual: str) -> Judged:
        got = f"{speeds[shaft] * RPM_PER_RAD_S:.4g} rpm of shaft '{shaft}', {what}"
        return address, value, (0.0, most), got, usual, "rpm meant?"

    def runs(shaft: str, diameter: float, most: float, what: str) -> Judged:
        value = 0.5 * diameter * speeds[shaft]
        return row(shaft, value, most, f"{what} at {value:.3g} m/s", "up to {1:g} m/s")

    for name, shaft in model.shafts.items():
        yield runs(name, _thickest(shaft.sections), 600.0, "whose surface runs")
    for gear in layout.gears:
        yield runs(gear.shaft, 2.0 * gear.base_radius, 400.0, f"whose gear '{gear.name}' runs")
    for name, bearing in model.bearings.items():
        if (inside := bearing.geometry) is not None:
            yield runs(bearing.shaft, inside.surrounds, inside.fastest, inside.runs.format(name))
    for name in model.shafts if model.has("bending") else ():
        first = _first_bending(layout, name)
        if first:
            times = speeds[name] / first
            what = f"{times:.3g} times its first bending frequency on rigid bearings"
            yield row(name, times, 60.0, what, "up to {1:g} times")


def _first_bending(layout: Layout, name: str) -> float | None:
    """Estimate sqrt(48 E I/(l^3 m)) in rad/s of a shaft between its outermost bearings; None without two."""
    model = layout.model
    shaft = model.shafts[name]
    places = [layout.place(f"bearings.{key}")[1] for key, one in model.bearings.items() if one.shaft == name]
    span = max(places) - min(places) if places else 0.0
    elastic = [section for section in shaft.sections if not section.rigid]
    if span <= 0.0 or not elastic or span < 0.2 * shaft.length:
        return None
    inertia = 0.0
    length = 0.0
    for section in elastic:
        outer, bore, *_ = section.mass_diameters()
        inertia += section.length / (math.pi / 64.0 * (outer**4 - bore**4))
        length += section.length
    modulus = model.material_of(name, elastic[0]).youngs_modulus
    mass = _mass_of(layout, name)
    return math.sqrt(48.0 * modulus * length / inertia / (span**3 * mass)) if mass else None


def _loads(layout: Layout) -> Iterator[Judged]:
    """Torques, powers and forces against the strength of their shafts."""
    model = layout.model
    given = [(address, load, load.shaft) for address, load in model.parts_of("loads") if load.shaft is not None]
    if model.operation:
        given.append(("operation", model.operation, model.operation.input_shaft))
    for address, part, shaft in given:
        thinnest = _thinnest(model.shafts[shaft].sections)
        ripple = getattr(part, "ripple", 0.0)
        yield f"{address}.ripple", ripple, (0.0, 3.0), f"{ripple:.4g}", "0 to 1", "percent meant?"
        if not thinnest:
            continue
        force = math.sqrt(sum(x * x for x in getattr(part, "force", None) or ()))
        yield _along(f"{address}.force", force, thinnest)
        turning = abs((model.operating_speed or 0.0) * layout.train.ratio(shaft))
        torque = part.torque or (part.power / turning if part.power and turning else 0.0)
        if torque:
            stress = 16.0 * torque / (math.pi * thinnest**3)
            thick = f"in a shaft of {1e3 * thinnest:.3g} mm"
            got = f"{torque:.4g} N m, a shear stress of {1e-6 * stress:.3g} MPa {thick}"
            slips = ("kN m or kW meant?", "N mm or W meant?")
            key = "torque" if part.torque else "power"
            yield f"{address}.{key}", stress, (3e4, 1.5e9), got, "0.03 to 1500 MPa", slips


def _along(address: str, force: float, thickness: float) -> Judged:
    """A force against the strength of a shaft of a thickness along its axis."""
    stress = 4.0 * force / (math.pi * thickness**2)
    got = f"{force:.4g} N, a stress of {1e-6 * stress:.3g} MPa in a shaft of {1e3 * thickness:.3g} mm"
    return address, stress, (0.0, 1.5e9), got, "up to 1500 MPa", UNIT


def _history(address: str, history: LoadHistory, thinnest: float) -> Iterator[Judged]:
    """Forces of a file against the strength of their shaft, and rows that are missing among many."""
    columns = zip(history.components, history.values, strict=True)
    forces = [abs(x) for name, row in columns if name[0] == "f" for x in row]
    if thinnest and forces:
        yield _along(address, max(forces), thinnest)
    spacings = [b - a for a, b in pairwise(history.places)]
    usual = sorted(spacings)[len(spacings) // 2]
    widest = max(spacings)
    if len(spacings) >= _MANY:
        begin = history.places[spacings.index(widest)]
        unit = "s" if history.over == "time" else "rad"
        got = f"no row from {begin:.6g} to {begin + widest:.6g} {unit}"
        slip = "are rows missing? it is taken as linear between them"
        yield address, widest, (0.0, _GAP * usual), got, f"one every {usual:.4g} {unit}", slip


@lru_cache
def _angle_names(part: type[BaseModel]) -> tuple[str, ...]:
    """Names of the fields of a part that are angles."""
    units = {name: unit_of(field) for name, field in part.model_fields.items()}
    return tuple(name for name, unit in units.items() if unit and unit.dimension == "angle")


def _angles(address: str, part: Any) -> Iterator[Judged]:
    """Angles of a part and of the parts in it that go round more than twice."""
    if isinstance(part, tuple):
        for number, item in enumerate(part):
            yield from _angles(f"{address}[{number}]", item)
    elif isinstance(part, BaseModel):
        angles = _angle_names(type(part))
        for name in type(part).model_fields:
            value = getattr(part, name)
            if name in angles and isinstance(value, float):
                got = f"{value:.6g} rad, {math.degrees(value):.6g} deg"
                yield f"{address}.{name}", value, (-_ANGLE, _ANGLE), got, "-720 to 720 deg", "deg meant?"
            elif isinstance(value, tuple | BaseModel):
                yield from _angles(f"{address}.{name}", value)
