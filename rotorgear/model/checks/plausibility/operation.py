"""Operating points, loads, damping and angles that the physics of a machine makes unlikely."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from itertools import pairwise
from typing import Annotated, Any, get_args, get_origin

from pydantic import BaseModel

from rotorgear.model.checks.plausibility.sentence import GRAVITY, mass_of, outside, said
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.fields import Unit
from rotorgear.model.parts.load import Load
from rotorgear.model.parts.operation import Operation
from rotorgear.quantity import RPM_PER_RAD_S

# Surface of a shaft, and gears at their base circles, in m/s.
_SURFACE = 600.0
_FLANKS = 400.0
# Speed over the first bending frequency of a shaft on its bearings.
_SUPERCRITICAL = 60.0
# Shear stress of the thinnest part of a shaft in Pa under its torque; stress along a shaft under a force, and by its own weight.
_SHEAR = (3e4, 1.5e9)
_STRESS = 1.5e9
_WEIGHT = 3e8
_WEIGHTS = (1.5, 300.0)
_DAMPING = 0.5
_PERCENT = ("", "percent meant?")
_ALPHA = 1e4
_BETA = 1e-2
_RIPPLE = 3.0
# A file of so many rows is sampled; a gap of so many of their spacings is one of missing rows.
_MANY = 20
_GAP = 10.0
# Two turns: more is no angle of a drawing, nor a phase that one would write.
_ANGLE = 4.0 * math.pi


def operation(layout: Layout) -> Iterator[str]:
    """Gravity, damping, speed, weight, torques and forces, and angles."""
    model = layout.model
    if model.operation and model.operation.gravity:
        size = math.sqrt(sum(x * x for x in model.operation.gravity))
        if size:
            words = (f"{size:.4g} m/s^2", "9.81 m/s^2")
            slips = ("is it in g?", "mm/s^2 meant?")
            yield from outside("operation.gravity", size, _WEIGHTS, words, slips)
    words = (f"{model.damping.modal_ratio:.4g}", "0.005 to 0.05")
    yield from outside("damping.modal_ratio", model.damping.modal_ratio, (0.0, _DAMPING), words, _PERCENT)
    words = (f"{model.damping.rayleigh_beta:.4g} s", f"up to {_BETA:g} s")
    yield from outside("damping.rayleigh_beta", model.damping.rayleigh_beta, (0.0, _BETA), words, ("", "us meant?"))
    words = (f"{model.damping.rayleigh_alpha:.4g} 1/s", f"up to {_ALPHA:g} 1/s")
    yield from outside(
        "damping.rayleigh_alpha", model.damping.rayleigh_alpha, (0.0, _ALPHA), words, ("", "is its unit right?")
    )
    yield from _speed(layout)
    yield from _weight(layout)
    yield from _loads(layout)
    for name, load in model.loads.items():
        yield from _history(layout, f"loads.{name}.history", load)
    for table in type(model).model_fields:
        parts = getattr(model, table)
        for address, part in parts.items() if isinstance(parts, dict) else ():
            yield from _angles(f"{table}.{address}", part)


def _speed(layout: Layout) -> Iterator[str]:
    """The first of shafts, gears and bearings that runs faster than any does."""
    model = layout.model
    if not model.operation or not model.operation.speed:
        return
    speeds = {name: abs(model.operation.speed * layout.train.ratio(name)) for name in model.shafts}
    found: list[tuple[str, float, str, str]] = []

    def runs(shaft: str, value: float, most: float, what: str) -> None:
        if value > most:
            found.append((shaft, speeds[shaft], f"{what} at {value:.3g} m/s", f"up to {most:g} m/s"))

    for name, shaft in model.shafts.items():
        largest = max((section.outer_diameter for section in shaft.sections), default=0.0)
        runs(name, 0.5 * largest * speeds[name], _SURFACE, "whose surface runs")
    for gear in layout.gears:
        runs(gear.shaft, gear.base_radius * speeds[gear.shaft], _FLANKS, f"whose gear '{gear.name}' runs")
    for name, bearing in model.bearings.items():
        if (inside := bearing.geometry) is not None:
            value = 0.5 * inside.surrounds * speeds[bearing.shaft]
            runs(bearing.shaft, value, inside.fastest, inside.runs.format(name))
    if model.has("bending"):
        for name in model.shafts:
            first = _first_bending(layout, name)
            if first and speeds[name] > _SUPERCRITICAL * first:
                times = f"{speeds[name] / first:.3g} times its first bending frequency on rigid bearings"
                found.append((name, speeds[name], times, f"up to {_SUPERCRITICAL:g} times"))
    for shaft_name, speed, what, usual in found[:1]:
        yield said(
            "operation.speed", f"{speed * RPM_PER_RAD_S:.4g} rpm of shaft '{shaft_name}', {what}", usual, "rpm meant?"
        )


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
    mass = mass_of(layout, name)
    return math.sqrt(48.0 * modulus * length / inertia / (span**3 * mass)) if mass else None


def _weight(layout: Layout) -> Iterator[str]:
    """Stress of the thickest section of a shaft under its own weight in the middle between its ends."""
    for name, shaft in layout.model.shafts.items():
        thick = max((section.outer_diameter for section in shaft.sections), default=0.0)
        if not thick:
            continue
        mass = mass_of(layout, name)
        stress = 8.0 * GRAVITY * mass * shaft.length / (math.pi * thick**3)
        words = (
            f"{mass:.4g} kg with what it carries, under which it would have {1e-6 * stress:.3g} MPa",
            "up to 300 MPa",
        )
        yield from outside(f"shafts.{name}", stress, (0.0, _WEIGHT), words, ("", "is a mass in g, or a density off?"))


def _loads(layout: Layout) -> Iterator[str]:
    """Torques, powers and forces against the strength of their shafts."""
    model = layout.model
    given: dict[str, tuple[Operation | Load, str]] = {
        f"loads.{name}": (load, load.shaft) for name, load in model.loads.items() if load.shaft is not None
    }
    if model.operation:
        given["operation"] = (model.operation, model.operation.input_shaft)
    speed = model.operation.speed if model.operation else None
    for address, (part, shaft) in given.items():
        thinnest = min((s.outer_diameter for s in model.shafts[shaft].sections if not s.rigid), default=0.0)
        ripple = getattr(part, "ripple", 0.0)
        yield from outside(f"{address}.ripple", ripple, (0.0, _RIPPLE), (f"{ripple:.4g}", "0 to 1"), _PERCENT)
        if not thinnest:
            continue
        thick = f"in a shaft of {1e3 * thinnest:.3g} mm"
        force = math.sqrt(sum(x * x for x in getattr(part, "force", None) or ()))
        yield from _along(f"{address}.force", force, thinnest)
        turning = abs(speed * layout.train.ratio(shaft)) if speed else 0.0
        torque = part.torque or (part.power / turning if part.power and turning else 0.0)
        if not torque:
            continue
        stress = 16.0 * torque / (math.pi * thinnest**3)
        words = (f"{torque:.4g} N m, a shear stress of {1e-6 * stress:.3g} MPa {thick}", "0.03 to 1500 MPa")
        slips = ("kN m or kW meant?", "N mm or W meant?")
        yield from outside(f"{address}.{'torque' if part.torque else 'power'}", stress, _SHEAR, words, slips)


def _along(address: str, force: float, thickness: float) -> Iterator[str]:
    """A force against the strength of a shaft of a thickness along its axis."""
    stress = 4.0 * force / (math.pi * thickness**2)
    words = (
        f"{force:.4g} N, a stress of {1e-6 * stress:.3g} MPa in a shaft of {1e3 * thickness:.3g} mm",
        "up to 1500 MPa",
    )
    yield from outside(address, stress, (0.0, _STRESS), words, ("", "is its unit right?"))


def _history(layout: Layout, address: str, load: Load) -> Iterator[str]:
    """Forces of a file against the strength of their shaft, and rows that are missing among many."""
    history = load.history
    if history is None:
        return
    sections = layout.model.shafts[load.shaft].sections if load.shaft is not None else ()
    thinnest = min((section.outer_diameter for section in sections if not section.rigid), default=0.0)
    forces = [
        abs(x) for name, row in zip(history.components, history.values, strict=True) if name[0] == "f" for x in row
    ]
    if thinnest and forces:
        yield from _along(address, max(forces), thinnest)
    spacings = [b - a for a, b in pairwise(history.places)]
    usual = sorted(spacings)[len(spacings) // 2]
    widest = max(spacings)
    if len(spacings) >= _MANY and widest > _GAP * usual:
        begin = history.places[spacings.index(widest)]
        unit = "s" if history.over == "time" else "rad"
        words = (f"no row from {begin:.6g} to {begin + widest:.6g} {unit}", f"one every {usual:.4g} {unit}")
        yield said(address, *words, "are rows missing? it is taken as linear between them")


@lru_cache
def _angle_names(part: type[BaseModel]) -> tuple[str, ...]:
    """Names of the fields of a part that are angles."""

    def marked(kind: Any) -> bool:
        if get_origin(kind) is Annotated:
            return any(isinstance(item, Unit) and item.dimension == "angle" for item in get_args(kind)[1:])
        return any(marked(each) for each in get_args(kind))

    def is_angle(field: Any) -> bool:
        return marked(field.annotation) or any(isinstance(m, Unit) and m.dimension == "angle" for m in field.metadata)

    return tuple(name for name, field in part.model_fields.items() if is_angle(field))


def _angles(address: str, part: Any) -> Iterator[str]:
    """Angles of a part and of the parts in it that go round more than twice."""
    if isinstance(part, tuple):
        for number, item in enumerate(part):
            yield from _angles(f"{address}[{number}]", item)
        return
    if not isinstance(part, BaseModel):
        return
    own = _angle_names(type(part))
    for name in type(part).model_fields:
        value = getattr(part, name)
        if name in own and isinstance(value, float):
            words = (f"{value:.6g} rad, {math.degrees(value):.6g} deg", "-720 to 720 deg")
            yield from outside(f"{address}.{name}", value, (-_ANGLE, _ANGLE), words, ("deg meant?", "deg meant?"))
        elif isinstance(value, tuple | BaseModel):
            yield from _angles(f"{address}.{name}", value)
