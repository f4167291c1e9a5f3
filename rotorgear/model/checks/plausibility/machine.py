"""Values that the physics of a machine makes unlikely: address, value, usual range and the likely slip of a unit.

The ranges are wide: they are judged by ratios that do not depend on the size of the machine (slenderness, sag under the weight,
speed of sound, load per width, eccentricity, shear stress), and a value outside is some ten times off whatever is built.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.model.checks.plausibility.bearings import bearings, couplings
from rotorgear.model.checks.plausibility.operation import operation
from rotorgear.model.checks.plausibility.sentence import mass_of, outside, said
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.gear import Gear

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
# Radius of gyration in m; eccentricity of an unbalance in m.
_GYRATION = (1e-3, 10.0)
_ECCENTRICITY = 1e-3
# Errors, reliefs and gaps of flanks over module; face width over module; base diameter over that of the thinnest shaft.
_ERROR = 0.2
_DEPTH = 0.1
_PER_MODULE = (0.8, 300.0)
_PER_SHAFT = 60.0
_DAMPING = 0.5
_PERCENT = ("", "percent meant?")
_VISCOSITY = (5e-5, 3.0)
# Depths on a flank.
_DEPTHS = ("root_relief", "crowning", "profile_crowning", "profile_slope", "end_relief", "helix_slope", "bias")


def implausible(layout: Layout) -> Iterator[str]:
    """Yield a sentence on every value that is far from all that is built."""
    yield from _materials(layout)
    yield from _shafts(layout)
    yield from _gears(layout)
    yield from _meshes(layout)
    yield from bearings(layout)
    yield from couplings(layout)
    yield from _bodies(layout)
    yield from operation(layout)


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
        yield said(
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
            yield said(
                f"shafts.{name}",
                f"{shaft.length:.4g} m long and up to {max(largest):.4g} m thick, {slender:.3g} diameters",
                f"{_SLENDER[0]:g} to {_SLENDER[1]:g} diameters",
                "is a length or diameter in mm?",
            )
        elif max(largest) > _STEPPED * min(largest):
            number = largest.index(max(largest))
            yield said(
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
            yield from outside(f"gears.{gear.name}.normal_module", module, _MODULE, words, ("mm meant?", "mm meant?"))
        diameter = 2.0 * gear.base_radius
        if part.width and diameter:
            words = (
                f"{part.width:.4g} m on a base diameter of {diameter:.4g} m",
                f"{_WIDTH[0]:g} to {_WIDTH[1]:g} of it",
            )
            slips = ("is its unit right?", "mm meant?")
            yield from outside(f"gears.{gear.name}.width", part.width / diameter, _WIDTH, words, slips)
        if module is not None:
            yield from _teeth(f"gears.{gear.name}", part, module)
        sections = [section for section in layout.model.shafts[gear.shaft].sections if not section.rigid]
        if sections and diameter:
            thin = min(section.outer_diameter for section in sections)
            words = (
                f"{diameter:.4g} m of its base circle on a shaft of {thin:.4g} m",
                f"up to {_PER_SHAFT:g} times as much",
            )
            yield from outside(f"gears.{gear.name}", diameter / thin, (0.0, _PER_SHAFT), words, ("", "mm meant?"))


def _teeth(address: str, gear: Gear, module: float) -> Iterator[str]:
    """Face width, reliefs and crowning of a gear over its module."""
    if gear.width:
        words = (f"{gear.width:.4g} m, {gear.width / module:.3g} modules", "5 to 60 modules")
        slips = ("is the module in inches, or the width in another unit?", "is its unit right?")
        yield from outside(f"{address}.width", gear.width / module, _PER_MODULE, words, slips)
    depths = {"tip_relief": gear.tip_relief} | {f"flank.{key}": getattr(gear.flank, key) for key in _DEPTHS}
    for key, depth in depths.items():
        words = (f"{depth:.4g} m at a module of {module:.4g} m", f"up to {_DEPTH:g} of it")
        yield from outside(f"{address}.{key}", abs(depth), (0.0, _DEPTH * module), words, ("", "um meant?"))


def _meshes(layout: Layout) -> Iterator[str]:
    for mesh in layout.meshes:
        address = f"meshes.{mesh.name}"
        given = mesh.given_mean
        if given is not None:
            width = mesh.width * mesh.helices
            low, high = (_MESH_PER_WIDTH[0] * width, _MESH_PER_WIDTH[1] * width) if width else _MESH
            words = (f"{given:.4g} N/m", f"{low:.2g} to {high:.2g} N/m")
            slips = ("N/um or N/(mm um) meant?", "is its unit right?")
            yield from outside(f"{address}.stiffness", given, (low, high), words, slips)
        module = mesh.pinion.part.normal_module
        for item in mesh.part.transmission_error if module else ():
            if module and item.amplitude > _ERROR * module:
                yield said(
                    f"{address}.transmission_error",
                    f"{item.amplitude:.4g} m at a module of {module:.4g} m",
                    f"up to {_ERROR:g} of it",
                    "um meant?",
                )
        if module and mesh.part.backlash and mesh.part.backlash > module:
            yield said(f"{address}.backlash", f"{mesh.part.backlash:.4g} m", "below the module", "um or mm meant?")
        if module and abs(mesh.part.index_error) > module:
            yield said(
                f"{address}.index_error", f"{mesh.part.index_error:.4g} m", "below the module", "um or mm meant?"
            )
        words = (f"{mesh.part.friction_coefficient:.4g}", "0.02 to 0.1")
        yield from outside(
            f"{address}.friction_coefficient", mesh.part.friction_coefficient, (0.0, 1.0), words, _PERCENT
        )
        oil = mesh.part.lubricant_viscosity
        if oil:
            words = (f"{oil:.4g} Pa s", f"{_VISCOSITY[0]:g} to {_VISCOSITY[1]:g} Pa s")
            slips = ("is its unit right?", "mPa s (cP) meant?")
            yield from outside(f"{address}.lubricant_viscosity", oil, _VISCOSITY, words, slips)
        words = (f"{mesh.part.damping_ratio:.4g}", "0.02 to 0.2")
        yield from outside(f"{address}.damping_ratio", mesh.part.damping_ratio, (0.0, _DAMPING), words, _PERCENT)


def _bodies(layout: Layout) -> Iterator[str]:
    for body in layout.bodies:
        mass = body.body.mass
        if not mass or not body.body.polar_inertia:
            continue
        radius = math.sqrt(body.body.polar_inertia / mass)
        if not _GYRATION[0] <= radius <= _GYRATION[1]:
            yield said(
                f"{body.part}.polar_inertia",
                f"{body.body.polar_inertia:.4g} kg m^2 on {mass:.4g} kg, a radius of gyration of {radius:.3g} m",
                f"{_GYRATION[0]:g} to {_GYRATION[1]:g} m",
                "kg mm^2 or g meant?",
            )
    for name, unbalance in layout.model.unbalances.items():
        mass = mass_of(layout, unbalance.shaft)
        if mass and unbalance.magnitude > _ECCENTRICITY * mass:
            yield said(
                f"unbalances.{name}.magnitude",
                f"{unbalance.magnitude:.4g} kg m, which puts its rotor off by {1e3 * unbalance.magnitude / mass:.3g} mm",
                f"up to {1e3 * _ECCENTRICITY:g} mm",
                "g mm meant?",
            )
