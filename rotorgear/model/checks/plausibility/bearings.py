"""Bearings that the physics of a machine makes unlikely: stiffness, damping, films, rolling elements, pedestals, couplings."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.model.checks.plausibility.sentence import ASK, GRAVITY, mass_of, outside, said
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.supports import Bearing, RollingElements, StiffnessMatrix

# Sag of a rotor on its bearings in m; stiffness of a bearing in N/m that nothing reaches.
_SAG = 1e-3
_STIFFEST = 1e12
# Radial clearance over radius of a film; viscosity in Pa s; temperature of an inlet in K; density of oils in kg/m^3.
_FILM = (1e-4, 0.02)
_VISCOSITY = (5e-5, 3.0)
_CELSIUS = 273.15
_INLET = (233.15, 423.15)
_OIL = (500.0, 2000.0)
# Depth of the taper of thrust pads over their clearance.
_TAPER = (0.02, 50.0)
# What surrounds a shaft over its diameters; damping of a bearing over the critical one.
_FITS = {"rolling": (0.3, 12.0), "journal": (0.3, 3.0), "thrust": (0.3, 12.0)}
_OVERDAMPED = 1e3
# Of the diameter of an element: clearance and preload; share of its circle that the elements of a row fill; length of a roller.
_CLEARANCE = 0.05
_PRESSED = 0.02
_FILLED = (0.15, 1.0)
_LONG = (0.2, 30.0)
# Preload over elements times diameter squared in Pa: some five times the static capacity.
_PRELOAD = 3e8
# Twist of a coupling under the torque of the operating point in rad.
_TWIST = 0.5


def bearings(layout: Layout) -> Iterator[str]:
    model = layout.model
    weights = {name: GRAVITY * mass_of(layout, name) for name in model.shafts}
    for name, bearing in model.bearings.items():
        address = f"bearings.{name}"
        held = sum(other.shaft == bearing.shaft for other in model.bearings.values())
        weight = weights[bearing.shaft] / held if model.has("bending") else 0.0
        matrix = bearing.stiffness or (bearing.table[0].stiffness if bearing.table else None)
        yield from _stiffness(f"{address}.stiffness", matrix, weight)
        if bearing.pedestal is not None:
            yield from _stiffness(f"{address}.pedestal.stiffness", bearing.pedestal.stiffness, weight, given=True)
        if bearing.rolling:
            yield from _rolling(f"{address}.rolling", bearing.rolling)
        yield from _films(address, bearing)
        yield from _fits(address, bearing, layout)
        yield from _dampers(address, bearing, weights[bearing.shaft] / GRAVITY)


def _films(address: str, bearing: Bearing) -> Iterator[str]:
    """Gap, viscosity and density of oil films."""
    for key in ("journal", "thrust"):
        film = getattr(bearing, key)
        if film is None:
            continue
        radius = 0.5 * (film.diameter if key == "journal" else film.outer_diameter)
        share = film.clearance / radius
        words = (f"{film.clearance:.4g} m, {share:.2g} of the radius", f"{_FILM[0]:g} to {_FILM[1]:g}")
        yield from outside(f"{address}.{key}.clearance", share, _FILM, words, ("is its unit right?", "um meant?"))
        if film.viscosity is not None:
            words = (f"{film.viscosity:.4g} Pa s", f"{_VISCOSITY[0]:g} to {_VISCOSITY[1]:g} Pa s")
            slips = ("is its unit right?", "mPa s (cP) meant?")
            yield from outside(f"{address}.{key}.viscosity", film.viscosity, _VISCOSITY, words, slips)
        if film.inlet_temperature is not None:
            words = (f"{film.inlet_temperature - _CELSIUS:.4g} degC", "-40 to 150 degC")
            slips = ("degC meant, not K?", "is its unit right?")
            yield from outside(f"{address}.{key}.inlet_temperature", film.inlet_temperature, _INLET, words, slips)
        if key == "thrust" and film.taper is not None:
            share = film.taper / film.clearance
            words = (f"{film.taper:.4g} m, {share:.3g} of the clearance", f"{_TAPER[0]:g} to {_TAPER[1]:g} of it")
            yield from outside(f"{address}.thrust.taper", share, _TAPER, words, ("is its unit right?", "um meant?"))
        words = (f"{film.density:.4g} kg/m^3", f"{_OIL[0]:g} to {_OIL[1]:g} kg/m^3")
        yield from outside(
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
        share = (_FITS[key][0] * thin, _FITS[key][1] * thick)
        size = getattr(part, name)
        words = (f"{size:.4g} m on a shaft of {thin:.4g} to {thick:.4g} m", f"{share[0]:.2g} to {share[1]:.2g} m")
        yield from outside(f"{address}.{key}.{name}", size, share, words, ("is its unit right?", "mm meant?"))


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
    yield from outside(f"{address}.damping", ratio, (0.0, _OVERDAMPED), words, ASK)


def _stiffness(address: str, matrix: StiffnessMatrix | None, weight: float, given: bool = False) -> Iterator[str]:
    """Stiffness across the shaft against the weight on it; `given`: directions without one are rigid."""
    if matrix is None:
        return
    rows = matrix.as_rows()
    across = [rows[i][i] for i in range(2) if rows[i][i] or not given]
    if not any(any(row) for row in rows):
        if not given:
            yield said(address, "0 in all directions", "1e6 to 1e10 N/m", "it holds nothing; leave it out")
        return
    if not across:
        return
    if max(across) > _STIFFEST:
        yield said(address, f"{max(across):.4g} N/m", "1e6 to 1e10 N/m", "is its unit right?")
    softest = min(across)
    if max(across) > 0.0 and weight > _SAG * softest:
        sag = "no stiffness across" if softest == 0.0 else f"{softest:.4g} N/m, on which its rotor sags by"
        amount = "" if softest == 0.0 else f" {1e3 * weight / softest:.3g} mm"
        yield said(address, f"{sag}{amount}", "1e6 to 1e10 N/m", "N/mm or N/um meant?")


def _rolling(address: str, rolling: RollingElements) -> Iterator[str]:
    """Clearance, preload, number and length of rolling elements against their diameter."""
    size = rolling.element_diameter
    for key, value, most in (
        ("clearance", rolling.clearance, _CLEARANCE),
        ("preload_displacement", rolling.preload_displacement, _PRESSED),
    ):
        words = (f"{value:.4g} m", f"up to {most:g} of the diameter of an element")
        yield from outside(f"{address}.{key}", value, (0.0, most * size), words, ("", "um meant?"))
    filled = rolling.elements * size / (math.pi * rolling.pitch_diameter)
    words = (f"{size:.4g} m, of which {rolling.elements} fill {filled:.2g} of their circle", "0.15 to 1 of it")
    yield from outside(f"{address}.element_diameter", filled, _FILLED, words, ASK)
    pressure = rolling.preload_force / (rolling.elements * size**2)
    words = (
        f"{rolling.preload_force:.4g} N, {1e-6 * pressure:.3g} MPa on the squares of the diameters",
        "up to 300 MPa",
    )
    yield from outside(f"{address}.preload_force", pressure, (0.0, _PRELOAD), words, ("", "is its unit right?"))
    if rolling.length is not None:
        words = (f"{rolling.length:.4g} m, {rolling.length / size:.3g} diameters", f"{_LONG[0]:g} to {_LONG[1]:g}")
        yield from outside(
            f"{address}.length", rolling.length / size, _LONG, words, ("is its unit right?", "mm meant?")
        )


def couplings(layout: Layout) -> Iterator[str]:
    """Twist of couplings under the torque of the operating point."""
    operation = layout.model.operation
    if operation is None:
        return
    speed = abs(operation.speed or 0.0)
    torque = operation.torque or (operation.power / speed if operation.power and speed else 0.0)
    for name, coupling in layout.model.couplings.items():
        stiffness = coupling.stiffness.as_rows()[5][5]
        ratio = abs(float(layout.train.ratio(coupling.from_shaft)))
        if stiffness <= 0.0 or not ratio:
            continue
        twist = torque / ratio / stiffness
        words = (
            f"{stiffness:.4g} N m/rad, which the whole torque of the operating point would twist by {twist:.3g} rad",
            f"up to {_TWIST:g} rad",
        )
        yield from outside(f"couplings.{name}.stiffness", twist, (0.0, _TWIST), words, ("", "kN m/rad meant?"))
