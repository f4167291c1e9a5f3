"""Values that the physics of a machine makes unlikely: address, value, usual range and the likely slip of a unit.

The ranges are wide: they are judged by ratios that do not depend on the size of the machine (slenderness, sag under the weight,
speed of sound, load per width, eccentricity, shear stress), and a value outside is some ten times off whatever is built.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.load import Load
from rotorgear.model.parts.operation import Operation
from rotorgear.model.parts.supports import Bearing
from rotorgear.quantity import RPM_PER_RAD_S

_GRAVITY = 9.81
# Usual ranges. Speed of sound sqrt(E/rho) in m/s: rubber to beryllium.
_SOUND = (300.0, 14e3)
# Densities of solids in kg/m^3, and the units that slip.
_SOLID = (1.4e3, 2.3e4)
_DENSITIES = {"g/cm^3": 1e3, "kg/mm^3": 1e9, "t/mm^3": 1e12}
# Length of a shaft over its largest diameter, and of its largest over its smallest diameter.
_SLENDER = (0.05, 200.0)
_STEPPED = 60.0
# Face width over reference diameter; normal module in m.
_WIDTH = (0.01, 5.0)
_MODULE = (0.05e-3, 0.1)
# Mesh stiffness over width in N/m^2 (ISO 6336-1: 1.4e10 to 2.5e10 for steel), and alone in N/m.
_MESH_PER_WIDTH = (5e8, 3e11)
_MESH = (1e5, 1e12)
# Sag of a rotor on its bearings in m; stiffness of a bearing in N/m that nothing reaches.
_SAG = 5e-4
_STIFFEST = 1e12
# Radius of gyration in m; eccentricity of an unbalance in m; radial clearance over radius of a film; viscosity in Pa s.
_GYRATION = (1e-3, 10.0)
_ECCENTRICITY = 1e-3
_FILM = (1e-4, 0.02)
_VISCOSITY = (5e-5, 3.0)
# Shear stress of a shaft in Pa, and speed of a surface in m/s, beyond the strongest steel.
_SHEAR = 1.5e9
_SURFACE = 600.0
_ROLLING_CLEARANCE = 0.05  # of the diameter of an element
_ERROR = 0.2  # transmission error over module
_DAMPING = 0.5
_PERCENT = ("", "percent meant?")
_ASK = ("is its unit right?", "is its unit right?")
# Of oils in kg/m^3; what surrounds a shaft over its diameters; damping of a bearing over the critical one; Rayleigh's beta in s.
_OIL = (500.0, 2000.0)
_FITS = (0.3, 12.0)
_OVERDAMPED = 1e3
_BETA = 1e-2
# Stress along a shaft under a force in Pa.
_STRESS = 1.5e9


def implausible(layout: Layout) -> Iterator[str]:
    """Yield a sentence on every value that is far from all that is built."""
    yield from _materials(layout)
    yield from _shafts(layout)
    yield from _gears(layout)
    yield from _meshes(layout)
    yield from _bearings(layout)
    yield from _bodies(layout)
    yield from _operation(layout)


def _said(address: str, value: str, usual: str, slip: str) -> str:
    return f"{address}: {value}; usual is {usual}: {slip}"


def _outside(
    address: str, value: float, usual: tuple[float, float], words: tuple[str, str], slips: tuple[str, str]
) -> Iterator[str]:
    """The sentence on a value that is below or above what is usual.

    Args:
        address: of the value. value: by which it is judged, such as a ratio. usual: lowest and highest, infinite where none is.
        words: the value, and what is usual, as they are printed. slips: the likely slip of a value below, and of one above.
    """
    if not usual[0] <= value <= usual[1]:
        yield _said(address, *words, slips[0] if value < usual[0] else slips[1])


def _materials(layout: Layout) -> Iterator[str]:
    for name, material in layout.model.materials.items():
        sound = math.sqrt(material.youngs_modulus / material.density)
        if _SOUND[0] <= sound <= _SOUND[1]:
            continue
        light = material.density < 50.0
        known = [unit for unit, factor in _DENSITIES.items() if _SOLID[0] <= factor * material.density <= _SOLID[1]]
        if light and not known:
            continue  # without mass on purpose
        key = "density" if light else "youngs_modulus"
        value = material.density if light else material.youngs_modulus
        slip = "MPa meant?" if material.youngs_modulus > 5e3 else "GPa meant?"
        if light:
            slip = f"{known[0]} meant?"
        if sound > _SOUND[1] and not light:
            slip = "is its unit right, and that of the density?"
        unit = "kg/m^3" if light else "N/m^2"
        yield _said(
            f"materials.{name}.{key}",
            f"{value:.6g} {unit}, with which sound runs at {sound:.3g} m/s",
            f"{_SOUND[0]:g} to {_SOUND[1]:g} m/s",
            slip,
        )


def _shafts(layout: Layout) -> Iterator[str]:
    for name, shaft in layout.model.shafts.items():
        if not shaft.sections:
            continue
        largest = [max(section.outer_diameter, section.outer_diameter_end or 0.0) for section in shaft.sections]
        slender = shaft.length / max(largest)
        if not _SLENDER[0] <= slender <= _SLENDER[1]:
            yield _said(
                f"shafts.{name}",
                f"{shaft.length:.4g} m long and up to {max(largest):.4g} m thick, {slender:.3g} diameters",
                f"{_SLENDER[0]:g} to {_SLENDER[1]:g} diameters",
                "is a length or diameter in mm?",
            )
        elif max(largest) > _STEPPED * min(largest):
            number = largest.index(max(largest))
            yield _said(
                f"shafts.{name}.sections[{number}].outer_diameter",
                f"{max(largest):.4g} m beside {min(largest):.4g} m",
                f"up to {_STEPPED:g} times as much",
                "mm meant?",
            )


def _gears(layout: Layout) -> Iterator[str]:
    for gear in layout.gears:
        part = gear.part
        module = part.normal_module
        if module is not None:
            words = (f"{module:.4g} m", "0.05 to 100 mm")
            yield from _outside(f"gears.{gear.name}.normal_module", module, _MODULE, words, ("mm meant?", "mm meant?"))
        diameter = 2.0 * gear.base_radius
        if part.width and diameter:
            words = (
                f"{part.width:.4g} m on a base diameter of {diameter:.4g} m",
                f"{_WIDTH[0]:g} to {_WIDTH[1]:g} of it",
            )
            slips = ("is its unit right?", "mm meant?")
            yield from _outside(f"gears.{gear.name}.width", part.width / diameter, _WIDTH, words, slips)


def _meshes(layout: Layout) -> Iterator[str]:
    for mesh in layout.meshes:
        address = f"meshes.{mesh.name}"
        given = mesh.given_mean
        if given is not None:
            width = mesh.width * mesh.helices
            low, high = (_MESH_PER_WIDTH[0] * width, _MESH_PER_WIDTH[1] * width) if width else _MESH
            words = (f"{given:.4g} N/m", f"{low:.2g} to {high:.2g} N/m")
            slips = ("N/um or N/(mm um) meant?", "is its unit right?")
            yield from _outside(f"{address}.stiffness", given, (low, high), words, slips)
        module = mesh.pinion.part.normal_module
        for item in mesh.part.transmission_error if module else ():
            if module and item.amplitude > _ERROR * module:
                yield _said(
                    f"{address}.transmission_error",
                    f"{item.amplitude:.4g} m at a module of {module:.4g} m",
                    f"up to {_ERROR:g} of it",
                    "um meant?",
                )
        if module and mesh.part.backlash and mesh.part.backlash > module:
            yield _said(f"{address}.backlash", f"{mesh.part.backlash:.4g} m", "below the module", "um or mm meant?")
        words = (f"{mesh.part.damping_ratio:.4g}", "0.02 to 0.2")
        yield from _outside(f"{address}.damping_ratio", mesh.part.damping_ratio, (0.0, _DAMPING), words, _PERCENT)


def _bearings(layout: Layout) -> Iterator[str]:
    model = layout.model
    weights = {name: _GRAVITY * _mass(layout, name) for name in model.shafts}
    for name, bearing in model.bearings.items():
        address = f"bearings.{name}"
        held = sum(other.shaft == bearing.shaft for other in model.bearings.values())
        yield from _stiffness(address, bearing, weights[bearing.shaft] / held, model.has("bending"))
        if bearing.rolling and bearing.rolling.clearance > _ROLLING_CLEARANCE * bearing.rolling.element_diameter:
            yield _said(
                f"{address}.rolling.clearance",
                f"{bearing.rolling.clearance:.4g} m",
                f"up to {_ROLLING_CLEARANCE:g} of the diameter of an element",
                "um meant?",
            )
        yield from _films(address, bearing)
        yield from _fits(address, bearing, layout)
        yield from _dampers(address, bearing, weights[bearing.shaft] / _GRAVITY)


def _films(address: str, bearing: Bearing) -> Iterator[str]:
    """Gap, viscosity and density of oil films."""
    for key in ("journal", "thrust"):
        film = getattr(bearing, key)
        if film is None:
            continue
        radius = 0.5 * (film.diameter if key == "journal" else film.outer_diameter)
        share = film.clearance / radius
        words = (f"{film.clearance:.4g} m, {share:.2g} of the radius", f"{_FILM[0]:g} to {_FILM[1]:g}")
        yield from _outside(f"{address}.{key}.clearance", share, _FILM, words, ("is its unit right?", "um meant?"))
        words = (f"{film.viscosity:.4g} Pa s", f"{_VISCOSITY[0]:g} to {_VISCOSITY[1]:g} Pa s")
        slips = ("is its unit right?", "mPa s (cP) meant?")
        yield from _outside(f"{address}.{key}.viscosity", film.viscosity, _VISCOSITY, words, slips)
        words = (f"{film.density:.4g} kg/m^3", f"{_OIL[0]:g} to {_OIL[1]:g} kg/m^3")
        yield from _outside(
            f"{address}.{key}.density", film.density, _OIL, words, ("g/cm^3 meant?", "is its unit right?")
        )


def _fits(address: str, bearing: Bearing, layout: Layout) -> Iterator[str]:
    """Size of what surrounds the shaft against the shaft."""
    sections = layout.model.shafts[bearing.shaft].sections
    sizes = (("rolling", "pitch_diameter"), ("journal", "diameter"), ("thrust", "outer_diameter"))
    for key, name in sizes if sections else ():
        part = getattr(bearing, key)
        if part is None:
            continue
        thick = max(section.outer_diameter for section in sections)
        thin = min(section.outer_diameter for section in sections)
        share = (_FITS[0] * thin, _FITS[1] * thick)
        size = getattr(part, name)
        words = (f"{size:.4g} m on a shaft of {thin:.4g} to {thick:.4g} m", f"{share[0]:.2g} to {share[1]:.2g} m")
        yield from _outside(f"{address}.{key}.{name}", size, share, words, ("is its unit right?", "mm meant?"))


def _dampers(address: str, bearing: Bearing, mass: float) -> Iterator[str]:
    """Damping across the shaft against that which is critical with its stiffness and the mass of the rotor."""
    if bearing.stiffness is None or bearing.damping is None or not mass:
        return
    stiffness = max(bearing.stiffness.as_rows()[i][i] for i in range(2))
    damping = max(bearing.damping.as_rows()[i][i] for i in range(2))
    if stiffness <= 0.0:
        return
    ratio = damping / (2.0 * math.sqrt(stiffness * mass))
    words = (f"{damping:.4g} N s/m, {ratio:.3g} of the critical damping", f"up to {_OVERDAMPED:g} of it")
    yield from _outside(f"{address}.damping", ratio, (0.0, _OVERDAMPED), words, _ASK)


def _stiffness(address: str, bearing: Bearing, weight: float, bends: bool) -> Iterator[str]:
    matrix = bearing.stiffness or (bearing.table[0].stiffness if bearing.table else None)
    if matrix is None:
        return
    rows = matrix.as_rows()
    across = [rows[0][0], rows[1][1]]
    if not any(any(row) for row in rows):
        yield _said(f"{address}.stiffness", "0 in all directions", "1e6 to 1e10 N/m", "it holds nothing; leave it out")
        return
    if max(across) > _STIFFEST:
        yield _said(f"{address}.stiffness", f"{max(across):.4g} N/m", "1e6 to 1e10 N/m", "is its unit right?")
    softest = min(across)
    if bends and max(across) > 0.0 and weight > _SAG * softest:
        sag = "no stiffness across" if softest == 0.0 else f"{softest:.4g} N/m, on which its rotor sags by"
        amount = "" if softest == 0.0 else f" {1e3 * weight / softest:.3g} mm"
        yield _said(f"{address}.stiffness", f"{sag}{amount}", "1e6 to 1e10 N/m", "N/mm or N/um meant?")


def _mass(layout: Layout, shaft: str) -> float:
    """Mass of a shaft and of what stands on it, in kg."""
    model = layout.model
    total = 0.0
    for section in model.shafts[shaft].sections:
        outer, bore, outer_end, bore_end = section.mass_diameters()
        area = 0.125 * math.pi * (outer**2 + outer_end**2 - bore**2 - bore_end**2)
        total += model.material_of(shaft, section).density * section.length * area
    return total + sum(body.body.mass for body in layout.bodies if body.shaft == shaft)


def _bodies(layout: Layout) -> Iterator[str]:
    for body in layout.bodies:
        mass = body.body.mass
        if not mass or not body.body.polar_inertia:
            continue
        radius = math.sqrt(body.body.polar_inertia / mass)
        if not _GYRATION[0] <= radius <= _GYRATION[1]:
            yield _said(
                f"{body.part}.polar_inertia",
                f"{body.body.polar_inertia:.4g} kg m^2 on {mass:.4g} kg, a radius of gyration of {radius:.3g} m",
                f"{_GYRATION[0]:g} to {_GYRATION[1]:g} m",
                "kg mm^2 or g meant?",
            )
    for name, unbalance in layout.model.unbalances.items():
        mass = _mass(layout, unbalance.shaft)
        if mass and unbalance.magnitude > _ECCENTRICITY * mass:
            yield _said(
                f"unbalances.{name}.magnitude",
                f"{unbalance.magnitude:.4g} kg m, which puts its rotor off by {1e3 * unbalance.magnitude / mass:.3g} mm",
                f"up to {1e3 * _ECCENTRICITY:g} mm",
                "g mm meant?",
            )


def _operation(layout: Layout) -> Iterator[str]:
    model = layout.model
    operation = model.operation
    if operation and operation.gravity:
        size = math.sqrt(sum(x * x for x in operation.gravity))
        if size and not 0.1 <= size <= 1e3:
            yield _said("operation.gravity", f"{size:.4g} m/s^2", "9.81 m/s^2", "mm/s^2 or g meant?")
    words = (f"{model.damping.modal_ratio:.4g}", "0.005 to 0.05")
    yield from _outside("damping.modal_ratio", model.damping.modal_ratio, (0.0, _DAMPING), words, _PERCENT)
    words = (f"{model.damping.rayleigh_beta:.4g} s", f"up to {_BETA:g} s")
    yield from _outside("damping.rayleigh_beta", model.damping.rayleigh_beta, (0.0, _BETA), words, ("", "us meant?"))
    if operation and operation.speed:
        for name, shaft in model.shafts.items():
            largest = max((section.outer_diameter for section in shaft.sections), default=0.0)
            speed = abs(operation.speed * layout.train.ratio(name))
            if 0.5 * largest * speed > _SURFACE:
                yield _said(
                    "operation.speed",
                    f"{speed * RPM_PER_RAD_S:.4g} rpm of shaft '{name}', whose surface runs at {0.5 * largest * speed:.3g} m/s",
                    f"up to {_SURFACE:g} m/s",
                    "rpm meant?",
                )
                break
    given: dict[str, tuple[Operation | Load, str]] = {
        f"loads.{name}": (load, load.shaft) for name, load in model.loads.items() if load.shaft is not None
    }
    if operation:
        given["operation"] = (operation, operation.input_shaft)
    for address, (part, shaft_name) in given.items():
        thinnest = min((s.outer_diameter for s in model.shafts[shaft_name].sections if not s.rigid), default=0.0)
        turning = abs(operation.speed * layout.train.ratio(shaft_name)) if operation and operation.speed else 0.0
        torque = part.torque or (part.power / turning if part.power and turning else 0.0)
        stress = 16.0 * torque / (math.pi * thinnest**3) if thinnest else 0.0
        force = math.sqrt(sum(x * x for x in getattr(part, "force", None) or ()))
        along = 4.0 * force / (math.pi * thinnest**2) if thinnest else 0.0
        words = (
            f"{force:.4g} N, a stress of {1e-6 * along:.3g} MPa in a shaft of {1e3 * thinnest:.3g} mm",
            "up to 1500 MPa",
        )
        yield from _outside(f"{address}.force", along, (0.0, _STRESS), words, ("", "is its unit right?"))
        if stress > _SHEAR:
            key = "torque" if part.torque else "power"
            yield _said(
                f"{address}.{key}",
                f"{torque:.4g} N m, a shear stress of {1e-6 * stress:.3g} MPa in a shaft of {1e3 * thinnest:.3g} mm",
                f"up to {1e-6 * _SHEAR:g} MPa",
                "N mm or W meant?",
            )
